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
class vtkDataSetAttributes;
class vtkDisplacementAlgorithm;

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
/// A filter with that input.
template <typename Filter>
vtkSmartPointer<Filter> of(vtkDataObject* input)
{
  auto filter = vtkSmartPointer<Filter>::New();
  filter->SetInputDataObject(input);
  return filter;
}
/// Makes a filter move its boundary by a vector.
void moveBy(vtkDisplacementAlgorithm* filter, double x, double y, double z);
/// A copy whose arrays are its own.
vtkSmartPointer<vtkUnstructuredGrid> copy(vtkUnstructuredGrid* grid);

/// vtkExtractMorphBoundary's output, its points moved by `map`, in double.
vtkSmartPointer<vtkPolyData> boundary(vtkUnstructuredGrid* grid, const Map& map);
/// A point set without cells or arrays.
vtkSmartPointer<vtkPolyData> cloud(const morph::Points& points);
void addIds(vtkDataSet* data, const char* name, const std::vector<morph::Index>& ids);
void addVectors(vtkDataSet* data, const char* name, const morph::Points& vectors);
/// Equal numbers.
void addNumbers(
  vtkDataSetAttributes* data, const char* name, vtkIdType tuples, double value, int components = 1);
/// A point array, or a cell array by the middle of bounds: 1 where `is` holds, and 0.
void mark(vtkDataSet* data, const char* name, const std::function<bool(const Row&)>& is);
void markCells(vtkDataSet* data, const char* name, const std::function<bool(const Row&)>& is);
/// Appends to an array of the field data, as `SurfaceNames`.
void addTexts(vtkDataSet* data, const char* name, const std::vector<std::string>& texts);

morph::Points points(vtkPointSet* data);
/// `map` applied to each row.
morph::Points mapped(const morph::Points& points, const Map& map);
/// Shear, stretch and turn, with a shift.
Row affine(const Row& x);
/// A twist about the z axis and a bulge: not affine.
Row twist(const Row& x);
inline Row same(const Row& x)
{
  return x;
}
/// The first number of an array of the field data. Fails the test where there is none.
double field(vtkDataObject* data, const char* name);

/// Updates the filter. Expects no error; neither error nor warning; one error, or one warning and
/// no error, with this part.
///@{
void update(vtkAlgorithm* filter);
void updateQuietly(vtkAlgorithm* filter);
void expectError(vtkAlgorithm* filter, const std::string& part);
void expectWarning(vtkAlgorithm* filter, const std::string& part);
///@}
/// Updates the filter. Returns its error: it is the only one, and the executive has none.
std::string errorOf(vtkAlgorithm* filter);

/// Counts the errors and warnings of one filter while it lives, and keeps them off the console.
class Listener
{
public:
  explicit Listener(vtkAlgorithm* filter);
  ~Listener();

  /// Expects one error, or warning, so far, and that it has this part.
  ///@{
  void ExpectError(const std::string& part) const;
  void ExpectWarning(const std::string& part) const;
  ///@}

  std::vector<std::string> Errors;
  std::vector<std::string> Warnings;
  std::vector<std::string> ExecutiveErrors; ///< what VTK's executive adds after a return of 0

private:
  struct Tags;
  Tags* Observers;
};

/// A filter's update, and what the filter says in it.
struct Run : Listener
{
  explicit Run(vtkAlgorithm* filter);
};
}
