// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Timing.h"
#include "TwistedBrick.h"

#include "Morpher/Morpher.h"

#include <memory>
#include <stdexcept>
#include <vector>

namespace benchmark
{
/// What a morphing method took, in seconds, one entry a repetition.
struct MethodTimes
{
  std::vector<double> prepare;
  std::vector<double> cold; ///< prepare and the first evaluate
  /// an evaluate after that: the median of several, as when a boundary is dragged
  std::vector<double> warm;
  int iterations = 0;
};

/// One repetition: a fresh Method (a Morpher) after configure(method), prepared and evaluated
/// twice. Appends to `times`; `moved` becomes the moved mesh. Returns the morpher. Throws
/// std::runtime_error if the two evaluations differ in a bit.
template <typename Method, typename Configure>
std::unique_ptr<Method> timeConfigured(const Problem& problem, const Configure& configure,
  morph::Monitor& monitor, MethodTimes& times, morph::Points& moved)
{
  moved.resize(0, 3); // the first evaluate pays for its result
  const Stopwatch cold;
  auto method = std::make_unique<Method>();
  configure(*method);
  method->prepare(problem.mesh, problem.partition, monitor);
  times.prepare.push_back(cold.seconds());
  method->evaluate(problem.target, moved, monitor);
  times.cold.push_back(cold.seconds());

  const morph::Points first = moved;
  constexpr int Evaluations = 5;
  std::vector<double> seconds;
  morph::EvaluateReport report;
  for (int i = 0; i < Evaluations; ++i)
  {
    const Stopwatch warm;
    report = method->evaluate(problem.target, moved, monitor);
    seconds.push_back(warm.seconds());
  }
  times.warm.push_back(median(seconds));
  times.iterations = report.iterations;
  if (moved != first)
  {
    throw std::runtime_error("Two evaluations of the same boundary gave different meshes.");
  }
  return method;
}

/// The same for a Method with a tolerance.
template <typename Method>
std::unique_ptr<Method> timeMethod(const Problem& problem, double tolerance,
  morph::Monitor& monitor, MethodTimes& times, morph::Points& moved)
{
  return timeConfigured<Method>(
    problem, [tolerance](Method& method) { method.setTolerance(tolerance); }, monitor, times,
    moved);
}
}
