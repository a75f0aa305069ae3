// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Displace/BoundaryModel.h"
#include "Private/Displace/Patches.h"

#include <set>
#include <string>

class vtkExtractSelection;
class vtkImplicitFunction;
class vtkPointSet;
class vtkSelection;

/// Which nodes of a boundary move, and which are held.
namespace morph::filters::Choice
{
enum class By
{
  Everything,
  Selection,
  Patches,
  Region
};

struct Options
{
  By How = By::Everything;
  vtkSelection* Selection = nullptr;
  vtkExtractSelection* Extractor = nullptr;
  std::set<std::string> Patches;
  vtkImplicitFunction* Region = nullptr; ///< inside where it is zero or less
  std::set<std::string> HeldPatches;
};

struct Result
{
  std::vector<morph::Index> Moving;       ///< ascending, at least one
  std::vector<morph::Index> Held;         ///< ascending, none of them moving
  std::vector<std::uint8_t> IsMovingFace; ///< #faces
};

/// Nodes between corners (of quadratic cells) that all move, move too. A face moves if it is of a
/// patch that does or, where something else than patches was chosen, if all of its corners do.
/// Nodes of a held patch that are chosen to move, move. `input`: what `model` was made from. Throws
/// morph::Error where nothing on the boundary is chosen, with what is missing.
Result Choose(vtkPointSet* input, const BoundaryModel& model, const Options& options);
}
