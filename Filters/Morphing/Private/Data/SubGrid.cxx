// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/SubGrid.h"

#include "Private/Data/Arrays.h"

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <unordered_map>

namespace morph::filters
{
namespace
{
void copyTuples(
  vtkDataSetAttributes* from, vtkIdList* ids, vtkDataSetAttributes* to, const char* idName)
{
  to->CopyAllOn();
  // 0 would mean the size of `from`.
  to->CopyAllocate(from, std::max<vtkIdType>(1, ids->GetNumberOfIds()));
  auto numbers = Arrays::Make<vtkIdTypeArray>(idName);
  for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
  {
    to->CopyData(from, ids->GetId(i), i);
    numbers->InsertNextValue(ids->GetId(i));
  }
  Arrays::Add(numbers, to);
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
void renumberFaces(const SubGrid::Numbering& numberOf, vtkIdList* faces)
{
  vtkIdType at = 1;
  for (vtkIdType face = 0; face < faces->GetId(0); ++face)
  {
    const vtkIdType end = at + 1 + faces->GetId(at);
    for (++at; at < end; ++at)
    {
      faces->SetId(at, numberOf(faces->GetId(at)));
    }
  }
}
}

namespace SubGrid
{
void InsertCell(
  vtkUnstructuredGrid* from, vtkIdType cell, const Numbering& numberOf, vtkUnstructuredGrid* to)
{
  vtkNew<vtkIdList> corners;
  const int type = from->GetCellType(cell);
  if (type == VTK_POLYHEDRON)
  {
    from->GetFaceStream(cell, corners);
    renumberFaces(numberOf, corners);
  }
  else
  {
    from->GetCellPoints(cell, corners);
    for (vtkIdType k = 0; k < corners->GetNumberOfIds(); ++k)
    {
      corners->SetId(k, numberOf(corners->GetId(k)));
    }
  }
  to->InsertNextCell(type, corners);
}

void Extract(vtkUnstructuredGrid* grid, vtkIdList* cells, vtkUnstructuredGrid* output)
{
  output->Initialize();
  output->AllocateExact(cells->GetNumberOfIds(), 8 * cells->GetNumberOfIds());
  Nodes nodes;
  for (vtkIdType i = 0; i < cells->GetNumberOfIds(); ++i)
  {
    InsertCell(
      grid, cells->GetId(i), [&nodes](vtkIdType node) { return nodes.NumberOf(node); }, output);
  }
  auto points = Arrays::MakePoints(grid->GetPoints()->GetDataType());
  grid->GetPoints()->GetPoints(nodes.Ids, points);
  output->SetPoints(points);
  copyTuples(grid->GetPointData(), nodes.Ids, output->GetPointData(), "MorphPointId");
  copyTuples(grid->GetCellData(), cells, output->GetCellData(), "MorphCellId");
}
}
}
