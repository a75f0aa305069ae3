// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>

class vtkDataObjectTree;
class vtkExtractSelection;
class vtkSelection;
class vtkUnstructuredGrid;

namespace morph::filters
{
class Blocks;
}

/// A selection in composite data, from which surfaces are to be picked, as one of the grid.
namespace morph::filters::BlockPick
{
struct OnGrid
{
  vtkSmartPointer<vtkUnstructuredGrid> Shown; ///< the grid and, after its cells, selected faces
  vtkSmartPointer<vtkSelection> Selection;    ///< of its points or cells, by index
};

/// `shown`: the input of `blocks`, or an output of the same structure, the boundary's faces in
/// place of the cells or not. Throws as Selection::Evaluate() does, where the data have another
/// structure, and where the mesh has not been read yet.
OnGrid Translate(const Blocks& blocks, vtkDataObjectTree* shown, vtkSelection* selection,
  vtkExtractSelection* extractor);
}
