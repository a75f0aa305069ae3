// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Data/Unchanged.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

class vtkDataObject;
class vtkUnstructuredGrid;

namespace morph::filters
{
/// A mesh of triangles and quadrilaterals alone as the solid that filters morph, see
/// morph::thicken(), and their results as that mesh again. The images of a point have its arrays.
class ShellGrid
{
public:
  /// Returns the solid of a grid or of polygonal data, kept while these stay the same; other data
  /// are returned as they are. These are grids with volume cells, or without faces, and boundaries
  /// from Extract Morph Boundary. Throws morph::Error as morph::thicken(),
  /// DataCheck::Require() and GridMesh::FromGrid(). Cost: passes over the grid.
  vtkDataObject* Thicken(vtkDataObject* input);
  /// Whether Thicken() would make a solid of it.
  static bool IsShell(vtkDataObject* input);
  /// Makes a result on the solid one on the mesh; others stay as they are. `withFaces`: also one
  /// whose cells are faces of the solid, which become their edges in the mesh.
  void Flatten(vtkUnstructuredGrid* output, bool withFaces) const;
  /// Makes some cells of the solid, as SubGrid::Extract() has them, those of the mesh.
  void FlattenCells(vtkUnstructuredGrid* cells) const;

private:
  vtkSmartPointer<vtkUnstructuredGrid> Flat, Thick;
  Unchanged Seen;
  const vtkDataObject* Input = nullptr; ///< polygonal data, compared, never used
  vtkMTimeType InputTime = 0;
};
}
