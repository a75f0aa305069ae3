// SPDX-License-Identifier: BSD-3-Clause
#include "OnRanks.h"

#include "Arguments.h"
#include "Files.h"
#include "Messages.h"
#include "Pieces.h"
#include "ProgressBar.h"
#include "Report.h"

#include "Distributed/Ranks.h"
#include "Support/Error.h"

#include <vtkDoubleArray.h>
#include <vtkMPIController.h>
#include <vtkMorphAlgorithm.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkScaledJacobian.h>
#include <vtkUnstructuredGrid.h>

#include <iostream>
#include <string>
#include <utility>

namespace morph_mesh
{
namespace
{
using morph::distributed::Ranks;

constexpr const char* Displacement = "MorphMeshDisplacement";

/// MPI and VTK's controller while the program runs.
class Controller
{
public:
  Controller()
  {
    MPI_Init(nullptr, nullptr);
    this->controller_->Initialize(nullptr, nullptr, 1);
    vtkMultiProcessController::SetGlobalController(this->controller_);
  }
  ~Controller()
  {
    vtkMultiProcessController::SetGlobalController(nullptr);
    this->controller_->Finalize(1);
    MPI_Finalize();
  }
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

private:
  vtkNew<vtkMPIController> controller_;
};

/// As Ranks::together(), for this program's errors.
template <typename Work>
void together(const Ranks& ranks, const Work& work)
{
  ranks.together(
    [&]
    {
      try
      {
        work();
      }
      catch (const Failure& failure)
      {
        throw morph::Error(failure.what());
      }
    });
}

void requireFiles(const Arguments& arguments)
{
  const auto needsOne = [](const std::string& what)
  {
    throw UsageError(what + " needs one MPI rank, and mpiexec has started " +
                     std::to_string(numberOfRanks()) + ".");
  };
  if (arguments.task != Arguments::Task::Morph)
  {
    needsOne("This task of morph-mesh");
  }
  if (arguments.boundary.empty())
  {
    needsOne("A motion by morph-mesh's options");
  }
  if (extensionOf(arguments.grid) != ".pvtu" || extensionOf(arguments.output) != ".pvtu")
  {
    throw UsageError("On several MPI ranks morph-mesh reads a .pvtu and writes a .pvtu: each rank "
                     "takes some of its pieces. " +
                     arguments.grid + " or " + arguments.output + " is none.");
  }
}

/// The boundary, on the first rank. Its points carry their undeformed places where they have them:
/// the ids of a file are numbers in the whole mesh, which no rank has.
vtkSmartPointer<vtkPointSet> boundaryOf(const Arguments& arguments, vtkMorphAlgorithm* filter)
{
  vtkSmartPointer<vtkPointSet> points = readPoints(arguments.boundary);
  vtkDataArray* rest = points->GetPointData()->GetArray("RestPosition");
  if (arguments.properties.has("BoundaryIdArray") ||
      arguments.properties.has("DisplacementArray") || !rest || rest->GetNumberOfComponents() < 3)
  {
    return points;
  }
  vtkNew<vtkDoubleArray> displacement;
  displacement->SetName(Displacement);
  displacement->SetNumberOfComponents(3);
  displacement->SetNumberOfTuples(points->GetNumberOfPoints());
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  places->SetNumberOfPoints(points->GetNumberOfPoints());
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    double x[3];
    points->GetPoint(i, x);
    for (int j = 0; j < 3; ++j)
    {
      displacement->SetComponent(i, j, x[j] - rest->GetComponent(i, j));
      x[j] = rest->GetComponent(i, j);
    }
    places->SetPoint(i, x);
  }
  vtkNew<vtkPolyData> result;
  result->SetPoints(places);
  result->GetPointData()->AddArray(displacement);
  if (vtkDataArray* free = points->GetPointData()->GetArray("MorphFree"))
  {
    result->GetPointData()->AddArray(free);
  }
  filter->SetDisplacementArray(Displacement);
  return result.Get();
}

int morphPart(const Ranks& ranks, vtkMorphAlgorithm* filter, vtkUnstructuredGrid* grid,
  const Arguments& arguments, const Part& part)
{
  const bool isFirst = ranks.rank() == 0;
  Messages messages(filter);
  {
    const ProgressBar bar(
      filter, arguments.method(), isFirst && arguments.progress && !arguments.quiet);
    filter->Update();
  }
  for (const std::string& warning : messages.warnings())
  {
    std::cerr << "morph-mesh: warning: " << warning << "\n";
  }
  const bool isPartial = std::string(filter->GetMorphStatus()) == "Partial" ||
                         std::string(filter->GetMorphStatus()) == "Inverted";
  together(ranks,
    [&]
    {
      if (!messages.errors().empty() && !isPartial)
      {
        throw Failure("Cannot morph " + arguments.grid + ": " + messages.errors().front());
      }
    });
  for (const std::string& error : messages.errors())
  {
    std::cerr << "morph-mesh: " << error << "\n";
  }
  const morph::Index errors = ranks.sum(static_cast<morph::Index>(messages.errors().size()));
  auto* morphed = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  together(ranks, [&] { writePieces(morphed, arguments.grid, arguments.output, part); });
  together(ranks,
    [&]
    {
      if (isFirst)
      {
        writeListOfPieces(arguments.grid, arguments.output);
      }
    });
  vtkNew<vtkScaledJacobian> before;
  before->SetInputData(grid);
  before->SetNumberOfThreads(arguments.threads);
  before->Update();
  const Outcome outcome = outcomeOf(filter);
  if (isFirst && !arguments.quiet)
  {
    printReport(before, outcome, nullptr, arguments.output);
  }
  return errors > 0 || (arguments.wantsValid() && !outcome.isValid()) ? 3 : 0;
}
}

int morphOnRanks(vtkMorphAlgorithm* filter, const Arguments& arguments)
{
  requireFiles(arguments); // all ranks have the same arguments
  if (arguments.steps > 0 || !arguments.criteria.empty() || !arguments.report.empty())
  {
    throw UsageError(std::string(arguments.steps > 0           ? "--steps"
                                 : !arguments.criteria.empty() ? "--criteria"
                                                               : "--report") +
                     " needs one MPI rank, and mpiexec has started " +
                     std::to_string(numberOfRanks()) + ".");
  }
  const Controller controller;
  const Ranks ranks(MPI_COMM_WORLD);
  const Part part{ ranks.rank(), ranks.count() };
  try
  {
    vtkSmartPointer<vtkUnstructuredGrid> grid;
    vtkSmartPointer<vtkPointSet> boundary = vtkSmartPointer<vtkPolyData>::New();
    together(ranks,
      [&]
      {
        requireWritablePieces(arguments.grid, arguments.output);
        grid = mergedPieces(arguments.grid, part);
        // Points of several pieces are one where they are equal, as on one rank.
        grid->GetPointData()->SetActiveAttribute(nullptr, vtkDataSetAttributes::GLOBALIDS);
        if (part.rank == 0)
        {
          boundary = boundaryOf(arguments, filter);
        }
      });
    filter->SetDisplacementArray(
      ranks.sum(morph::Index(part.rank == 0 && filter->GetDisplacementArray() &&
                             filter->GetDisplacementArray() == std::string(Displacement))) > 0
        ? Displacement
        : arguments.properties.text("DisplacementArray").c_str());
    filter->SetInputData(grid);
    filter->SetBoundaryData(boundary);
    return morphPart(ranks, filter, grid, arguments, part);
  }
  catch (const morph::Error& error)
  {
    if (ranks.rank() == 0)
    {
      std::cerr << "morph-mesh: " << error.what() << "\n";
    }
    return 1;
  }
}
}
