// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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
};

/// Every morphing filter.
const std::vector<MorphFilter>& morphFilters();

std::ostream& operator<<(std::ostream& stream, const MorphFilter& filter);
}
