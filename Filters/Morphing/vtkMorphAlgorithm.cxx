// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphAlgorithm.h"

#include "Morpher.h"
#include "SmoothMesh.h"
#include "Topology.h"
#include "vtkMorphBoundaryMatch.h"
#include "vtkMorphInput.h"
#include "vtkMorphMesh.h"
#include "vtkMorphMonitor.h"
#include "vtkMorphOutput.h"
#include "vtkMorphPorts.h"
#include "vtkMorphQuality.h"
#include "vtkMorphValidity.h"

#include <vtkAlgorithmOutput.h>
#include <vtkDataObject.h>
#include <vtkUnstructuredGrid.h>

#include <chrono>
#include <limits>

namespace
{
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}
}

namespace
{
/// Smooths `moved` and returns the steps that led to it.
morph::Index smoothAfterwards(const morph::Mesh& rest, const std::vector<std::int8_t>& orientation,
  const morph::NodePartition& partition, int iterationLimit, morph::Points& moved,
  morph::Monitor& monitor)
{
  morph::SmoothingOptions options;
  options.target = morph::Target::Initial;
  options.iterationLimit = iterationLimit;
  options.neverWorse = true;
  const morph::SmoothingReport report =
    morph::smoothMesh(rest, orientation, partition, options, moved, monitor);
  return report.wasKept ? 0 : report.untangleSteps + report.newtonSteps;
}
}

/// What an execution leaves for the next one.
struct vtkMorphAlgorithm::vtkInternals
{
  morph::Mesh Mesh;
  morph::BoundaryFaces Outer;              ///< of Mesh's cells
  double Size = 0;                         ///< of Mesh; see vtkMorphMesh::Size
  std::vector<std::int8_t> Orientation;    ///< of Mesh
  std::unique_ptr<morph::Morpher> Morpher; ///< prepared for Mesh under Options, or null
  std::string Options;
  std::vector<morph::Count> Counts; ///< as of the last execution
  std::string Status;               ///< as of the last execution
  vtkMorphPorts Ports;

  explicit vtkInternals(vtkAlgorithm* filter)
    : Ports(filter)
  {
  }

  /// Takes the grid over unless it is what is kept already.
  void SetGrid(vtkUnstructuredGrid* grid, morph::Monitor& monitor);
};

void vtkMorphAlgorithm::vtkInternals::SetGrid(vtkUnstructuredGrid* grid, morph::Monitor& monitor)
{
  const bool sameCells = vtkMorphMesh::SameCells(grid, this->Mesh);
  if (sameCells && vtkMorphMesh::SamePoints(grid, this->Mesh) && this->Mesh.numberOfCells() > 0)
  {
    return;
  }
  morph::Mesh mesh = vtkMorphMesh::FromGrid(grid);
  vtkMorphInput::RequireVolumeCells(mesh);
  std::vector<std::int8_t> orientation = morph::orientation(mesh, morph::bodies(mesh));
  if (!sameCells)
  {
    this->Outer = morph::boundaryFaces(mesh, monitor);
  }
  this->Morpher.reset();
  this->Orientation = std::move(orientation);
  this->Size = vtkMorphMesh::Size(mesh);
  this->Mesh = std::move(mesh);
}

vtkMorphAlgorithm::vtkMorphAlgorithm()
  : Internals(new vtkInternals(this))
{
  this->SetNumberOfInputPorts(2);
  this->ResetResults();
}

vtkMorphAlgorithm::~vtkMorphAlgorithm()
{
  this->SetBoundaryIdArray(nullptr);
  this->SetDisplacementArray(nullptr);
}

void vtkMorphAlgorithm::SetBoundaryConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkMorphAlgorithm::SetBoundaryData(vtkDataObject* boundary)
{
  this->SetInputDataObject(1, boundary);
}

int vtkMorphAlgorithm::FillInputPortInformation(int port, vtkInformation* info)
{
  return vtkMorphPorts::FillInformation(port, info);
}

int vtkMorphAlgorithm::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  return vtkMorphPorts::RequestInformation(inputVector, outputVector);
}

int vtkMorphAlgorithm::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  return this->Internals->Ports.RequestUpdateExtent(this->RestTime, inputVector, outputVector);
}

int vtkMorphAlgorithm::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector);
  std::string partial;
  const vtkMorphPorts::Task task = { "morph this mesh", this->NumberOfThreads,
    [&] { this->ResetResults(); },
    [&](vtkUnstructuredGrid* grid, vtkDataObject* boundary, vtkMorphMonitor& monitor)
    { partial = this->Morph(grid, boundary, output, monitor); } };
  const int done = this->Internals->Ports.RequestData(task, request, inputVector, outputVector);
  if (!partial.empty())
  {
    vtkErrorMacro(<< partial);
  }
  return done;
}

std::string vtkMorphAlgorithm::Morph(vtkUnstructuredGrid* grid, vtkDataObject* boundary,
  vtkUnstructuredGrid* output, vtkMorphMonitor& monitor)
{
  vtkInternals& kept = *this->Internals;
  vtkPointSet* displaced = vtkMorphInput::RequirePointSet(boundary, "The boundary");
  kept.SetGrid(grid, monitor);

  vtkMorphBoundaryMatch::Options options;
  options.BoundaryIdArray = vtkMorphInput::ArrayName(this->BoundaryIdArray);
  options.DisplacementArray = vtkMorphInput::ArrayName(this->DisplacementArray);
  options.ScaleFactor = this->ScaleFactor;
  options.MatchTolerance = this->MatchTolerance;
  options.HoldUnnamedBoundary = this->HoldUnnamedBoundary;
  const vtkMorphBoundaryMatch::Result match =
    vtkMorphBoundaryMatch::Match(displaced, kept.Mesh, kept.Outer, kept.Size, options);
  for (const std::string& warning : match.Warnings)
  {
    monitor.warn(warning);
  }
  monitor.check();

  const morph::NodePartition partition = morph::partitionNodes(kept.Mesh, match.Ids);
  const vtkMorphValidity validity{ this->Validity, this->MaximumSubSteps, kept.Mesh, partition,
    kept.Orientation, match.Targets,
    [this]
    {
      auto morpher = this->CreateMorpher();
      this->SetEvaluateOptions(*morpher);
      return morpher;
    } };
  validity.RequireFeasible();

  monitor.SetRange(0.05, 0.4);
  const std::string prepareOptions = this->PrepareOptions();
  if (!kept.Morpher || kept.Options != prepareOptions ||
      kept.Morpher->partition().prescribed != match.Ids)
  {
    const auto start = Clock::now();
    kept.Morpher.reset();
    std::unique_ptr<morph::Morpher> morpher = this->CreateMorpher();
    morpher->prepare(kept.Mesh, partition, monitor);
    kept.Morpher = std::move(morpher);
    kept.Options = prepareOptions;
    ++this->PrepareCount;
    this->PrepareSeconds = secondsSince(start);
  }

  monitor.SetRange(0.4, 0.7);
  this->SetEvaluateOptions(*kept.Morpher);
  const auto start = Clock::now();
  morph::Points moved;
  const morph::EvaluateReport report = kept.Morpher->evaluate(match.Targets, moved, monitor);
  kept.Counts = report.counts;
  if (this->PostSmooth)
  {
    monitor.SetRange(0.7, 0.8);
    kept.Counts.push_back(
      { "PostSmoothSteps", smoothAfterwards(kept.Mesh, kept.Orientation, partition,
                             this->PostSmoothIterations, moved, monitor) });
  }
  monitor.SetRange(this->PostSmooth ? 0.8 : 0.7, 0.9);
  const vtkMorphValidity::Outcome valid = validity.Ensure(moved, monitor);
  this->EvaluateSeconds = secondsSince(start);
  this->SolverIterations = report.iterations;
  this->LargestValidStep = valid.LargestValidStep;
  this->SubSteps = static_cast<vtkIdType>(valid.SubSteps);
  kept.Status = valid.Status;
  this->PrescribedPoints = static_cast<vtkIdType>(match.Ids.size());
  this->UnmatchedPoints = static_cast<vtkIdType>(match.Unmatched);

  monitor.SetRange(0.9, 1);
  vtkMorphOutput::Write(grid, kept.Mesh.points, moved, this->OutputPointsPrecision, output);
  const morph::Quality quality =
    vtkMorphQuality::Measure(kept.Mesh, output, kept.Orientation, monitor);
  vtkMorphQuality::Write(quality, output);
  this->MinScaledJacobian = quality.minimum;
  this->MeanScaledJacobian = quality.mean;
  this->InvertedCells = quality.inverted;
  this->DegenerateCells = quality.degenerate;
  this->WorstCellId = quality.worstCell;
  vtkMorphOutput::AddField(output, "PrepareSeconds", this->PrepareSeconds);
  vtkMorphOutput::AddField(output, "EvaluateSeconds", this->EvaluateSeconds);
  vtkMorphOutput::AddField(output, "SolverIterations", this->SolverIterations);
  for (const morph::Count& count : kept.Counts)
  {
    vtkMorphOutput::AddField(output, count.name.c_str(), static_cast<vtkIdType>(count.value));
  }
  vtkMorphOutput::AddField(output, "MorphStatus", this->GetMorphStatus());
  vtkMorphOutput::AddField(output, "LargestValidStep", this->LargestValidStep);
  return valid.Error;
}

const char* vtkMorphAlgorithm::GetMorphStatus() const
{
  return this->Internals->Status.c_str();
}

vtkIdType vtkMorphAlgorithm::GetCount(const char* name) const
{
  for (const morph::Count& count : this->Internals->Counts)
  {
    if (count.name == name)
    {
      return static_cast<vtkIdType>(count.value);
    }
  }
  return 0;
}

void vtkMorphAlgorithm::ResetResults()
{
  this->Internals->Counts.clear();
  this->MinScaledJacobian = std::numeric_limits<double>::quiet_NaN();
  this->MeanScaledJacobian = std::numeric_limits<double>::quiet_NaN();
  this->InvertedCells = 0;
  this->DegenerateCells = 0;
  this->WorstCellId = -1;
  this->PrepareSeconds = 0;
  this->EvaluateSeconds = 0;
  this->Internals->Status = "None";
  this->LargestValidStep = std::numeric_limits<double>::quiet_NaN();
  this->SubSteps = 0;
  this->SolverIterations = 0;
  this->PrescribedPoints = 0;
  this->UnmatchedPoints = 0;
}

void vtkMorphAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto text = [](const char* name) { return name ? name : "(none)"; };
  os << indent << "BoundaryIdArray: " << text(this->BoundaryIdArray) << "\n";
  os << indent << "DisplacementArray: " << text(this->DisplacementArray) << "\n";
  os << indent << "ScaleFactor: " << this->ScaleFactor << "\n";
  os << indent << "MatchTolerance: " << this->MatchTolerance << "\n";
  os << indent << "HoldUnnamedBoundary: " << this->HoldUnnamedBoundary << "\n";
  os << indent << "Validity: " << this->Validity << "\n";
  os << indent << "MaximumSubSteps: " << this->MaximumSubSteps << "\n";
  os << indent << "PostSmooth: " << this->PostSmooth << "\n";
  os << indent << "PostSmoothIterations: " << this->PostSmoothIterations << "\n";
  os << indent << "RestTime: " << this->RestTime << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "OutputPointsPrecision: " << this->OutputPointsPrecision << "\n";
  os << indent << "MinScaledJacobian: " << this->MinScaledJacobian << "\n";
  os << indent << "MeanScaledJacobian: " << this->MeanScaledJacobian << "\n";
  os << indent << "InvertedCells: " << this->InvertedCells << "\n";
  os << indent << "DegenerateCells: " << this->DegenerateCells << "\n";
  os << indent << "WorstCellId: " << this->WorstCellId << "\n";
  os << indent << "PrepareSeconds: " << this->PrepareSeconds << "\n";
  os << indent << "EvaluateSeconds: " << this->EvaluateSeconds << "\n";
  os << indent << "MorphStatus: " << this->GetMorphStatus() << "\n";
  os << indent << "LargestValidStep: " << this->LargestValidStep << "\n";
  os << indent << "SubSteps: " << this->SubSteps << "\n";
  os << indent << "SolverIterations: " << this->SolverIterations << "\n";
  os << indent << "PrepareCount: " << this->PrepareCount << "\n";
  os << indent << "PrescribedPoints: " << this->PrescribedPoints << "\n";
  os << indent << "UnmatchedPoints: " << this->UnmatchedPoints << "\n";
  for (const morph::Count& count : this->Internals->Counts)
  {
    os << indent << count.name << ": " << count.value << "\n";
  }
}
