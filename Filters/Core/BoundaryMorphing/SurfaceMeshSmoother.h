// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/FaceQuality.h"
#include "BoundaryMorphing/BoundaryProjection.h"
#include "BoundaryMorphing/PhongSurface.h"
#include "Energies/FaceEnergy.h"
#include "Optimization/Minimizers.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace morph
{
/// Smooths the mesh of one surface; see smoothSurfaceMeshes(). Holds its arguments by reference.
class SurfaceMeshSmoother
{
public:
  /// `surface`: its number. `start`: #nodes x 3, moved positions. `quality`: of the start.
  /// `isFolded`: #faces, nonzero for foldedFaces() of the start. Without a `target` that holds the
  /// surface, its nodes keep to its shape at the start.
  SurfaceMeshSmoother(const BoundaryFaces& faces, const Classification& geometry, Index surface,
    const ProjectionTarget* target, const BoundaryMotion& motion, const Points& start,
    const FaceQuality& quality, const std::vector<std::uint8_t>& isFolded, Monitor& monitor);

  /// Corners that move, as numbers among the surface's nodes; may be empty.
  const std::vector<Index>& free() const { return this->free_; }
  /// Untangles and smooths. Call it once, with a free node.
  void run();
  /// #surface nodes x 3
  const Points& points() const { return this->points_; }
  const MinimizerEffort& effort() const { return this->effort_; }

private:
  Index local(Index node) const;
  std::vector<std::uint8_t> findFree();
  void makeCorners();
  /// Returns the side of a face's area that is up.
  Eigen::RowVector3d upOf(Index face, const Points& points) const;
  Eigen::RowVector3d planeNormal() const;
  bool isPlane() const { return this->shape_ && this->shape_->isPlane(); }
  void setPlanes(FaceEnergy& energy, const Points& points);
  /// Puts free nodes on the surface. Returns false if one has no place there.
  bool project(Points& points);
  bool isOnTarget(Index number, double tolerance) const;
  double meanEdge(const Points& points) const;
  /// Returns whether no corner is inverted any more.
  bool untangle(FaceEnergy& energy);
  void improve(FaceEnergy& energy);

  const BoundaryFaces& faces_;
  const Classification& geometry_;
  const Index surface_;
  const std::vector<Index>& nodes_; ///< ids, ascending
  const ProjectionTarget* target_;  ///< null without one that holds the surface
  const BoundaryMotion& motion_;
  const FaceQuality& quality_;
  const std::vector<std::uint8_t>& isFolded_;
  Monitor& monitor_;
  Points points_;                     ///< #nodes_ x 3
  std::optional<PhongSurface> shape_; ///< without a target
  std::vector<FaceCorner> corners_;   ///< with numbers in nodes_
  std::vector<Index> faceOf_;         ///< of each corner
  std::vector<Index> free_;           ///< numbers in nodes_
  std::vector<Index> triangle_;       ///< of the shape, of each free node
  Points normals_;                    ///< #free_ x 3
  BlockCsr3f matrix_;
  MinimizerEffort effort_;
};
}
