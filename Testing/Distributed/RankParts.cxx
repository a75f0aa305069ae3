// SPDX-License-Identifier: BSD-3-Clause
#include "RankParts.h"

#include "Pieces.h"
#include "TestGrids.h"

#include <vtkCellData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>

namespace rank_grids
{
namespace
{
/// The tuples of `from` with these ids, which become global ids.
void copyTuples(
  vtkDataSetAttributes* from, const std::vector<std::int64_t>& ids, vtkDataSetAttributes* to)
{
  to->CopyAllOn();
  to->CopyAllocate(from, static_cast<vtkIdType>(ids.size()));
  vtkNew<vtkIdTypeArray> global;
  global->SetName("GlobalIds");
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    to->CopyData(from, static_cast<vtkIdType>(ids[i]), static_cast<vtkIdType>(i));
    global->InsertNextValue(static_cast<vtkIdType>(ids[i]));
  }
  to->SetGlobalIds(global);
}
}

vtkSmartPointer<vtkUnstructuredGrid> part(const morph::distributed::Ranks& ranks,
  vtkUnstructuredGrid* whole, const morph::Mesh& mesh, unsigned seed)
{
  const auto mine =
    pieces::pieceOf(mesh, pieces::randomOwners(mesh, ranks.count(), seed), ranks.rank());
  vtkSmartPointer<vtkUnstructuredGrid> grid = grids::make(mine.mesh);
  copyTuples(whole->GetPointData(), mine.nodeIds, grid->GetPointData());
  copyTuples(whole->GetCellData(), mine.cellIds, grid->GetCellData());
  grid->GetFieldData()->ShallowCopy(whole->GetFieldData());
  return grid;
}
}
