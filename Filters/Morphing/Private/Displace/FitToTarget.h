// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Displace/BoundaryModel.h"
#include "Private/Displace/Choice.h"
#include "Private/Project/Target.h"

#include <memory>
#include <set>
#include <string>

class vtkPolyData;

namespace morph::filters
{
/// Moves a part of a boundary onto a target surface. The target is kept while it, the mesh and the
/// options are the same.
class FitToTarget
{
public:
  struct Options
  {
    bool Align = false;       ///< the target rigidly onto the mesh first
    double FeatureAngle = 25; ///< degrees, for the target's feature edges
    double Angle = 60;        ///< degrees, largest between normals of mesh and target
    double Reach = 0;         ///< how far a node may go, in the unit of the points
  };

  /// Takes the target. `choice`: what moves, onto which it is aligned; null for the whole boundary.
  /// Throws morph::Error as Target does.
  void Update(vtkPolyData* target, const BoundaryModel& model, const Choice::Result* choice,
    const Options& options, morph::Monitor& monitor);

  /// Names of the surfaces that the target belongs to. Each is the nearest one for an area of the
  /// target of at least half its own. Throws morph::Error where there is none.
  std::set<std::string> NearestSurfaces(const BoundaryModel& model) const;

  /// The positions of choice.Moving on the target, #Moving x 3. Vertices go to the target's
  /// vertices, then curves to its feature edges, then surfaces follow and go to the target, as in
  /// vtkMorphBoundary. What has no such place within reach goes to the nearest place of the target.
  /// A warning names nodes that do not reach it. Throws morph::Error where none does.
  morph::Points Targets(
    const BoundaryModel& model, const Choice::Result& choice, morph::Monitor& monitor);

  /// The triangles that nodes go to: the target as aligned.
  vtkPolyData* Surface() const { return this->Place ? this->Place->Surface() : nullptr; }

private:
  const vtkPolyData* Input = nullptr; ///< compared, never used
  vtkMTimeType InputTime = 0;
  vtkIdType MotionVersion = -1;
  Options Made;
  std::vector<morph::Index> AlignedOnto;
  std::unique_ptr<Target> Place;
};
}
