// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Interpolation/InterpolationSites.h"
#include "Interpolation/WeightMatrix.h"
#include "Support/Monitor.h"

namespace morph
{
/// Which sites have a weight at a place.
struct Neighborhood
{
  /// the nearest, by (distance, site number); at least 1, and all where there are fewer
  Index count = 80;
  /// double `count` at each place until it lies in its neighbors' convex hull, or has all sites
  bool grows = false;
};

/// Weights |x - b_k|^-2 / sum_j |x - b_j|^-2 of the sites b_k nearest to each of the places x
/// (`places`: #places x 3), as a matrix #places x #sites; columns ascending. A place within the
/// tolerance of a site has weight 1 there (the nearest one). Equation (6) of Staten et al. (IMR
/// 2011). Neither threads nor the order of the places show.
///
/// Cost: O(log #sites + count) a place, see NearestNodes; where neighborhoods grow, a second search
/// over all of them and a hull test (insideConvexHull) for each size tried. Throws Error where the
/// memory does not suffice, and for coordinates of 1e150 and beyond. Progress runs from 0.1 to 1.
WeightMatrix inverseDistanceWeights(const InterpolationSites& sites, const Points& places,
  const Neighborhood& neighborhood, Monitor& monitor);
}
