// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Quality/ScaledJacobian.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <functional>
#include <vector>

class vtkCellArray;
class vtkIdTypeArray;
class vtkPoints;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace morph::filters
{
/// The outer boundary of a mesh as polygons that are made once: only the points move. A view that
/// shows it needs neither extract the surface nor sort the polygons again.
class MovedSurface
{
public:
  /// Makes the polygons. `mesh`, `faces`: of `grid`. `orientation`: see Surface::Write(). Cost: a
  /// pass over the faces.
  void Make(vtkUnstructuredGrid* grid, const morph::Mesh& mesh, const morph::BoundaryFaces& faces,
    const std::vector<std::int8_t>* orientation = nullptr);
  /// Adds lines along the edges at which the undeformed faces turn by more than 25 degrees, or not
  /// exactly two faces meet; or takes them away. `mesh`, `faces`: those of Make(). Cost: where they
  /// were not there, a sort of the faces' edges. `isDrawn`: null, or for a part of a mesh whether
  /// it draws an edge, from the cells at the edge; `faces` may then have others of the mesh, too.
  void SetFeatureLines(bool on, const morph::Mesh& mesh, const morph::BoundaryFaces& faces,
    const std::function<bool(const std::vector<morph::Index>& cells)>& isDrawn = nullptr);
  bool HasFeatureLines() const { return this->Lines != nullptr; }
  /// The cells behind the faces, ascending.
  const std::vector<morph::Index>& OuterCells() const { return this->Outer; }

  /// Fills `output`: the polygons and the arrays MorphPointId and MorphCellId are the same objects
  /// each time. `moved`: the points of all nodes. Lines have the MorphCellId -1.
  void Write(vtkPoints* moved, vtkPolyData* output) const;
  /// As above, with the cell array ScaledJacobian (active scalars): that of the cell behind each
  /// face, NaN for lines. `quality`: of all cells, or those behind the faces at least. Returns the
  /// number of cells behind the faces without a positive value.
  vtkIdType Write(vtkPoints* moved, const morph::Quality& quality, vtkPolyData* output) const;
  /// Adds the cell array CrossesItself to what Write() has filled: 1 on the polygons of these faces
  /// of Make(), ascending, and 0 elsewhere.
  void MarkCrossing(const std::vector<morph::Index>& faces, vtkPolyData* output) const;

private:
  std::vector<morph::Index> Outer;
  std::vector<morph::Index> Faces; ///< of the polygons
  vtkSmartPointer<vtkCellArray> Polygons;
  vtkSmartPointer<vtkIdTypeArray> Nodes;  ///< MorphPointId
  vtkSmartPointer<vtkIdTypeArray> Owners; ///< MorphCellId: that of the lines, then of the polygons
  vtkSmartPointer<vtkCellArray> Lines;    ///< or null
};
}
