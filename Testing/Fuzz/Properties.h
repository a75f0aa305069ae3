// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Choices.h"

#include <vtkAlgorithm.h>
#include <vtkSmartPointer.h>

#include <functional>
#include <string>
#include <vector>

namespace fuzz
{
/// A property of a filter that takes a number.
struct Property
{
  std::string name;
  double plain;     ///< the filter's default; 1 for NumberOfThreads
  double low, high; ///< values that a user may want; the range is often wider
  bool isWhole;
  std::function<void(vtkAlgorithm*, double)> set;
  bool isLength = false; ///< values are in units of the mesh's size
};

/// A scale of motions, the smallest but 0.
constexpr double Tiny = 1e-9;

struct Filter
{
  std::string name; ///< without the prefix vtk
  int share;        ///< of `shares`, how many cases it gets
  bool isMorph;     ///< a vtkMorphAlgorithm
  bool isLinear;    ///< a method that keeps affine motions
  std::function<vtkSmartPointer<vtkAlgorithm>()> make;
  std::vector<Property> properties;
};

/// All public filters.
const std::vector<Filter>& filters();
/// The filter of a seed: each gets its share of any run of seeds.
const Filter& filterOf(std::uint64_t seed);

/// What became of the properties that were set.
struct PropertiesSet
{
  bool areRegular = true; ///< all values are usual ones
  /// the first property that took a number that is not finite without an error
  std::string accepted;
};

/// Sets some of the filter's properties, in range or not. `size`: of the mesh.
PropertiesSet setProperties(
  Choices& choices, const Filter& filter, double size, vtkAlgorithm* algorithm);
}
