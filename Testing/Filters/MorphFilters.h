// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "TestGrids.h"
#include "vtkMorphAlgorithm.h"

#include <vtkSmartPointer.h>

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace grids
{
/// An option of a morphing filter, set to another value than its default.
struct MorphOption
{
  std::string name;
  std::function<void(vtkMorphAlgorithm*)> set;
  bool prepares; ///< the method has to be prepared again
};

/// A morphing filter whose properties TestMorphFilters.cxx checks.
struct MorphFilter
{
  std::string name; ///< letters and digits
  /// With options under which affine motions come out exactly.
  std::function<vtkSmartPointer<vtkMorphAlgorithm>()> make;
  std::vector<MorphOption> options; ///< those of the method itself
  /// What the method counts, as the output's field data name it, and the filter's getter.
  std::vector<std::pair<std::string, std::function<vtkIdType(vtkMorphAlgorithm*)>>> counts;
  bool linear = true; ///< free displacements are a fixed matrix times the prescribed ones

  /// The filter of a mesh and its moved boundary.
  vtkSmartPointer<vtkMorphAlgorithm> of(vtkDataObject* mesh, vtkDataObject* boundary) const;
  /// `map`: moves the boundary.
  vtkSmartPointer<vtkMorphAlgorithm> of(vtkUnstructuredGrid* grid, const Map& map) const;
};

/// A filter of a mesh and its moved boundary.
template <typename Filter>
vtkSmartPointer<Filter> morphed(vtkDataObject* mesh, vtkDataObject* boundary)
{
  auto filter = vtkSmartPointer<Filter>::New();
  filter->SetInputDataObject(mesh);
  filter->SetBoundaryData(boundary);
  return filter;
}
/// `map`: moves the boundary.
template <typename Filter>
vtkSmartPointer<Filter> morphed(vtkUnstructuredGrid* grid, const Map& map)
{
  return morphed<Filter>(grid, boundary(grid, map));
}

/// Every morphing filter.
const std::vector<MorphFilter>& morphFilters();

std::ostream& operator<<(std::ostream& stream, const MorphFilter& filter);
}
