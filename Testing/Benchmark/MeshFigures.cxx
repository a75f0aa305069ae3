// SPDX-License-Identifier: BSD-3-Clause
#include "MeshFigures.h"

#include "Baselines.h"
#include "FigureRun.h"
#include "ReadProblem.h"
#include "Threads.h"

#include "LinearMethods/FemWarp.h"
#include "LinearMethods/LogBarrierWarp.h"

namespace benchmark
{
namespace
{
constexpr double Tolerance = 1e-10; // of both methods, the filters' default
constexpr double LargestResidual = 2 * Tolerance;

class Run : public FigureRun
{
public:
  using FigureRun::FigureRun;

  template <typename Method>
  void measure(const Problem& problem, const std::string& name);

private:
  void againstKlu(
    const Problem& named, const LinearSystem& system, const morph::Points& x, double warm);
};

template <typename Method>
void Run::measure(const Problem& problem, const std::string& name)
{
  Problem named = problem;
  named.name += ", " + name;
  say(named.name);
  MethodTimes times;
  morph::Points moved;
  const auto monitor = makeMonitor(this->cores_);
  std::unique_ptr<Method> method;
  for (int i = 0; i < this->options_.repeat; ++i)
  {
    method.reset();
    this->settleDown();
    method = timeMethod<Method>(named, Tolerance, *monitor, times, moved);
  }
  this->addTimes(named, this->cores_, times);
  this->add(named, "iterations", times.iterations, "");
  const LinearSystem system = linearSystem(*method, named);
  const morph::Points x = solution(*method, named, moved);
  this->check(named, "relative residual, recomputed", relativeResidual(system, x), LargestResidual);
  this->againstKlu(named, system, x, median(times.warm));
}

/// As often as the others where that is within the limit, since it may take minutes.
void Run::againstKlu(
  const Problem& named, const LinearSystem& system, const morph::Points& x, double warm)
{
  if (this->options_.skipKlu)
  {
    say("KLU skipped");
    return;
  }
  double left = this->options_.kluLimit;
  std::vector<double> cold, solve;
  DirectResult last;
  for (int i = 0; i < this->options_.repeat && left > 0; ++i)
  {
    say(named.name + ", KLU, repetition " + std::to_string(i + 1));
    this->settleDown();
    const Stopwatch watch;
    const std::optional<DirectResult> klu = solveByKlu(system, left);
    left -= watch.seconds();
    if (!klu)
    {
      break;
    }
    last = *klu;
    cold.push_back(klu->coldSeconds);
    solve.push_back(klu->solveSeconds);
  }
  this->add(named, "KLU's repetitions within the limit", static_cast<double>(cold.size()), "");
  if (cold.empty())
  {
    this->add(named, "KLU, stopped at the limit", this->options_.kluLimit, "s");
    this->add(named, "limit / warm", this->options_.kluLimit / warm, "");
    return;
  }
  this->checkAgainst(named, "difference from KLU", last.x, x);
  this->add(named, "KLU cold" + withThreads(1), median(cold), "s");
  this->add(named, "KLU solve" + withThreads(1), median(solve), "s");
  this->add(named, "KLU factors", last.factorBytes, "B");
  this->add(named, "KLU cold / warm", median(cold) / warm, "");
}
}

Report measureMeshFigures(const Options& options, bool& correct)
{
  Run run(options);
  for (const std::string& file : options.files)
  {
    const Problem problem = readProblem(file);
    run.measure<morph::FemWarp>(problem, "FEMWARP");
    run.measure<morph::LogBarrierWarp>(problem, "LBWARP");
  }
  correct = run.correct;
  return run.report;
}
}
