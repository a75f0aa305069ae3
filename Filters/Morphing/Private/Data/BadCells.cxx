// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/BadCells.h"

#include "Private/Data/SubGrid.h"

#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>

namespace morph::filters::BadCells
{
void Extract(
  const morph::Quality& quality, vtkUnstructuredGrid* morphed, vtkUnstructuredGrid* output)
{
  vtkNew<vtkIdList> cells;
  for (const morph::Index cell : morph::invertedCells(quality))
  {
    cells->InsertNextId(static_cast<vtkIdType>(cell));
  }
  SubGrid::Extract(morphed, cells, output);
}
}
