// SPDX-License-Identifier: BSD-3-Clause
#include "LbWarpFigures.h"

#include "Baselines.h"
#include "FigureRun.h"
#include "Threads.h"

#include "LinearMethods/FemWarp.h"
#include "LinearMethods/LogBarrierSystem.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "LinearMethods/NodeWeights.h"

#include <algorithm>
#include <utility>

namespace benchmark
{
namespace
{
constexpr double Tolerance = 1e-10; // of both methods
constexpr double LargestResidual = 2 * Tolerance;
constexpr double Jitter = 0.2;
constexpr int AxisX = 0;
constexpr int AxisZ = 2;

class Run : public FigureRun
{
public:
  using FigureRun::FigureRun;

  void weights(const Problem& problem);
  void againstFemWarp(const Problem& problem);
  void series(const std::vector<Problem>& problems);
  void againstKlu(const Problem& problem);
};

double microseconds(double seconds, const Problem& problem)
{
  return 1e6 * seconds / static_cast<double>(problem.partition.free.size());
}

/// The neighborhoods of some nodes, one after another.
struct Neighborhoods
{
  std::vector<morph::Points> offsets;
  std::vector<Eigen::VectorXd> weights;
};

Neighborhoods neighborhoods(const Problem& problem, const morph::WeightColumns& columns,
  morph::NodeWeights& row, std::size_t first, std::size_t last)
{
  Neighborhoods result;
  for (std::size_t i = first; i < last; ++i)
  {
    const morph::Index node = problem.partition.free[i];
    row.compute(node, false);
    const auto k = static_cast<morph::Index>(row.columns().size());
    result.offsets.emplace_back(k, 3);
    result.weights.emplace_back(k);
    for (morph::Index j = 0; j < k; ++j)
    {
      result.offsets.back().row(j) =
        problem.mesh.points.row(columns.nodes[row.columns()[j]]) - problem.mesh.points.row(node);
    }
  }
  return result;
}

/// Processor time, not wall-clock: a microsecond a node is lost in what other processes do.
void Run::weights(const Problem& problem)
{
  constexpr std::size_t Batch = 1000; // its numbers stay in cache, as they do in a row by row run
  const morph::Adjacency around = morph::nodeToCells(problem.mesh);
  const std::vector<morph::Index>& free = problem.partition.free;
  const morph::WeightColumns columns(
    problem.mesh.numberOfNodes(), free, problem.partition.prescribed);
  const auto monitor = makeMonitor(1);
  std::vector<double> rows, alone, system, eigen;
  double difference = 0;
  morph::Index steps = 0;
  for (int i = 0; i < this->options_.repeat; ++i)
  {
    say(problem.name + ", weights, repetition " + std::to_string(i + 1));
    this->settleDown();
    morph::NodeWeights row(problem.mesh, around, columns);
    steps = 0;
    const ThreadStopwatch rowsWatch;
    for (const morph::Index node : free)
    {
      row.compute(node, false);
      steps += row.iterations();
    }
    rows.push_back(rowsWatch.seconds());

    const ThreadStopwatch systemWatch;
    morph::logBarrierSystem(problem.mesh, free, problem.partition.prescribed, false, *monitor);
    system.push_back(systemWatch.seconds());

    // The weights without the search for neighbors, ours and Eigen's, on the same numbers.
    morph::LogBarrierWeights solver;
    double ours = 0;
    double theirs = 0;
    for (std::size_t first = 0; first < free.size(); first += Batch)
    {
      Neighborhoods batch =
        neighborhoods(problem, columns, row, first, std::min(free.size(), first + Batch));
      const ThreadStopwatch watch;
      for (std::size_t n = 0; n < batch.offsets.size(); ++n)
      {
        solver.compute(reinterpret_cast<const double(*)[3]>(batch.offsets[n].data()),
          static_cast<int>(batch.offsets[n].rows()), batch.weights[n].data());
      }
      ours += watch.seconds();
      const ThreadStopwatch eigenWatch;
      std::vector<Eigen::VectorXd> expected;
      for (const morph::Points& offsets : batch.offsets)
      {
        expected.push_back(weightsByEigen(offsets));
      }
      theirs += eigenWatch.seconds();
      for (std::size_t n = 0; n < expected.size(); ++n)
      {
        difference = std::max(difference, (batch.weights[n] - expected[n]).cwiseAbs().maxCoeff());
      }
    }
    alone.push_back(ours);
    eigen.push_back(theirs);
  }
  this->check(problem, "difference from Eigen's weights", difference, 1e-10);
  this->add(problem, "weights, processor time a node", microseconds(median(alone), problem), "us",
    Target::atMost(2));
  this->add(problem, "plain Eigen's weights, processor time a node",
    microseconds(median(eigen), problem), "us");
  this->add(problem, "plain Eigen / weights", median(eigen) / median(alone), "");
  this->add(problem, "search for neighbors and weights, processor time a node",
    microseconds(median(rows), problem), "us", Target::atMost(2));
  this->add(
    problem, "whole matrix, processor time a node", microseconds(median(system), problem), "us");
  this->add(problem, "Newton steps a node",
    static_cast<double>(steps) / static_cast<double>(free.size()), "");
}

void Run::againstFemWarp(const Problem& problem)
{
  MethodTimes barrier, femWarp, barrierAll, femWarpAll;
  morph::Points moved, movedByAll;
  std::unique_ptr<morph::LogBarrierWarp> method;
  const auto one = makeMonitor(1);
  const auto all = makeMonitor(this->cores_);
  for (int i = 0; i < this->options_.repeat; ++i)
  {
    say(problem.name + ", repetition " + std::to_string(i + 1));
    method.reset();
    this->settleDown();
    timeMethod<morph::FemWarp>(problem, Tolerance, *one, femWarp, moved);
    this->settleDown();
    timeMethod<morph::LogBarrierWarp>(problem, Tolerance, *one, barrier, moved);
    this->settleDown();
    timeMethod<morph::FemWarp>(problem, Tolerance, *all, femWarpAll, movedByAll);
    this->settleDown();
    method = timeMethod<morph::LogBarrierWarp>(problem, Tolerance, *all, barrierAll, movedByAll);
    this->correct = this->correct && moved == movedByAll;
  }
  this->check(problem, "relative residual, recomputed",
    relativeResidual(linearSystem(*method, problem), solution(*method, problem, moved)),
    LargestResidual);
  this->add(problem, "cold / FEMWARP's cold" + withThreads(1),
    median(barrier.cold) / median(femWarp.cold), "", Target::atMost(4));
  this->add(problem, "cold / FEMWARP's cold" + withThreads(this->cores_),
    median(barrierAll.cold) / median(femWarpAll.cold), "", Target::atMost(4));
  this->add(problem, "warm / FEMWARP's warm" + withThreads(1),
    median(barrier.warm) / median(femWarp.warm), "");
  this->add(problem, "iterations", barrier.iterations, "");
  this->add(problem, "FEMWARP's iterations", femWarp.iterations, "");
  this->addTimes(problem, 1, barrier);
  this->addTimes(problem, this->cores_, barrierAll);
}

void Run::series(const std::vector<Problem>& problems)
{
  std::vector<MethodTimes> times(problems.size());
  double worst = 0;
  const auto monitor = makeMonitor(this->cores_);
  // Repetitions outside: a slow spell of the machine falls on all sizes alike.
  for (int i = 0; i < this->options_.repeat; ++i)
  {
    say("series, repetition " + std::to_string(i + 1));
    for (std::size_t p = 0; p < problems.size(); ++p)
    {
      morph::Points moved;
      this->settleDown();
      const auto method =
        timeMethod<morph::LogBarrierWarp>(problems[p], Tolerance, *monitor, times[p], moved);
      worst = std::max(worst, relativeResidual(linearSystem(*method, problems[p]),
                                solution(*method, problems[p], moved)));
    }
  }
  std::vector<double> nodes, cold, warm;
  for (std::size_t p = 0; p < problems.size(); ++p)
  {
    nodes.push_back(static_cast<double>(problems[p].mesh.numberOfNodes()));
    cold.push_back(median(times[p].cold));
    warm.push_back(median(times[p].warm));
    this->add(problems[p], "series, cold" + withThreads(this->cores_), cold.back(), "s");
    this->add(problems[p], "series, iterations", times[p].iterations, "");
  }
  this->check(
    problems.back(), "series, largest relative residual, recomputed", worst, LargestResidual);
  const std::string tail = " against nodes, series of " + std::to_string(problems.size());
  this->add(problems.back(), "exponent of cold time" + tail, logLogSlope(nodes, cold), "",
    Target::atMost(1.2));
  this->add(problems.back(), "exponent of warm time" + tail, logLogSlope(nodes, warm), "");
}

void Run::againstKlu(const Problem& problem)
{
  if (this->options_.skipKlu)
  {
    say("KLU skipped");
    return;
  }
  say(problem.name + ", KLU, once");
  MethodTimes times;
  morph::Points moved;
  const auto monitor = makeMonitor(this->cores_);
  std::unique_ptr<morph::LogBarrierWarp> method;
  for (int i = 0; i < this->options_.repeat; ++i)
  {
    method.reset();
    this->settleDown();
    method = timeMethod<morph::LogBarrierWarp>(problem, Tolerance, *monitor, times, moved);
  }
  this->settleDown();
  const std::optional<DirectResult> klu =
    solveByKlu(linearSystem(*method, problem), this->options_.kluLimit);
  if (!klu)
  {
    say("KLU stopped at its limit");
    return;
  }
  this->checkAgainst(problem, "difference from KLU", klu->x, solution(*method, problem, moved));
  this->add(problem, "KLU cold", klu->coldSeconds, "s");
  // KLU is given the matrix: the weights are not in its time, but they are in ours.
  this->add(problem, "KLU cold / cold, weights included", klu->coldSeconds / median(times.cold), "",
    Target::atLeast(100));
}
}

Report measureLbWarpFigures(const Options& options, bool& correct)
{
  const int side = options.quick ? 12 : 50;
  const int across = options.quick ? 6 : 20;
  const int shortest = options.quick ? 18 : 60;
  const int longest = options.quick ? 42 : 260;
  const int step = options.quick ? 12 : 40;

  Run run(options);
  const Problem jittered = twistedBrick(side, side, side, AxisZ, Jitter);
  run.weights(jittered);
  run.againstFemWarp(twistedBrick(side, side, side, AxisZ));
  run.againstFemWarp(jittered);
  std::vector<Problem> bricks;
  for (int length = shortest; length <= longest; length += step)
  {
    bricks.push_back(twistedBrick(length, across, across, AxisX, Jitter));
  }
  run.series(bricks);
  run.againstKlu(bricks.back());
  correct = run.correct;
  return run.report;
}
}
