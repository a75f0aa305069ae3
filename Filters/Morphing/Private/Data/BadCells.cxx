// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/BadCells.h"

#include <vtkCellData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

#include <unordered_map>

namespace morph::filters
{
namespace
{
void copyTuples(
  vtkDataSetAttributes* from, vtkIdList* ids, vtkDataSetAttributes* to, const char* idName)
{
  to->CopyAllOn();
  to->CopyAllocate(from, ids->GetNumberOfIds());
  vtkNew<vtkIdTypeArray> numbers;
  numbers->SetName(idName);
  for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
  {
    to->CopyData(from, ids->GetId(i), i);
    numbers->InsertNextValue(ids->GetId(i));
  }
  to->AddArray(numbers);
}

/// The nodes of a grid's cells, in the order in which the cells first name them.
class Nodes
{
public:
  vtkNew<vtkIdList> Ids;

  vtkIdType NumberOf(vtkIdType node)
  {
    const auto [place, isNew] = this->Numbers.try_emplace(node, this->Ids->GetNumberOfIds());
    if (isNew)
    {
      this->Ids->InsertNextId(node);
    }
    return place->second;
  }

private:
  std::unordered_map<vtkIdType, vtkIdType> Numbers;
};
}

namespace BadCells
{
void Extract(
  const morph::Quality& quality, vtkUnstructuredGrid* morphed, vtkUnstructuredGrid* output)
{
  vtkNew<vtkIdList> cells;
  for (const morph::Index cell : morph::invertedCells(quality))
  {
    cells->InsertNextId(static_cast<vtkIdType>(cell));
  }

  output->Initialize();
  output->AllocateExact(cells->GetNumberOfIds(), 8 * cells->GetNumberOfIds());
  Nodes nodes;
  vtkNew<vtkIdList> corners;
  for (vtkIdType i = 0; i < cells->GetNumberOfIds(); ++i)
  {
    morphed->GetCellPoints(cells->GetId(i), corners);
    for (vtkIdType k = 0; k < corners->GetNumberOfIds(); ++k)
    {
      corners->SetId(k, nodes.NumberOf(corners->GetId(k)));
    }
    output->InsertNextCell(morphed->GetCellType(cells->GetId(i)), corners);
  }

  vtkNew<vtkPoints> points;
  points->SetDataType(morphed->GetPoints()->GetDataType());
  morphed->GetPoints()->GetPoints(nodes.Ids, points);
  output->SetPoints(points);
  copyTuples(morphed->GetPointData(), nodes.Ids, output->GetPointData(), "MorphPointId");
  copyTuples(morphed->GetCellData(), cells, output->GetCellData(), "MorphCellId");
}
}
}
