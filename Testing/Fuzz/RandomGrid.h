// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Choices.h"
#include "RandomMesh.h"

#include "Mesh/Mesh.h"

#include <vtkDataObject.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <vector>

namespace fuzz
{
/// What a filter gets on port 0.
struct RandomGrid
{
  vtkSmartPointer<vtkDataObject> data; ///< null, or of any type
  morph::Mesh mesh;                    ///< what `data` was made from
  Known known;                         ///< of `mesh`
  std::vector<morph::Index> outer;     ///< outerNodes() of `mesh`, or those that are known
  std::vector<morph::Index> nodes;     ///< cellNodes() of `mesh`
  double size = 0;                     ///< of `mesh`
  /// false: `data` is no grid, or its cells, ids or points are not those of `mesh`
  bool isAsMesh = true;
  bool hasWalls = false; ///< the set "Walls" of two-dimensional cells inside
  bool hasParts = false; ///< the sets of cells "Left" and "Right", and "Between", nodes of both
  bool hasGhosts = false;
  bool hasOddArrays = false; ///< arrays that are too short, too long or of unexpected types

  bool isShell() const { return this->known.faces != Known::None; }
  vtkUnstructuredGrid* grid() const { return vtkUnstructuredGrid::SafeDownCast(this->data); }
};

RandomGrid randomGrid(Choices& choices);

/// The points as a grid has them: in float, those of the mesh are rounded.
morph::Points pointsOf(vtkPointSet* data);

/// Adds point and cell arrays: of the names that the filters read or write, of the right length and
/// type or not.
void addArrays(
  Choices& choices, vtkDataSet* data, const std::string& prefix, bool hostile, bool& hasOddArrays);
}
