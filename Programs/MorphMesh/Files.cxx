// SPDX-License-Identifier: BSD-3-Clause
#include "Files.h"

#include "Messages.h"

#include <vtkAVSucdReader.h>
#include <vtkAppendFilter.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataSet.h>
#include <vtkDataSetWriter.h>
#include <vtkErrorCode.h>
#include <vtkExodusIIReader.h>
#include <vtkGAMBITReader.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPLYReader.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLGenericDataObjectReader.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>
#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <initializer_list>

namespace morph_mesh
{
namespace
{
std::string extension(const std::string& path)
{
  return vtksys::SystemTools::LowerCase(vtksys::SystemTools::GetFilenameLastExtension(path));
}

bool isOneOf(const std::string& text, std::initializer_list<const char*> list)
{
  return std::find(list.begin(), list.end(), text) != list.end();
}

template <typename Reader>
vtkSmartPointer<vtkAlgorithm> readerFor(const std::string& path)
{
  auto reader = vtkSmartPointer<Reader>::New();
  reader->SetFileName(path.c_str());
  return reader;
}

vtkSmartPointer<vtkAlgorithm> makeReader(const std::string& path)
{
  const std::string kind = extension(path);
  if (isOneOf(kind, { ".vtu", ".pvtu", ".vtp", ".pvtp" }))
  {
    return readerFor<vtkXMLGenericDataObjectReader>(path);
  }
  if (kind == ".vtk")
  {
    return readerFor<vtkGenericDataObjectReader>(path);
  }
  if (kind == ".inp")
  {
    return readerFor<vtkAVSucdReader>(path);
  }
  if (kind == ".neu")
  {
    return readerFor<vtkGAMBITReader>(path);
  }
  if (isOneOf(kind, { ".e", ".exo", ".ex2", ".exii" }))
  {
    return readerFor<vtkExodusIIReader>(path);
  }
  if (kind == ".ply")
  {
    return readerFor<vtkPLYReader>(path);
  }
  if (kind == ".stl")
  {
    return readerFor<vtkSTLReader>(path);
  }
  if (kind == ".obj")
  {
    return readerFor<vtkOBJReader>(path);
  }
  throw Failure("Cannot read " + path + ": its extension is none of those that --help lists.");
}

vtkSmartPointer<vtkUnstructuredGrid> merged(vtkCompositeDataSet* blocks)
{
  vtkNew<vtkAppendFilter> append;
  append->MergePointsOn();
  const auto block = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  for (block->InitTraversal(); !block->IsDoneWithTraversal(); block->GoToNextItem())
  {
    append->AddInputDataObject(block->GetCurrentDataObject());
  }
  append->Update();
  return append->GetOutput();
}

vtkSmartPointer<vtkDataObject> readFile(const std::string& path)
{
  // Some readers say nothing of a file that is not there.
  if (!vtksys::SystemTools::FileExists(path, true))
  {
    throw Failure("Cannot read " + path + ": there is no such file.");
  }
  const vtkSmartPointer<vtkAlgorithm> reader = makeReader(path);
  Messages messages(reader);
  messages.update("Cannot read " + path);
  vtkDataObject* data = reader->GetOutputDataObject(0);
  if (auto* blocks = vtkCompositeDataSet::SafeDownCast(data))
  {
    return merged(blocks);
  }
  return data;
}

template <typename Writer>
void writeFile(Writer* writer, vtkDataObject* data, const std::string& path)
{
  Messages messages(writer);
  writer->SetFileName(path.c_str());
  writer->SetInputDataObject(data);
  messages.update("Cannot write " + path);
  if (writer->GetErrorCode() != vtkErrorCode::NoError)
  {
    throw Failure("Cannot write " + path + ": " +
                  vtkErrorCode::GetStringFromErrorCode(writer->GetErrorCode()) + ".");
  }
}

template <typename Writer>
void writeXml(vtkDataObject* data, const std::string& path)
{
  vtkNew<Writer> writer;
  // Raw appended data, VTK's default, is no XML: Debian's ParaView cannot read it.
  writer->SetDataModeToBinary();
  writeFile(writer.Get(), data, path);
}

void writeLegacy(vtkDataObject* data, const std::string& path)
{
  vtkNew<vtkDataSetWriter> writer;
  writer->SetFileTypeToBinary();
  writeFile(writer.Get(), data, path);
}
}

vtkSmartPointer<vtkUnstructuredGrid> readGrid(const std::string& path)
{
  const vtkSmartPointer<vtkDataObject> data = readFile(path);
  auto* grid = vtkUnstructuredGrid::SafeDownCast(data);
  if (!grid || grid->GetNumberOfCells() == 0)
  {
    throw Failure(
      "Cannot read " + path + ": it holds " +
      (grid ? "no cells" : std::string("a ") + (data ? data->GetClassName() : "nothing")) +
      " where an unstructured grid is needed.");
  }
  return grid;
}

vtkSmartPointer<vtkPointSet> readPoints(const std::string& path)
{
  const vtkSmartPointer<vtkDataObject> data = readFile(path);
  auto* points = vtkPointSet::SafeDownCast(data);
  if (!points || points->GetNumberOfPoints() == 0)
  {
    throw Failure("Cannot read " + path + ": it holds no points.");
  }
  return points;
}

void requireGridFormat(const std::string& path)
{
  if (!isOneOf(extension(path), { ".vtu", ".vtk" }))
  {
    throw Failure("Cannot write " + path + ": a grid is written as .vtu or .vtk.");
  }
}

void requireBoundaryFormat(const std::string& path)
{
  if (!isOneOf(extension(path), { ".vtp", ".vtk" }))
  {
    throw Failure(
      "Cannot write " + path + ": a boundary, with its arrays, is written as .vtp or .vtk.");
  }
}

void writeGrid(vtkUnstructuredGrid* grid, const std::string& path)
{
  requireGridFormat(path);
  extension(path) == ".vtk" ? writeLegacy(grid, path)
                            : writeXml<vtkXMLUnstructuredGridWriter>(grid, path);
}

void writeBoundary(vtkPointSet* boundary, const std::string& path)
{
  requireBoundaryFormat(path);
  extension(path) == ".vtk" ? writeLegacy(boundary, path)
                            : writeXml<vtkXMLPolyDataWriter>(boundary, path);
}
}
