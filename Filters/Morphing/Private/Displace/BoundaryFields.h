// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Displace/BoundaryModel.h"
#include "Private/Displace/Choice.h"
#include "Private/Displace/Motion.h"
#include "Private/Displace/Surroundings.h"

#include <vtkDoubleArray.h>
#include <vtkSmartPointer.h>

#include <vector>

class vtkPolyData;

namespace morph::filters
{
/// The answer of a boundary to an affine motion of what moves: four numbers of each point, kept
/// while the parameters of the motion change.
class BoundaryFields
{
public:
  /// Writes AffineArrays on the displaced boundary `output` where they describe it: the motion is
  /// affine, and the rest of the boundary stays or fades. Removes those of an input elsewhere.
  /// `result`: of `spread`. Cost, where something else moves than before: spreading twice.
  void Write(const BoundaryModel& model, const Choice::Result& choice,
    const Motion::Options& motion, const Surroundings::Options& rest,
    const Surroundings::Result& result, Surroundings& spread, vtkPolyData* output,
    morph::Monitor& monitor);

private:
  void Compute(const BoundaryModel& model, const Choice::Result& choice,
    const Surroundings::Options& rest, Surroundings& spread, morph::Monitor& monitor);

  vtkSmartPointer<vtkDoubleArray> Fields; ///< for the motions of what follows, or null
  vtkIdType MotionVersion = -1;
  Surroundings::Kind How = Surroundings::Kind::Stay;
  double Radius = 0;
  std::vector<morph::Index> Moving, Held, Free;
  Eigen::RowVector3d Centre; ///< of what moves
};
}
