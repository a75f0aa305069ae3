// SPDX-License-Identifier: BSD-3-Clause
#include "Files.h"

#include "FileCheck.h"
#include "Messages.h"
#include "Pieces.h"

#include "Files/ReplaceFile.h"
#include "Formats/FoamFolders.h"
#include "Formats/SolverFile.h"

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
#include <vtkSTLReader.h>
#include <vtkSolverFileReader.h>
#include <vtkSolverFileWriter.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLGenericDataObjectReader.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLStructuredGridWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>
#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <iostream>
#include <new>
#include <set>
#include <vector>

namespace morph_mesh
{
namespace
{
namespace io = morph::io;

bool isOneOf(const std::string& text, std::initializer_list<const char*> list)
{
  return std::find(list.begin(), list.end(), text) != list.end();
}

/// Whether a library of others reads this solver's file, which a build may lack.
bool isReadByLibrary(const std::string& path)
{
  return isOneOf(extensionOf(path), { ".cgns", ".e", ".ex2", ".exo", ".exii", ".g", ".gen" });
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
  const std::string kind = extensionOf(path);
  if (isOneOf(kind, { ".vtu", ".vtp", ".pvtp", ".vts", ".vti", ".vtr" }))
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
  if (!std::filesystem::exists(path))
  {
    throw Failure("Cannot read " + path + ": there is no such file.");
  }
  if (std::filesystem::is_directory(path))
  {
    throw Failure("Cannot read " + path + ": the folder has no mesh of OpenFOAM.");
  }
  const bool isOfSolver = isOneOf(kind,
    { ".bdf", ".nas", ".fem", ".dat", ".k", ".key", ".dyn", ".cdb", ".su2", ".msh", ".g", ".gen" });
  if (isOfSolver)
  {
    requireWholeFile(path);
  }
  throw Failure(
    "Cannot read " + path +
    (isOfSolver ? ": it does not begin as a " + kind + " file does. Its format is another one."
                : ": no format that --help lists has its extension.") +
    io::converterOf(path));
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

/// The first of the errors, which is the cause of the others.
void requireNoErrors(
  const std::string& path, const Messages& messages, const ConsoleMessages& inner)
{
  const std::vector<std::string>& errors = inner.errors.empty() ? messages.errors() : inner.errors;
  if (!errors.empty())
  {
    // It may cite the file's bytes.
    std::string cause = errors.front().substr(0, 500);
    std::replace_if(
      cause.begin(), cause.end(), [](char c) { return c < ' ' || c > '~'; }, ' ');
    throw Failure(
      "Cannot read " + path + ": the file is damaged, or not what its extension says: " + cause);
  }
}

void printWarnings(const std::string& path, const std::vector<std::string>& warnings)
{
  for (const std::string& warning : warnings)
  {
    std::cerr << "morph-mesh: warning: " << path << ": " << warning << "\n";
  }
}

vtkSmartPointer<vtkDataObject> readByVtk(const std::string& path)
{
  const vtkSmartPointer<vtkAlgorithm> reader = makeReader(path);
  requireWholeFile(path);
  ConsoleMessages inner;
  Messages messages(reader);
  try
  {
    reader->Update();
    requireNoErrors(path, messages, inner);
    vtkSmartPointer<vtkDataObject> data = reader->GetOutputDataObject(0);
    if (auto* blocks = vtkCompositeDataSet::SafeDownCast(data))
    {
      data = merged(blocks);
      requireNoErrors(path, messages, inner);
    }
    printWarnings(path, inner.warnings);
    printWarnings(path, messages.warnings());
    return data;
  }
  catch (const std::bad_alloc&)
  {
    throw Failure(
      "Cannot read " + path +
      ": VTK's reader did not get the memory that it asked for. The file is damaged, or "
      "not what its extension says.");
  }
}

/// The format's name, not the extension alone, tells that VTK has no reader for it.
vtkSmartPointer<vtkDataObject> readSolverFile(const std::string& path, int timeStep)
{
  vtkNew<vtkSolverFileReader> reader;
  reader->SetTimeStep(timeStep);
  reader->SetFileName(path.c_str());
  Messages messages(reader);
  reader->Update();
  if (!messages.errors().empty())
  {
    std::string error = messages.errors().front(); // it names the file
    const std::string property = "`TimeStep`";
    const std::size_t at = error.find(property);
    throw Failure(
      at == std::string::npos ? error : error.replace(at, property.size(), "--time-step"));
  }
  printWarnings(path, messages.warnings());
  return reader->GetOutput();
}

bool isVtkGrid(const std::string& path)
{
  return isOneOf(extensionOf(path), { ".vtu", ".vtk" });
}

/// The writer writes into memory, which takes up to 3 times the size of the file. On a full disk
/// VTK's XML writer would crash, and its legacy writer miss that the last block is lost.
template <typename Writer>
void runWriter(Writer* writer, vtkDataObject* data, const std::string& path)
{
  Messages messages(writer);
  writer->WriteToOutputStringOn();
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
  io::replaceFile(path, xmlOf<Writer>(data, path), io::Signals::RemoveTemporaries);
}

void writeLegacy(vtkDataObject* data, const std::string& path)
{
  vtkNew<vtkDataSetWriter> writer;
  writer->SetFileTypeToBinary();
  runWriter(writer.Get(), data, path);
  const auto length = static_cast<std::size_t>(writer->GetOutputStringLength());
  io::replaceFile(path, { writer->GetOutputString(), length }, io::Signals::RemoveTemporaries);
}
}

std::string extensionOf(const std::string& path)
{
  return vtksys::SystemTools::LowerCase(vtksys::SystemTools::GetFilenameLastExtension(path));
}

vtkSmartPointer<vtkDataObject> readFile(const std::string& path, int timeStep)
{
  if (isListOfPieces(path) && timeStep < 0)
  {
    return mergedPieces(path);
  }
  // VTK has no reader of CGNS here: the error names the library that is missing.
  if (vtkSolverFileReader::CanReadFile(path.c_str()) || extensionOf(path) == ".cgns")
  {
    return readSolverFile(path, timeStep);
  }
  if (timeStep >= 0)
  {
    throw Failure("--time-step is of files of Exodus II and CGNS with displacements, and " + path +
                  " is neither.");
  }
  return readByVtk(path);
}

template <typename Writer>
std::string xmlOf(vtkDataObject* data, const std::string& path)
{
  auto writer = vtkSmartPointer<Writer>::New();
  // Raw appended data, VTK's default, is no XML: Debian's ParaView cannot read it.
  writer->SetDataModeToBinary();
  runWriter(writer.Get(), data, path);
  return writer->GetOutputString();
}

template std::string xmlOf<vtkXMLPolyDataWriter>(vtkDataObject*, const std::string&);
template std::string xmlOf<vtkXMLStructuredGridWriter>(vtkDataObject*, const std::string&);
template std::string xmlOf<vtkXMLUnstructuredGridWriter>(vtkDataObject*, const std::string&);

vtkSmartPointer<vtkUnstructuredGrid> readGrid(const std::string& path, int timeStep)
{
  const vtkSmartPointer<vtkDataObject> data = readFile(path, timeStep);
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

vtkSmartPointer<vtkPointSet> readPoints(const std::string& path, int timeStep)
{
  const vtkSmartPointer<vtkDataObject> data = readFile(path, timeStep);
  auto* points = vtkPointSet::SafeDownCast(data);
  if (!points || points->GetNumberOfPoints() == 0)
  {
    throw Failure("Cannot read " + path + ": it holds no points.");
  }
  return points;
}

std::string regionOf(const std::string& folder, const std::string& region)
{
  const bool isMarker = extensionOf(folder) == ".foam";
  const std::filesystem::path root =
    isMarker ? std::filesystem::path(folder).parent_path() : std::filesystem::path(folder);
  const std::string path = (root / "constant" / region).string();
  if (!io::FoamFolders::of(path).parts.empty())
  {
    return path;
  }
  std::set<std::string> names;
  for (const io::FoamFolder& part : io::FoamFolders::of(folder).parts)
  {
    names.insert(part.region);
  }
  names.erase("");
  const std::string list =
    vtksys::SystemTools::Join(std::vector<std::string>(names.begin(), names.end()), ", ");
  throw Failure(folder + " has no region '" + region + "' with a mesh of OpenFOAM" +
                (list.empty() ? "." : ". Its regions are " + list + "."));
}

void requireGridFormat(const std::string& path)
{
  if (!isVtkGrid(path))
  {
    throw Failure("Cannot write " + path + ": a grid is written as .vtu or .vtk.");
  }
  io::requireReplaceable(path);
}

void requireMorphedFormat(const std::string& original, const std::string& path)
{
  if (isListOfPieces(original) && !isVtkGrid(path))
  {
    requireWritablePieces(original, path);
    return;
  }
  const bool isSolverFile =
    vtkSolverFileReader::CanReadFile(original.c_str()) || isReadByLibrary(original);
  if (isVtkGrid(path) || !isSolverFile)
  {
    requireGridFormat(path);
    return;
  }
  const std::string reason = vtkSolverFileWriter::WhyNot(original.c_str(), path.c_str());
  if (!reason.empty())
  {
    throw Failure(reason);
  }
}

void requireBoundaryFormat(const std::string& path)
{
  if (!isOneOf(extensionOf(path), { ".vtp", ".vtk" }))
  {
    throw Failure(
      "Cannot write " + path + ": a boundary, with its arrays, is written as .vtp or .vtk.");
  }
  io::requireReplaceable(path);
}

void writeGrid(vtkUnstructuredGrid* grid, const std::string& path)
{
  requireGridFormat(path);
  extensionOf(path) == ".vtk" ? writeLegacy(grid, path)
                              : writeXml<vtkXMLUnstructuredGridWriter>(grid, path);
}

Written writeMorphed(
  vtkUnstructuredGrid* grid, const std::string& original, const std::string& path)
{
  if (isVtkGrid(path))
  {
    writeGrid(grid, path);
    return {};
  }
  if (isListOfPieces(original))
  {
    return { writePieces(grid, original, path), -1 };
  }
  vtkNew<vtkSolverFileWriter> writer;
  writer->SetInputData(grid);
  writer->SetOriginalFileName(original.c_str());
  writer->SetFileName(path.c_str());
  writer->HandleSignalsOn();
  Messages messages(writer);
  writer->Write();
  if (!messages.errors().empty())
  {
    throw Failure(messages.errors().front()); // it names the file
  }
  return { writer->GetLargestRounding(), writer->GetChangedCoordinates() };
}

void writeBoundary(vtkPointSet* boundary, const std::string& path)
{
  requireBoundaryFormat(path);
  extensionOf(path) == ".vtk" ? writeLegacy(boundary, path)
                              : writeXml<vtkXMLPolyDataWriter>(boundary, path);
}
}
