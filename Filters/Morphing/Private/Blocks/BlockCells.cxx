// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Blocks/BlockCells.h"

#include "Mesh/CellShape.h"
#include "Private/Data/DataCheck.h"
#include "Private/Data/Version.h"
#include "Support/Error.h"

#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>

namespace morph::filters::BlockCells
{
namespace
{
morph::Mesh readAny(vtkDataSet* block)
{
  morph::Mesh mesh;
  mesh.points = ReadPoints(block);
  vtkNew<vtkIdList> nodes;
  for (vtkIdType c = 0; c < block->GetNumberOfCells(); ++c)
  {
    const auto type = static_cast<std::uint8_t>(block->GetCellType(c));
    nodes->Reset();
    if (type != morph::EmptyCell) // as a structured grid has for its hidden cells
    {
      block->GetCellPoints(c, nodes);
    }
    mesh.add(type, nodes->begin(), nodes->end());
  }
  morph::validate(mesh);
  return mesh;
}
}

int Dimension(vtkDataSet* block)
{
  if (auto* surface = vtkPolyData::SafeDownCast(block))
  {
    return surface->GetNumberOfPolys() + surface->GetNumberOfStrips() > 0 ? 2
           : surface->GetNumberOfLines() > 0                              ? 1
           : surface->GetNumberOfVerts() > 0                              ? 0
                                                                          : -1;
  }
  auto* grid = vtkUnstructuredGrid::SafeDownCast(block);
  vtkDataArray* types = grid ? Version::CellTypes(grid) : nullptr;
  const vtkIdType count = types  ? std::min(types->GetNumberOfValues(), block->GetNumberOfCells())
                          : grid ? 0
                                 : block->GetNumberOfCells();
  bool seen[256] = {};
  int highest = -1;
  for (vtkIdType c = 0; c < count; ++c)
  {
    const auto type =
      static_cast<std::uint8_t>(types ? types->GetComponent(c, 0) : block->GetCellType(c));
    if (!seen[type])
    {
      seen[type] = true;
      highest = std::max(highest, GridMesh::Dimension(type));
    }
  }
  return highest;
}

morph::Points ReadPoints(vtkDataSet* block)
{
  if (auto* set = vtkPointSet::SafeDownCast(block))
  {
    return GridMesh::FromPoints(set->GetPoints());
  }
  morph::Points points(block->GetNumberOfPoints(), 3);
  for (vtkIdType i = 0; i < block->GetNumberOfPoints(); ++i)
  {
    block->GetPoint(i, points.row(i).data());
  }
  return points;
}

morph::Mesh Read(vtkDataSet* block, const std::string& name, GridMesh::UnknownCells unknown)
{
  if (!vtkPointSet::SafeDownCast(block))
  {
    DataCheck::RequireLengths(block, name.c_str());
  }
  DataCheck::Require(block, name.c_str(), DataCheck::Cells::InCore);
  try
  {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(block);
    return grid ? GridMesh::FromGrid(grid, unknown) : readAny(block);
  }
  catch (const morph::Error& error)
  {
    throw morph::Error(error.kind(), name + ": " + error.what());
  }
}

std::vector<morph::Index> GlobalIds(vtkDataSetAttributes* attributes, vtkIdType count)
{
  vtkDataArray* array = attributes->GetGlobalIds();
  if (!array || array->GetNumberOfComponents() != 1 || array->GetNumberOfTuples() < count)
  {
    return {};
  }
  // A double does not hold every number of 64 bits.
  const bool isWhole = array->GetDataType() != VTK_FLOAT && array->GetDataType() != VTK_DOUBLE;
  vtkNew<vtkIdTypeArray> whole;
  if (isWhole)
  {
    whole->DeepCopy(array);
  }
  std::vector<morph::Index> ids(count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    const double id = array->GetComponent(i, 0);
    if (!isWhole && !(std::abs(id) <= 9007199254740992. && std::floor(id) == id))
    {
      return {};
    }
    ids[i] = isWhole ? whole->GetValue(i) : static_cast<morph::Index>(id);
    if (ids[i] < 0)
    {
      return {};
    }
  }
  return ids;
}
}
