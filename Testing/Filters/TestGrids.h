// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../Core/Meshes.h"

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;

/// Grids and boundaries for the tests of the filters, and what a filter says.
namespace grids
{
using Row = Eigen::RowVector3d;
using Map = std::function<Row(const Row&)>;

/// The mesh as a grid; `pointType`: VTK_DOUBLE or VTK_FLOAT. With the point array `Number` and the
/// cell array `Cell`.
vtkSmartPointer<vtkUnstructuredGrid> make(const morph::Mesh& mesh, int pointType = VTK_DOUBLE);
/// A jittered hexahedral grid of n x n x n cells: the default input.
vtkSmartPointer<vtkUnstructuredGrid> hexes(int n = 4);
/// A copy whose arrays are its own.
vtkSmartPointer<vtkUnstructuredGrid> copy(vtkUnstructuredGrid* grid);

/// vtkExtractMorphBoundary's output, its points moved by `map`, in double.
vtkSmartPointer<vtkPolyData> boundary(vtkUnstructuredGrid* grid, const Map& map);
/// A point set without cells or arrays.
vtkSmartPointer<vtkPolyData> cloud(const morph::Points& points);
void addIds(vtkDataSet* data, const char* name, const std::vector<morph::Index>& ids);
void addVectors(vtkDataSet* data, const char* name, const morph::Points& vectors);

morph::Points points(vtkPointSet* data);
/// `map` applied to each row.
morph::Points mapped(const morph::Points& points, const Map& map);
/// Shear, stretch and turn, with a shift.
Row affine(const Row& x);
/// A twist about the z axis and a bulge: not affine.
Row twist(const Row& x);

/// Counts the errors and warnings of one filter while it lives, and keeps them off the console.
class Listener
{
public:
  explicit Listener(vtkAlgorithm* filter);
  ~Listener();
  std::vector<std::string> Errors;
  std::vector<std::string> Warnings;
  std::vector<std::string> ExecutiveErrors; ///< what VTK's executive adds after a return of 0

private:
  struct Tags;
  Tags* Observers;
};
}
