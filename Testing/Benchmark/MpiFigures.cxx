// SPDX-License-Identifier: BSD-3-Clause
#include "MpiFigures.h"

#include "FigureRun.h"
#include "Machine.h"
#include "MpiTraffic.h"
#include "Threads.h"
#include "Timing.h"

#include "Distributed/DistributedMesh.h"
#include "Distributed/HypreSolver.h"
#include "Distributed/RankCommunicator.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/FemWarpSystem.h"
#include "Solvers/SpdSolver.h"

#include <time.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

namespace benchmark
{
namespace
{
using morph::Index;
using morph::Points;
using morph::distributed::DistributedMesh;
using morph::distributed::Ranks;

constexpr double Tolerance = 1e-8;
constexpr int AxisZ = 2;
constexpr int Warm = 5;

/// Waits for all ranks without taking a core from those that still work.
void meet()
{
  MPI_Request request;
  MPI_Ibarrier(MPI_COMM_WORLD, &request);
  for (int done = 0; done == 0;)
  {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    const timespec pause = { 0, 1000000 };
    nanosleep(&pause, nullptr);
  }
}

/// Bytes of this process: "VmRSS", resident, or "VmHWM", their peak.
double processBytes(const std::string& name)
{
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
  {
    if (line.rfind(name + ":", 0) == 0)
    {
      return 1024 * std::stod(line.substr(name.size() + 1));
    }
  }
  return 0;
}

/// The rank's slab of cells, with its nodes.
morph::distributed::Piece slabOf(const morph::Mesh& mesh, int rank, int ranks)
{
  morph::distributed::Piece piece;
  piece.mesh.offsets = { 0 };
  std::vector<Index> local(mesh.numberOfNodes(), -1);
  const Index cells = mesh.numberOfCells();
  for (Index c = cells * rank / ranks; c < cells * (rank + 1) / ranks; ++c)
  {
    for (Index k = 0; k < mesh.cellSize(c); ++k)
    {
      Index& node = local[mesh.cell(c)[k]];
      if (node < 0)
      {
        node = static_cast<Index>(piece.nodeIds.size());
        piece.nodeIds.push_back(mesh.cell(c)[k]);
      }
      piece.mesh.connectivity.push_back(node);
    }
    piece.mesh.types.push_back(mesh.types[c]);
    piece.mesh.offsets.push_back(static_cast<Index>(piece.mesh.connectivity.size()));
    piece.cellIds.push_back(c);
  }
  piece.mesh.points = mesh.points(piece.nodeIds, morph::allColumns);
  return piece;
}

/// Of the slowest rank, in seconds; of the rank that sends most, in bytes.
struct Times
{
  std::vector<double> cold, warm, mesh, hypreCold, hypreWarm;
  double iterations = 0; ///< a column
  double bytes = 0, messages = 0, reductions = 0, interfaceNodes = 0, memory = 0;
};

class Run : public FigureRun
{
public:
  using FigureRun::FigureRun;

  void cube(const Problem& problem);

private:
  void distributed(const Problem& problem, const Ranks& ranks, Times& times, Points& moved);
};

/// One repetition on these ranks. `moved`: of all nodes, where this rank owns them.
void Run::distributed(const Problem& problem, const Ranks& ranks, Times& times, Points& moved)
{
  const auto monitor = makeMonitor(1);
  morph::distributed::Piece piece = slabOf(problem.mesh, ranks.rank(), ranks.count());
  const double before = processBytes("VmRSS");
  std::ofstream("/proc/self/clear_refs") << "5"; // the peak is that from now on
  ranks.sum(1.);
  const Stopwatch cold;
  const DistributedMesh mesh(ranks, std::move(piece), 1, *monitor);
  times.mesh.push_back(ranks.maximum(cold.seconds()));
  std::vector<Index> prescribed, rows;
  for (Index n = 0; n < mesh.mesh().numberOfNodes(); ++n)
  {
    const std::vector<Index>& ids = problem.partition.prescribed;
    const auto found = std::lower_bound(ids.begin(), ids.end(), mesh.nodeId(n));
    if (found != ids.end() && *found == mesh.nodeId(n))
    {
      prescribed.push_back(n);
      rows.push_back(found - ids.begin());
    }
  }
  const Points target = problem.target(rows, morph::allColumns);
  morph::FemWarp method;
  method.setTolerance(Tolerance);
  method.prepare(mesh.mesh(), morph::partitionNodes(mesh.mesh(), prescribed), *monitor,
    std::make_shared<morph::distributed::RankCommunicator>(mesh));
  Points local;
  morph::EvaluateReport report = method.evaluate(target, local, *monitor);
  times.cold.push_back(ranks.maximum(cold.seconds()));
  const auto& hypre = dynamic_cast<const morph::distributed::HypreSolver&>(method.solver());
  const morph::distributed::HypreSolver::Seconds first = hypre.seconds();
  times.hypreCold.push_back(ranks.maximum(first.setUp + first.solve));
  times.memory = ranks.maximum((processBytes("VmHWM") - before) /
                               (static_cast<double>(problem.mesh.numberOfNodes()) / ranks.count()));
  std::vector<double> seconds;
  const MpiTraffic start = MpiTraffic::now();
  for (int i = 0; i < Warm; ++i)
  {
    const Stopwatch warm;
    report = method.evaluate(target, local, *monitor);
    seconds.push_back(ranks.maximum(warm.seconds()));
  }
  const MpiTraffic sent = MpiTraffic::now() - start;
  times.warm.push_back(median(seconds));
  times.hypreWarm.push_back(ranks.maximum((hypre.seconds().solve - first.solve) / Warm));
  times.iterations = report.iterations / 3.;
  times.bytes = ranks.maximum(sent.bytes / Warm);
  times.messages = ranks.maximum(sent.messages / Warm);
  times.reductions = ranks.maximum(sent.reductions / Warm);
  times.interfaceNodes = ranks.maximum(static_cast<double>(mesh.halo().bytes(1)) / sizeof(double));
  for (Index n = 0; n < local.rows(); ++n)
  {
    if (mesh.owns(n))
    {
      moved.row(mesh.nodeId(n)) = local.row(n);
    }
  }
}

void Run::cube(const Problem& problem)
{
  const Ranks world(MPI_COMM_WORLD);
  const bool isFirst = world.rank() == 0;
  Times all, one;
  std::vector<double> cold, warm, solver, warmSolver;
  int iterations = 0;
  Points serial(problem.mesh.numberOfNodes(), 3);
  Points moved = Points::Zero(problem.mesh.numberOfNodes(), 3), alone = moved;
  for (int i = 0; i < this->options_.repeat; ++i)
  {
    if (isFirst)
    {
      say(problem.name + ", repetition " + std::to_string(i + 1));
      this->settleDown();
    }
    meet();
    moved.setZero();
    this->distributed(problem, world, all, moved);
    meet();
    if (isFirst)
    {
      this->settleDown();
      this->distributed(problem, Ranks(MPI_COMM_SELF), one, alone);
      this->settleDown();
      // The serial method with as many threads as there are ranks.
      const auto monitor = makeMonitor(world.count());
      MethodTimes times;
      const auto method = timeMethod<morph::FemWarp>(problem, Tolerance, *monitor, times, serial);
      iterations = times.iterations;
      cold.push_back(times.cold.back());
      warm.push_back(times.warm.back());
      // Its solver's share: once more, by itself.
      morph::FemWarpSystem system = morph::femWarpSystem(
        problem.mesh, method->rows(), problem.partition.prescribed, {}, *monitor);
      const Points coordinates = problem.mesh.points(method->rows(), morph::allColumns);
      const Points displacement =
        problem.target - problem.mesh.points(problem.partition.prescribed, morph::allColumns);
      const Points rhs = -(system.coupling * displacement);
      morph::LinearEquations equations;
      equations.matrix.swap(system.interior);
      equations.coordinates = coordinates;
      const Stopwatch watch;
      morph::SpdSolver own;
      own.prepare(std::move(equations), *monitor);
      const double setUp = watch.seconds();
      Points x = Points::Zero(rhs.rows(), 3);
      own.solve(rhs, x, Tolerance, 2000, *monitor);
      warmSolver.push_back(watch.seconds() - setUp);
      solver.push_back(watch.seconds());
    }
    meet();
  }
  world.sum(moved.data(), static_cast<std::size_t>(moved.size()));
  if (!isFirst)
  {
    return;
  }
  const std::string ranks = std::to_string(world.count()) + " ranks";
  this->check(problem, "difference of " + ranks + " from the serial mesh, of its size",
    (moved - serial).rowwise().norm().maxCoeff() / problem.size, 1e-6);
  this->check(problem, "difference of 1 rank from the serial mesh, of its size",
    (alone - serial).rowwise().norm().maxCoeff() / problem.size, 1e-6);
  const double two = median(all.cold), single = median(one.cold);
  this->add(problem, "1 rank / " + ranks + ", cold", single / two, "", Target::atLeast(1.6));
  this->add(problem, "1 rank / " + ranks + ", warm", median(one.warm) / median(all.warm), "");
  const double ours = two - median(all.hypreCold), theirs = median(cold) - median(solver);
  this->add(problem,
    "all but hypre, " + ranks + " / all but the solver, serial" + withThreads(world.count()),
    ours / theirs, "", Target::atMost(1.5));
  this->add(
    problem, ranks + " / serial" + withThreads(world.count()) + ", cold", two / median(cold), "");
  this->add(problem, ranks + " / serial" + withThreads(world.count()) + ", warm",
    median(all.warm) / median(warm), "");
  this->add(problem, "hypre / our solver, cold", median(all.hypreCold) / median(solver), "");
  this->add(problem, "hypre / our solver, warm", median(all.hypreWarm) / median(warmSolver), "");
  this->add(problem, "hypre's iterations, a coordinate", all.iterations, "");
  this->add(problem, "our multigrid's iterations, all coordinates at once", iterations, "");
  this->add(problem, "nodes a rank sends as ghosts", all.interfaceNodes, "");
  this->add(problem, "bytes a rank sends a warm step", all.bytes, "B");
  this->add(problem, "bytes a rank sends a warm step / (24 B a ghost)",
    all.bytes / (24 * all.interfaceNodes), "");
  this->add(problem, "bytes a rank sends an iteration / (8 B a ghost)",
    all.bytes / (3 * all.iterations) / (8 * all.interfaceNodes), "");
  this->add(problem, "messages a rank sends a warm step", all.messages, "");
  this->add(problem, "reductions a warm step", all.reductions, "");
  this->add(problem, "peak memory a node, " + ranks, all.memory, "B");
  this->add(problem, "peak memory a node, 1 rank", one.memory, "B");
  this->add(problem, "cold, " + ranks, two, "s");
  this->add(problem, "cold, 1 rank", single, "s");
  this->add(problem, "cold, serial" + withThreads(world.count()), median(cold), "s");
  this->add(problem, "warm, " + ranks, median(all.warm), "s");
  this->add(problem, "warm, 1 rank", median(one.warm), "s");
  this->add(problem, "warm, serial" + withThreads(world.count()), median(warm), "s");
  this->add(problem, "ghosts and bodies, " + ranks, median(all.mesh), "s");
  this->add(problem, "hypre cold, " + ranks, median(all.hypreCold), "s");
  this->add(problem, "hypre warm, " + ranks, median(all.hypreWarm), "s");
  this->add(problem, "our solver cold, serial" + withThreads(world.count()), median(solver), "s");
}
}

Report measureMpi(const Options& options, bool& correct)
{
  const int side = options.quick ? 16 : 100;
  Run run(options);
  run.cube(twistedBrick(side, side, side, AxisZ));
  correct = run.correct;
  return run.report;
}
}
