// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCompareMorphMethods.h"

#include "Private/Compare/Comparison.h"
#include "Private/Compare/PeakMemory.h"
#include "Private/Data/Quality.h"
#include "Private/Data/Results.h"
#include "Private/Distributed/OnRanks.h"
#include "Private/GridMorpher/GridMorpher.h"
#include "Private/Options.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Ports.h"
#include "Private/Pipeline/Ranks.h"
#include "Quality/ScaledJacobian.h"
#include "Session/IncrementalMorph.h"
#include "Support/Error.h"
#include "Support/Monitor.h"
#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkLBWarpMorph.h"
#include "vtkRadialBasisMorph.h"
#include "vtkSimplexLinearMorph.h"
#include "vtkSimplexNaturalNeighborMorph.h"
#include "vtkSmoothingMorph.h"
#include "vtkWeightedResidualMorph.h"

#include <vtkAlgorithmOutput.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleVectorKey.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace filters = morph::filters;

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(vtkCompareMorphMethods);

struct vtkCompareMorphMethods::vtkInternals
{
  filters::Ports Ports;
  filters::Steps Steps;
  std::string BestMethod, BestStepping;

  explicit vtkInternals(vtkAlgorithm* filter)
    : Ports(filter)
  {
  }
  std::vector<double> Times() const
  {
    std::vector<double> times(this->Steps.Number());
    for (int i = 0; i < this->Steps.Number(); ++i)
    {
      times[i] = this->Steps.Time(i);
    }
    return times;
  }
  /// Takes the steps of a method, until the first that fails. Each message becomes one warning,
  /// with the first step that raised it. All `processes` call it.
  void Run(vtkMorphAlgorithm* method, vtkUnstructuredGrid* grid,
    const std::vector<vtkSmartPointer<vtkDataObject>>& boundaries,
    const morph::CompareMorphMethodsOptions& options, const filters::RankGroup& processes,
    filters::MethodRun& run, morph::Monitor& monitor) const;
};

namespace
{
template <typename Filter>
vtkSmartPointer<vtkMorphAlgorithm> make()
{
  return vtkSmartPointer<Filter>::New();
}

struct Method
{
  const char* Name;
  vtkSmartPointer<vtkMorphAlgorithm> (*Make)();
};

/// Measures the mesh, of which all `processes` have a part, also by `criteria`.
morph::Quality measure(vtkUnstructuredGrid* grid,
  std::vector<filters::Quality::OfCriterion>& criteria, const filters::RankGroup& processes,
  morph::Monitor& monitor)
{
  const auto run = processes.IsOfAll() ? filters::OnRanks::Measure : filters::Quality::MeasureAlone;
  vtkNew<vtkUnstructuredGrid> measured;
  return run(grid, false, criteria, measured, monitor).first.Whole;
}
}

vtkCompareMorphMethods::vtkCompareMorphMethods()
  : Internals(new vtkInternals(this))
  , Options(std::make_unique<morph::CompareMorphMethodsOptions>())
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(3);
}

vtkCompareMorphMethods::~vtkCompareMorphMethods() = default;

void vtkCompareMorphMethods::SetBoundaryConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkCompareMorphMethods::SetBoundaryData(vtkDataObject* boundary)
{
  this->SetInputDataObject(1, boundary);
}

int vtkCompareMorphMethods::FillInputPortInformation(int port, vtkInformation* info)
{
  return filters::Ports::FillInformation(port, info);
}

int vtkCompareMorphMethods::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  // The tables hold all times at once.
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    outputVector->GetInformationObject(port)->Remove(Pipeline::TIME_STEPS());
    outputVector->GetInformationObject(port)->Remove(Pipeline::TIME_RANGE());
  }
  return 1;
}

int vtkCompareMorphMethods::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  vtkInternals& kept = *this->Internals;
  vtkInformation* boundary = inputVector[1]->GetInformationObject(0);
  kept.Steps = filters::Steps(this->Options->NumberOfSteps, boundary);
  std::optional<double> asked;
  if (kept.Steps.FromBoundary())
  {
    asked = kept.Steps.Time(0);
  }
  return kept.Ports.RequestUpdateExtent(this->Options->RestTime, asked, inputVector);
}

int vtkCompareMorphMethods::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInternals& kept = *this->Internals;
  const auto reset = [&]
  {
    for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
    {
      vtkTable::GetData(outputVector, port)->Initialize();
    }
    kept.BestMethod.clear();
    kept.BestStepping.clear();
  };
  if (filters::Ranks::Processes() > 1 && !filters::Ranks::TakePieces())
  {
    reset();
    if (filters::Ranks::IsFirst())
    {
      vtkErrorMacro("This plugin was built without MPI or hypre: vtkCompareMorphMethods needs a "
                    "single MPI rank. Build with MESHMORPHING_USE_MPI, or run on one rank.");
    }
    return 1;
  }
  const auto compare = [&](vtkUnstructuredGrid* grid, vtkDataObject* boundary, bool isDistributed,
                         filters::Monitor& monitor)
  {
    const filters::RankGroup processes(isDistributed);
    std::vector<vtkSmartPointer<vtkDataObject>> boundaries;
    const int wanted = kept.Steps.FromBoundary() ? kept.Steps.Number() : 1;
    for (int step = 0; step < wanted; ++step)
    {
      processes.Together(
        [&]
        {
          monitor.check();
          vtkPointSet* points = filters::Input::RequireBoundary(
            step == 0 ? boundary : kept.Ports.Fetch(1, kept.Steps.Time(step)));
          boundaries.push_back(vtkSmartPointer<vtkDataObject>::Take(points->NewInstance()));
          boundaries.back()->ShallowCopy(points);
        });
    }
    this->Compare(grid, boundaries, isDistributed, outputVector, monitor);
  };
  const filters::Ports::Task task = { "compare methods on this mesh",
    this->Options->NumberOfThreads, this->Options->CoincidentPoints, reset, compare, {}, true };
  return kept.Ports.RequestData(task, inputVector, outputVector);
}

void vtkCompareMorphMethods::Configure(vtkMorphAlgorithm* filter) const
{
  filter->SetValidityToNone();
  filter->SetStepMemoryLimit(0); // steps are taken in order
  filter->SetBoundaryIdArray(this->Options->BoundaryIdArray.c_str());
  filter->SetDisplacementArray(this->Options->DisplacementArray.c_str());
  filter->SetScaleFactor(this->Options->ScaleFactor);
  filter->SetMatchTolerance(this->Options->MatchTolerance);
  filter->SetFixUnnamedBoundary(this->Options->FixUnnamedBoundary);
  if (auto* stiff = vtkFEMWarpMorph::SafeDownCast(filter))
  {
    stiff->SetStiffness(this->Options->Stiffness);
    stiff->SetStiffnessExponent(this->Options->StiffnessExponent);
  }
}

void vtkCompareMorphMethods::vtkInternals::Run(vtkMorphAlgorithm* method, vtkUnstructuredGrid* grid,
  const std::vector<vtkSmartPointer<vtkDataObject>>& boundaries,
  const morph::CompareMorphMethodsOptions& options, const filters::RankGroup& processes,
  filters::MethodRun& run, morph::Monitor& monitor) const
{
  const auto check = [&] { processes.Together([&] { monitor.check(); }); };
  // As the method's own filter: on the one process with cells, or on all.
  const bool isHere = grid->GetNumberOfCells() > 0;
  const bool isDistributed =
    processes.IsOfAll() &&
    (filters::Ranks::Count(isHere) > 1 ||
      filters::Ranks::Count(!isHere && filters::Input::HasPoints(boundaries.front())) > 0);
  filters::Results results(filters::ResultTables::vtkMorphAlgorithm());
  filters::GridMorpher morpher(method, results);
  vtkNew<vtkUnstructuredGrid> mesh, inverted;
  vtkNew<vtkPolyData> surface;
  filters::GridMorpher::Motion motion;
  motion.Steps = this->Steps;
  if (motion.Steps.FromBoundary())
  {
    motion.Boundary = [&](int step) { return boundaries[step].Get(); };
  }
  const filters::PeakMemory memory;
  std::set<std::string> told;
  const double number = motion.Steps.Number();
  for (motion.Step = 0; motion.Step < motion.Steps.Number(); ++motion.Step)
  {
    check();
    morph::QuietRange part(monitor, motion.Step / number, (motion.Step + 1) / number);
    results.Reset();
    std::vector<std::string> messages;
    const auto work = [&]
    {
      if (isDistributed || isHere || filters::Ranks::Processes() == 1) // else another has them
      {
        vtkDataObject* boundary = boundaries[motion.Boundary ? motion.Step : 0];
        filters::RankGroup(isDistributed).Together([&] { method->TakeInputs(grid, boundary); });
        morpher.Morph(grid, boundary, isDistributed, motion,
          { method->GetOptions(), [method] { return method->CreateMorpher(); } },
          { mesh, inverted, surface }, part);
      }
    };
    const filters::Execution::Outcome outcome = filters::Execution::Run(
      method, "morph this mesh", work, [] {},
      [&](const std::string& problem) { messages.push_back(problem); });
    check();
    run.Failure = messages.empty() ? "" : messages.front();
    const std::vector<std::string> warnings = part.take();
    messages.insert(messages.end(), warnings.begin(), warnings.end());
    for (const std::string& message : messages)
    {
      if (told.insert(message).second)
      {
        monitor.warn(run.Title() + ", step " + std::to_string(motion.Step) + ": " + message);
      }
    }
    if (outcome != filters::Execution::Outcome::Done)
    {
      processes.Share(run.Failure); // one process tells it
      break;
    }
    run.Steps.push_back(filters::Comparison::Measure(
      results, mesh, motion.Steps.Time(motion.Step), options.Percentile, processes));
    std::vector<filters::Quality::OfCriterion> criteria =
      filters::Quality::ReadCriteria(options.Criteria);
    if (!criteria.empty())
    {
      measure(mesh, criteria, processes, part);
      run.Steps.back().Criteria = std::move(criteria);
    }
  }
  run.PeakMegabytes = processes.Maximum(memory.Megabytes());
}

void vtkCompareMorphMethods::Compare(vtkUnstructuredGrid* grid,
  const std::vector<vtkSmartPointer<vtkDataObject>>& boundaries, bool onRanks,
  vtkInformationVector* outputVector, morph::Monitor& monitor)
{
  const filters::RankGroup processes(onRanks);
  const std::pair<bool, Method> methods[] = { { this->Options->Smoothing,
                                                { "Smoothing", make<vtkSmoothingMorph> } },
    { this->Options->WeightedResidual, { "Weighted residual", make<vtkWeightedResidualMorph> } },
    { this->Options->SimplexLinear, { "Simplex-linear", make<vtkSimplexLinearMorph> } },
    { this->Options->SimplexNaturalNeighbor,
      { "Simplex-natural neighbor", make<vtkSimplexNaturalNeighborMorph> } },
    { this->Options->RadialBasis, { "Radial basis", make<vtkRadialBasisMorph> } },
    { this->Options->FEMWARP, { "FEMWARP", make<vtkFEMWarpMorph> } },
    { this->Options->LBWARP, { "LBWARP", make<vtkLBWarpMorph> } },
    { this->Options->InversionFree, { "Inversion-free", make<vtkInversionFreeMorph> } } };
  std::vector<Method> chosen;
  for (const auto& [on, method] : methods)
  {
    if (on)
    {
      chosen.push_back(method);
    }
  }
  if (chosen.empty() || !(this->Options->Absolute || this->Options->Relative))
  {
    throw morph::Error(chosen.empty() ? "No method is chosen. Switch one on."
                                      : "Neither absolute nor relative steps are chosen. Switch "
                                        "one on.");
  }

  std::vector<filters::Quality::OfCriterion> criteria =
    filters::Quality::ReadCriteria(this->Options->Criteria);
  vtkInternals& kept = *this->Internals;
  const std::vector<double> times = kept.Times();
  const morph::Quality atRest =
    measure(grid, criteria, processes, monitor); // throws before the work
  const vtkIdType badAtRest = atRest.inverted + atRest.degenerate;
  if (badAtRest > 0 && processes.IsFirst())
  {
    monitor.warn(
      "The undeformed mesh has " + std::to_string(badAtRest) +
      " inverted or degenerate cells. Methods are ranked by the steps up to which they have no "
      "more than that.");
  }
  std::vector<filters::MethodRun> runs;
  const double number =
    static_cast<double>(chosen.size()) * (this->Options->Absolute + this->Options->Relative);
  for (const bool relative : { false, true })
  {
    for (const Method& method : relative ? this->Options->Relative ? chosen : std::vector<Method>()
                                : this->Options->Absolute ? chosen
                                                          : std::vector<Method>())
    {
      const double done = static_cast<double>(runs.size());
      morph::ProgressRange part(monitor, done / number, (done + 1) / number);
      filters::MethodRun run;
      run.Method = method.Name;
      run.Stepping = relative ? "Relative" : "Absolute";
      run.BadAtRest = badAtRest;
      const auto filter = method.Make();
      this->Configure(filter);
      filter->SetStepping(
        relative ? vtkMorphAlgorithm::STEPPING_RELATIVE : vtkMorphAlgorithm::STEPPING_ABSOLUTE);
      kept.Run(filter, grid, boundaries, *this->Options, processes, run, part);
      runs.push_back(std::move(run));
    }
  }
  if (std::all_of(
        runs.begin(), runs.end(), [](const filters::MethodRun& run) { return run.Steps.empty(); }))
  {
    throw morph::Error(
      "No method gave a mesh. " + runs.front().Title() + ": " + runs.front().Failure);
  }
  filters::Comparison::Rank(runs);
  filters::Comparison::WriteSteps(runs, vtkTable::GetData(outputVector, 0));
  filters::Comparison::WriteChart(runs, times, vtkTable::GetData(outputVector, 1));
  filters::Comparison::WriteRanking(
    runs, static_cast<int>(times.size()), vtkTable::GetData(outputVector, 2));
  const auto best = std::find_if(
    runs.begin(), runs.end(), [](const filters::MethodRun& run) { return run.Rank == 1; });
  kept.BestMethod = best->Method;
  kept.BestStepping = best->Stepping;
}

const char* vtkCompareMorphMethods::GetBestMethod() const
{
  return this->Internals->BestMethod.c_str();
}

const char* vtkCompareMorphMethods::GetBestStepping() const
{
  return this->Internals->BestStepping.c_str();
}

void vtkCompareMorphMethods::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->PrintOptions(os, indent);
  os << indent << "BestMethod: " << this->GetBestMethod() << "\n";
  os << indent << "BestStepping: " << this->GetBestStepping() << "\n";
}
