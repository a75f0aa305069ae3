// SPDX-License-Identifier: BSD-3-Clause
// morph-mesh: the morphing filters on the command line.
#include "Arguments.h"
#include "Boundaries.h"
#include "Designs.h"
#include "Files.h"
#include "Messages.h"
#include "OnRanks.h"
#include "ProgressBar.h"
#include "Report.h"

#include <vtkCellData.h>
#include <vtkDataArraySelection.h>
#include <vtkDisplacementAlgorithm.h>
#include <vtkExtractMorphBoundary.h>
#include <vtkMorphAlgorithm.h>
#include <vtkMorphMesh.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVersion.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace
{
using namespace morph_mesh;

void printWarnings(const Messages& messages)
{
  for (const std::string& warning : messages.warnings())
  {
    std::cerr << "morph-mesh: warning: " << warning << "\n";
  }
}

int extractBoundary(const Arguments& arguments)
{
  requireBoundaryFormat(arguments.output);
  vtkNew<vtkExtractMorphBoundary> boundary;
  boundary->SetInputData(readGrid(arguments.grid));
  boundary->SetNumberOfThreads(arguments.threads);
  Messages messages(boundary);
  messages.update("Cannot extract the boundary of " + arguments.grid);
  writeBoundary(boundary->GetOutput(), arguments.output);
  if (!arguments.quiet)
  {
    std::cout << boundary->GetOutput()->GetNumberOfPoints() << " points, "
              << boundary->GetOutput()->GetNumberOfCells() << " faces\n";
  }
  return 0;
}

/// What morphs: Morph Mesh and its method, or, with a boundary, the method alone.
struct Morphing
{
  vtkNew<vtkMorphMesh> mesh;
  vtkSmartPointer<vtkMorphAlgorithm> method;
  vtkAlgorithm* filter = nullptr; ///< the one to execute
};

void configure(Morphing& morphing, const Arguments& arguments)
{
  const GivenProperties& given = arguments.properties;
  morphing.mesh->SetMethod(static_cast<int>(given.number("Method", 0)));
  morphing.method = morphing.mesh->GetMethodFilter();
  const bool isMade = arguments.boundary.empty() && arguments.displacements.empty();
  morphing.filter = isMade ? static_cast<vtkAlgorithm*>(morphing.mesh) : morphing.method;
  if (isMade)
  {
    if (arguments.task == Arguments::Task::Repair)
    {
      setRepair(morphing.mesh);
    }
    morphing.mesh->SetNumberOfThreads(arguments.threads);
    given.apply({ morphing.mesh, morphing.method }, "with " + arguments.method());
    return;
  }
  morphing.method->SetValidity(vtkMorphAlgorithm::VALIDITY_REPAIR); // as Morph Mesh has it
  morphing.method->SetNumberOfThreads(arguments.threads);
  given.apply({ morphing.method }, "with " + arguments.method() + " and a given boundary");
}

/// The names of surfaces and zones as the grid, the input of the filter, has them.
void spellNames(Morphing& morphing, GivenProperties& given, const Arguments& arguments)
{
  morphing.mesh->UpdateInformation();
  std::vector<std::string> listed;
  for (vtkDataArraySelection* list :
    { morphing.mesh->GetSurfaceList(), morphing.mesh->GetZoneList() })
  {
    for (int i = 0; i < list->GetNumberOfArrays(); ++i)
    {
      listed.emplace_back(list->GetArrayName(i));
    }
  }
  if (given.spell(listed))
  {
    morphing.mesh->RemoveAllSurfaces();
    morphing.mesh->RemoveAllFixedSurfaces();
    morphing.mesh->RemoveAllSlidingSurfaces();
    morphing.mesh->RemoveAllFreeSurfaces();
    morphing.mesh->RemoveAllContactSurfaces();
    morphing.mesh->RemoveAllFixedZones();
    morphing.mesh->RemoveAllRigidZones();
    morphing.mesh->RemoveAllSoftZones();
    given.apply({ morphing.mesh, morphing.method }, "with " + arguments.method());
  }
}

/// Connects what says where the boundary goes.
void setBoundary(Morphing& morphing, vtkUnstructuredGrid* grid, const Arguments& arguments)
{
  const GivenProperties& given = arguments.properties;
  if (!arguments.boundary.empty())
  {
    morphing.method->SetBoundaryData(given.has("BoundaryIdArray")
                                       ? readPoints(arguments.boundary)
                                       : readBoundary(grid, arguments.boundary,
                                           given.has("DisplacementArray"), arguments.timeStep));
  }
  else if (!arguments.displacements.empty())
  {
    morphing.method->SetBoundaryConnection(
      readDisplacements(grid, arguments.displacements, arguments.nodeNumbers)->GetOutputPort());
    morphing.method->SetDisplacementArray(DisplacementName);
  }
  else
  {
    readMotion(morphing.mesh, arguments);
  }
}

/// Prints the quality of a grid.
int check(const Arguments& arguments)
{
  const vtkSmartPointer<vtkScaledJacobian> measured = measure(readGrid(arguments.grid), arguments);
  if (!arguments.quiet)
  {
    printQuality(measured);
  }
  const bool isValid = measured->GetInvertedCells() + measured->GetDegenerateCells() == 0;
  return arguments.requireValid && !isValid ? 3 : 0;
}

/// "out.vtu" and 3: "out-3.vtu".
std::string numbered(const std::string& path, int step)
{
  const std::size_t dot = path.find_last_of('.');
  return path.substr(0, dot) + "-" + std::to_string(step) + path.substr(dot);
}

/// The grid with the points of the morphed one: its arrays stay as they were, but for the normals,
/// which would be wrong.
vtkSmartPointer<vtkUnstructuredGrid> withPoints(
  vtkUnstructuredGrid* grid, vtkUnstructuredGrid* morphed)
{
  auto result = vtkSmartPointer<vtkUnstructuredGrid>::New();
  result->ShallowCopy(grid);
  result->SetPoints(morphed->GetPoints());
  result->GetPointData()->SetNormals(nullptr);
  result->GetCellData()->SetNormals(nullptr);
  return result;
}

/// 12,345
std::string grouped(long long number)
{
  std::string digits = std::to_string(number);
  for (std::size_t at = digits.size(); at > 3; at -= 3)
  {
    digits.insert(at - 3, ",");
  }
  return digits;
}

/// Throws UsageError where what is written would take the place of another file of the same run.
/// A mesh may replace the one that it is made from.
void requireOwnFiles(const Arguments& arguments)
{
  namespace fs = std::filesystem;
  const auto areSame = [](const std::string& a, const std::string& b)
  {
    std::error_code none; // files that do not exist are the same if their paths are
    return !a.empty() && !b.empty() &&
           (fs::equivalent(a, b, none) ||
             fs::weakly_canonical(a, none) == fs::weakly_canonical(b, none));
  };
  const auto require = [&](const std::string& written, const char* what)
  {
    const bool isReport = written == arguments.report;
    const bool isMesh = !isReport && arguments.task != Arguments::Task::ExtractBoundary;
    const std::pair<const char*, const std::string&> others[] = { { isMesh ? "" : "the grid",
                                                                    arguments.grid },
      { isReport ? "the output" : "", arguments.output }, { "the boundary", arguments.boundary },
      { "--target", arguments.target }, { "--handles", arguments.handles },
      { "--lattice", arguments.lattice }, { "--field", arguments.field },
      { "--displacements", arguments.displacements } };
    for (const auto& [name, file] : others)
    {
      if (*name != '\0' && areSame(written, file))
      {
        throw UsageError(std::string(what) + " would replace " + name + ", " + file +
                         ". Give it a file of its own.");
      }
    }
  };
  require(arguments.report, "--report");
  require(arguments.output, "The output");
}

/// Removes that of another run, which would be taken for this one's. Throws Failure where none can
/// be written.
void makeRoomFor(const std::string& report)
{
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(report).parent_path();
  if (fs::is_directory(report) || !(folder.empty() || fs::is_directory(folder)))
  {
    throw Failure("Cannot write the report " + report + ".");
  }
  if (fs::is_regular_file(report))
  {
    fs::remove(report);
  }
}

/// Morphs by a part of the motion, and writes and reports the mesh. `report`: of Arguments.
int morphPart(Morphing& morphing, vtkUnstructuredGrid* grid, const Arguments& arguments,
  const std::string& output, const std::string& report)
{
  const bool reports = !arguments.quiet || !arguments.report.empty();
  const vtkSmartPointer<vtkScaledJacobian> before = reports ? measure(grid, arguments) : nullptr;
  if (!report.empty())
  {
    makeRoomFor(report);
  }
  Messages messages(morphing.filter);
  std::string partial;
  {
    const ProgressBar bar(
      morphing.filter, arguments.method(), arguments.progress && !arguments.quiet);
    partial = messages.updatePartly("Cannot morph " + arguments.grid);
  }
  printWarnings(messages);
  if (!partial.empty())
  {
    std::cerr << "morph-mesh: " << partial << "\n";
  }
  auto* morphed = vtkUnstructuredGrid::SafeDownCast(morphing.filter->GetOutputDataObject(0));
  const bool isMade = morphing.filter == morphing.mesh;
  if (isMade && morphing.mesh->GetAdvice() != std::string("None"))
  {
    throw Failure(morphing.mesh->GetAdvice());
  }
  if (!arguments.target.empty() && !arguments.quiet)
  {
    printTargetDistances(morphed);
  }
  if (arguments.properties.has("SlideRounds") && !arguments.quiet)
  {
    std::cout << "sliding: " << morphing.mesh->GetSlideReport() << "\n";
  }
  const Written written = writeMorphed(
    arguments.results ? morphed : withPoints(grid, morphed).Get(), arguments.grid, output);
  const Outcome outcome = outcomeOf(morphing.filter);
  const vtkSmartPointer<vtkScaledJacobian> after =
    reports && !arguments.criteria.empty() ? measure(morphed, arguments) : nullptr;
  if (!arguments.report.empty())
  {
    std::vector<std::string> seen = messages.warnings();
    seen.insert(seen.end(), messages.errors().begin(), messages.errors().end());
    writeReport(before, outcome, after, seen, output, report);
  }
  if (!arguments.quiet)
  {
    printReport(before, outcome, after, output);
    if (written.rounding > 0)
    {
      std::cout << "largest rounding of a coordinate: " << std::scientific << written.rounding
                << "\n";
    }
    if (written.changed >= 0)
    {
      std::cout << grouped(written.changed) << " coordinates of " << output
                << " changed, all else kept\n";
    }
  }
  return !partial.empty() || (arguments.wantsValid() && !outcome.isValid()) ? 3 : 0;
}

int morphMesh(const Arguments& arguments)
{
  Morphing morphing;
  configure(morphing, arguments);
  requireMorphedFormat(arguments.grid, arguments.output);
  if (arguments.steps > 0 && !std::filesystem::path(arguments.output).has_extension())
  {
    throw UsageError("--steps needs an output with an extension, before which it puts the number.");
  }
  const bool hasOwn = arguments.boundary.empty() && arguments.field.empty(); // displacements
  const vtkSmartPointer<vtkUnstructuredGrid> grid =
    readGrid(arguments.grid, hasOwn ? arguments.timeStep : -1);
  morphing.filter->SetInputDataObject(0, grid);
  if (morphing.filter == morphing.mesh)
  {
    GivenProperties given = arguments.properties;
    spellNames(morphing, given, arguments);
  }
  setBoundary(morphing, grid, arguments);
  if (arguments.steps == 0)
  {
    return morphPart(morphing, grid, arguments, arguments.output, arguments.report);
  }
  int status = 0;
  for (int step = 1; step <= arguments.steps; ++step)
  {
    const double factor = arguments.properties.number("ScaleFactor", 1) * step / arguments.steps;
    morphing.mesh->SetScaleFactor(factor);
    if (morphing.filter == morphing.method)
    {
      morphing.method->SetScaleFactor(factor);
    }
    status = std::max(status, morphPart(morphing, grid, arguments, numbered(arguments.output, step),
                                arguments.report.empty() ? "" : numbered(arguments.report, step)));
  }
  return status;
}

int run(int argc, char* argv[])
{
  Arguments arguments = parseArguments(argc, argv);
  requireOwnFiles(arguments);
  if (!arguments.region.empty())
  {
    arguments.grid = regionOf(arguments.grid, arguments.region);
  }
  if (numberOfRanks() > 1 && arguments.task != Arguments::Task::ShowHelp &&
      arguments.task != Arguments::Task::ShowVersion)
  {
    // Each would do the whole work, and write the same files.
    Morphing morphing;
    configure(morphing, arguments);
    return morphOnRanks(morphing.method, arguments);
  }
  switch (arguments.task)
  {
    case Arguments::Task::ShowHelp:
      std::cout << arguments.help;
      return 0;
    case Arguments::Task::ShowVersion:
      std::cout << "morph-mesh " << MESHMORPHING_VERSION << ", VTK " << vtkVersion::GetVTKVersion()
                << "\n";
      return 0;
    case Arguments::Task::ExtractBoundary:
      return extractBoundary(arguments);
    case Arguments::Task::WriteDesigns:
      return writeDesigns(arguments);
    case Arguments::Task::ListSurfaces:
      printSurfaces(readGrid(arguments.grid), arguments.grid, arguments.threads);
      return 0;
    case Arguments::Task::Check:
      return check(arguments);
    case Arguments::Task::Repair:
    case Arguments::Task::Morph:
      break;
  }
  return morphMesh(arguments);
}

/// Ends the program after an error. Libraries are not unloaded: with a damaged file that could not
/// be closed, HDF5 would print errors of its own.
int fail(int status)
{
  std::cout.flush();
  std::cerr.flush();
  std::_Exit(status);
}
}

int main(int argc, char* argv[])
{
  installConsole();
  try
  {
    const int status = run(argc, argv);
    if (!std::cout.flush())
    {
      throw Failure("Cannot write to the standard output.");
    }
    return status;
  }
  catch (const UsageError& error)
  {
    std::cerr << "morph-mesh: " << error.what() << "\nTry " << helpCommand(argc, argv) << ".\n";
    return fail(2);
  }
  catch (const std::exception& error)
  {
    std::cerr << "morph-mesh: " << error.what() << "\n";
    return fail(1);
  }
}
