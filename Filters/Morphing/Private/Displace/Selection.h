// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

class vtkDataSet;
class vtkExtractSelection;
class vtkSelection;

/// The evaluation of a VTK selection.
namespace morph::filters::Selection
{
/// Tells for each point of `input` whether it, or a cell that has it, is selected. `extractor`:
/// evaluates the selection; its inputs are removed afterwards. Throws morph::Error for a null or
/// empty selection, for one of neither points nor cells or of both, and where the extractor fails.
/// Cost: that of the extractor.
std::vector<std::uint8_t> Points(
  vtkDataSet* input, vtkSelection* selection, vtkExtractSelection* extractor);
}
