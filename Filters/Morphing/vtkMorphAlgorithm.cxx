// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphAlgorithm.h"

#include "Morpher/Morpher.h"
#include "Private/Data/Output.h"
#include "Private/Data/Results.h"
#include "Private/Data/Version.h"
#include "Private/Distributed/OnRanks.h"
#include "Private/Morph/MorphOutput.h"
#include "Private/Morph/Session.h"
#include "Private/Morph/Validity.h"
#include "Private/Options.h"
#include "Private/Pipeline/CrewMonitor.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Ports.h"
#include "Private/Pipeline/Ranks.h"
#include "Private/Pipeline/Steps.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"

#include <vtkAlgorithmOutput.h>
#include <vtkDataObject.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkDoubleArray.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationIntegerKey.h>
#include <vtkInformationVector.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

namespace filters = morph::filters;

/// What an execution leaves for the next one, and what it does.
class vtkMorphAlgorithm::vtkInternals
{
public:
  filters::Results Results{ filters::ResultTables::vtkMorphAlgorithm() };
  filters::Session Session{ Results };
  /// null until the mesh is on several MPI processes
  std::unique_ptr<filters::OnRanks::Morphing> Distributed;
  bool IsOnRanks = false; ///< the last execution was that of Distributed
  filters::Ports Ports;
  filters::Steps Steps;
  int Step = -1;                     ///< asked for, of Steps
  int BoundaryStep = -1;             ///< that the boundary is asked for
  morph::Index BoundaryInverted = 0; ///< cells for which the last execution has no result

  explicit vtkInternals(vtkMorphAlgorithm* filter)
    : Ports(filter)
    , Filter(filter)
  {
  }

  bool IsSeries() const
  {
    return this->Filter->Options->Stepping == STEPPING_RELATIVE && this->Steps.Any();
  }
  /// Whether all cells are measured. What a valid mesh needs comes before Quality.
  bool MeasuresAll() const
  {
    return this->Filter->Options->Quality == QUALITY_ALL ||
           this->Filter->Options->Validity >= VALIDITY_SUB_STEP;
  }
  filters::MorphOutput::Measures Measures() const
  {
    return { this->MeasuresAll(), this->Filter->Options->Certify,
      this->Filter->Options->Validity != VALIDITY_NONE };
  }
  filters::Session::Options Options(vtkUnstructuredGrid* grid, vtkDataObject* boundary) const;
  /// Returns an error that comes with a result, or nothing.
  std::string Morph(vtkUnstructuredGrid* grid, vtkDataObject* boundary, vtkUnstructuredGrid* output,
    vtkUnstructuredGrid* badCells, vtkPolyData* surface, morph::Monitor& monitor);
  /// Morph() where the mesh has pieces on several MPI processes.
  std::string MorphOnRanks(vtkUnstructuredGrid* grid, vtkDataObject* boundary,
    vtkUnstructuredGrid* output, vtkUnstructuredGrid* badCells, vtkPolyData* surface,
    morph::Monitor& monitor);
  filters::OnRanks::Morphing& OnRanks();
  /// Makes `output` the undeformed mesh, where that can be read, without a result.
  void WriteUndeformed(
    vtkDataObject* input, const char* status, vtkUnstructuredGrid* output, vtkPolyData* surface);

private:
  vtkMorphAlgorithm* Filter;

  /// The steps of a motion. `boundary`: returns that of a step.
  filters::Session::Motion Motion(std::function<vtkPointSet*(int step)> boundary) const;
  std::shared_ptr<const filters::StepResult> MorphSeries(
    vtkPointSet* displaced, const filters::Session::Options& options, morph::Monitor& monitor);
};

vtkMorphAlgorithm::vtkMorphAlgorithm()
  : Internals(new vtkInternals(this))
  , Options(std::make_unique<morph::MorphOptions>())
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(3);
  this->Internals->Results.Reset();
}

vtkMorphAlgorithm::~vtkMorphAlgorithm() = default;

void vtkMorphAlgorithm::SetBoundaryConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkMorphAlgorithm::SetBoundaryData(vtkDataObject* boundary)
{
  this->SetInputDataObject(1, boundary);
}

vtkTypeBool vtkMorphAlgorithm::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  return filters::Ports::MakeOutput(request, inputVector, outputVector) ||
         this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

int vtkMorphAlgorithm::FillInputPortInformation(int port, vtkInformation* info)
{
  return filters::Ports::FillInformation(port, info);
}

int vtkMorphAlgorithm::FillOutputPortInformation(int port, vtkInformation* info)
{
  return filters::Ports::FillOutputInformation(port, info);
}

int vtkMorphAlgorithm::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const int done = filters::Ports::RequestInformation(inputVector, outputVector);
  const filters::Steps steps(this->Options->NumberOfSteps, inputVector[1]->GetInformationObject(0));
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    steps.Write(outputVector->GetInformationObject(port));
  }
  return done;
}

int vtkMorphAlgorithm::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInternals& kept = *this->Internals;
  vtkInformation* boundary = inputVector[1]->GetInformationObject(0);
  vtkInformation* asked = filters::Ports::Asked(request, outputVector);
  std::optional<double> time = filters::Ports::AskedTime(asked);
  kept.Steps = filters::Steps(this->Options->NumberOfSteps, boundary);
  kept.Step = kept.Steps.Asked(asked);
  kept.BoundaryStep = kept.Step;
  if (kept.IsSeries())
  {
    auto* upstream =
      boundary ? vtkDemandDrivenPipeline::SafeDownCast(this->GetInputExecutive(1, 0)) : nullptr;
    kept.Session.CheckSeries(
      this->GetMTime(), kept.Steps.FromBoundary(), upstream ? upstream->GetPipelineMTime() : 0);
    if (kept.Distributed)
    {
      kept.Distributed->CheckSeries(
        this->GetMTime(), kept.Steps.FromBoundary(), upstream ? upstream->GetPipelineMTime() : 0);
    }
    const int last = kept.Session.LastStepUntil(kept.Step);
    kept.BoundaryStep = std::min(kept.Step, last + 1);
    time = kept.Steps.Time(kept.BoundaryStep);
  }
  else if (kept.Steps.FromBoundary() &&
           boundary->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS()) == 0)
  {
    time = kept.Steps.Time(kept.BoundaryStep); // of the parts of its range
  }
  if (kept.Steps.Any() && !kept.Steps.FromBoundary())
  {
    time.reset(); // it is not the boundary's
  }
  return kept.Ports.RequestUpdateExtent(this->Options->RestTime, time, inputVector);
}

int vtkMorphAlgorithm::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInternals& kept = *this->Internals;
  vtkUnstructuredGrid* output = kept.Ports.Output(outputVector);
  vtkUnstructuredGrid* badCells = vtkUnstructuredGrid::GetData(outputVector, 1);
  vtkPolyData* surface = vtkPolyData::GetData(outputVector, 2);
  std::string partial;
  const auto noteInfeasible = [&](const auto& morph)
  {
    try
    {
      morph();
    }
    catch (const filters::Validity::Infeasible& infeasible)
    {
      kept.BoundaryInverted = infeasible.Cells;
      throw;
    }
  };
  const filters::Ports::Task task = { "morph this mesh", this->Options->NumberOfThreads,
    this->Options->CoincidentPoints, [&] { kept.Results.Reset(); },
    [&](vtkUnstructuredGrid* grid, vtkDataObject* boundary, filters::Monitor& monitor)
    {
      noteInfeasible(
        [&] { partial = kept.Morph(grid, boundary, output, badCells, surface, monitor); });
    },
    [&](vtkDataObject* input, const char* status)
    { kept.WriteUndeformed(input, status, output, surface); },
    [&](vtkUnstructuredGrid* grid, vtkDataObject* boundary, filters::Monitor& monitor)
    {
      noteInfeasible(
        [&] { partial = kept.MorphOnRanks(grid, boundary, output, badCells, surface, monitor); });
    } };
  kept.BoundaryInverted = 0;
  const int done = kept.Ports.RequestData(task, inputVector, outputVector);
  if (kept.Steps.Any() && !kept.Steps.FromBoundary())
  {
    for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
    {
      vtkDataObject* data = vtkDataObject::GetData(outputVector, port);
      data->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), kept.Steps.Time(kept.Step));
    }
  }
  if (!partial.empty())
  {
    vtkErrorMacro(<< partial);
  }
  return done;
}

void vtkMorphAlgorithm::vtkInternals::WriteUndeformed(
  vtkDataObject* input, const char* status, vtkUnstructuredGrid* output, vtkPolyData* surface)
{
  // Who stops a drag midway, or makes a mistake, wants to see the mesh it began with.
  if (filters::Version::AbortRequested(this->Filter))
  {
    filters::Version::KeepAbortedOutput(this->Filter);
  }
  filters::MorphOutput::WriteUndeformed(
    input, status, this->BoundaryInverted, this->Results, output);
  if (this->IsOnRanks)
  {
    this->Distributed->WriteUndeformedSurface(output, surface);
    return;
  }
  this->Session.GetKept().WriteUndeformedSurface(output, surface);
}

filters::Session::Options vtkMorphAlgorithm::vtkInternals::Options(
  vtkUnstructuredGrid* grid, vtkDataObject* boundary) const
{
  vtkMorphAlgorithm* filter = this->Filter;
  filter->TakeInputs(grid, boundary);
  filters::Session::Options options;
  options.Method = filter->GetClassName();
  options.Matching.BoundaryIdArray = filters::Input::ArrayName(filter->Options->BoundaryIdArray);
  options.Matching.DisplacementArray =
    filters::Input::ArrayName(filter->Options->DisplacementArray);
  options.Matching.ScaleFactor = filter->Options->ScaleFactor;
  options.Matching.MatchTolerance = filter->Options->MatchTolerance;
  options.Matching.FixUnnamedBoundary = filter->Options->FixUnnamedBoundary;
  options.Validity = filter->Options->Validity;
  options.MeasureAll = this->MeasuresAll();
  options.MaximumSubSteps = filter->Options->MaximumSubSteps;
  options.PostSmooth = filter->Options->PostSmooth;
  options.PostSmoothIterations = filter->Options->PostSmoothIterations;
  options.StepMemoryLimit = filter->Options->StepMemoryLimit;
  options.IsFloat = filters::Output::IsFloat(grid, filter->Options->OutputPointsPrecision);
  options.CreateMorpher = [filter] { return filter->CreateMorpher(); };
  return options;
}

std::string vtkMorphAlgorithm::vtkInternals::Morph(vtkUnstructuredGrid* grid,
  vtkDataObject* boundary, vtkUnstructuredGrid* output, vtkUnstructuredGrid* badCells,
  vtkPolyData* surface, morph::Monitor& monitor)
{
  this->IsOnRanks = false;
  vtkPointSet* displaced = filters::Input::RequireBoundary(boundary);
  this->Session.SetGrid(grid, monitor);
  this->Session.SetFeatureLines(this->Filter->Options->FeatureLines);
  const double fraction = this->Steps.Any() ? this->Steps.Fraction(this->Step) : 1;
  const filters::Session::Options options = this->Options(grid, displaced);
  this->Session.ReportMesh(options, monitor);
  std::shared_ptr<filters::StepResult> single; // a series keeps its steps
  std::shared_ptr<const filters::StepResult> result;
  if (this->IsSeries())
  {
    result = this->MorphSeries(displaced, options, monitor);
  }
  else
  {
    result = single = this->Session.Morph(displaced, fraction, options, monitor);
  }
  // Of a step that was kept, too; inverted cells on the way there are no news.
  if (!result->Valid.Warning.empty())
  {
    monitor.warn(result->Valid.Warning);
  }
  morph::ProgressRange writing(monitor, 0.9, 1);
  filters::MorphOutput::WriteMesh(this->Session, result->Moved,
    this->Filter->Options->OutputPointsPrecision, grid, output, writing);
  if (single)
  {
    single->Moved.resize(0, 3); // 24 bytes a node, which the measures need
  }
  filters::MorphOutput::WriteMeasures(this->Session, *result, this->Measures(), displaced,
    this->Results, output, badCells, surface, writing);
  return result->Valid.Error;
}

filters::OnRanks::Morphing& vtkMorphAlgorithm::vtkInternals::OnRanks()
{
  this->IsOnRanks = true;
  if (!this->Distributed)
  {
    this->Distributed = std::make_unique<filters::OnRanks::Morphing>(this->Results);
  }
  return *this->Distributed;
}

std::string vtkMorphAlgorithm::vtkInternals::MorphOnRanks(vtkUnstructuredGrid* grid,
  vtkDataObject* boundary, vtkUnstructuredGrid* output, vtkUnstructuredGrid* badCells,
  vtkPolyData* surface, morph::Monitor& monitor)
{
  filters::Session::Options options;
  filters::Ranks::Together([&] { options = this->Options(grid, boundary); });
  const double fraction = this->Steps.Any() ? this->Steps.Fraction(this->Step) : 1;
  // All processes ask for the same steps, whatever time the boundary has here.
  const filters::Session::Motion motion = this->Motion(
    [&](int step)
    {
      return filters::Input::RequireBoundary(
        this->Steps.FromBoundary() ? this->Ports.Fetch(1, this->Steps.Time(step)) : boundary);
    });
  return this->OnRanks().Run({ grid, boundary, fraction, this->IsSeries() ? &motion : nullptr,
                               this->Filter->Options->OutputPointsPrecision, this->Measures(),
                               this->Filter->Options->FeatureLines, output, badCells, surface },
    options, monitor);
}

filters::Session::Motion vtkMorphAlgorithm::vtkInternals::Motion(
  std::function<vtkPointSet*(int step)> boundary) const
{
  filters::Session::Motion motion;
  motion.Step = this->Step;
  motion.Varies = this->Steps.FromBoundary();
  motion.Fraction = [this](int step) { return this->Steps.Fraction(step); };
  motion.Boundary = std::move(boundary);
  return motion;
}

std::shared_ptr<const filters::StepResult> vtkMorphAlgorithm::vtkInternals::MorphSeries(
  vtkPointSet* displaced, const filters::Session::Options& options, morph::Monitor& monitor)
{
  // A process without cells has no series, and would not know which step to ask the boundary for.
  if (this->Steps.FromBoundary() && filters::Ranks::Processes() > 1)
  {
    throw morph::Error("Relative steps after a boundary that varies in time need a mesh with cells "
                       "on several MPI processes, or a single process. Distribute the mesh, or set "
                       "Stepping to Absolute.");
  }
  const filters::Session::Motion motion = this->Motion(
    [&](int step)
    {
      if (this->Steps.FromBoundary() && step != this->BoundaryStep)
      {
        displaced = filters::Input::RequireBoundary(this->Ports.Fetch(1, this->Steps.Time(step)));
        this->BoundaryStep = step;
      }
      return displaced;
    });
  return this->Session.MorphSeries(motion, options, monitor);
}

bool vtkMorphAlgorithm::ApplyTranspose(vtkUnstructuredGrid* rest, vtkPointSet* boundary,
  vtkDataArray* gradient, vtkDoubleArray* boundaryGradient)
{
  filters::CrewMonitor monitor(this, this->Options->NumberOfThreads);
  const filters::Execution::Outcome outcome = filters::Execution::Run(
    this, "apply the adjoint",
    [&]
    {
      this->Transpose(filters::Input::RequireGrid(rest, "The mesh"), boundary, gradient,
        boundaryGradient, false, monitor);
    },
    [&] { boundaryGradient->Initialize(); });
  for (const std::string& warning : monitor.TakeWarnings())
  {
    vtkWarningMacro(<< warning);
  }
  return outcome != filters::Execution::Outcome::Failed;
}

void vtkMorphAlgorithm::Transpose(vtkUnstructuredGrid* rest, vtkDataObject* boundary,
  vtkDataArray* gradient, vtkDoubleArray* boundaryGradient, bool onRanks, morph::Monitor& monitor)
{
  vtkInternals& kept = *this->Internals;
  if (this->Options->Stepping == STEPPING_RELATIVE &&
      (this->Options->NumberOfSteps > 0 || kept.Steps.Any()))
  {
    throw morph::Error("Relative steps have no adjoint: each depends on those before it. Set "
                       "Stepping to Absolute.");
  }
  if (onRanks)
  {
    filters::Session::Options options;
    filters::Ranks::Together([&] { options = kept.Options(rest, boundary); });
    kept.OnRanks().Transpose(rest, boundary, gradient, options, boundaryGradient, monitor);
    return;
  }
  kept.Session.Transpose(
    rest, boundary, gradient, kept.Options(rest, boundary), boundaryGradient, monitor);
}

double vtkMorphAlgorithm::GetNumber(const char* name) const
{
  return this->Internals->Results.Number(name);
}

vtkIdType vtkMorphAlgorithm::GetInteger(const char* name) const
{
  return this->Internals->Results.Integer(name);
}

vtkIdType vtkMorphAlgorithm::GetCount(const char* name) const
{
  return this->Internals->Results.Count(name);
}

const char* vtkMorphAlgorithm::GetMorphStatus() const
{
  return this->Internals->Results.Text("MorphStatus").c_str();
}

void vtkMorphAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->PrintOptions(os, indent);
  this->Internals->Results.Print(os, indent);
}
