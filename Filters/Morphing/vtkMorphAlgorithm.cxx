// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphAlgorithm.h"

#include "Mesh/Topology.h"
#include "Morpher/Morpher.h"
#include "Private/Data/BadCells.h"
#include "Private/Data/DataCheck.h"
#include "Private/Data/Gradient.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Output.h"
#include "Private/Data/Quality.h"
#include "Private/Data/Version.h"
#include "Private/Morph/BoundaryMatch.h"
#include "Private/Morph/Series.h"
#include "Private/Morph/Validity.h"
#include "Private/Pipeline/CrewMonitor.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Monitor.h"
#include "Private/Pipeline/Ports.h"
#include "Private/Pipeline/Property.h"
#include "Private/Pipeline/Ranks.h"
#include "Private/Pipeline/Steps.h"
#include "Quality/BoundaryDetermined.h"
#include "Support/Error.h"
#include "Untangling/InversionFree.h"
#include "Untangling/SmoothMesh.h"

#include <vtkAlgorithmOutput.h>
#include <vtkDataObject.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkDoubleArray.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationIntegerKey.h>
#include <vtkInformationVector.h>
#include <vtkPointSet.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>

namespace filters = morph::filters;

namespace
{
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Smooths `moved` and returns the steps that led to it.
morph::Index smoothAfterwards(const morph::Mesh& rest, const std::vector<std::int8_t>& orientation,
  const morph::NodePartition& partition, int iterationLimit, morph::Points& moved,
  morph::Monitor& monitor)
{
  morph::SmoothingOptions options;
  options.target = morph::SmoothingTarget::Initial;
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
  double Size = 0;                         ///< of Mesh; see filters::GridMesh::Size
  std::vector<std::int8_t> Orientation;    ///< of Mesh
  morph::Index Mirrored = 0;               ///< bodies of Mesh; see GetMirroredBodies()
  std::unique_ptr<morph::Morpher> Morpher; ///< prepared for Mesh under Options, or null
  std::string Options;
  std::vector<morph::Statistic> Statistics; ///< as of the last execution
  std::string Status;                       ///< as of the last execution
  morph::Index BoundaryInverted = 0;        ///< cells for which the last execution has no result
  filters::Ports Ports;

  filters::Steps Steps;
  int Step = -1;         ///< asked for, of Steps
  int BoundaryStep = -1; ///< that the boundary is asked for
  filters::Series Series;
  vtkMTimeType OwnTime = 0;      ///< of the filter, for Series
  bool Varied = false;           ///< the boundary, for Series
  vtkMTimeType BoundaryTime = 0; ///< of the pipeline behind port 1, for Series where it varies
  filters::BoundaryMatch::Result Whole; ///< the whole motion, for Series where it does not

  explicit vtkInternals(vtkAlgorithm* filter)
    : Ports(filter)
  {
  }

  bool IsSeries(int stepping) const { return stepping == STEPPING_RELATIVE && this->Steps.Any(); }
  /// Forgets the series if the filter, or a boundary that varies, was modified since.
  void CheckSeries(vtkMTimeType own, vtkMTimeType boundary);
  /// Takes the grid over unless it is what is kept already.
  void SetGrid(vtkUnstructuredGrid* grid, morph::Monitor& monitor);
};

void vtkMorphAlgorithm::vtkInternals::SetGrid(vtkUnstructuredGrid* grid, morph::Monitor& monitor)
{
  const bool sameCells = filters::GridMesh::SameCells(grid, this->Mesh);
  if (sameCells && filters::GridMesh::SamePoints(grid, this->Mesh) &&
      this->Mesh.numberOfCells() > 0)
  {
    return;
  }
  morph::Mesh mesh = filters::GridMesh::FromGrid(grid);
  filters::Input::RequireVolumeCells(mesh);
  const morph::ConnectedComponents bodies = morph::connectedComponents(mesh);
  std::vector<std::int8_t> orientation = morph::cellSigns(mesh, bodies);
  if (!sameCells)
  {
    this->Outer = morph::boundaryFaces(mesh, monitor);
  }
  this->Morpher.reset();
  this->Series.Clear();
  this->Mirrored = filters::Quality::MirroredBodies(bodies, orientation);
  this->Orientation = std::move(orientation);
  this->Size = filters::GridMesh::Size(mesh);
  this->Mesh = std::move(mesh);
}

void vtkMorphAlgorithm::vtkInternals::CheckSeries(vtkMTimeType own, vtkMTimeType boundary)
{
  const bool varies = this->Steps.FromBoundary();
  if (own != this->OwnTime || varies != this->Varied || (varies && boundary != this->BoundaryTime))
  {
    this->Series.Clear();
  }
  this->Varied = varies;
  this->OwnTime = own;
  this->BoundaryTime = boundary;
}

morphSetNumberMacro(vtkMorphAlgorithm, StepMemoryLimit, 0.0, 1e12)
  morphSetNumberMacro(vtkMorphAlgorithm, MatchTolerance, 0.0, 1.0)
    morphSetNumberMacro(vtkMorphAlgorithm, ScaleFactor)
      morphSetNumberMacro(vtkMorphAlgorithm, RestTime)

        vtkMorphAlgorithm::vtkMorphAlgorithm()
  : Internals(new vtkInternals(this))
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
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
  return filters::Ports::FillInformation(port, info);
}

int vtkMorphAlgorithm::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const int done = filters::Ports::RequestInformation(inputVector, outputVector);
  const filters::Steps steps(this->NumberOfSteps, inputVector[1]->GetInformationObject(0));
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
  kept.Steps = filters::Steps(this->NumberOfSteps, boundary);
  kept.Step = kept.Steps.Asked(asked);
  kept.BoundaryStep = kept.Step;
  if (kept.IsSeries(this->Stepping))
  {
    auto* upstream =
      boundary ? vtkDemandDrivenPipeline::SafeDownCast(this->GetInputExecutive(1, 0)) : nullptr;
    kept.CheckSeries(this->GetMTime(), upstream ? upstream->GetPipelineMTime() : 0);
    const int last = kept.Series.LastUntil(kept.Step).first;
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
  return kept.Ports.RequestUpdateExtent(this->RestTime, time, inputVector);
}

int vtkMorphAlgorithm::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector);
  vtkUnstructuredGrid* badCells = vtkUnstructuredGrid::GetData(outputVector, 1);
  vtkInternals& kept = *this->Internals;
  std::string partial;
  // A process without cells has no series, and would not know which step to ask the boundary for.
  if (kept.IsSeries(this->Stepping) && kept.Steps.FromBoundary() && filters::Ranks::Count(true) > 1)
  {
    this->ResetResults();
    vtkErrorMacro("Relative steps after a boundary that varies in time need a single MPI process. "
                  "Run on one, or set Stepping to Absolute.");
    this->WriteUndeformed(nullptr, "Failed", output);
    return 1;
  }
  const filters::Ports::Task task = { "morph this mesh", this->NumberOfThreads,
    [&] { this->ResetResults(); },
    [&](vtkUnstructuredGrid* grid, vtkDataObject* boundary, filters::Monitor& monitor)
    {
      try
      {
        partial = this->Morph(grid, boundary, output, badCells, monitor);
      }
      catch (const filters::Validity::Infeasible& infeasible)
      {
        kept.BoundaryInverted = infeasible.Cells;
        throw;
      }
    },
    [&](vtkDataObject* input, const char* status)
    { this->WriteUndeformed(input, status, output); } };
  kept.BoundaryInverted = 0;
  const int done = kept.Ports.RequestData(task, inputVector, outputVector);
  if (kept.Steps.Any() && !kept.Steps.FromBoundary())
  {
    for (vtkUnstructuredGrid* data : { output, badCells })
    {
      data->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), kept.Steps.Time(kept.Step));
    }
  }
  if (!partial.empty())
  {
    vtkErrorMacro(<< partial);
  }
  return done;
}

void vtkMorphAlgorithm::WriteUndeformed(
  vtkDataObject* input, const char* status, vtkUnstructuredGrid* output)
{
  // Who stops a drag midway, or makes a mistake, wants to see the mesh it began with.
  if (filters::Version::AbortRequested(this))
  {
    filters::Version::KeepAbortedOutput(this);
  }
  output->Initialize();
  if (filters::Input::IsReadable(input))
  {
    output->ShallowCopy(input);
  }
  this->Internals->Status = status;
  if (this->Internals->BoundaryInverted > 0)
  {
    // What the error tells.
    this->BoundaryInvertedCells = static_cast<vtkIdType>(this->Internals->BoundaryInverted);
    this->Internals->Statistics = { { "BoundaryDeterminedCells",
      this->Internals->BoundaryInverted } };
    filters::Output::AddField(output, "BoundaryInvertedCells", this->BoundaryInvertedCells);
  }
  filters::Output::AddField(output, "MorphStatus", status);
  filters::Output::AddField(output, "InvertedCells", this->InvertedCells);
  filters::Output::AddField(output, "MinScaledJacobian", this->MinScaledJacobian);
}

std::string vtkMorphAlgorithm::Morph(vtkUnstructuredGrid* grid, vtkDataObject* boundary,
  vtkUnstructuredGrid* output, vtkUnstructuredGrid* badCells, filters::Monitor& monitor)
{
  vtkInternals& kept = *this->Internals;
  vtkPointSet* displaced = filters::Input::RequireBoundary(boundary);
  kept.SetGrid(grid, monitor);
  this->MirroredBodies = static_cast<vtkIdType>(kept.Mirrored);
  if (kept.Mirrored > 0)
  {
    const auto first = std::find(kept.Orientation.begin(), kept.Orientation.end(), -1);
    monitor.warn(std::to_string(kept.Mirrored) +
                 " bodies of the mesh are mirrored: in VTK's order of nodes all their cells of a "
                 "type are inverted, the first is cell " +
                 std::to_string(first - kept.Orientation.begin()) +
                 ". They are morphed and measured as if they were not. Reverse their order of "
                 "nodes if a solver expects VTK's.");
  }
  std::shared_ptr<const filters::StepResult> result;
  if (kept.IsSeries(this->Stepping))
  {
    result = this->MorphSeries(displaced, monitor);
  }
  else
  {
    monitor.SetRange(0, 0.9);
    const double part = kept.Steps.Any() ? kept.Steps.Fraction(kept.Step) : 1;
    result = std::make_shared<filters::StepResult>(this->MorphStep(
      kept.Mesh, this->Match(displaced, part, monitor), this->Validity, 0, 0.9, monitor));
  }
  // Of a step that was kept, too; inverted cells on the way there are no news.
  if (!result->Valid.Warning.empty())
  {
    monitor.warn(result->Valid.Warning);
  }
  monitor.SetRange(0.9, 1);
  this->Write(grid, *result, output, badCells, monitor);
  return result->Valid.Error;
}

filters::BoundaryMatch::Result vtkMorphAlgorithm::Match(
  vtkPointSet* displaced, double part, filters::Monitor& monitor) const
{
  const vtkInternals& kept = *this->Internals;
  filters::BoundaryMatch::Options options;
  options.BoundaryIdArray = filters::Input::ArrayName(this->BoundaryIdArray);
  options.DisplacementArray = filters::Input::ArrayName(this->DisplacementArray);
  options.ScaleFactor = this->ScaleFactor * part;
  options.MatchTolerance = this->MatchTolerance;
  options.HoldUnnamedBoundary = this->HoldUnnamedBoundary;
  filters::BoundaryMatch::Result match =
    filters::BoundaryMatch::Match(displaced, kept.Mesh, kept.Outer, kept.Size, options);
  for (const std::string& warning : match.Warnings)
  {
    monitor.warn(warning);
  }
  monitor.check();
  return match;
}

std::shared_ptr<const filters::StepResult> vtkMorphAlgorithm::MorphSeries(
  vtkPointSet* displaced, filters::Monitor& monitor)
{
  vtkInternals& kept = *this->Internals;
  const bool varies = kept.Steps.FromBoundary();
  if (!varies)
  {
    filters::BoundaryMatch::Result whole = this->Match(displaced, 1, monitor);
    if (whole.Ids != kept.Whole.Ids || whole.Targets != kept.Whole.Targets)
    {
      kept.Series.Clear();
      kept.Whole = std::move(whole);
    }
  }
  auto [step, result] = kept.Series.LastUntil(kept.Step);
  const double first = step;
  constexpr int Most = 10; // messages about steps before the last; a million help nobody
  int partial = 0;
  while (step < kept.Step)
  {
    ++step;
    if (varies && step != kept.BoundaryStep)
    {
      displaced = filters::Input::RequireBoundary(kept.Ports.Fetch(1, kept.Steps.Time(step)));
      kept.BoundaryStep = step;
    }
    morph::Mesh from = kept.Mesh;
    if (result)
    {
      from.points = result->Moved;
    }
    const auto progress = [&](int n) { return 0.9 * (n - first) / (kept.Step - first); };
    try
    {
      auto made = std::make_shared<filters::StepResult>(
        this->MorphStep(from, this->Match(displaced, kept.Steps.Fraction(step), monitor),
          this->Validity, progress(step - 1), progress(step), monitor));
      made->Valid.Measured = {}; // a series keeps meshes alone
      result = std::move(made);
    }
    catch (const filters::Validity::Infeasible& infeasible)
    {
      throw filters::Validity::Infeasible(
        "Step " + std::to_string(step) + ": " + infeasible.what(), infeasible.Cells);
    }
    catch (const morph::Error& error)
    {
      throw morph::Error(error.kind(), "Step " + std::to_string(step) + ": " + error.what());
    }
    if (step < kept.Step && !result->Valid.Error.empty() && ++partial <= Most)
    {
      monitor.warn("Step " + std::to_string(step) + ": " + result->Valid.Error);
    }
    kept.Series.Keep(step, result, this->StepMemoryLimit);
  }
  if (partial > Most)
  {
    monitor.warn(std::to_string(partial - Most) + " more steps came only part of the way.");
  }
  return result;
}

filters::StepResult vtkMorphAlgorithm::MorphStep(const morph::Mesh& from,
  const filters::BoundaryMatch::Result& match, int validityMode, double first, double last,
  filters::Monitor& monitor)
{
  vtkInternals& kept = *this->Internals;
  const auto part = [&](double a, double b)
  { monitor.SetRange(first + a * (last - first), first + b * (last - first)); };
  const morph::NodePartition partition = morph::partitionNodes(from, match.Ids);
  const filters::Validity validity{ validityMode, this->MaximumSubSteps, from, kept.Mesh.points,
    partition, kept.Orientation, match.Targets, kept.Outer,
    dynamic_cast<morph::InversionFree*>(this->CreateMorpher().get()) != nullptr,
    [this]
    {
      auto morpher = this->CreateMorpher();
      this->SetEvaluateOptions(*morpher);
      return morpher;
    } };
  validity.RequireFeasible();

  part(0.05, 0.45);
  this->Prepare(from, partition, monitor);

  part(0.45, 0.75);
  this->SetEvaluateOptions(*kept.Morpher);
  const auto start = Clock::now();
  filters::StepResult result;
  const morph::EvaluateReport report = kept.Morpher->evaluate(match.Targets, result.Moved, monitor);
  if (const auto wrong = filters::DataCheck::Immoderate(result.Moved); !wrong.empty())
  {
    throw morph::Error(
      "The method gave positions that are not finite or beyond 1e50, at node ids " +
      morph::listIds(wrong) +
      ". Check the boundary for huge values, and the mesh for cells without "
      "volume.");
  }
  result.Statistics = report.statistics;
  if (this->PostSmooth)
  {
    part(0.75, 0.85);
    result.Statistics.push_back(
      { "PostSmoothSteps", smoothAfterwards(kept.Mesh, kept.Orientation, partition,
                             this->PostSmoothIterations, result.Moved, monitor) });
  }
  part(this->PostSmooth ? 0.85 : 0.75, 1);
  result.Valid = validity.Ensure(result.Moved, monitor);
  this->EvaluateSeconds = secondsSince(start);
  if (result.Valid.Status == "Inverted")
  {
    result.BoundaryInverted = static_cast<morph::Index>(
      morph::boundaryDeterminedInversions(from, partition, kept.Orientation, result.Moved).size());
  }
  result.Iterations = report.iterations;
  result.Prescribed = static_cast<morph::Index>(match.Ids.size());
  result.Unmatched = match.Unmatched;
  return result;
}

void vtkMorphAlgorithm::Prepare(
  const morph::Mesh& from, const morph::NodePartition& partition, filters::Monitor& monitor)
{
  vtkInternals& kept = *this->Internals;
  const std::string options = this->PrepareOptions();
  this->PrepareSeconds = 0;
  if (kept.Morpher && kept.Options == options &&
      kept.Morpher->partition().prescribed == partition.prescribed &&
      kept.Morpher->restPoints() == from.points)
  {
    return;
  }
  const auto start = Clock::now();
  kept.Morpher.reset();
  std::unique_ptr<morph::Morpher> morpher = this->CreateMorpher();
  if (from.points != kept.Mesh.points)
  {
    morpher->setReference(kept.Mesh.points);
  }
  morpher->prepare(from, partition, monitor);
  kept.Morpher = std::move(morpher);
  kept.Options = options;
  ++this->PrepareCount;
  this->PrepareSeconds = secondsSince(start);
}

void vtkMorphAlgorithm::Write(vtkUnstructuredGrid* grid, const filters::StepResult& result,
  vtkUnstructuredGrid* output, vtkUnstructuredGrid* badCells, filters::Monitor& monitor)
{
  vtkInternals& kept = *this->Internals;
  this->SolverIterations = result.Iterations;
  this->LargestValidStep = result.Valid.LargestValidStep;
  this->SubSteps = static_cast<vtkIdType>(result.Valid.SubSteps);
  kept.Status = result.Valid.Status;
  kept.Statistics = result.Statistics;
  this->PrescribedPoints = static_cast<vtkIdType>(result.Prescribed);
  this->UnmatchedPoints = static_cast<vtkIdType>(result.Unmatched);

  filters::Output::Write(grid, kept.Mesh.points, result.Moved, this->OutputPointsPrecision, output);
  const bool known =
    !result.Valid.Measured.scaledJacobian.empty() && filters::Quality::IsThatOfComputed(output);
  const morph::Quality quality =
    known ? result.Valid.Measured
          : filters::Quality::Measure(kept.Mesh, output, kept.Orientation, monitor);
  if (kept.Status != "Inverted" && quality.inverted + quality.degenerate > 0)
  {
    // The mesh in double precision is valid, and what is written is not.
    kept.Status = "Inverted";
    this->LargestValidStep = std::numeric_limits<double>::quiet_NaN();
    monitor.warn("Rounding to single precision inverts " +
                 std::to_string(quality.inverted + quality.degenerate) +
                 " cells. Set OutputPointsPrecision to double.");
  }
  filters::Quality::Write(quality, output);
  filters::Quality::RemoveCertificate(output);
  if (this->Certify)
  {
    const morph::CertificateReport report =
      filters::Quality::Certify(kept.Mesh, output, kept.Orientation, {}, monitor);
    filters::Quality::Write(report, output);
    this->CertifiedCells = static_cast<vtkIdType>(report.certified);
    this->UncertifiedCells = static_cast<vtkIdType>(report.inverted);
    this->UndecidedCells = static_cast<vtkIdType>(report.undecided);
  }
  filters::BadCells::Extract(quality, output, badCells);
  this->MinScaledJacobian = quality.minimum;
  this->MeanScaledJacobian = quality.mean;
  this->InvertedCells = quality.inverted;
  this->DegenerateCells = quality.degenerate;
  this->WorstCellId = quality.worstCell;
  this->BoundaryInvertedCells = static_cast<vtkIdType>(result.BoundaryInverted);
  filters::Output::AddField(output, "BoundaryInvertedCells", this->BoundaryInvertedCells);
  filters::Quality::WriteMirroredBodies(kept.Mirrored, output);
  filters::Output::AddField(output, "PrepareSeconds", this->PrepareSeconds);
  filters::Output::AddField(output, "EvaluateSeconds", this->EvaluateSeconds);
  filters::Output::AddField(output, "SolverIterations", this->SolverIterations);
  for (const morph::Statistic& count : kept.Statistics)
  {
    filters::Output::AddField(output, count.name.c_str(), static_cast<vtkIdType>(count.value));
  }
  filters::Output::AddField(output, "MorphStatus", this->GetMorphStatus());
  filters::Output::AddField(output, "LargestValidStep", this->LargestValidStep);
}

const char* vtkMorphAlgorithm::GetMorphStatus() const
{
  return this->Internals->Status.c_str();
}

bool vtkMorphAlgorithm::ApplyTranspose(vtkUnstructuredGrid* rest, vtkPointSet* boundary,
  vtkDataArray* gradient, vtkDoubleArray* boundaryGradient)
{
  filters::CrewMonitor monitor(this, this->NumberOfThreads);
  const filters::Execution::Outcome outcome = filters::Execution::Run(
    this, "apply the adjoint",
    [&]
    {
      this->Transpose(filters::Input::RequireGrid(rest, "The mesh"), boundary, gradient,
        boundaryGradient, monitor);
    },
    [&] { boundaryGradient->Initialize(); });
  for (const std::string& warning : monitor.TakeWarnings())
  {
    vtkWarningMacro(<< warning);
  }
  return outcome != filters::Execution::Outcome::Failed;
}

void vtkMorphAlgorithm::Transpose(vtkUnstructuredGrid* rest, vtkDataObject* boundary,
  vtkDataArray* gradient, vtkDoubleArray* boundaryGradient, filters::Monitor& monitor)
{
  vtkInternals& kept = *this->Internals;
  if (this->Stepping == STEPPING_RELATIVE && (this->NumberOfSteps > 0 || kept.Steps.Any()))
  {
    throw morph::Error("Relative steps have no adjoint: each depends on those before it. Set "
                       "Stepping to Absolute.");
  }
  const morph::Points nodes = filters::Gradient::Require(gradient, rest->GetNumberOfPoints());
  vtkPointSet* displaced = filters::Input::RequireBoundary(boundary);
  kept.SetGrid(rest, monitor);
  const filters::BoundaryMatch::Result match = this->Match(displaced, 1, monitor);
  monitor.SetRange(0.05, 0.5);
  this->Prepare(kept.Mesh, morph::partitionNodes(kept.Mesh, match.Ids), monitor);
  auto* linear = dynamic_cast<morph::LinearMorpher*>(kept.Morpher.get());
  if (!linear)
  {
    throw morph::Error(std::string(this->GetClassName()) +
                       " is not a linear method, so it has no adjoint that is the same for all "
                       "motions. Use one that is, FEMWARP for instance.");
  }
  const std::string& status = kept.Status;
  if (this->PostSmooth || status == "SubStepped" || status == "Repaired" || status == "Partial")
  {
    monitor.warn("PostSmooth or Validity changes the mesh after the method has made it; the "
                 "gradient is that of the method alone.");
  }
  monitor.SetRange(0.5, 1);
  this->SetEvaluateOptions(*linear);
  morph::Points prescribed;
  linear->applyTranspose(nodes, prescribed, monitor);
  filters::Gradient::Gather(this->ScaleFactor * prescribed, match.Sources,
    vtkPointSet::SafeDownCast(boundary)->GetNumberOfPoints(), boundaryGradient);
}

vtkIdType vtkMorphAlgorithm::GetCount(const char* name) const
{
  for (const morph::Statistic& count : this->Internals->Statistics)
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
  this->Internals->Statistics.clear();
  // No loop that looks for 0 inverted cells, or for a minimum above 0, passes without a result.
  this->MinScaledJacobian = -1;
  this->MeanScaledJacobian = std::numeric_limits<double>::quiet_NaN();
  this->InvertedCells = -1;
  this->DegenerateCells = -1;
  this->WorstCellId = -1;
  this->BoundaryInvertedCells = 0;
  this->MirroredBodies = 0;
  this->CertifiedCells = 0;
  this->UncertifiedCells = 0;
  this->UndecidedCells = 0;
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
  os << indent << "NumberOfSteps: " << this->NumberOfSteps << "\n";
  os << indent << "Stepping: " << this->Stepping << "\n";
  os << indent << "StepMemoryLimit: " << this->StepMemoryLimit << "\n";
  os << indent << "MatchTolerance: " << this->MatchTolerance << "\n";
  os << indent << "HoldUnnamedBoundary: " << this->HoldUnnamedBoundary << "\n";
  os << indent << "Validity: " << this->Validity << "\n";
  os << indent << "Certify: " << this->Certify << "\n";
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
  os << indent << "BoundaryInvertedCells: " << this->BoundaryInvertedCells << "\n";
  os << indent << "MirroredBodies: " << this->MirroredBodies << "\n";
  os << indent << "CertifiedCells: " << this->CertifiedCells << "\n";
  os << indent << "UncertifiedCells: " << this->UncertifiedCells << "\n";
  os << indent << "UndecidedCells: " << this->UndecidedCells << "\n";
  os << indent << "PrepareSeconds: " << this->PrepareSeconds << "\n";
  os << indent << "EvaluateSeconds: " << this->EvaluateSeconds << "\n";
  os << indent << "MorphStatus: " << this->GetMorphStatus() << "\n";
  os << indent << "LargestValidStep: " << this->LargestValidStep << "\n";
  os << indent << "SubSteps: " << this->SubSteps << "\n";
  os << indent << "SolverIterations: " << this->SolverIterations << "\n";
  os << indent << "PrepareCount: " << this->PrepareCount << "\n";
  os << indent << "PrescribedPoints: " << this->PrescribedPoints << "\n";
  os << indent << "UnmatchedPoints: " << this->UnmatchedPoints << "\n";
  for (const morph::Statistic& count : this->Internals->Statistics)
  {
    os << indent << count.name << ": " << count.value << "\n";
  }
}
