// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>
#include <vtkType.h>

class vtkExtractSelection;
class vtkSelection;

namespace morph::filters
{
class Blocks;

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
