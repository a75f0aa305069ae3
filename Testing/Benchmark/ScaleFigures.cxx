// SPDX-License-Identifier: BSD-3-Clause
#include "ScaleFigures.h"

#include "FigureRun.h"
#include "LinearSystem.h"
#include "Machine.h"
#include "Threads.h"
#ifdef MORPH_BENCHMARK_HYPRE
#include "HypreBaseline.h"
#endif

#include "Boundary/Classification.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "LinearMethods/SimplexLinear.h"
#include "LinearMethods/WeightedResidual.h"
#include "Mesh/Topology.h"
#include "Quality/ScaledJacobian.h"
#include "Solvers/SpdSolver.h"

#include <cstdlib>
#include <functional>
#include <memory>
#include <stdexcept>
#include <type_traits>

namespace benchmark
{
namespace
{
constexpr double Tolerance = 1e-8;
constexpr double LeastEfficiency = 0.8; // of two threads
constexpr int AxisZ = 2;

class Run : public FigureRun
{
public:
  using FigureRun::FigureRun;

  void measure(const Problem& problem);

private:
  /// Times `work` on one thread and on all: adds its seconds and parallel efficiency. Returns its
  /// median seconds on all threads.
  double stage(const Problem& problem, const std::string& name,
    const std::function<void(morph::Monitor&)>& work);
  template <typename Method>
  double method(const Problem& problem, const std::string& name);
  void mesh(const Problem& problem, double femWarpCold);
  void againstHypre(const Problem& problem);
};

double Run::stage(
  const Problem& problem, const std::string& name, const std::function<void(morph::Monitor&)>& work)
{
  std::vector<double> one, all;
  for (int i = 0; i < this->options_.repeat; ++i)
  {
    for (const int threads : { 1, this->cores_ })
    {
      const auto monitor = makeMonitor(threads);
      this->settleDown();
      const Stopwatch watch;
      work(*monitor);
      (threads == 1 ? one : all).push_back(watch.seconds());
      if (this->cores_ == 1)
      {
        all = one;
        break;
      }
    }
  }
  this->add(problem, name + withThreads(this->cores_), median(all), "s");
  if (this->cores_ > 1)
  {
    this->add(problem, name + ": parallel efficiency" + withThreads(this->cores_),
      median(one) / median(all) / this->cores_, "",
      this->cores_ == 2 ? Target::atLeast(LeastEfficiency) : Target::none());
  }
  return median(all);
}

/// Prepare and warm evaluate. Returns the seconds of both.
template <typename Method>
double Run::method(const Problem& problem, const std::string& name)
{
  say(problem.name + ", " + name);
  std::unique_ptr<Method> prepared;
  const double prepare = this->stage(problem, name + ", prepare",
    [&](morph::Monitor& monitor)
    {
      prepared = std::make_unique<Method>();
      if constexpr (std::is_same_v<Method, morph::FemWarp> ||
                    std::is_same_v<Method, morph::LogBarrierWarp>)
      {
        prepared->setTolerance(Tolerance);
      }
      prepared->prepare(problem.mesh, problem.partition, monitor);
    });
  morph::Points moved;
  morph::EvaluateReport report;
  const auto evaluate = [&](morph::Monitor& monitor)
  { report = prepared->evaluate(problem.target, moved, monitor); };
  const double warm = this->stage(problem, name + ", warm evaluate", evaluate);
  this->add(problem, name + ": iterations", report.iterations, "");
  return prepare + warm;
}

/// What the filters do beside a method, and its share of FEMWARP's cold step with them.
void Run::mesh(const Problem& problem, double femWarpCold)
{
  say(problem.name + ", mesh");
  morph::BoundaryFaces faces;
  const double boundary = this->stage(problem, "boundary faces",
    [&](morph::Monitor& monitor) { faces = morph::boundaryFaces(problem.mesh, monitor); });
  const double surfaces = this->stage(problem, "surfaces and curves, of Extract Morph Boundary",
    [&](morph::Monitor& monitor) { morph::classify(problem.mesh, faces, {}, monitor); });
  const double quality = this->stage(problem, "quality",
    [&](morph::Monitor& monitor)
    { morph::measureQuality(problem.mesh, problem.mesh.points, {}, {}, monitor); });
  const double whole = boundary + quality + femWarpCold;
  this->add(problem, "share of boundary faces in a cold FEMWARP step", boundary / whole, "");
  this->add(problem, "share of quality in a cold FEMWARP step", quality / whole, "");
  this->add(problem, "surfaces and curves over a cold FEMWARP step", surfaces / whole, "");
}

/// Three right-hand sides by our solver and by hypre's, on one thread each.
void Run::againstHypre(const Problem& problem)
{
#ifdef MORPH_BENCHMARK_HYPRE
  say(problem.name + ", hypre");
  std::vector<double> prepare, warm, start, hypreSetUp, ownSetUp, solve;
  HypreResult hypre;
  morph::EvaluateReport report;
  const auto monitor = makeMonitor(1);
  for (int i = 0; i < this->options_.repeat; ++i)
  {
    morph::FemWarp femWarp;
    femWarp.setTolerance(Tolerance);
    morph::Points moved;
    this->settleDown();
    const Stopwatch prepareWatch;
    femWarp.prepare(problem.mesh, problem.partition, *monitor);
    prepare.push_back(prepareWatch.seconds());
    femWarp.evaluate(problem.target, moved, *monitor);
    const Stopwatch warmWatch;
    report = femWarp.evaluate(problem.target, moved, *monitor);
    warm.push_back(warmWatch.seconds());
    const LinearSystem system = linearSystem(femWarp, problem);
    const morph::Points coordinates = problem.mesh.points(femWarp.rows(), morph::allColumns);
    morph::LinearEquations equations = { system.matrix, coordinates };
    this->settleDown();
    const Stopwatch setUpWatch;
    morph::SpdSolver solver;
    solver.prepare(std::move(equations), *monitor);
    ownSetUp.push_back(setUpWatch.seconds());
    this->settleDown();
    hypre = solveByHypre(system, Tolerance);
    start.push_back(hypre.startSeconds);
    hypreSetUp.push_back(hypre.setUpSeconds);
    solve.push_back(hypre.solveSeconds);
    this->checkAgainst(
      problem, "difference from hypre", hypre.x, solution(femWarp, problem, moved));
  }
  this->add(problem, "MPI's start", start.front(), "s");
  this->add(problem, "iterations" + withThreads(1), report.iterations, "");
  this->add(problem, "hypre's iterations", hypre.iterations, "");
  this->add(problem, "hypre's set-up", median(hypreSetUp), "s");
  this->add(problem, "hypre's solution of three right-hand sides", median(solve), "s");
  this->add(problem, "hypre's set-up / ours, of the same matrix" + withThreads(1),
    median(hypreSetUp) / median(ownSetUp), "", Target::atLeast(1));
  // Assembly, which hypre leaves to its caller, is in prepare.
  this->add(problem, "hypre's set-up / prepare, with our assembly" + withThreads(1),
    median(hypreSetUp) / median(prepare), "");
  this->add(problem, "hypre's solution / warm evaluate" + withThreads(1),
    median(solve) / median(warm), "", Target::atLeast(1));
#else
  say(problem.name + ": built without hypre");
#endif
}

void Run::measure(const Problem& problem)
{
  this->againstHypre(problem);
  const double cold = this->method<morph::FemWarp>(problem, "FEMWARP");
  this->mesh(problem, cold);
  this->method<morph::LogBarrierWarp>(problem, "LBWARP");
  this->method<morph::WeightedResidual>(problem, "weighted residual");
  this->method<morph::SimplexLinear>(problem, "simplex-linear");
}
}

Report measureScaleFigures(const Options& options, bool& correct)
{
  Run run(options);
  for (const std::string& side : options.files)
  {
    const int cells = std::atoi(side.c_str());
    if (cells < 2 || cells > 500)
    {
      throw std::runtime_error("Cells a side are from 2 to 500, not \"" + side + "\".");
    }
    run.measure(twistedBrick(cells, cells, cells, AxisZ));
  }
  correct = run.correct;
  return run.report;
}
}
