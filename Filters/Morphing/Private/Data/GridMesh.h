// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

#include <cstdint>

class vtkDataArray;
class vtkPoints;
class vtkUnstructuredGrid;

/// Conversion from vtkUnstructuredGrid to morph::Mesh.
namespace morph::filters::GridMesh
{
/// What to do with cells of a type or an order that the core does not know.
enum class UnknownCells
{
  Refuse, ///< throw morph::Error that names the type and the cells
  Keep    ///< copy them; the core measures and morphs nothing in them
};

/// A copy of the grid's points (float, double or any other type) and cells. Throws morph::Error
/// where morph::validate would: node ids that do not exist, coordinates that are not finite, wrong
/// cell sizes, polyhedra that are not closed. The faces of a polyhedron run alike. Cost: one pass
/// over the grid; 24 bytes a point and 8 bytes a connectivity entry. Threads come from `monitor`;
/// without it there is one.
///@{
morph::Mesh FromGrid(vtkUnstructuredGrid* grid, UnknownCells unknown, morph::Monitor& monitor);
morph::Mesh FromGrid(vtkUnstructuredGrid* grid, UnknownCells unknown = UnknownCells::Refuse);
///@}

/// Marks a grid as the layer of a mesh of faces, in its field data, for FromGrid(). No layer:
/// removes the mark. `points`: of the mesh of faces; on several processes, copies of other
/// processes' nodes come behind these in the front.
void MarkLayer(const morph::ShellLayer& layer, morph::Index points, vtkUnstructuredGrid* grid);
/// Those points of a marked grid; of any other, its points.
morph::Index PointsOfFront(vtkUnstructuredGrid* grid);
/// The layer that a grid is marked as; none if it has no mark, or not all nodes. Cost: none.
morph::ShellLayer LayerOf(vtkUnstructuredGrid* grid);

/// Copies `points` as double, #points x 3. A null pointer gives 0 x 3.
morph::Points FromPoints(vtkPoints* points);

/// Copies the first three components of each tuple as double, #tuples x 3. The array needs at least
/// three.
morph::Points FromVectors(vtkDataArray* vectors);

/// The dimension of cells of this VTK type; VTK is asked for those that the core does not know.
int Dimension(std::uint8_t type);

/// Whether the grid's cells (points) are still, number by number, the ones that `mesh` was copied
/// from. Ends at the first difference; allocates a byte a cell.
bool SameCells(vtkUnstructuredGrid* grid, const morph::Mesh& mesh);
bool SamePoints(vtkUnstructuredGrid* grid, const morph::Mesh& mesh);
}
