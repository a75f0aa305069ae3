// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/Falloff.h"
#include "BoundaryMorphing/SurfaceMorph.h"
#include "Private/Displace/BoundaryModel.h"
#include "Private/Displace/Choice.h"

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
    Fade
  };

  struct Options
  {
    Kind How = Kind::Follow;
    morph::SurfaceMorphOptions Follow;
    double Radius = 0; ///< of Fade, in the unit of the points
  };

  /// What a node does; the values of the output's array Role.
  enum Role : signed char
  {
    Stays = 0,
    Moves = 1,
    IsHeld = 2,
    Follows = 3
  };

  struct Result
  {
    morph::Points Moved;            ///< #nodes x 3
    std::vector<signed char> Roles; ///< #nodes
  };

  /// Computes the positions of all nodes. `targets`: those of choice.Moving. Moving nodes go there,
  /// and held nodes stay, exactly. The other nodes of the boundary
  /// - with Stay: all stay;
  /// - with Follow: all follow as vtkMorphBoundary's do, curves first, and vertices are held;
  /// - with Fade: nodes within the radius of a moving node follow it in part; see morph::Falloff.
  /// With Stay and Fade mid-side and face nodes keep their place between their corners. A result
  /// does not depend on what is kept.
  Result Spread(const BoundaryModel& model, const Choice::Result& choice,
    const morph::Points& targets, const Options& options, morph::Monitor& monitor);

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
    const morph::Points& targets, const morph::SurfaceMorphOptions& options, Result& result,
    morph::Monitor& monitor);
  void Fade(const BoundaryModel& model, const Choice::Result& choice, const morph::Points& targets,
    double radius, Result& result, morph::Monitor& monitor);

  Key WeightsKey, FalloffKey;
  morph::SurfaceWeights Weights;
  morph::Falloff Falloff;
  std::vector<morph::Index> Others; ///< that the falloff was prepared for
  int FalloffCount = 0;
};
}
