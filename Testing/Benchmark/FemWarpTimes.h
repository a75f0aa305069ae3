// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "FemWarp.h"
#include "TwistedBrick.h"

#include <memory>
#include <vector>

namespace benchmark
{
/// Relative residual that every iterative solution here stops at.
constexpr double Tolerance = 1e-8;

/// What FEMWARP took, in seconds, one entry a repetition.
struct FemWarpTimes
{
  std::vector<double> prepare;
  std::vector<double> cold; ///< prepare and the first evaluate
  std::vector<double> warm; ///< an evaluate after that
  int iterations = 0;
  double bytesMoved = 0; ///< by the iterations of one warm evaluate, as the solver counts them
};

/// One repetition: a fresh morpher, prepared and evaluated twice. Appends to `times`; `moved` becomes the moved mesh.
/// Returns the morpher. Throws std::runtime_error if the two evaluations differ in a bit.
std::unique_ptr<morph::FemWarp> timeFemWarp(
  const Problem& problem, morph::Monitor& monitor, FemWarpTimes& times, morph::Points& moved);
}
