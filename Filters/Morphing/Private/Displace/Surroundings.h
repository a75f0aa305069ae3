// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/Falloff.h"
#include "BoundaryMorphing/SurfaceMeshSmoothing.h"
#include "BoundaryMorphing/SurfaceMorph.h"
#include "Private/Displace/BoundaryModel.h"
#include "Private/Displace/Choice.h"
#include "Private/Displace/LocalBoundary.h"
#include "Private/Displace/SurfaceShape.h"

#include <memory>
#include <vector>

namespace morph::filters
{
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
    Kind How = Kind::Follow;
    morph::SurfaceMorphOptions Follow;   ///< where `linear`, nothing slides
    double Radius = 0;                   ///< of Fade, in the unit of the points
    std::vector<morph::Index> Sliding;   ///< surfaces of the geometry that slide, of any kind
    std::vector<morph::Index> Free;      ///< surfaces whose nodes are solved with the interior
    std::vector<morph::Index> FreeNodes; ///< that are, too

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
    morph::Points Moved;            ///< #nodes x 3
    std::vector<signed char> Roles; ///< #nodes
    /// BoundaryModel::MotionVersion() of a result in which nodes of the boundary alone have moved;
    /// -1 for another one.
    vtkIdType MotionVersion = -1;
  };

  /// Computes the positions of all nodes. `targets`: those of choice.Moving. Moving nodes go there,
  /// and held nodes stay, exactly. The other nodes of the boundary
  /// - with Stay: all stay;
  /// - with Follow: surfaces that touch what moves follow as vtkMorphBoundary's do, curves first,
  ///   vertices being held. A surface touches if a moving edge, or a moving node without a moving
  ///   neighbor, is on it. The others stay. Where the motion lets a surface keep its shape, to 1 %
  ///   of the largest displacement, its nodes slide along it; else a warning says how far they
  ///   leave it. Where a surface folds, its mesh is smoothed along its shape, and a warning says
  ///   so;
  /// - with FollowAll: all follow, and none slides;
  /// - with Fade: nodes within the radius of a moving node follow it in part; see morph::Falloff.
  /// Nodes of sliding surfaces, moving ones too, go to the nearest point at their height above the
  /// surface's shape.
  /// With Stay and Fade mid-side and face nodes keep their place between their corners. So they do
  /// on surfaces that stay or are held, next to a moving corner. Nodes of free surfaces alone, and
  /// free nodes, neither moving nor held, have the role IsFree and their current position.
  /// A result does not depend on what is kept. `last`: an earlier result that is no longer needed.
  /// Its memory is used again, so that nodes inside cost nothing.
  Result Spread(const BoundaryModel& model, const Choice::Result& choice,
    const morph::Points& targets, const Options& options, morph::Monitor& monitor, Result last);
  Result Spread(const BoundaryModel& model, const Choice::Result& choice,
    const morph::Points& targets, const Options& options, morph::Monitor& monitor)
  {
    return this->Spread(model, choice, targets, options, monitor, Result());
  }

  /// The undeformed shape of a surface of the geometry, by its number; kept with the boundary.
  const SurfaceShape& ShapeOf(const BoundaryModel& model, morph::Index surface);
  /// Where a node of these surfaces slides to from its place `to`: the nearest point of a single
  /// surface. Of several it is where they meet, by alternating projections. The node keeps its
  /// undeformed height above each.
  Eigen::RowVector3d Slid(const BoundaryModel& model, const std::vector<morph::Index>& surfaces,
    morph::Index node, const Eigen::RowVector3d& to);

  /// How often weights were computed so far, those of a surface or of the falloff.
  int PrepareCount() const;

private:
  /// What the kept weights depend on.
  struct Key
  {
    vtkIdType MotionVersion = -1;
    morph::Index Neighbors = 0;
    double Radius = -1;
    std::vector<morph::Index> Moving, Held;
  };

  void Follow(const BoundaryModel& model, const Choice::Result& choice,
    const morph::Points& targets, const Options& options, Result& result, morph::Monitor& monitor);
  void Fade(const BoundaryModel& model, const Choice::Result& choice, const morph::Points& targets,
    double radius, Result& result, morph::Monitor& monitor);

  /// Surfaces along which the others' motion lets them slide; warns of those that leave theirs.
  std::vector<morph::Index> AbleToSlide(const BoundaryModel& model,
    const std::vector<morph::Index>& surfaces, const Result& result, morph::Monitor& monitor);
  /// Puts nodes of these roles onto the shapes of the surfaces that they are on.
  void Slide(const BoundaryModel& model, const std::vector<morph::Index>& surfaces,
    const std::vector<Role>& roles, Result& result);
  /// Smooths the meshes of surfaces that followed; those in `sliding` keep to their shapes. Warns
  /// of those that were folded.
  void SmoothMeshes(const BoundaryModel& model, const std::vector<morph::Index>& sliding,
    morph::SmoothedSurfaces which, morph::BoundaryMotion& motion, Result& result,
    morph::Monitor& monitor);
  /// Does all of Spread() but the free surfaces.
  void Place(const BoundaryModel& model, const Choice::Result& choice, const Options& options,
    Result& result, morph::Monitor& monitor);

  vtkIdType ShapesVersion = -1;
  std::vector<std::unique_ptr<SurfaceShape>> Shapes; ///< #surfaces, null where not needed yet
  LocalBoundary Local;                               ///< of Follow
  Key WeightsKey, FalloffKey;
  morph::SurfaceWeights Weights;
  morph::Falloff Falloff;
  std::vector<morph::Index> Others; ///< that the falloff was prepared for
  int FalloffCount = 0;
};
}
