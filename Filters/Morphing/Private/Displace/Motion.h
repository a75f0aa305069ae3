// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Displace/BoundaryModel.h"
#include "Private/Displace/Choice.h"

#include <array>
#include <string>

class vtkAbstractTransform;
class vtkPointSet;

/// Where the moving part of a boundary goes.
namespace morph::filters::Motion
{
enum class Kind
{
  Transform,
  Vector,
  AlongNormals,
  Array
};

struct Options
{
  Kind How = Kind::Transform;
  vtkAbstractTransform* Transform = nullptr; ///< null: the identity
  std::array<double, 3> Vector = { 0, 0, 0 };
  double Distance = 0;   ///< along the normals
  std::string ArrayName; ///< a point array of the input, three components
  double ScaleFactor = 1;
};

/// New positions of choice.Moving: #Moving x 3, none beyond 1e50; for a ScaleFactor of 0 where they
/// are and for 1 those of the motion, bit for bit. Normals are area-weighted over the faces that
/// move, or, at nodes without one, over all faces. Throws morph::Error for places that are not
/// finite or beyond 1e50, naming nodes, for arrays that are missing, not numeric or of the wrong
/// length or number of components, and as morph::nodeNormals() does. Cost: one pass.
morph::Points Targets(vtkPointSet* input, const BoundaryModel& model, const Choice::Result& choice,
  const Options& options);

/// Cells of model.Surface() that have an area where they are and, all of their corners moving, none
/// at `moved` (#nodes x 3): a morph cannot keep the cells behind them.
std::vector<morph::Index> Collapsed(
  const BoundaryModel& model, const Choice::Result& choice, const morph::Points& moved);
}
