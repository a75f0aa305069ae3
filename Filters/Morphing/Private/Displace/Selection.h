// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <cstdint>
#include <vector>

class vtkDataObjectTree;
class vtkDataSet;
class vtkExtractSelection;
class vtkSelection;
class vtkUnstructuredGrid;

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

/// A selection in composite data, from which surfaces are to be picked, as one of the grid.
struct OnGrid
{
  vtkSmartPointer<vtkUnstructuredGrid> Shown; ///< the grid and, after its cells, selected faces
  vtkSmartPointer<vtkSelection> Selection;    ///< of its points or cells, by index
};

/// `shown`: the input of `blocks`, or an output of the same structure, the boundary's faces in
/// place of the cells or not. Throws as Evaluate() does, where the data have another
/// structure, and where the mesh has not been read yet.
OnGrid Translate(const Blocks& blocks, vtkDataObjectTree* shown, vtkSelection* selection,
  vtkExtractSelection* extractor);
}

namespace morph::filters
{
/// A selection in composite data as one of the grid that their blocks became.
class BlockSelection
{
public:
  /// Returns `selection` itself where the input is not composite, and where it is null or empty.
  /// Otherwise: the points of the grid that it selects, or that its selected cells have, by their
  /// ids. The same object as long as grid, selection and extractor are the same. `extractor`:
  /// evaluates the selection; null for VTK's own. Throws as Selection::Points() does.
  vtkSelection* OfGrid(
    const Blocks& blocks, vtkSelection* selection, vtkExtractSelection* extractor);

private:
  const void *Grid = nullptr, *Given = nullptr, *Extractor = nullptr; ///< compared, never used
  vtkMTimeType GridTime = 0, GivenTime = 0;
  vtkSmartPointer<vtkSelection> Translated;
};
}
