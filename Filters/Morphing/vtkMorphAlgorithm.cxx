// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphAlgorithm.h"

#include "Morpher/Morpher.h"
#include "Private/Data/Gradient.h"
#include "Private/Data/Output.h"
#include "Private/Data/Results.h"
#include "Private/Data/Version.h"
#include "Private/Distributed/OnRanks.h"
#include "Private/Morph/BoundaryMatch.h"
#include "Private/Morph/KeptMesh.h"
#include "Private/Morph/MorphOutput.h"
#include "Private/Options.h"
#include "Private/Pipeline/CrewMonitor.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Ports.h"
#include "Private/Pipeline/Ranks.h"
#include "Private/Pipeline/Steps.h"
#include "Session/Session.h"
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
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

namespace filters = morph::filters;

/// What an execution leaves for the next one, and what it does.
class vtkMorphAlgorithm::vtkInternals
{
public:
  filters::Results Results{ filters::ResultTables::vtkMorphAlgorithm() };
  filters::KeptMesh Kept;
  morph::Session Session; ///< of Kept
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
  filters::MotionOptions Options(vtkUnstructuredGrid* grid, vtkDataObject* boundary) const;
  /// Returns an error that comes with a result, or nothing.
  std::string Morph(vtkUnstructuredGrid* grid, vtkDataObject* boundary, vtkUnstructuredGrid* output,
    vtkUnstructuredGrid* badCells, vtkPolyData* surface, morph::Monitor& monitor);
  /// Morph() where the mesh has pieces on several MPI processes.
  std::string MorphOnRanks(vtkUnstructuredGrid* grid, vtkDataObject* boundary,
    vtkUnstructuredGrid* output, vtkUnstructuredGrid* badCells, vtkPolyData* surface,
    morph::Monitor& monitor);
  filters::OnRanks::Morphing& OnRanks();
  /// vtkMorphAlgorithm::ApplyTranspose() on one process. Throws morph::Error.
  void Transpose(vtkUnstructuredGrid* rest, vtkDataObject* boundary, vtkDataArray* gradient,
    vtkDoubleArray* boundaryGradient, morph::Monitor& monitor);
  /// Makes `output` the undeformed mesh, where that can be read, without a result.
  void WriteUndeformed(
    vtkDataObject* input, const char* status, vtkUnstructuredGrid* output, vtkPolyData* surface);

private:
  vtkMorphAlgorithm* Filter;

  /// Takes the cost of Session's last motion over.
  void NoteEffort();
  /// Matches the boundary, for that fraction of its motion.
  morph::BoundaryTargets Match(vtkPointSet* boundary, double fraction,
    const filters::MotionOptions& options, morph::Monitor& monitor) const;
  std::shared_ptr<const morph::StepResult> MorphSeries(
    vtkPointSet* displaced, const filters::MotionOptions& options, morph::Monitor& monitor);
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
    kept.Session.steps().check(
      this->GetMTime(), kept.Steps.FromBoundary(), upstream ? upstream->GetPipelineMTime() : 0);
    if (kept.Distributed)
    {
      kept.Distributed->CheckSeries(
        this->GetMTime(), kept.Steps.FromBoundary(), upstream ? upstream->GetPipelineMTime() : 0);
    }
    const int last = kept.Session.steps().lastUntil(kept.Step).first;
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
    catch (const morph::Validity::Infeasible& infeasible)
    {
      kept.BoundaryInverted = infeasible.cells;
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
  this->NoteEffort();
  filters::MorphOutput::WriteUndeformed(
    input, status, this->BoundaryInverted, this->Results, output);
  if (this->IsOnRanks)
  {
    this->Distributed->WriteUndeformedSurface(output, surface);
    return;
  }
  this->Kept.WriteUndeformedSurface(output, surface);
}

filters::MotionOptions vtkMorphAlgorithm::vtkInternals::Options(
  vtkUnstructuredGrid* grid, vtkDataObject* boundary) const
{
  vtkMorphAlgorithm* filter = this->Filter;
  filter->TakeInputs(grid, boundary);
  filters::MotionOptions options;
  options.method = filter->GetClassName();
  options.Matching.BoundaryIdArray = filters::Input::ArrayName(filter->Options->BoundaryIdArray);
  options.Matching.displacementArray =
    filters::Input::ArrayName(filter->Options->DisplacementArray);
  options.Matching.scaleFactor = filter->Options->ScaleFactor;
  options.Matching.matchTolerance = filter->Options->MatchTolerance;
  options.Matching.fixUnnamedBoundary = filter->Options->FixUnnamedBoundary;
  static_assert(int(morph::Validity::Mode::RepairAll) == VALIDITY_REPAIR_ALL, "of one order");
  options.validity = static_cast<morph::Validity::Mode>(filter->Options->Validity);
  options.measureAll = this->MeasuresAll();
  options.maximumSubSteps = filter->Options->MaximumSubSteps;
  options.postSmooth = filter->Options->PostSmooth;
  options.postSmoothIterations = filter->Options->PostSmoothIterations;
  options.stepMemoryLimit = filter->Options->StepMemoryLimit;
  options.createMorpher = [filter] { return filter->CreateMorpher(); };
  return options;
}

std::string vtkMorphAlgorithm::vtkInternals::Morph(vtkUnstructuredGrid* grid,
  vtkDataObject* boundary, vtkUnstructuredGrid* output, vtkUnstructuredGrid* badCells,
  vtkPolyData* surface, morph::Monitor& monitor)
{
  this->IsOnRanks = false;
  vtkPointSet* displaced = filters::Input::RequireBoundary(boundary);
  this->Kept.Take(grid, monitor);
  this->Session.setMesh(this->Kept.Rest());
  this->Kept.SetFeatureLines(this->Filter->Options->FeatureLines);
  const double fraction = this->Steps.Any() ? this->Steps.Fraction(this->Step) : 1;
  const filters::MotionOptions options = this->Options(grid, displaced);
  this->Results.SetInteger(
    "MirroredBodies", static_cast<vtkIdType>(this->Session.mesh().mirroredBodies()));
  this->Session.reportMesh(options, monitor);
  std::shared_ptr<morph::StepResult> single; // a series keeps its steps
  std::shared_ptr<const morph::StepResult> result;
  morph::ProgressRange morphing(monitor, 0, 0.9), writing(monitor, 0.9, 1);
  if (this->IsSeries())
  {
    result = this->MorphSeries(displaced, options, morphing);
  }
  else
  {
    const morph::BoundaryTargets match = this->Match(displaced, fraction, options, morphing);
    std::optional<morph::Session::AffineHandle> handle;
    if (options.Matching.displacementArray.empty())
    {
      handle = filters::BoundaryMatch::FindHandle(displaced, match, this->Session.mesh().mesh(),
        options.Matching.scaleFactor * fraction,
        filters::Output::IsFloat(grid, this->Filter->Options->OutputPointsPrecision));
    }
    result = single = this->Session.morph(match, options, morphing, handle ? &*handle : nullptr);
  }
  this->NoteEffort();
  // Of a step that was kept, too; inverted cells on the way there are no news.
  if (!result->valid.warning.empty())
  {
    monitor.warn(result->valid.warning);
  }
  filters::MorphOutput::WriteMesh(
    this->Kept, result->moved, this->Filter->Options->OutputPointsPrecision, grid, output, writing);
  if (single)
  {
    single->moved.resize(0, 3); // 24 bytes a node, which the measures need
  }
  filters::MorphOutput::WriteMeasures(this->Kept, *result, this->Measures(), displaced,
    this->Results, output, badCells, surface, writing);
  return result->valid.error;
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
  filters::MotionOptions options;
  filters::Ranks::Together([&] { options = this->Options(grid, boundary); });
  const double fraction = this->Steps.Any() ? this->Steps.Fraction(this->Step) : 1;
  // All processes ask for the same steps, whatever time the boundary has here.
  const filters::OnRanks::Motion motion = { this->Step, this->Steps.FromBoundary(),
    [this](int step) { return this->Steps.Fraction(step); },
    [&](int step)
    {
      return filters::Input::RequireBoundary(
        this->Steps.FromBoundary() ? this->Ports.Fetch(1, this->Steps.Time(step)) : boundary);
    } };
  return this->OnRanks().Run({ grid, boundary, fraction, this->IsSeries() ? &motion : nullptr,
                               this->Filter->Options->OutputPointsPrecision, this->Measures(),
                               this->Filter->Options->FeatureLines, output, badCells, surface },
    options, monitor);
}

void vtkMorphAlgorithm::vtkInternals::NoteEffort()
{
  const morph::Session::Effort effort = std::exchange(this->Session.effort, {});
  if (!std::isnan(effort.prepareSeconds))
  {
    this->Results.SetNumber("PrepareSeconds", effort.prepareSeconds);
  }
  if (!std::isnan(effort.evaluateSeconds))
  {
    this->Results.SetNumber("EvaluateSeconds", effort.evaluateSeconds);
  }
  this->Results.SetInteger(
    "PrepareCount", this->Results.Integer("PrepareCount") + effort.preparations);
}

morph::BoundaryTargets vtkMorphAlgorithm::vtkInternals::Match(vtkPointSet* boundary,
  double fraction, const filters::MotionOptions& options, morph::Monitor& monitor) const
{
  filters::BoundaryMatch::Options matching = options.Matching;
  matching.scaleFactor *= fraction;
  const morph::UndeformedMesh& rest = this->Session.mesh();
  morph::BoundaryTargets match =
    filters::BoundaryMatch::Match(boundary, rest.mesh(), rest.outerFaces(), rest.size(), matching);
  morph::warnOf(match, monitor);
  monitor.check();
  return match;
}

std::shared_ptr<const morph::StepResult> vtkMorphAlgorithm::vtkInternals::MorphSeries(
  vtkPointSet* displaced, const filters::MotionOptions& options, morph::Monitor& monitor)
{
  // A process without cells has no series, and would not know which step to ask the boundary for.
  if (this->Steps.FromBoundary() && filters::Ranks::Processes() > 1)
  {
    throw morph::Error("Relative steps after a boundary that varies in time need a mesh with cells "
                       "on several MPI processes, or a single process. Distribute the mesh, or set "
                       "Stepping to Absolute.");
  }
  const bool varies = this->Steps.FromBoundary();
  const auto boundaryOf = [&](int step)
  {
    if (varies && step != this->BoundaryStep)
    {
      displaced = filters::Input::RequireBoundary(this->Ports.Fetch(1, this->Steps.Time(step)));
      this->BoundaryStep = step;
    }
    return morph::inStep(
      step, [&] { return this->Match(displaced, this->Steps.Fraction(step), options, monitor); });
  };
  morph::BoundaryTargets whole;
  if (!varies)
  {
    whole = this->Match(displaced, 1, options, monitor);
  }
  return this->Session.morphSeries(
    this->Step, boundaryOf, varies ? nullptr : &whole, options, monitor);
}

void vtkMorphAlgorithm::vtkInternals::Transpose(vtkUnstructuredGrid* rest, vtkDataObject* boundary,
  vtkDataArray* gradient, vtkDoubleArray* boundaryGradient, morph::Monitor& monitor)
{
  const filters::MotionOptions options = this->Options(rest, boundary);
  morph::Points nodes = filters::Gradient::Require(gradient, rest->GetNumberOfPoints());
  vtkPointSet* displaced = filters::Input::RequireBoundary(boundary);
  this->Kept.Take(rest, monitor);
  this->Session.setMesh(this->Kept.Rest());
  const morph::BoundaryTargets match = this->Match(displaced, 1, options, monitor);
  const morph::Points prescribed =
    this->Session.transpose(match.ids, std::move(nodes), options, monitor);
  this->NoteEffort();
  const std::string& status = this->Results.Text("MorphStatus");
  if (options.postSmooth || status == "SubStepped" || status == "Repaired" || status == "Partial")
  {
    monitor.warn("PostSmooth or Validity changes the mesh after the method has made it; the "
                 "gradient is that of the method alone.");
  }
  filters::Gradient::Gather(options.Matching.scaleFactor * prescribed, match.sources,
    displaced->GetNumberOfPoints(), boundaryGradient);
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
    filters::MotionOptions options;
    filters::Ranks::Together([&] { options = kept.Options(rest, boundary); });
    kept.OnRanks().Transpose(rest, boundary, gradient, options, boundaryGradient, monitor);
    return;
  }
  kept.Transpose(rest, boundary, gradient, boundaryGradient, monitor);
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
