// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/PrescribedMotion.h"
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
  /// Of an array, a field, a target, handles and a lattice: the positions, #Moving x 3.
  const morph::Points* Given = nullptr;
};

/// The new positions of choice.moving: #Moving x 3, none beyond 1e50. A ScaleFactor of 0 gives the
/// current positions and 1 those of the motion, bit for bit; another is a factor of the numbers of
/// the motion, of a linear transform as morph::partOf(), else of the displacements.
/// `presentDimension` becomes that of DISPLACEMENT_DIMENSION. Normals are area-weighted over the
/// faces that move or, at nodes without such a face, over all faces. Throws morph::Error for
/// positions that are not finite or beyond 1e50, naming nodes, and as morph::nodeNormals() does.
/// Cost: one pass.
morph::Points Targets(const BoundaryModel& model, const Choice& choice, const Options& options,
  double* presentDimension = nullptr);

/// The displacement by a linear transform, fields (1, x); nothing for another one.
std::optional<morph::AffineMotion> OfTransform(vtkAbstractTransform* transform);

/// The displacements of choice.moving by `DisplacementArray`: NaN where vtkValidPointMask is 0.
/// Throws morph::Error for an array that is missing, not numeric, or of the wrong length or number
/// of components.
morph::Points OfArray(vtkPointSet* input, const Options& options, const Choice& choice);

/// Takes the nodes whose displacement is NaN out of choice.moving and `displacements`, and warns.
/// With MISSING_VALUES_STAY they are held; else it returns them, which are free. Throws
/// morph::Error where none is left.
std::vector<morph::Index> TakeMissing(
  morph::Points& displacements, const Options& options, Choice& choice, morph::Monitor& monitor);

/// The displacement of what moves as w c + A (x - center), with w = 1, or nothing where it is not
/// affine. `center`: of choice.moving.
std::optional<morph::AffineMotion> Affine(const BoundaryModel& model, const Choice& choice,
  const Options& options, const Eigen::RowVector3d& center);
}
