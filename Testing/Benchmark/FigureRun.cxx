// SPDX-License-Identifier: BSD-3-Clause
#include "FigureRun.h"

#include "Machine.h"
#include "Threads.h"
#include "Timing.h"

#include <cstdio>

namespace benchmark
{
namespace
{
constexpr double LargestDifference = 1e-6; // from a direct solution, of the mesh's size
}

void say(const std::string& text)
{
  std::fprintf(stderr, "%s\n", text.c_str());
}

std::string withThreads(int n)
{
  return ", " + std::to_string(n) + (n == 1 ? " thread" : " threads");
}

FigureRun::FigureRun(const Options& options)
  : options_(options)
  , cores_(numberOfCores())
{
}

void FigureRun::settleDown() const
{
  if (!settle(this->options_.waitIdle))
  {
    say("other processes are busy: measuring all the same");
  }
}

void FigureRun::add(const Problem& problem, const std::string& figure, double measured,
  const std::string& unit, Target target)
{
  this->report.add(
    problem.name + ": " + figure, measured, unit, this->options_.quick ? Target::none() : target);
}

void FigureRun::check(
  const Problem& problem, const std::string& figure, double measured, double atMost)
{
  this->report.add(problem.name + ": " + figure, measured, "", Target::atMost(atMost));
  this->correct = this->correct && measured <= atMost; // false for NaN
}

void FigureRun::checkAgainst(const Problem& problem, const std::string& figure,
  const morph::Points& reference, const morph::Points& x)
{
  const double difference = (x - reference).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  this->check(problem, figure + ", of the size", difference / problem.size, LargestDifference);
}

void FigureRun::addTimes(const Problem& problem, int threads, const MethodTimes& times)
{
  const std::string tail = withThreads(threads);
  this->add(problem, "prepare" + tail, median(times.prepare), "s");
  this->add(problem, "cold" + tail, median(times.cold), "s");
  this->add(problem, "warm" + tail, median(times.warm), "s");
}
}
