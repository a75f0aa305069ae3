// SPDX-License-Identifier: BSD-3-Clause
#include "Figures.h"

#include "Bandwidth.h"
#include "Baselines.h"
#include "FigureRun.h"
#include "Machine.h"
#include "Threads.h"
#include "Timing.h"

#include "LinearMethods/FemWarp.h"
#include "Morpher/AffineModes.h"
#include "Morpher/Blend.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>

namespace benchmark
{
namespace
{
constexpr double Tolerance = 1e-8;                // of every iterative solution here
constexpr double LargestResidual = 2 * Tolerance; // recomputed, which adds rounding of its own
constexpr int AxisX = 0;
constexpr int AxisZ = 2;

double perNode(double bytes, const Problem& problem)
{
  return bytes / static_cast<double>(problem.mesh.numberOfNodes());
}

class Run : public FigureRun
{
public:
  using FigureRun::FigureRun;

  void peakMemory(const Problem& problem);
  void cube(const Problem& problem);
  void longBrick(const Problem& problem);
  void modes(const Problem& problem);
  void series(const std::vector<Problem>& problems);

private:
  /// The bytes of a set that no cache holds.
  double beyondCaches() const;
  void bandwidth(const Problem& problem);
};

void Run::peakMemory(const Problem& problem)
{
  say("peak memory, " + problem.name);
  std::unique_ptr<morph::Monitor> monitor;
  morph::FemWarp femWarp;
  morph::Points moved;
  const double growth = peakMemoryGrowth(
    [&]
    {
      monitor = makeMonitor(this->cores_);
      femWarp.setTolerance(Tolerance);
    },
    [&]
    {
      femWarp.prepare(problem.mesh, problem.partition, *monitor);
      femWarp.evaluate(problem.target, moved, *monitor);
    });
  this->add(problem, "peak memory growth a node, cold", perNode(growth, problem), "B",
    Target::atMost(1000));
}

double Run::beyondCaches() const
{
  const double available = static_cast<double>(sysconf(_SC_AVPHYS_PAGES)) * sysconf(_SC_PAGESIZE);
  return this->options_.quick ? 1e8
                              : std::min(std::max(4 * lastLevelCacheBytes(), 1e9), 0.5 * available);
}

/// The memory bandwidth that bounds a step.
void Run::bandwidth(const Problem& problem)
{
  say("memory bandwidth");
  const auto monitor = makeMonitor(this->cores_);
  const double large = this->beyondCaches();
  this->settleDown();
  const Bandwidth measured = measureBandwidth(static_cast<std::size_t>(large), *monitor);
  const std::string size =
    " over " + std::to_string(static_cast<int>(large / 1e6)) + " MB" + withThreads(this->cores_);
  this->add(problem, "memory bandwidth, read" + size, measured.read, "B/s");
  this->add(problem, "memory bandwidth, triad" + size, measured.triad, "B/s");
}

void Run::cube(const Problem& problem)
{
  MethodTimes all;
  MethodTimes one;
  std::vector<double> cholmodCold;
  std::vector<double> cholmodSolve;
  std::vector<double> jacobiSeconds;
  DirectResult cholmod;
  IterativeResult jacobi;
  morph::Points moved;
  morph::Points movedByOne;
  std::unique_ptr<morph::FemWarp> femWarp;
  const auto monitor = makeMonitor(this->cores_);
  const auto serial = makeMonitor(1);
  for (int i = 0; i < this->options_.repeat; ++i)
  {
    say(problem.name + ", repetition " + std::to_string(i + 1));
    femWarp.reset();
    this->settleDown();
    timeMethod<morph::FemWarp>(problem, Tolerance, *serial, one, movedByOne);
    this->settleDown();
    femWarp = timeMethod<morph::FemWarp>(problem, Tolerance, *monitor, all, moved);
    const LinearSystem system = linearSystem(*femWarp, problem);
    this->settleDown();
    cholmod = solveByCholmod(system);
    cholmodCold.push_back(cholmod.coldSeconds);
    cholmodSolve.push_back(cholmod.solveSeconds);
    this->settleDown();
    jacobi = solveByJacobiCg(system, Tolerance);
    jacobiSeconds.push_back(jacobi.seconds);
  }
  if (moved != movedByOne)
  {
    throw std::runtime_error("The moved mesh depends on the number of threads.");
  }
  this->checkAgainst(
    problem, "difference from CHOLMOD", cholmod.x, solution(*femWarp, problem, moved));
  this->checkAgainst(problem, "Jacobi CG's difference from CHOLMOD", cholmod.x, jacobi.x);
  this->check(problem, "relative residual, recomputed",
    relativeResidual(linearSystem(*femWarp, problem), solution(*femWarp, problem, moved)),
    LargestResidual);

  const double warm = median(all.warm);
  this->add(problem, "CHOLMOD cold / cold", median(cholmodCold) / median(all.cold), "",
    Target::atLeast(15));
  this->add(problem, "warm / CHOLMOD solve", warm / median(cholmodSolve), "", Target::atMost(1));
  this->bandwidth(problem);

  this->add(problem, "iterations", all.iterations, "");
  this->addTimes(problem, 1, one);
  this->addTimes(problem, this->cores_, all);
  this->add(problem, "CHOLMOD cold", median(cholmodCold), "s");
  this->add(problem, "CHOLMOD solve", median(cholmodSolve), "s");
  this->add(problem, "CHOLMOD factor a node", perNode(cholmod.factorBytes, problem), "B");
  this->add(
    problem, "Jacobi CG, the assembled system" + withThreads(1), median(jacobiSeconds), "s");
  this->add(problem, "Jacobi CG iterations, three columns", jacobi.iterations, "");
  this->add(
    problem, "Jacobi CG / warm" + withThreads(1), median(jacobiSeconds) / median(one.warm), "");
}

void Run::longBrick(const Problem& problem)
{
  MethodTimes times;
  std::vector<double> cholmodCold;
  DirectResult cholmod;
  morph::Points moved;
  std::unique_ptr<morph::FemWarp> femWarp;
  const auto monitor = makeMonitor(this->cores_);
  for (int i = 0; i < this->options_.repeat; ++i)
  {
    say(problem.name + ", repetition " + std::to_string(i + 1));
    femWarp.reset();
    this->settleDown();
    femWarp = timeMethod<morph::FemWarp>(problem, Tolerance, *monitor, times, moved);
    this->settleDown();
    cholmod = solveByCholmod(linearSystem(*femWarp, problem));
    cholmodCold.push_back(cholmod.coldSeconds);
  }
  const double cold = median(times.cold);
  this->checkAgainst(
    problem, "difference from CHOLMOD", cholmod.x, solution(*femWarp, problem, moved));
  this->addTimes(problem, this->cores_, times);
  this->add(problem, "CHOLMOD cold", median(cholmodCold), "s");
  this->add(problem, "CHOLMOD cold / cold", median(cholmodCold) / cold, "");
  if (this->options_.skipKlu)
  {
    say("KLU skipped");
    return;
  }
  say(problem.name + ", KLU, once");
  this->settleDown();
  const std::optional<DirectResult> klu =
    solveByKlu(linearSystem(*femWarp, problem), this->options_.kluLimit);
  if (!klu)
  {
    say("KLU stopped at its limit");
    return;
  }
  this->checkAgainst(problem, "difference from KLU", klu->x, solution(*femWarp, problem, moved));
  this->add(problem, "KLU cold", klu->coldSeconds, "s");
  this->add(problem, "KLU solve", klu->solveSeconds, "s");
  this->add(problem, "KLU factors a node", perNode(klu->factorBytes, problem), "B");
  this->add(problem, "KLU cold / cold", klu->coldSeconds / cold, "", Target::atLeast(150));
}

void Run::series(const std::vector<Problem>& problems)
{
  std::vector<MethodTimes> times(problems.size());
  std::vector<double> residual(problems.size());
  const auto monitor = makeMonitor(this->cores_);
  // Repetitions outside: a slow spell of the machine falls on all sizes alike.
  for (int i = 0; i < this->options_.repeat; ++i)
  {
    say("series, repetition " + std::to_string(i + 1));
    for (std::size_t p = 0; p < problems.size(); ++p)
    {
      morph::Points moved;
      this->settleDown();
      const auto femWarp =
        timeMethod<morph::FemWarp>(problems[p], Tolerance, *monitor, times[p], moved);
      residual[p] = relativeResidual(
        linearSystem(*femWarp, problems[p]), solution(*femWarp, problems[p], moved));
    }
  }
  std::vector<double> nodes;
  std::vector<double> cold;
  std::vector<double> warm;
  for (std::size_t p = 0; p < problems.size(); ++p)
  {
    nodes.push_back(static_cast<double>(problems[p].mesh.numberOfNodes()));
    cold.push_back(median(times[p].cold));
    warm.push_back(median(times[p].warm));
    this->add(problems[p], "series, cold" + withThreads(this->cores_), cold.back(), "s");
    this->add(problems[p], "series, iterations", times[p].iterations, "");
  }
  const auto worst = std::max_element(residual.begin(), residual.end());
  this->check(problems[worst - residual.begin()], "series, largest relative residual, recomputed",
    *worst, LargestResidual);
  const std::string tail = " against nodes, series of " + std::to_string(problems.size());
  this->add(problems.back(), "exponent of cold time" + tail, logLogSlope(nodes, cold), "",
    Target::atMost(1.2));
  this->add(problems.back(), "exponent of warm time" + tail, logLogSlope(nodes, warm), "");
}

/// The median seconds of several calls after the first.
template <typename Call>
double secondsOf(const Call& call)
{
  call();
  std::vector<double> seconds;
  for (int i = 0; i < 21; ++i)
  {
    const Stopwatch watch;
    call();
    seconds.push_back(watch.seconds());
  }
  return median(seconds);
}

/// A drag once the fields of its motion are there: an affine motion that fades, and three saved
/// shapes.
void Run::modes(const Problem& problem)
{
  say("modes, " + problem.name);
  const auto monitor = makeMonitor(this->cores_);
  morph::FemWarp femWarp;
  femWarp.setTolerance(Tolerance);
  femWarp.prepare(problem.mesh, problem.partition, *monitor);
  const std::vector<morph::Index>& ids = problem.partition.prescribed;
  const morph::Points rest = problem.mesh.points(ids, morph::allColumns);
  const double low = rest.col(AxisZ).minCoeff(), high = rest.col(AxisZ).maxCoeff();
  morph::AffineFields fields(rest.rows(), 4);
  for (morph::Index i = 0; i < rest.rows(); ++i)
  {
    const double weight = std::max(0., 2 * (rest(i, AxisZ) - low) / (high - low) - 1);
    fields.row(i) << weight, weight * rest.row(i);
  }
  morph::AffineMotion motion;
  motion << .1, .05, -.02, 0, .2, .02, .05, 0, -.1, 0, 0, .1;
  const morph::Points targets = rest + fields * motion.transpose();
  morph::Points direct, moved;
  femWarp.evaluate(targets, direct, *monitor);
  morph::AffineModes handle;
  handle.prepare(femWarp, fields, *monitor);
  this->settleDown();
  const double dragged =
    secondsOf([&] { handle.evaluate(femWarp, motion, targets, moved, *monitor); });
  this->checkAgainst(problem, "affine handle's difference from the method", direct, moved);
  this->add(problem, "affine handle's evaluation" + withThreads(this->cores_), dragged, "s",
    Target::atMost(2e-3));

  std::vector<morph::Points> displacements;
  for (int axis = 0; axis < 3; ++axis)
  {
    displacements.emplace_back(morph::Points::Zero(rest.rows(), 3));
    displacements.back().col(axis) = fields.col(0);
  }
  const std::vector<morph::Points> shapes = femWarp.basis(displacements, *monitor);
  const std::vector<morph::WeightedMode> weighted = { { &shapes[0], .3 }, { &shapes[1], -.2 },
    { &shapes[2], .1 } };
  this->settleDown();
  const double blended =
    secondsOf([&] { morph::blend(problem.mesh.points, weighted, moved, *monitor); });
  const double bytes = 5 * 24. * static_cast<double>(problem.mesh.numberOfNodes());
  this->add(problem, "blend of 3 shapes" + withThreads(this->cores_), blended, "s");
  for (const bool memory : { true, false })
  {
    this->settleDown();
    const Bandwidth measured =
      measureBandwidth(static_cast<std::size_t>(memory ? this->beyondCaches() : bytes), *monitor);
    const std::string where = memory ? "memory bandwidth" : "bandwidth of its working set";
    this->add(problem, "blend / (its bytes / " + where + ")", blended / (bytes / measured.best()),
      "", memory ? Target::atMost(1.5) : Target::none());
  }
}
}

Report measureFigures(const Options& options, bool& correct)
{
  const int side = options.quick ? 12 : 50;
  const int across = options.quick ? 6 : 20;
  const int shortest = options.quick ? 18 : 60;
  const int longest = options.quick ? 42 : 260;
  const int step = options.quick ? 12 : 40;

  Run run(options);
  const Problem cube = twistedBrick(side, side, side, AxisZ);
  run.peakMemory(cube); // forks, so before there are threads
  run.cube(cube);
  run.modes(cube);
  std::vector<Problem> bricks;
  for (int length = shortest; length <= longest; length += step)
  {
    bricks.push_back(twistedBrick(length, across, across, AxisX));
  }
  run.series(bricks);
  run.longBrick(bricks.back());
  correct = run.correct;
  return run.report;
}
}
