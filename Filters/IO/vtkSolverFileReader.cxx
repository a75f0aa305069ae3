// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSolverFileReader.h"

#include "Formats/SolverFile.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <exception>

namespace
{
using morph::Index;
using morph::io::SolverMesh;

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

void setPoints(const SolverMesh& mesh, vtkUnstructuredGrid* grid)
{
  vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  coordinates->SetNumberOfTuples(mesh.nodes());
  std::copy(mesh.coordinates.begin(), mesh.coordinates.end(), coordinates->GetPointer(0));
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  grid->SetPoints(points);
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

void setArrays(const SolverMesh& mesh, const std::string& path, vtkUnstructuredGrid* grid)
{
  grid->GetPointData()->SetGlobalIds(idArray("NodeNumber", mesh.nodeNumbers));
  grid->GetCellData()->AddArray(idArray("ElementNumber", mesh.cellNumbers));
  const auto names = stringArray("SurfaceNames");
  for (const morph::io::NamedSet& set : mesh.sets)
  {
    if (!set.nodes.empty())
    {
      grid->GetPointData()->AddArray(mask(set.name, set.nodes, mesh.nodes()));
    }
    if (!set.cells.empty())
    {
      grid->GetCellData()->AddArray(mask(set.name, set.cells, mesh.cells()));
    }
    if (!set.nodes.empty() || !set.cells.empty())
    {
      names->InsertNextValue(set.name);
    }
  }
  grid->GetFieldData()->AddArray(names);
  const auto file = stringArray("SolverFile");
  file->InsertNextValue(path);
  grid->GetFieldData()->AddArray(file);
}
}

vtkStandardNewMacro(vtkSolverFileReader);

vtkSolverFileReader::vtkSolverFileReader()
{
  this->SetNumberOfInputPorts(0);
}

vtkSolverFileReader::~vtkSolverFileReader()
{
  this->SetFileName(nullptr);
}

int vtkSolverFileReader::CanReadFile(const char* name)
{
  return FormatOf(name).empty() ? 0 : 1;
}

std::string vtkSolverFileReader::FormatOf(const char* name)
{
  try
  {
    return name ? morph::io::solverFormat(name) : "";
  }
  catch (const std::exception&)
  {
    return "";
  }
}

int vtkSolverFileReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector);
  if (!this->FileName || !this->FileName[0])
  {
    vtkErrorMacro("No file is named that is to be read: set FileName.");
    return 1;
  }
  try
  {
    const auto file = morph::io::readSolverFile(this->FileName);
    setPoints(file->mesh(), output);
    setCells(file->mesh(), output);
    setArrays(file->mesh(), this->FileName, output);
    for (const std::string& warning : file->mesh().warnings)
    {
      vtkWarningMacro(<< warning);
    }
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorMacro("Cannot read " << this->FileName << ": there is not enough memory.");
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
  }
  return 1;
}

void vtkSolverFileReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
}
