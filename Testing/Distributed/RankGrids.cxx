// SPDX-License-Identifier: BSD-3-Clause
#include "RankGrids.h"

#include "Pieces.h"
#include "TestGrids.h"

#include <vtkCellData.h>
#include <vtkDummyController.h>
#include <vtkIdTypeArray.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkPointData.h>

namespace rankgrids
{
namespace
{
vtkSmartPointer<vtkIdTypeArray> globalIds(const std::vector<std::int64_t>& ids)
{
  auto array = vtkSmartPointer<vtkIdTypeArray>::New();
  array->SetName("GlobalIds");
  for (const std::int64_t id : ids)
  {
    array->InsertNextValue(static_cast<vtkIdType>(id));
  }
  return array;
}

/// The tuples of `from` with these ids.
void copyTuples(
  vtkDataSetAttributes* from, const std::vector<std::int64_t>& ids, vtkDataSetAttributes* to)
{
  to->CopyAllOn();
  to->CopyAllocate(from, static_cast<vtkIdType>(ids.size()));
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    to->CopyData(from, static_cast<vtkIdType>(ids[i]), static_cast<vtkIdType>(i));
  }
  to->SetGlobalIds(globalIds(ids));
}
}

vtkSmartPointer<vtkUnstructuredGrid> piece(const morph::distributed::Ranks& ranks,
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

vtkSmartPointer<vtkUnstructuredGrid> piece(
  const morph::distributed::Ranks& ranks, const morph::Mesh& whole, unsigned seed)
{
  return piece(ranks, grids::make(whole), whole, seed);
}

void alone(const std::function<void()>& work)
{
  vtkSmartPointer<vtkMultiProcessController> all = vtkMultiProcessController::GetGlobalController();
  vtkNew<vtkDummyController> one;
  vtkMultiProcessController::SetGlobalController(one);
  work();
  vtkMultiProcessController::SetGlobalController(all);
}
}
