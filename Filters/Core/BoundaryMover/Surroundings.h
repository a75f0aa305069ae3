// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/Falloff.h"
#include "BoundaryMorphing/SurfaceMeshSmoothing.h"
#include "BoundaryMorphing/SurfaceMorph.h"
#include "BoundaryMover/BoundaryModel.h"
#include "BoundaryMover/Choice.h"
#include "BoundaryMover/SurfaceShape.h"

#include <memory>
#include <vector>

namespace morph
{
/// A boundary by itself: its nodes are numbered from 0 on, in the order of their numbers in the
/// mesh. What moves a boundary takes as long as its nodes are many, not those of the mesh.
class LocalBoundary
{
public:
  /// Renumbers the boundary of `model`, unless it is that of the last call.
  void update(const BoundaryModel& model);

  /// The mesh's number of each node, ascending.
  const std::vector<Index>& nodes() const { return this->nodes_; }
  const Points& points() const { return this->points_; } ///< #nodes() x 3, current
  const BoundaryFaces& faces() const { return this->faces_; }
  const Classification& geometry() const { return this->geometry_; }
  const std::vector<Index>& bodyOfNode() const { return this->bodyOfNode_; }
  /// The numbers here of nodes of the boundary.
  std::vector<Index> numbersOf(const std::vector<Index>& nodes) const;

private:
  std::int64_t version_ = -1; ///< BoundaryModel::motionVersion of all of this
  std::vector<Index> nodes_;
  Points points_;
  BoundaryFaces faces_;
  Classification geometry_;
  std::vector<Index> bodyOfNode_;
  std::vector<Index> number_; ///< #nodes of the mesh, -1 inside
};

/// The motion of the rest of a boundary when a part of it moves. Weights that depend on the part
/// alone are kept.
class Surroundings
{
public:
  enum class Kind
  {
    Stay,
    Follow,
    Fade,
    FollowAll
  };

  struct Options
  {
    Kind how = Kind::Follow;
    SurfaceMorphOptions follow;   ///< where `linear`, nothing slides
    double radius = 0;            ///< of Fade, in the unit of the points
    std::vector<Index> sliding;   ///< surfaces of the geometry that slide, of any kind
    std::vector<Index> free;      ///< surfaces whose nodes are solved with the interior
    std::vector<Index> freeNodes; ///< that are, too

    bool operator==(const Options& other) const;
  };

  /// What a node does; the values of the output's array Role.
  enum Role : signed char
  {
    Stays = 0,
    Moves = 1,
    IsHeld = 2,
    Follows = 3,
    IsFree = 4,
    IsZone = 5, ///< of a zone, see InnerNodes.h
    IsLayer = 6
  };

  struct Result
  {
    Points moved;                   ///< #nodes x 3
    std::vector<signed char> roles; ///< #nodes
    /// BoundaryModel::motionVersion of a result in which nodes of the boundary alone have moved;
    /// -1 for another one.
    std::int64_t motionVersion = -1;
  };

  /// Computes the positions of all nodes. `targets`: those of choice.moving. Moving nodes go there,
  /// and held nodes stay, exactly. The other nodes of the boundary
  /// - with Stay: all stay;
  /// - with Follow: surfaces that touch what moves follow as morphSurfaces() moves them, curves
  ///   first, vertices being held. A surface touches if a moving edge, or a moving node without a
  ///   moving neighbor, is on it. The others stay. Where the motion lets a surface keep its shape,
  ///   to 1 % of the largest displacement, its nodes slide along it; else a warning says how far
  ///   they leave it. Where a surface folds, its mesh is smoothed along its shape, and a warning
  ///   says so;
  /// - with FollowAll: all follow, and none slides;
  /// - with Fade: nodes within the radius of a moving node of their body follow it in part; see
  ///   Falloff.
  /// Nodes of sliding surfaces, moving ones too, go to the nearest point at their height above the
  /// surface's shape.
  /// With Stay and Fade mid-side and face nodes keep their place between their corners. So they do
  /// on surfaces that stay or are held, next to a moving corner, and on edges that linear cells
  /// have, too; a warning names those that the targets take off. Nodes of free surfaces alone, and
  /// free nodes, neither moving nor held, have the role IsFree and their current position.
  /// A result does not depend on what is kept. `last`: an earlier result that is no longer needed.
  /// Its memory is used again, so that nodes inside cost nothing.
  Result spread(const BoundaryModel& model, const Choice& choice, const Points& targets,
    const Options& options, Monitor& monitor, Result last);
  Result spread(const BoundaryModel& model, const Choice& choice, const Points& targets,
    const Options& options, Monitor& monitor)
  {
    return this->spread(model, choice, targets, options, monitor, Result());
  }

  /// The undeformed shape of a surface of the geometry, by its number; kept with the boundary.
  const SurfaceShape& shapeOf(const BoundaryModel& model, Index surface);
  /// Where a node of these surfaces, undeformed at `from`, slides to from its place `to`: the
  /// nearest point of a single surface. Of several it is where they meet, by alternating
  /// projections. The node keeps its undeformed height above each. An edge of a curved shell that
  /// is no part of a plane, cylinder or sphere across the shell is a curve on the shell, where the
  /// two meet.
  Eigen::RowVector3d slid(const BoundaryModel& model, const std::vector<Index>& surfaces,
    const Eigen::RowVector3d& from, const Eigen::RowVector3d& to);

  /// How often weights were computed so far, those of a surface or of the falloff.
  int prepareCount() const;

private:
  /// What the kept weights depend on.
  struct Key
  {
    std::int64_t motionVersion = -1;
    Index neighbors = 0;
    double radius = -1;
    std::vector<Index> moving, held;
  };

  void follow(const BoundaryModel& model, const Choice& choice, const Points& targets,
    const Options& options, Result& result, Monitor& monitor);
  void fade(const BoundaryModel& model, const Choice& choice, const Points& targets, double radius,
    Result& result, Monitor& monitor);

  /// Surfaces along which the others' motion lets them slide; warns of those that leave theirs.
  std::vector<Index> ableToSlide(const BoundaryModel& model, const std::vector<Index>& surfaces,
    const Result& result, Monitor& monitor);
  /// Puts nodes of these roles onto the shapes of the surfaces that they are on.
  void slide(const BoundaryModel& model, const std::vector<Index>& surfaces,
    const std::vector<Role>& roles, Result& result);
  /// Smooths the meshes of surfaces that followed; those in `sliding` keep to their shapes. Warns
  /// of those that were folded.
  void smoothMeshes(const BoundaryModel& model, const std::vector<Index>& sliding,
    SmoothedSurfaces which, BoundaryMotion& motion, Result& result, Monitor& monitor);
  /// Does all of spread() but the free surfaces.
  void place(const BoundaryModel& model, const Choice& choice, const Options& options,
    Result& result, Monitor& monitor);

  std::int64_t shapesVersion_ = -1;
  std::vector<std::unique_ptr<SurfaceShape>> shapes_; ///< #surfaces, null where not needed yet
  std::unique_ptr<SurfaceShape> shell_;               ///< of a curved shell with a curve in it
  LocalBoundary local_;                               ///< of Follow
  Key weightsKey_, falloffKey_;
  SurfaceWeights weights_;
  /// The falloff of a body, within which the motion stays.
  struct Fading
  {
    std::vector<Index> moving; ///< rows of Choice::moving
    std::vector<Index> others; ///< nodes
    Falloff falloff;
  };
  std::vector<Fading> fading_; ///< of the bodies that have moving nodes
  int falloffCount_ = 0;
};
}
