// SPDX-License-Identifier: BSD-3-Clause
#include "HypreBaseline.h"

#include "Timing.h"

#include "Distributed/HypreSolver.h"

#include <cstdlib>

namespace benchmark
{
namespace
{
constexpr int MaxIterations = 500;

/// Returns the seconds that MPI took to start, if it has not run before.
double startMpi()
{
  int running = 0;
  MPI_Initialized(&running);
  if (running)
  {
    return 0;
  }
  const Stopwatch watch;
  MPI_Init(nullptr, nullptr);
  std::atexit([] { MPI_Finalize(); });
  return watch.seconds();
}
}

HypreResult solveByHypre(const LinearSystem& system, double tolerance)
{
  HypreResult result;
  result.startSeconds = startMpi();
  const morph::distributed::Ranks ranks(MPI_COMM_SELF);
  morph::Monitor monitor;
  morph::distributed::HypreSolver solver(ranks, morph::distributed::HypreSolver::Kind::Symmetric);
  const Stopwatch setUp;
  solver.prepare({ system.matrix, {}, morph::CsrMatrix(system.matrix.rows(), 0) }, monitor);
  // The hierarchy is set up with the first solution.
  result.x = morph::Points::Zero(system.rightHandSide.rows(), 3);
  const double copySeconds = setUp.seconds();
  const double before = solver.seconds().setUp;
  const Stopwatch solve;
  result.iterations =
    solver.solve(system.rightHandSide, result.x, tolerance, MaxIterations, monitor).iterations;
  const double late = solver.seconds().setUp - before;
  result.setUpSeconds = copySeconds + late;
  result.solveSeconds = solve.seconds() - late;
  return result;
}
}
