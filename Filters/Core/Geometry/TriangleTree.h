// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace morph
{
/// The triangles near a place, by a hierarchy of boxes. Several threads may search at once. Of
/// equally near triangles the lowest is found. Cost of a search: O(log n) for n triangles, and the
/// triangles that are nearly as near.
class TriangleTree
{
public:
  using Row = Eigen::RowVector3d;
  using Triangle = std::array<Row, 3>;
  struct Found
  {
    Index triangle; ///< -1: none, and the place is that of the search
    Row place;
  };

  /// Flat and collapsed triangles are lines and points. Source of the hierarchy: Eigen's KdBVH.
  /// Cost: O(n log n).
  explicit TriangleTree(std::vector<Triangle> triangles);
  ~TriangleTree();

  /// Returns the place nearest to `x`, at most `radius` away, on the triangles that `fits`.
  Found nearest(
    const Row& x, double radius, const std::function<bool(Index)>& fits = nullptr) const;

  /// Returns the place nearest to `x` on the line through it, at most `radius` away, where the
  /// line meets a triangle that `fits`. Triangles are wider by `tolerance` than their edges.
  /// `direction`: unit length.
  Found nearestAlong(const Row& x, const Row& direction, double radius, double tolerance,
    const std::function<bool(Index)>& fits) const;

  const std::vector<Triangle>& triangles() const;
  /// The unit normal, by the right-hand rule; zero for a triangle without area, and for -1.
  Row normal(Index triangle) const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};
}
