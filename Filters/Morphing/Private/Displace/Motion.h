// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/AffineModes.h"
#include "Private/Displace/BoundaryModel.h"
#include "Private/Displace/Choice.h"
#include "Private/Options.h"

#include <optional>

class vtkAbstractTransform;
class vtkPointSet;

/// The motion of the moving part of a boundary.
namespace morph::filters::Motion
{
struct Options : DisplacementOptions
{
  vtkAbstractTransform* Transform = nullptr; ///< null: the identity
  /// Of a target, handles and a lattice: the positions, #Moving x 3.
  const morph::Points* Given = nullptr;
};

/// The new positions of choice.Moving: #Moving x 3, none beyond 1e50. A ScaleFactor of 0 gives the
/// current positions and 1 those of the motion, bit for bit. Normals are area-weighted over the
/// faces that move or, at nodes without such a face, over all faces. Throws morph::Error for
/// positions that are not finite or beyond 1e50, naming nodes. Throws it too for arrays that are
/// missing, not numeric or of the wrong length or number of components, and as morph::nodeNormals()
/// does. Cost: one pass.
morph::Points Targets(vtkPointSet* input, const BoundaryModel& model, const Choice::Result& choice,
  const Options& options);

/// Takes the nodes out of choice.Moving for which the array has no displacement: NaN, or 0 in
/// vtkValidPointMask. Returns them, and warns; throws morph::Error where none is left, and as
/// Targets() does for the array.
std::vector<morph::Index> TakeMissing(
  vtkPointSet* input, const Options& options, Choice::Result& choice, morph::Monitor& monitor);

/// The displacement of what moves as w c + A (x - center), with w = 1, or nothing where it is not
/// affine. `center`: of choice.Moving.
std::optional<morph::AffineMotion> Affine(const BoundaryModel& model, const Choice::Result& choice,
  const Options& options, const Eigen::RowVector3d& center);
/// The middle of the box around the nodes that move; the origin where none does.
Eigen::RowVector3d Center(const BoundaryModel& model, const Choice::Result& choice);

/// The cells of model.Surface() that lose their area at `moved` (#nodes x 3), all of their corners
/// moving. A morph cannot keep the volume cells behind them.
std::vector<morph::Index> Collapsed(
  const BoundaryModel& model, const Choice::Result& choice, const morph::Points& moved);
}
