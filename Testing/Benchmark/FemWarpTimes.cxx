// SPDX-License-Identifier: BSD-3-Clause
#include "FemWarpTimes.h"
#include "Timing.h"

#include <stdexcept>

namespace benchmark
{
std::unique_ptr<morph::FemWarp> timeFemWarp(
  const Problem& problem, morph::Monitor& monitor, FemWarpTimes& times, morph::Points& moved)
{
  moved.resize(0, 3); // the first evaluate pays for its result
  const Stopwatch cold;
  auto femWarp = std::make_unique<morph::FemWarp>();
  femWarp->setTolerance(Tolerance);
  femWarp->prepare(problem.mesh, problem.partition, monitor);
  times.prepare.push_back(cold.seconds());
  femWarp->evaluate(problem.target, moved, monitor);
  times.cold.push_back(cold.seconds());

  const morph::Points first = moved;
  const Stopwatch warm;
  const morph::EvaluateReport report = femWarp->evaluate(problem.target, moved, monitor);
  times.warm.push_back(warm.seconds());
  times.iterations = report.iterations;
  times.bytesMoved = report.bytesMoved;
  if (moved != first)
  {
    throw std::runtime_error("Two evaluations of the same boundary gave different meshes.");
  }
  return femWarp;
}
}
