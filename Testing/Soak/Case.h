// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../Filters/TestGrids.h"

#include <random>

namespace soak
{
/// A box of hexahedra and ever new motions of its boundary.
class Case
{
public:
  /// `cells`: along each edge of the box.
  Case(int cells, unsigned seed);

  vtkUnstructuredGrid* grid() const { return this->grid_; }
  /// The whole boundary, twisted and bulged by random amounts.
  vtkSmartPointer<vtkPolyData> boundary();
  /// The same without a random tenth of its points: other nodes are free, so a method has to be
  /// prepared for it.
  vtkSmartPointer<vtkPolyData> partOfBoundary();

private:
  morph::Points motion();
  double random(double low, double high);

  double size_;
  std::mt19937 random_;
  vtkSmartPointer<vtkUnstructuredGrid> grid_;
  vtkSmartPointer<vtkPolyData> rest_; ///< with the array MorphPointId
};
}
