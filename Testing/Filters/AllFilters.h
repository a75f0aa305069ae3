// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkAlgorithm.h>
#include <vtkSmartPointer.h>

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

class vtkDataObject;

namespace grids
{
/// A filter of the module, whatever it makes.
struct AnyFilter
{
  std::string name; ///< letters and digits
  std::function<vtkSmartPointer<vtkAlgorithm>()> make;
  bool hasBoundary; ///< takes a moved boundary on port 1
  /// Connects port 0 and, where there is one, port 1.
  vtkSmartPointer<vtkAlgorithm> connected(vtkDataObject* grid, vtkDataObject* boundary) const;
};

/// Every filter, set up so that grids::hexes() with the point array Gradient gives a result.
const std::vector<AnyFilter>& allFilters();

std::ostream& operator<<(std::ostream& stream, const AnyFilter& filter);
}
