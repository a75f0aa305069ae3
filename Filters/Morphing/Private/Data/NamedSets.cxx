// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/NamedSets.h"

#include "Mesh/InnerFaces.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace morph::filters
{
namespace
{
using morph::Index;

/// Whether each point or cell is marked; empty without an array that has a value for each.
std::vector<std::uint8_t> marks(vtkDataSetAttributes* data, const char* name, vtkIdType count)
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

/// A volume cell has faces on the boundary alone, of which the last `inside` faces are not.
void addFacesOfCells(const morph::Mesh& mesh, const morph::BoundaryFaces& faces, Index firstPolygon,
  std::size_t inside, const std::vector<std::uint8_t>& isMarked, std::vector<Index>& result)
{
  const bool isGrid = mesh.numberOfCells() > 0;
  const std::map<morph::Corners, int> flat =
    isGrid ? morph::flatCells(mesh, isMarked) : std::map<morph::Corners, int>();
  const Index* all = faces.connectivity.data();
  const std::size_t count = faces.offsets.size() - 1;
  for (std::size_t f = 0; f < (flat.empty() ? count - inside : count); ++f)
  {
    const Index behind = isGrid ? faces.cells[f] : firstPolygon + static_cast<Index>(f);
    if (flat.empty() ? isMarked[static_cast<std::size_t>(behind)] != 0
                     : flat.count(morph::sortedCorners(
                         all + faces.offsets[f], all + faces.offsets[f + 1])) > 0)
    {
      result.push_back(static_cast<Index>(f));
    }
  }
}

void sortUnique(std::vector<Index>& list)
{
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

std::optional<NamedSet> findSet(vtkPointSet* input, const char* name, const morph::Mesh& mesh,
  const morph::BoundaryFaces& faces, Index firstPolygon, std::size_t inside)
{
  NamedSet set;
  set.Name = name;
  const auto isNode = marks(input->GetPointData(), name, input->GetNumberOfPoints());
  const auto isCell = marks(input->GetCellData(), name, input->GetNumberOfCells());
  if (std::count(isNode.begin(), isNode.end(), 1) + std::count(isCell.begin(), isCell.end(), 1) ==
      0)
  {
    return std::nullopt;
  }
  if (!isCell.empty())
  {
    addFacesOfCells(mesh, faces, firstPolygon, inside, isCell, set.Faces);
    for (const Index face : set.Faces)
    {
      const auto begin = faces.connectivity.begin();
      set.Nodes.insert(set.Nodes.end(), begin + faces.offsets[static_cast<std::size_t>(face)],
        begin + faces.offsets[static_cast<std::size_t>(face) + 1]);
    }
  }
  if (!isNode.empty())
  {
    std::copy_if(faces.nodes.begin(), faces.nodes.end(), std::back_inserter(set.Nodes),
      [&](Index node) { return isNode[static_cast<std::size_t>(node)] != 0; });
    for (std::size_t f = 0; f + 1 < faces.offsets.size(); ++f)
    {
      const auto begin = faces.connectivity.begin();
      if (std::all_of(begin + faces.offsets[f], begin + faces.offsets[f + 1],
            [&](Index node) { return isNode[static_cast<std::size_t>(node)] != 0; }))
      {
        set.Faces.push_back(static_cast<Index>(f));
      }
    }
  }
  sortUnique(set.Nodes);
  sortUnique(set.Faces);
  return set;
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

std::vector<NamedSet> FindNamedSets(vtkPointSet* input, const morph::Mesh& mesh,
  const morph::BoundaryFaces& faces, Index firstPolygon, std::size_t inside)
{
  std::vector<NamedSet> result;
  for (const std::string& name : NamesOfSets(input))
  {
    if (auto set = findSet(input, name.c_str(), mesh, faces, firstPolygon, inside))
    {
      result.push_back(std::move(*set));
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
  vtkNew<vtkStringArray> names;
  names->SetName("SurfaceNames");
  for (const NamedSet& set : sets)
  {
    vtkNew<vtkUnsignedCharArray> array;
    array->SetName(set.Name.c_str());
    array->SetNumberOfValues(output->GetNumberOfCells());
    array->FillValue(0);
    for (std::size_t polygon = 0; polygon < faceOf.size(); ++polygon)
    {
      const bool has = std::binary_search(set.Faces.begin(), set.Faces.end(), faceOf[polygon]);
      array->SetValue(firstPolygon + static_cast<vtkIdType>(polygon), has);
    }
    output->GetCellData()->AddArray(array);
    names->InsertNextValue(set.Name);
  }
  output->GetFieldData()->AddArray(names);
}
}
