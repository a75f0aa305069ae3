// SPDX-License-Identifier: BSD-3-Clause
#include "Baselines.h"
#include "Timing.h"

#include <klu.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <thread>

namespace benchmark
{
namespace
{
/// Owns what KLU allocates.
struct Session
{
  klu_common common;
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;

  Session() { klu_defaults(&this->common); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session()
  {
    klu_free_numeric(&this->numeric, &this->common);
    klu_free_symbolic(&this->symbolic, &this->common);
  }

  void require(bool done, const char* step) const
  {
    if (!done || this->common.status != KLU_OK)
    {
      throw std::runtime_error(std::string("KLU: ") + step + " failed with status " +
                               std::to_string(this->common.status) + ".");
    }
  }

  void solve(Eigen::MatrixXd& columns)
  {
    const auto n = static_cast<int>(columns.rows());
    this->require(klu_tsolve(this->symbolic, this->numeric, n, static_cast<int>(columns.cols()),
                    columns.data(), &this->common) != 0,
      "the solution");
  }
};

DirectResult solve(const LinearSystem& system)
{
  // KLU reads columns: it gets the transpose, and solves with the transpose of that. It does not
  // write to the arrays.
  const morph::CsrMatrix& matrix = system.matrix;
  auto* columnStart = const_cast<int*>(matrix.outerIndexPtr());
  auto* row = const_cast<int*>(matrix.innerIndexPtr());
  auto* value = const_cast<double*>(matrix.valuePtr());
  Eigen::MatrixXd columns = system.rightHandSide;

  Session session;
  DirectResult result;
  const Stopwatch cold;
  session.symbolic =
    klu_analyze(static_cast<int>(matrix.rows()), columnStart, row, &session.common);
  session.require(session.symbolic != nullptr, "the analysis");
  session.numeric = klu_factor(columnStart, row, value, session.symbolic, &session.common);
  session.require(session.numeric != nullptr, "the factorisation");
  session.solve(columns);
  result.coldSeconds = cold.seconds();
  result.x = columns;

  columns = system.rightHandSide;
  const Stopwatch warm;
  session.solve(columns);
  result.solveSeconds = warm.seconds();
  result.factorBytes =
    sizeof(double) * (static_cast<double>(session.numeric->lnz) + session.numeric->unz);
  return result;
}

/// Memory that a child process shares with this one: a DirectResult without its vector, and the
/// vector.
class SharedResult
{
public:
  explicit SharedResult(morph::Index rows)
    : rows_(rows)
    , bytes_((Numbers + 3 * rows) * sizeof(double))
  {
    void* memory =
      mmap(nullptr, this->bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED)
    {
      throw std::runtime_error("mmap() failed.");
    }
    this->values_ = static_cast<double*>(memory);
  }
  SharedResult(const SharedResult&) = delete;
  SharedResult& operator=(const SharedResult&) = delete;
  ~SharedResult() { munmap(this->values_, this->bytes_); }

  void write(const DirectResult& result)
  {
    this->values_[0] = result.coldSeconds;
    this->values_[1] = result.solveSeconds;
    this->values_[2] = result.factorBytes;
    Eigen::Map<morph::Points>(this->values_ + Numbers, this->rows_, 3) = result.x;
  }

  DirectResult read() const
  {
    return { this->values_[0], this->values_[1], this->values_[2],
      Eigen::Map<const morph::Points>(this->values_ + Numbers, this->rows_, 3) };
  }

private:
  static constexpr morph::Index Numbers = 3;

  morph::Index rows_;
  std::size_t bytes_;
  double* values_;
};

/// Whether the child has ended by itself within `limit` seconds; it is ended otherwise. `status`:
/// waitpid()'s.
bool waitFor(pid_t child, double limit, int& status)
{
  const Stopwatch watch;
  pid_t ended = 0;
  while ((ended = waitpid(child, &status, WNOHANG)) == 0 && watch.seconds() < limit)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (ended < 0)
  {
    throw std::runtime_error("waitpid() failed.");
  }
  if (ended == 0)
  {
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
  }
  return ended == child;
}
}

std::optional<DirectResult> solveByKlu(const LinearSystem& system, double limit)
{
  SharedResult shared(system.matrix.rows());
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0)
  {
    throw std::runtime_error("fork() failed.");
  }
  if (child == 0)
  {
    prctl(PR_SET_PDEATHSIG, SIGKILL); // it would go on for minutes after an interrupted benchmark
    int status = 1;
    try
    {
      shared.write(solve(system));
      status = 0;
    }
    catch (const std::exception& error)
    {
      std::fprintf(stderr, "%s\n", error.what());
    }
    _exit(status);
  }
  int status = 0;
  if (!waitFor(child, limit, status))
  {
    return std::nullopt;
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
  {
    throw std::runtime_error("KLU failed: see above, or out of memory.");
  }
  return shared.read();
}
}
