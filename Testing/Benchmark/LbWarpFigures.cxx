// SPDX-License-Identifier: BSD-3-Clause
#include "LbWarpFigures.h"

#include "Baselines.h"
#include "FigureRun.h"
#include "Threads.h"

#include "FemWarp.h"
#include "LogBarrierRow.h"
#include "LogBarrierSystem.h"
#include "LogBarrierWarp.h"

#include <algorithm>

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

void Run::weights(const Problem& problem)
{
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
    {
      const Stopwatch watch;
      morph::LogBarrierRow row(problem.mesh, around, columns);
      steps = 0;
      for (const morph::Index node : free)
      {
        row.compute(node, false);
        steps += row.iterations();
      }
      rows.push_back(watch.seconds());
    }
    this->settleDown();
    {
      const Stopwatch watch;
      const morph::LogBarrierSystem made = morph::logBarrierSystem(
        problem.mesh, free, problem.partition.prescribed, false, *monitor);
      system.push_back(watch.seconds());
    }
    // The weights without the search for neighbors, ours and Eigen's, on the same numbers.
    this->settleDown();
    morph::LogBarrierRow row(problem.mesh, around, columns);
    morph::LogBarrierWeights solver;
    double ours = 0;
    double theirs = 0;
    morph::Points offsets;
    Eigen::VectorXd found;
    for (const morph::Index node : free)
    {
      row.compute(node, false);
      const auto k = static_cast<morph::Index>(row.columns().size());
      offsets.resize(k, 3);
      found.resize(k);
      for (morph::Index j = 0; j < k; ++j)
      {
        offsets.row(j) = problem.mesh.points.row(columns.nodes[row.columns()[j]]) -
                         problem.mesh.points.row(node);
      }
      const Stopwatch first;
      solver.compute(reinterpret_cast<const double(*)[3]>(offsets.data()), static_cast<int>(k),
        found.data());
      ours += first.seconds();
      const Stopwatch second;
      const Eigen::VectorXd expected = weightsByEigen(offsets);
      theirs += second.seconds();
      difference = std::max(difference, (found - expected).cwiseAbs().maxCoeff());
    }
    alone.push_back(ours);
    eigen.push_back(theirs);
  }
  this->check(problem, "difference from Eigen's weights", difference, 1e-10);
  this->add(problem, "weights and search for neighbors a node and thread",
    microseconds(median(rows), problem), "us", Target::atMost(2));
  this->add(problem, "weights alone a node and thread", microseconds(median(alone), problem), "us");
  this->add(problem, "plain Eigen's weights a node and thread",
    microseconds(median(eigen), problem), "us");
  this->add(problem, "plain Eigen / weights alone", median(eigen) / median(alone), "");
  this->add(problem, "whole matrix a node and thread", microseconds(median(system), problem), "us");
  this->add(
    problem, "Newton steps a node", static_cast<double>(steps) / static_cast<double>(free.size()), "");
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
    relativeResidual(linearSystem(*method, problem), freeDisplacement(problem, moved)),
    LargestResidual);
  this->add(problem, "cold / FEMWARP's cold" + withThreads(1),
    median(barrier.cold) / median(femWarp.cold), "", Target::atMost(4));
  this->add(problem, "cold / FEMWARP's cold" + withThreads(this->cores_),
    median(barrierAll.cold) / median(femWarpAll.cold), "", Target::atMost(4));
  this->add(problem, "warm / FEMWARP's warm" + withThreads(1),
    median(barrier.warm) / median(femWarp.warm), "");
  this->add(problem, "memory kept a node",
    static_cast<double>(method->memory()) / static_cast<double>(problem.mesh.numberOfNodes()), "B");
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
      worst = std::max(worst,
        relativeResidual(linearSystem(*method, problems[p]), freeDisplacement(problems[p], moved)));
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
  const DirectResult klu = solveByKlu(linearSystem(*method, problem));
  this->checkAgainst(problem, "difference from KLU", klu.x, freeDisplacement(problem, moved));
  this->add(problem, "KLU cold", klu.coldSeconds, "s");
  // KLU is given the matrix: the weights are not in its time, but they are in ours.
  this->add(problem, "KLU cold / cold, weights included", klu.coldSeconds / median(times.cold), "",
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
