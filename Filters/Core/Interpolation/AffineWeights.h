// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// The weights of one place: those of the affine least-squares fit to the nearest sites.
struct AffineRow
{
  std::vector<std::int32_t> sites; ///< ascending
  std::vector<double> weights;     ///< they sum to 1
};

/// Computes such weights for `places`, #places x 3, which reproduce linear fields. `sites`: #sites
/// x 3, not all in one plane. A place takes its 32 nearest sites, and twice as many while these lie
/// in a plane or a weight exceeds `most` in magnitude; in the end all. Where even these are flat or
/// a weight exceeds it, directions count by the shares of PrincipalDirections. Cost: 20
/// microseconds a place.
std::vector<AffineRow> affineWeights(
  const Points& sites, const Points& places, double most, Monitor& monitor);
}
