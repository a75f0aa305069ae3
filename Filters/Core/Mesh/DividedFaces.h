// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"
#include "Support/Monitor.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace morph
{
struct FaceFunctions;

/// Finds the small faces in large ones, among the faces that one cell alone has: where cells are
/// refined on one side alone. Faces of 3, 4, 6, 8 and 9 nodes, which may be curved and folded.
class DividedFaces
{
public:
  static constexpr int MostNodes = 9; ///< of a face

  /// A place on a face, and the weights of its nodes there.
  struct PlaceOnFace
  {
    double u, v;
    std::array<double, MostNodes> N;
  };

  DividedFaces(const Mesh& mesh, const BoundaryFaces& faces, Monitor& monitor);

  /// The nodes of a face, corners first.
  const Index* begin(Index f) const { return this->nodes_.begin(f); }
  const Index* end(Index f) const { return this->nodes_.end(f); }
  Index size(Index f) const { return this->end(f) - this->begin(f); }
  Index corners(Index f) const { return this->faces_.offsets[f + 1] - this->faces_.offsets[f]; }
  bool has(Index f, Index node) const
  {
    return std::find(this->begin(f), this->end(f), node) != this->end(f);
  }
  bool isCorner(Index f, Index node) const;

  /// Whether other faces lie in `f` at each of its corners, as where it is divided.
  bool hasPartsAtCorners(Index f) const;

  /// Returns the faces that lie in `f` and fill it, ascending; none if there are no such.
  std::vector<Index> parts(Index f) const;

  /// Returns where on `f` a place is, and the weights of its nodes there; nothing off it. Steps
  /// start at the nearest node. A face that is folded may pass a place twice: of what steps from
  /// each node lead to a corner comes first, then a side.
  std::optional<PlaceOnFace> placeOn(Index f, const Eigen::RowVector3d& x) const;

  /// The ends of the side of `f` that a place is on, by their numbers in it, and how far it is from
  /// the first; nothing inside the face and at its corners.
  std::optional<std::tuple<Index, Index, double>> sideOf(Index f, const PlaceOnFace& at) const;

private:
  FaceFunctions functions(Index f, double u, double v) const;
  /// The sum of the nodes' places, relative to the first, by weights.
  Eigen::Vector3d sum(Index f, const std::array<double, MostNodes>& weights) const;
  /// The parameters of a node of `f`.
  std::pair<double, double> placeOf(Index node, Index f) const;
  /// Whether a part of `f` at one of its nodes faces another way than the whole.
  bool isFolded(Index f) const;
  /// The place that steps from a node of `f` lead to.
  std::optional<PlaceOnFace> placeFrom(Index start, Index f, const Eigen::RowVector3d& x) const;
  Eigen::RowVector3d place(Index f, Index node) const
  {
    return this->mesh_.points.row(this->begin(f)[node]);
  }
  /// The vector area, outward: half the integral of x times dx along the rim. A side through its
  /// middle m is a parabola, for which that of a to b is (4 a x m + 4 m x b - a x b) / 6.
  Eigen::RowVector3d areaOf(Index f) const;
  /// The area between the corners, also of a face that folds over.
  double magnitudeOf(Index f) const;
  /// Whether `g` lies in `f`, on its other side: it runs backward in the parameters of `f`.
  bool isPart(Index g, Index f) const;
  /// Whether all nodes of `g` are in the box of `f`, and so may lie on it. A side through its
  /// middle leaves the box of the three by less than a quarter of the box's size.
  bool mayReach(Index f, Index g) const;

  const Mesh& mesh_;
  const BoundaryFaces& faces_;
  Adjacency nodes_;
  Points area_;
  std::vector<std::uint8_t> isFolded_;
  Adjacency ofNode_;
};
}
