// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

class vtkDataObjectTree;
class vtkDataSet;
class vtkExtractSelection;
class vtkSelection;

namespace morph::filters
{
class Blocks;
}

/// The evaluation of a VTK selection.
namespace morph::filters::Selection
{
struct Inside
{
  bool ByPoints = false;           ///< whether points are selected, else cells
  std::vector<std::uint8_t> Flags; ///< #points or #cells: whether it is selected
};

/// Evaluates `selection` on `input` by `extractor`, whose inputs are removed afterwards; null: by
/// VTK's own. Throws and costs as Points() does.
Inside Evaluate(vtkDataSet* input, vtkSelection* selection, vtkExtractSelection* extractor);

/// The same for the data sets of composite data, in the order of Leaves::Of(); empty where nothing
/// is selected.
struct InsideBlocks
{
  bool ByPoints = false;
  std::vector<std::vector<std::uint8_t>> Flags;
};
InsideBlocks Evaluate(
  vtkDataObjectTree* input, vtkSelection* selection, vtkExtractSelection* extractor);

/// Tells for each point of `input` whether it, or a cell that has it, is selected. `extractor`:
/// evaluates the selection; its inputs are removed afterwards. Throws morph::Error for a null or
/// empty selection, for one of neither points nor cells or of both, and where the extractor fails.
/// Cost: that of the extractor.
std::vector<std::uint8_t> Points(
  vtkDataSet* input, vtkSelection* selection, vtkExtractSelection* extractor);
/// The same for the nodes of composite data, each of which has points in some of the blocks.
std::vector<std::uint8_t> Points(
  const Blocks& blocks, vtkSelection* selection, vtkExtractSelection* extractor);
}
