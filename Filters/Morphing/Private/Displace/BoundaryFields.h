// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/Surroundings.h"
#include "Private/Displace/InputBoundary.h"
#include "Private/Displace/Motion.h"

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
  /// Writes AffineArrays on the displaced boundary `output` where they describe it; removes those
  /// of an input elsewhere. They do where the motion is affine, and that of the rest is linear in
  /// it, the same for each coordinate: where the rest stays, fades, or follows by weighted residual
  /// without leaving a plane. They do not, for instance, where nodes slide along a surface that the
  /// motion leaves, or turn about a cylinder's axis. `result`: of `spread`. Cost: one pass; where
  /// something else moves than before, spreading twice.
  void Write(const InputBoundary& model, const Choice& choice, const Motion::Options& motion,
    const Surroundings::Options& rest, const Surroundings::Result& result, Surroundings& spread,
    vtkPolyData* output, morph::Monitor& monitor);

private:
  /// Whether the fields with this motion take all points to `moved`, up to rounding.
  bool Give(const morph::AffineMotion& motion, const InputBoundary& model,
    const morph::Points& moved) const;
  void Compute(const InputBoundary& model, const Choice& choice,
    const Surroundings::Options& options, Surroundings& spread, morph::Monitor& monitor);

  vtkSmartPointer<vtkDoubleArray> Fields; ///< for the motions of what follows, or null
  /// What they depend on.
  ///@{
  vtkIdType MotionVersion = -1;
  Surroundings::Options Rest;
  Choice Chosen;
  ///@}
  Eigen::RowVector3d Center; ///< of what moves
};
}
