// SPDX-License-Identifier: BSD-3-Clause
#include "SolverGrids.h"

#include "Formats/SolverMesh.h"
#include "Support/Lists.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCompositeDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>

namespace morph::io
{
namespace
{
vtkSmartPointer<vtkIdTypeArray> idArray(const char* name, const std::vector<Index>& values)
{
  auto array = vtkSmartPointer<vtkIdTypeArray>::New();
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

vtkSmartPointer<vtkUnsignedCharArray> mask(
  const std::string& name, const std::vector<Index>& members, Index size)
{
  auto array = vtkSmartPointer<vtkUnsignedCharArray>::New();
  array->SetName(name.c_str());
  array->SetNumberOfValues(size);
  array->FillValue(0);
  for (const Index member : members)
  {
    array->SetValue(member, 1);
  }
  return array;
}

vtkSmartPointer<vtkStringArray> stringArray(const char* name)
{
  auto array = vtkSmartPointer<vtkStringArray>::New();
  array->SetName(name);
  return array;
}

/// `values`: 3 for each node.
vtkSmartPointer<vtkDoubleArray> vectors(const std::string& name, const std::vector<double>& values)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name.c_str());
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size() / 3));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

void setPoints(const SolverMesh& mesh, vtkUnstructuredGrid* grid)
{
  vtkNew<vtkPoints> points;
  points->SetData(vectors("Points", mesh.coordinates));
  grid->SetPoints(points);
  if (!mesh.displacementName.empty())
  {
    grid->GetPointData()->AddArray(vectors(mesh.displacementName, mesh.displacements));
  }
}

/// One by one: a polyhedron is the list of its faces, in every VTK.
void insertCells(const SolverMesh& mesh, vtkUnstructuredGrid* grid)
{
  grid->Allocate(mesh.cells());
  vtkNew<vtkIdList> ids;
  for (Index c = 0; c < mesh.cells(); ++c)
  {
    ids->Reset();
    if (mesh.cellTypes[c] == VTK_POLYHEDRON)
    {
      const Index end = mesh.faceOffsets[c + 1];
      ids->InsertNextId(0);
      for (Index at = mesh.faceOffsets[c]; at < end; at += mesh.faces[at] + 1)
      {
        ids->SetId(0, ids->GetId(0) + 1);
        for (Index k = 0; k <= mesh.faces[at]; ++k)
        {
          ids->InsertNextId(mesh.faces[at + k]);
        }
      }
    }
    else
    {
      for (Index k = mesh.offsets[c]; k < mesh.offsets[c + 1]; ++k)
      {
        ids->InsertNextId(mesh.connectivity[k]);
      }
    }
    grid->InsertNextCell(mesh.cellTypes[c], ids);
  }
}

void setCells(const SolverMesh& mesh, vtkUnstructuredGrid* grid)
{
  if (!mesh.faceOffsets.empty())
  {
    insertCells(mesh, grid);
    return;
  }
  vtkNew<vtkCellArray> cells;
  cells->SetData(idArray("offsets", mesh.offsets), idArray("connectivity", mesh.connectivity));
  vtkNew<vtkUnsignedCharArray> types;
  types->SetNumberOfValues(mesh.cells());
  std::copy(mesh.cellTypes.begin(), mesh.cellTypes.end(), types->GetPointer(0));
  grid->SetCells(types, cells);
}

bool isEmpty(const NamedSet& set)
{
  return set.nodes.empty() && set.cells.empty();
}

void setFieldData(const SolverMesh& whole, const std::string& path, vtkFieldData* data)
{
  const auto names = stringArray("SurfaceNames");
  for (const NamedSet& set : whole.sets)
  {
    if (!isEmpty(set))
    {
      names->InsertNextValue(set.name);
    }
  }
  data->AddArray(names);
  if (!whole.periodic.empty())
  {
    const auto pairs = stringArray("PeriodicSurfaces");
    for (const auto& [first, second] : whole.periodic)
    {
      pairs->InsertNextValue(first + " = " + second);
    }
    data->AddArray(pairs);
  }
  if (!whole.symmetry.empty())
  {
    const auto planes = stringArray("SymmetrySurfaces");
    for (const std::string& name : whole.symmetry)
    {
      planes->InsertNextValue(name);
    }
    data->AddArray(planes);
  }
  const auto file = stringArray("SolverFile");
  file->InsertNextValue(path);
  data->AddArray(file);
}

/// `mesh`: a part of `whole`, with the same sets. It gets arrays of all sets, also of those that it
/// has nothing of, so that all parts have the same arrays.
void fill(const SolverMesh& mesh, const SolverMesh& whole, const std::string& path,
  vtkUnstructuredGrid* grid)
{
  setPoints(mesh, grid);
  setCells(mesh, grid);
  grid->GetPointData()->SetGlobalIds(idArray("NodeNumber", mesh.nodeNumbers));
  grid->GetCellData()->AddArray(idArray("ElementNumber", mesh.cellNumbers));
  for (std::size_t i = 0; i < whole.sets.size(); ++i)
  {
    const NamedSet& set = mesh.sets[i];
    if (!whole.sets[i].nodes.empty())
    {
      grid->GetPointData()->AddArray(mask(set.name, set.nodes, mesh.nodes()));
    }
    if (!whole.sets[i].cells.empty())
    {
      grid->GetCellData()->AddArray(mask(set.name, set.cells, mesh.cells()));
    }
  }
  setFieldData(whole, path, grid->GetFieldData());
}

/// All nodes, and the cells that are elements of the file.
SolverMesh elementsOf(const SolverMesh& mesh)
{
  std::vector<Index> nodes = consecutive(static_cast<std::size_t>(mesh.nodes())), cells;
  for (Index c = 0; c < mesh.cells(); ++c)
  {
    if (mesh.cellNumbers[c] >= 0)
    {
      cells.push_back(c);
    }
  }
  return partOf(mesh, nodes, cells);
}

/// The cells of the set, and a vertex for each of its nodes that these do not have.
SolverMesh membersOf(const SolverMesh& mesh, const NamedSet& set)
{
  std::vector<Index> cells = set.cells, alone = set.nodes; // a file may name one twice
  sortUnique(cells);
  sortUnique(alone);
  std::vector<Index> nodes;
  for (const Index cell : cells)
  {
    nodes.insert(nodes.end(), mesh.connectivity.begin() + mesh.offsets[cell],
      mesh.connectivity.begin() + mesh.offsets[cell + 1]);
  }
  sortUnique(nodes);
  alone.erase(
    std::remove_if(alone.begin(), alone.end(),
      [&nodes](Index node) { return std::binary_search(nodes.begin(), nodes.end(), node); }),
    alone.end());
  nodes.insert(nodes.end(), alone.begin(), alone.end());
  sortUnique(nodes);
  SolverMesh part = partOf(mesh, nodes, cells);
  for (const Index node : alone)
  {
    const auto place = std::lower_bound(nodes.begin(), nodes.end(), node);
    part.addCell(VTK_VERTEX, { static_cast<Index>(place - nodes.begin()) }, -1);
  }
  return part;
}
}

void fillGrid(const SolverMesh& mesh, const std::string& path, vtkUnstructuredGrid* grid)
{
  fill(mesh, mesh, path, grid);
}

void fillBlocks(
  const SolverMesh& mesh, const std::string& path, vtkPartitionedDataSetCollection* blocks)
{
  const auto add = [&](const SolverMesh& part, const std::string& name)
  {
    vtkNew<vtkUnstructuredGrid> grid;
    fill(part, mesh, path, grid);
    const unsigned int place = blocks->GetNumberOfPartitionedDataSets();
    blocks->SetPartition(place, 0, grid);
    blocks->GetMetaData(place)->Set(vtkCompositeDataSet::NAME(), name.c_str());
  };
  blocks->Initialize();
  add(elementsOf(mesh), "Mesh");
  for (const NamedSet& set : mesh.sets)
  {
    if (!isEmpty(set))
    {
      add(membersOf(mesh, set), set.name);
    }
  }
  setFieldData(mesh, path, blocks->GetFieldData());
}
}
