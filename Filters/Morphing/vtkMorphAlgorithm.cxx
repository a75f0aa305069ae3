// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphAlgorithm.h"

#include "Morpher/Morpher.h"
#include "Private/GridMorpher/GridMorpher.h"
#include "Private/Pipeline/CrewMonitor.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Ports.h"
#include "Private/Pipeline/Ranks.h"
#include "Support/Error.h"

#include <vtkAlgorithmOutput.h>
#include <vtkDataObject.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkDoubleArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <optional>

namespace filters = morph::filters;

/// What an execution leaves for the next one.
class vtkMorphAlgorithm::vtkInternals
{
public:
  filters::Results Results{ filters::ResultTables::vtkMorphAlgorithm() };
  filters::GridMorpher Morpher;
  filters::Ports Ports;
  filters::GridMorpher::Motion Motion;
  int BoundaryStep = -1; ///< that the boundary is asked for

  explicit vtkInternals(vtkMorphAlgorithm* filter)
    : Morpher(filter, this->Results)
    , Ports(filter)
    , Filter(filter)
  {
  }

  filters::GridMorpher::Method Method() const
  {
    return { *this->Filter->Options, [filter = this->Filter] { return filter->CreateMorpher(); } };
  }

private:
  vtkMorphAlgorithm* Filter;
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

const morph::MorphOptions& vtkMorphAlgorithm::GetOptions() const
{
  return *this->Options;
}

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
  filters::GridMorpher::Motion& motion = kept.Motion;
  vtkInformation* boundary = inputVector[1]->GetInformationObject(0);
  vtkInformation* asked = filters::Ports::Asked(request, outputVector);
  std::optional<double> time = filters::Ports::AskedTime(asked);
  motion.Steps = filters::Steps(this->Options->NumberOfSteps, boundary);
  motion.Step = motion.Steps.Asked(asked);
  kept.BoundaryStep = motion.Step;
  if (filters::GridMorpher::IsSeries(this->Options->Stepping, motion.Steps))
  {
    auto* upstream =
      boundary ? vtkDemandDrivenPipeline::SafeDownCast(this->GetInputExecutive(1, 0)) : nullptr;
    const int last = kept.Morpher.CheckSeries(this->GetMTime(), motion.Steps.FromBoundary(),
      upstream ? upstream->GetPipelineMTime() : 0, motion.Step);
    kept.BoundaryStep = std::min(motion.Step, last + 1);
    time = motion.Steps.Time(kept.BoundaryStep);
  }
  else if (motion.Steps.FromBoundary() &&
           boundary->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS()) == 0)
  {
    time = motion.Steps.Time(kept.BoundaryStep); // of the parts of its range
  }
  if (motion.Steps.Any() && !motion.Steps.FromBoundary())
  {
    time.reset(); // it is not the boundary's
  }
  return kept.Ports.RequestUpdateExtent(this->Options->RestTime, time, inputVector);
}

int vtkMorphAlgorithm::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInternals& kept = *this->Internals;
  const filters::GridMorpher::Outputs outputs = { kept.Ports.Output(outputVector),
    vtkUnstructuredGrid::GetData(outputVector, 1), vtkPolyData::GetData(outputVector, 2) };
  std::string partial;
  const auto morph = [&](vtkUnstructuredGrid* grid, vtkDataObject* boundary, bool isDistributed,
                       filters::Monitor& monitor)
  {
    filters::RankGroup(isDistributed).Together([&] { this->TakeInputs(grid, boundary); });
    const auto boundaryAt = [&](int step)
    {
      // On several processes all ask for the same steps, whatever time the boundary has here.
      if (isDistributed || step != kept.BoundaryStep)
      {
        boundary = kept.Ports.Fetch(1, kept.Motion.Steps.Time(step));
        kept.BoundaryStep = step;
      }
      return boundary;
    };
    kept.Motion.Boundary = {};
    if (kept.Motion.Steps.FromBoundary())
    {
      kept.Motion.Boundary = boundaryAt;
    }
    partial = kept.Morpher.Morph(
      grid, boundary, isDistributed, kept.Motion, kept.Method(), outputs, monitor);
  };
  const filters::Ports::Task task = { "morph this mesh", this->Options->NumberOfThreads,
    this->Options->CoincidentPoints, [&] { kept.Results.Reset(); }, morph,
    [&](vtkDataObject* input, const char* status)
    { kept.Morpher.WriteUndeformed(input, status, outputs); } };
  const int done = kept.Ports.RequestData(task, inputVector, outputVector);
  kept.Motion.Steps.WriteTime(kept.Motion.Step, outputVector);
  if (!partial.empty())
  {
    vtkErrorMacro(<< partial);
  }
  return done;
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
  monitor.TellWarnings();
  return outcome != filters::Execution::Outcome::Failed;
}

void vtkMorphAlgorithm::Transpose(vtkUnstructuredGrid* rest, vtkDataObject* boundary,
  vtkDataArray* gradient, vtkDoubleArray* boundaryGradient, bool onRanks, morph::Monitor& monitor)
{
  vtkInternals& kept = *this->Internals;
  if (this->Options->Stepping == STEPPING_RELATIVE &&
      (this->Options->NumberOfSteps > 0 || kept.Motion.Steps.Any()))
  {
    throw morph::Error("Relative steps have no adjoint: each depends on those before it. Set "
                       "`Stepping` to Absolute.");
  }
  filters::RankGroup(onRanks).Together([&] { this->TakeInputs(rest, boundary); });
  kept.Morpher.Transpose(
    rest, boundary, onRanks, gradient, kept.Method(), boundaryGradient, monitor);
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
