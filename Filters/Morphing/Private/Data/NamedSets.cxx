// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/NamedSets.h"

#include "Mesh/CellShape.h"
#include "Private/Data/Arrays.h"

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <utility>

namespace morph::filters
{
namespace
{
using morph::Index;
using Flags = std::vector<std::uint8_t>;

/// Whether each point or cell is marked; empty without an array that has a value for each.
Flags marks(vtkDataSetAttributes* data, const char* name, vtkIdType count)
{
  vtkDataArray* array = data->GetArray(name);
  if (!array || array->GetNumberOfTuples() != count)
  {
    return {};
  }
  std::vector<std::uint8_t> result(static_cast<std::size_t>(count));
  for (vtkIdType i = 0; i < count; ++i)
  {
    const double value = array->GetComponent(i, 0);
    result[static_cast<std::size_t>(i)] = value < 0 || value > 0; // a NaN marks nothing
  }
  return result;
}

}

std::vector<std::string> NamesOfSets(vtkPointSet* input)
{
  std::vector<std::string> result;
  auto* names =
    vtkStringArray::SafeDownCast(input->GetFieldData()->GetAbstractArray("SurfaceNames"));
  for (vtkIdType i = 0; names && i < names->GetNumberOfValues(); ++i)
  {
    if (names->LookupValue(names->GetValue(i)) == i)
    {
      result.push_back(names->GetValue(i));
    }
  }
  return result;
}

std::vector<std::uint8_t> CellsOfNamedSets(vtkPointSet* input)
{
  std::vector<std::uint8_t> result(static_cast<std::size_t>(input->GetNumberOfCells()), 0);
  for (const std::string& name : NamesOfSets(input))
  {
    const auto isCell = marks(input->GetCellData(), name.c_str(), input->GetNumberOfCells());
    for (std::size_t c = 0; c < isCell.size(); ++c)
    {
      result[c] |= isCell[c];
    }
  }
  return result;
}

std::vector<morph::NamedCells> PartsOf(const std::vector<ListedZone>& zones)
{
  std::vector<morph::NamedCells> parts;
  for (const ListedZone& zone : zones)
  {
    if (zone.CellCount > 0)
    {
      parts.push_back({ zone.Name, zone.Cells });
    }
  }
  return parts;
}

std::vector<morph::NamedNodes> NodeSets(vtkPointSet* input, const morph::Communicator& processes)
{
  std::vector<morph::NamedNodes> result;
  for (const std::string& name : processes.gatherTexts(NamesOfSets(input)))
  {
    const Flags isCell = marks(input->GetCellData(), name.c_str(), input->GetNumberOfCells());
    Flags isNode = marks(input->GetPointData(), name.c_str(), input->GetNumberOfPoints());
    bool hasFaces = false;
    for (std::size_t c = 0; c < isCell.size() && !isNode.empty(); ++c)
    {
      const auto type = isCell[c] ? input->GetCellType(static_cast<vtkIdType>(c)) : VTK_EMPTY_CELL;
      const morph::CellShape* shape = morph::cellShape(static_cast<std::uint8_t>(type));
      hasFaces = hasFaces || (isCell[c] && (!shape || shape->dimension < 3));
    }
    const bool hasNodes = std::find(isNode.begin(), isNode.end(), 1) != isNode.end();
    if (processes.all(!hasFaces) && !processes.all(!hasNodes))
    {
      result.push_back({ name, std::move(isNode) });
    }
  }
  return result;
}

std::vector<NamedSet> FindNamedSets(vtkPointSet* input, const morph::Mesh& mesh,
  const morph::BoundaryFaces& faces, Index firstPolygon, std::size_t inside)
{
  std::vector<NamedSet> result;
  for (const std::string& name : NamesOfSets(input))
  {
    const Flags isNode = marks(input->GetPointData(), name.c_str(), input->GetNumberOfPoints());
    Flags isCell = marks(input->GetCellData(), name.c_str(), input->GetNumberOfCells());
    if (std::count(isNode.begin(), isNode.end(), 1) + std::count(isCell.begin(), isCell.end(), 1) >
        0)
    {
      isCell.erase(isCell.begin(), isCell.begin() + (isCell.empty() ? 0 : firstPolygon));
      result.push_back(morph::boundarySet(name, mesh, faces, inside, isNode, isCell));
    }
  }
  return result;
}

void AddNamedSets(const std::vector<NamedSet>& sets, const std::vector<Index>& faceOf,
  Index firstPolygon, vtkPolyData* output)
{
  if (sets.empty())
  {
    return;
  }
  for (const NamedSet& set : sets)
  {
    auto array = Arrays::Make<vtkUnsignedCharArray>(set.name.c_str(), output->GetNumberOfCells());
    array->FillValue(0);
    for (std::size_t polygon = 0; polygon < faceOf.size(); ++polygon)
    {
      const bool has = std::binary_search(set.faces.begin(), set.faces.end(), faceOf[polygon]);
      array->SetValue(firstPolygon + static_cast<vtkIdType>(polygon), has);
    }
    output->GetCellData()->AddArray(array);
  }
  output->GetFieldData()->AddArray(Arrays::MakeOf<vtkStringArray>(
    "SurfaceNames", sets, [](const NamedSet& set) { return set.name; }));
}
}
