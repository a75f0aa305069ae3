// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/Choice.h"

#include <vtkType.h>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

class vtkDataArray;
class vtkExtractSelection;
class vtkImplicitFunction;
class vtkPointSet;
class vtkSelection;

/// The choice of what moves, from VTK's data.
namespace morph::filters::Chosen
{
enum class By
{
  Surfaces,
  Selection,
  Region,
  Everything,
  Array,
  Nothing
};

struct Options
{
  By How = By::Everything;
  vtkSelection* Selection = nullptr;
  vtkMTimeType SelectionTime = 0; ///< its modification
  vtkExtractSelection* Extractor = nullptr;
  /// #points, what a selection has chosen on MPI processes; null: evaluates Selection
  const std::vector<std::uint8_t>* IsSelected = nullptr;
  std::set<std::string> Surfaces;
  vtkImplicitFunction* Region = nullptr; ///< inside where it is zero or less
  vtkMTimeType RegionTime = 0;           ///< its modification
  std::string ArrayName;                 ///< a point array: nodes where it is not zero
  std::set<std::string> FixedSurfaces;

  /// Whether they choose the same of the same model. No two objects have the same time.
  bool operator==(const Options& other) const;
};

/// Chooses the nodes and faces that move. `input`: the data that `model` was made from. Throws
/// morph::Error where nothing on the boundary is chosen, with what is missing.
morph::Choice Choose(vtkPointSet* input, const morph::BoundaryModel& model, const Options& options);

/// For each tuple, whether one of its values is not 0. A NaN marks nothing.
std::vector<std::uint8_t> Marked(vtkDataArray* array);
}
