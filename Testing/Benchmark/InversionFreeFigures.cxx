// SPDX-License-Identifier: BSD-3-Clause
#include "InversionFreeFigures.h"

#include "Baselines.h"
#include "FigureRun.h"
#include "Threads.h"

#include "LinearMethods/FemWarp.h"
#include "Quality/ScaledJacobian.h"
#include "Untangling/InversionFree.h"

namespace benchmark
{
namespace
{
constexpr int AxisZ = 2;
constexpr double ExactMinimum = 0.80; // of the exact map 0.804

struct Outcome
{
  std::vector<double> seconds;
  morph::EvaluateReport report;
  morph::Quality quality;
};

class Run : public FigureRun
{
public:
  using FigureRun::FigureRun;

  void whole(const Problem& problem);
  void againstCholmod(const Problem& problem);
  /// Repairs FEMWARP's mesh with some inner nodes put out of place, `spacing` cells apart.
  void repair(const Problem& problem, int side, int spacing);

private:
  /// Appends to `outcome.seconds`.
  void morphOnce(const Problem& problem, Outcome& outcome) const;
  void addCounts(const Problem& problem, const std::string& name, const Outcome& outcome);
};

void Run::morphOnce(const Problem& problem, Outcome& outcome) const
{
  this->settleDown();
  const auto monitor = makeMonitor(this->cores_);
  morph::InversionFree method;
  method.prepare(problem.mesh, problem.partition, *monitor);
  morph::Points moved;
  const Stopwatch watch;
  outcome.report = method.evaluate(problem.target, moved, *monitor);
  outcome.seconds.push_back(watch.seconds());
  outcome.quality = morph::measureQuality(problem.mesh, moved, {}, {}, *monitor);
}

void Run::addCounts(const Problem& problem, const std::string& name, const Outcome& outcome)
{
  for (const morph::Statistic& count : outcome.report.statistics)
  {
    this->add(problem, name + ": " + count.name, static_cast<double>(count.value), "");
  }
  this->add(problem, name + ": minimum scaled Jacobian", outcome.quality.minimum, "");
  this->add(problem, name + ": evaluate" + withThreads(this->cores_), median(outcome.seconds), "s");
}

void Run::whole(const Problem& problem)
{
  Outcome outcome;
  for (int i = 0; i < this->options_.repeat; ++i)
  {
    say(problem.name + ", repetition " + std::to_string(i + 1));
    this->morphOnce(problem, outcome);
  }
  this->check(problem, "inverted cells", static_cast<double>(outcome.quality.inverted), 0);
  this->add(
    problem, "minimum scaled Jacobian", outcome.quality.minimum, "", Target::atLeast(ExactMinimum));
  this->addCounts(problem, "whole", outcome);
}

void Run::againstCholmod(const Problem& problem)
{
  say(problem.name + ", once");
  Outcome whole;
  this->morphOnce(problem, whole);
  this->check(problem, "inverted cells", static_cast<double>(whole.quality.inverted), 0);
  this->addCounts(problem, "whole", whole);

  const auto monitor = makeMonitor(this->cores_);
  morph::FemWarp femWarp;
  femWarp.prepare(problem.mesh, problem.partition, *monitor);
  say(problem.name + ", CHOLMOD");
  this->settleDown();
  const DirectResult cholmod = solveByCholmod(linearSystem(femWarp, problem));
  const double factorise = cholmod.coldSeconds - cholmod.solveSeconds;
  this->add(problem, "CHOLMOD's factorisation of FEMWARP's system", factorise, "s");
  this->add(problem, "evaluate / CHOLMOD's factorisation", median(whole.seconds) / factorise, "",
    Target::atMost(10));
}

void Run::repair(const Problem& problem, int side, int spacing)
{
  constexpr int Rows = 5;       // a node out of place inverts the four cells on one of its sides
  constexpr double Shift = 1.3; // of a cell
  const auto monitor = makeMonitor(this->cores_);
  morph::FemWarp femWarp;
  femWarp.prepare(problem.mesh, problem.partition, *monitor);
  morph::Points warped;
  std::vector<double> linear, prepare, repair;
  morph::Quality before, after;
  for (int i = 0; i < this->options_.repeat; ++i)
  {
    this->settleDown();
    const Stopwatch watch;
    femWarp.evaluate(problem.target, warped, *monitor);
    linear.push_back(watch.seconds());
    morph::Points moved = warped;
    const int start = (side - (Rows - 1) * spacing) / 2;
    for (int row = 0; row < Rows * Rows; ++row)
    {
      const morph::Index node =
        start + row / Rows * spacing +
        (side + 1) * (start + row % Rows * spacing + (side + 1) * (side / 2));
      moved.row(node) += Shift * (warped.row(node + 1) - warped.row(node));
    }
    before = morph::measureQuality(problem.mesh, moved, {}, {}, *monitor);
    const Stopwatch prepareWatch;
    morph::InversionFree method;
    method.setNearOnly(true);
    method.prepare(problem.mesh, problem.partition, *monitor);
    prepare.push_back(prepareWatch.seconds());
    const Stopwatch repairWatch;
    method.repair(moved, *monitor);
    repair.push_back(repairWatch.seconds());
    after = morph::measureQuality(problem.mesh, moved, {}, {}, *monitor);
  }
  const std::string name = "repair, " + std::to_string(spacing) + " cells apart: ";
  this->check(problem, name + "inverted cells left", static_cast<double>(after.inverted), 0);
  this->add(problem, name + "inverted cells", static_cast<double>(before.inverted), "");
  this->add(problem, name + "minimum scaled Jacobian", after.minimum, "");
  this->add(problem, name + "over FEMWARP's evaluate", median(repair) / median(linear), "",
    Target::atMost(10));
  this->add(problem, name + "with its prepare, over FEMWARP's evaluate",
    (median(prepare) + median(repair)) / median(linear), "", Target::atMost(10));
}
}

Report measureInversionFreeFigures(const Options& options, bool& correct)
{
  Run run(options);
  const int small = options.quick ? 8 : 20, middle = options.quick ? 10 : 40;
  const int large = options.quick ? 12 : 50;
  run.whole(twistedBrick(small, small, small, AxisZ));
  run.whole(twistedBrick(middle, middle, middle, AxisZ));
  const Problem largest = twistedBrick(large, large, large, AxisZ);
  run.againstCholmod(largest);
  run.repair(largest, large, 2);
  run.repair(largest, large, options.quick ? 2 : 8);
  correct = run.correct;
  return run.report;
}
}
