// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Private/Data/Unchanged.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <cstdint>
#include <functional>
#include <vector>

class vtkDataObject;
class vtkUnstructuredGrid;

namespace morph::filters
{
/// A mesh of triangles and quadrilaterals alone as the solid that filters morph, see
/// morph::thicken(), and their results as that mesh again. The images of a point have its arrays.
class ShellGrid
{
public:
  struct Solid
  {
    morph::Mesh Mesh; ///< the piece's cells come first, and its nodes in the front
    /// On several processes, the global ids of the front, which are below NextId. Images have those
    /// of their nodes and once or, between front and back, twice NextId.
    ///@{
    std::vector<std::int64_t> FrontIds;
    std::int64_t NextId = 0;
    ///@}
  };

  /// Returns the solid of a grid or of polygonal data, kept while these stay the same; other data
  /// are returned as they are. These are grids with volume cells, or without faces, and boundaries
  /// from Extract Morph Boundary. Throws morph::Error as morph::thicken(),
  /// DataCheck::Require() and GridMesh::FromGrid(). Cost: passes over the grid.
  vtkDataObject* Thicken(vtkDataObject* input);
  /// The same in two steps, of a piece of a mesh on several processes. `make`: takes the piece as a
  /// grid, perhaps without cells; see RankBlocks::Thicken().
  ///@{
  bool IsKept(vtkDataObject* input, bool areOnRanks = true) const;
  vtkDataObject* ThickenBy(
    const std::function<Solid(vtkUnstructuredGrid* flat)>& make, vtkDataObject* input);
  vtkDataObject* Kept() const;
  ///@}
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
