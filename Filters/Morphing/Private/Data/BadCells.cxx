// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/BadCells.h"

#include <vtkCellData.h>
#include <vtkCellType.h>
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

/// `faces`: the number of a polyhedron's faces, then for each its number of nodes and their ids.
void renumberFaces(Nodes& nodes, vtkIdList* faces)
{
  vtkIdType at = 1;
  for (vtkIdType face = 0; face < faces->GetId(0); ++face)
  {
    const vtkIdType end = at + 1 + faces->GetId(at);
    for (++at; at < end; ++at)
    {
      faces->SetId(at, nodes.NumberOf(faces->GetId(at)));
    }
  }
}
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
    const int type = morphed->GetCellType(cells->GetId(i));
    if (type == VTK_POLYHEDRON)
    {
      morphed->GetFaceStream(cells->GetId(i), corners);
      renumberFaces(nodes, corners);
    }
    else
    {
      morphed->GetCellPoints(cells->GetId(i), corners);
      for (vtkIdType k = 0; k < corners->GetNumberOfIds(); ++k)
      {
        corners->SetId(k, nodes.NumberOf(corners->GetId(k)));
      }
    }
    output->InsertNextCell(type, corners);
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
