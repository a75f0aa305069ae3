// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Interpolation/InterpolationSites.h"
#include "Interpolation/WeightMatrix.h"
#include "Support/Monitor.h"

namespace morph
{
/// Computes the inverse distance weights |x - b_k|^-2 / sum_j |x - b_j|^-2 of the sites b_k nearest
/// to x. `neighbors`: their number, at least 1; all sites where there are fewer. Sites as far as
/// the last of them count, too (NearestNodes). The result has a row for each of the `places`
/// (#places x 3) and ascending columns. A place within the tolerance of a site has weight 1 at the
/// nearest site. The weights do not depend on threads or on the order of the places. Progress runs
/// from 0.1 to 1.
///
/// Throws Error if memory does not suffice, and for coordinates of 1e150 and beyond. Cost: O(log
/// #sites + neighbors) a place. Source: equation (6) of Staten et al. (IMR 2011).
WeightMatrix inverseDistanceWeights(
  const InterpolationSites& sites, const Points& places, Index neighbors, Monitor& monitor);
}
