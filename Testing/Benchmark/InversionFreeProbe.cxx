// SPDX-License-Identifier: BSD-3-Clause
// Times the inversion-free morph on one problem. It compiles against the cores of older states,
// too, so that Utilities/benchmark_inversion_free.py runs both in turn.
#include "Mesh/Topology.h"
#include "Quality/ScaledJacobian.h"
#include "Untangling/InversionFree.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace
{
using morph::Index;

constexpr double Nanosecond = 1e-9;
constexpr double MebiByte = 1024; // in kibibytes

constexpr const char* Usage =
  "Usage: inversion-free-probe PROBLEM THREADS [STEPS]\n"
  "Times prepare and evaluate on a problem that Utilities/benchmark_inversion_free.py writes, "
  "with\n"
  "the default number of steps that raise the minimum, or with STEPS. Prints one line of "
  "name=value\n"
  "pairs: seconds, processor seconds, scaled Jacobian, inverted cells, counts of the method, and\n"
  "memory in MiB before and at most.\n";

class Threads : public morph::Monitor
{
public:
  explicit Threads(int threads)
    : threads_(threads)
  {
  }

  int threads() const { return this->threads_; } // an override but for older cores

protected:
  void share(
    Index n, Index grain, const std::function<void(Index first, Index last)>& body) override
  {
    const Index parts = std::min<Index>(this->threads_, n / grain);
    if (parts < 2)
    {
      body(0, n);
      return;
    }
    std::vector<std::thread> others;
    for (Index part = 1; part < parts; ++part)
    {
      others.emplace_back([&, part] { body(part * n / parts, (part + 1) * n / parts); });
    }
    body(0, n / parts);
    for (std::thread& other : others)
    {
      other.join();
    }
  }

private:
  int threads_;
};

struct Problem
{
  morph::Mesh mesh;
  morph::NodePartition partition;
  morph::Points target;
};

template <typename Value>
void read(std::ifstream& file, Value* values, Index count)
{
  file.read(reinterpret_cast<char*>(values), count * static_cast<Index>(sizeof(Value)));
}

/// Little-endian numbers: #nodes, #cells, #corners of all cells, #prescribed (int64); points and
/// targets (double); offsets, connectivity, prescribed (int64); types (uint8).
Problem readProblem(const char* name)
{
  std::ifstream file(name, std::ios::binary);
  std::int64_t size[4] = {};
  read(file, size, 4);
  if (!file)
  {
    throw std::runtime_error(std::string("Cannot read ") + name + ".");
  }
  Problem problem;
  morph::Mesh& mesh = problem.mesh;
  mesh.points.resize(size[0], 3);
  read(file, mesh.points.data(), 3 * size[0]);
  problem.target.resize(size[3], 3);
  read(file, problem.target.data(), 3 * size[3]);
  mesh.offsets.resize(size[1] + 1);
  read(file, mesh.offsets.data(), size[1] + 1);
  mesh.connectivity.resize(size[2]);
  read(file, mesh.connectivity.data(), size[2]);
  std::vector<Index> prescribed(size[3]);
  read(file, prescribed.data(), size[3]);
  mesh.types.resize(size[1]);
  read(file, mesh.types.data(), size[1]);
  if (!file)
  {
    throw std::runtime_error(std::string(name) + " ends too early.");
  }
  problem.partition = morph::partitionNodes(mesh, std::move(prescribed));
  return problem;
}

double processorSeconds()
{
  timespec time = {};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + Nanosecond * static_cast<double>(time.tv_nsec);
}

double seconds()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The maximum resident memory so far, in MiB. getrusage() would count the caller's, too.
double mostMemory()
{
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line))
  {
    if (line.compare(0, 6, "VmHWM:") == 0)
    {
      return std::atof(line.c_str() + 6) / MebiByte;
    }
  }
  return 0;
}

/// An older state has no number of steps.
template <typename Method>
auto setSteps(Method& method, int steps, int) -> decltype(method.setSteps(steps))
{
  method.setSteps(steps);
}
template <typename Method>
void setSteps(Method&, int, long)
{
}

void measure(morph::Morpher& method, const Problem& problem, morph::Monitor& monitor)
{
  const double memory = mostMemory();
  const double start = seconds(), startOfWork = processorSeconds();
  method.prepare(problem.mesh, problem.partition, monitor);
  const double prepared = seconds(), preparedWork = processorSeconds();
  morph::Points moved;
  const morph::EvaluateReport report = method.evaluate(problem.target, moved, monitor);
  const double end = seconds(), endOfWork = processorSeconds();
  const double most = mostMemory();
  const morph::Quality quality = morph::measureQuality(problem.mesh, moved, {}, {}, monitor);
  std::printf(
    "cells=%lld prepare=%.4f evaluate=%.4f prepareCpu=%.4f evaluateCpu=%.4f "
    "minimum=%.6f mean=%.6f inverted=%lld memoryBefore=%.1f memoryMost=%.1f iterations=%d",
    static_cast<long long>(problem.mesh.numberOfCells()), prepared - start, end - prepared,
    preparedWork - startOfWork, endOfWork - preparedWork, quality.minimum, quality.mean,
    static_cast<long long>(quality.inverted), memory, most, report.iterations);
  for (const auto& count : report.statistics)
  {
    std::printf(" %s=%lld", count.name.c_str(), static_cast<long long>(count.value));
  }
  std::printf("\n");
}
}

int main(int argc, char** argv)
{
  if (argc < 3 || argc > 4)
  {
    std::fputs(Usage, stderr);
    return 2;
  }
  try
  {
    const Problem problem = readProblem(argv[1]);
    Threads monitor(std::max(1, std::atoi(argv[2])));
    morph::InversionFree method;
    if (argc == 4)
    {
      setSteps(method, std::atoi(argv[3]), 0);
    }
    measure(method, problem, monitor);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
  return 0;
}
