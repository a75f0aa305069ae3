// SPDX-License-Identifier: BSD-3-Clause
#include "Private/GridMorpher/GridMorpher.h"

#include "Private/Data/Gradient.h"
#include "Private/Data/Output.h"
#include "Private/Data/Version.h"
#include "Private/Distributed/OnRanks.h"
#include "Private/Morph/BoundaryMatch.h"
#include "Private/Morph/MorphOutput.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Ranks.h"
#include "Support/Communicator.h"
#include "Support/Error.h"
#include "Support/Monitor.h"
#include "vtkMorphAlgorithm.h"

#include <vtkAlgorithm.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <cmath>
#include <optional>
#include <utility>

namespace morph::filters
{
namespace
{
/// What a valid mesh needs comes before Quality.
bool measuresAll(const MorphOptions& options)
{
  return options.Quality == vtkMorphAlgorithm::QUALITY_ALL ||
         options.Validity >= vtkMorphAlgorithm::VALIDITY_SUB_STEP;
}

MorphOutput::Measures measuresOf(const MorphOptions& options)
{
  return { measuresAll(options), options.Certify,
    options.Validity != vtkMorphAlgorithm::VALIDITY_NONE };
}
}

GridMorpher::GridMorpher(vtkAlgorithm* filter, filters::Results& results)
  : Filter(filter)
  , Results(results)
{
}

bool GridMorpher::IsSeries(int stepping, const filters::Steps& steps)
{
  return stepping == vtkMorphAlgorithm::STEPPING_RELATIVE && steps.Any();
}

int GridMorpher::CheckSeries(std::uint64_t options, bool varies, std::uint64_t boundary, int step)
{
  this->Session.steps().check(options, varies, boundary);
  // Processes may keep different steps, and have to ask for the same one.
  return this->IsOnRanks ? -1 : this->Session.steps().lastUntil(step).first;
}

MotionOptions GridMorpher::OptionsOf(const Method& method) const
{
  const MorphOptions& from = method.Options;
  MotionOptions options;
  options.method = this->Filter->GetClassName();
  options.Matching.BoundaryIdArray = from.BoundaryIdArray;
  options.Matching.displacementArray = from.DisplacementArray;
  options.Matching.scaleFactor = from.ScaleFactor;
  options.Matching.matchTolerance = from.MatchTolerance;
  options.Matching.fixUnnamedBoundary = from.FixUnnamedBoundary;
  static_assert(int(morph::Validity::Mode::RepairAll) == vtkMorphAlgorithm::VALIDITY_REPAIR_ALL,
    "of one order");
  options.validity = static_cast<morph::Validity::Mode>(from.Validity);
  options.measureAll = measuresAll(from);
  options.maximumSubSteps = from.MaximumSubSteps;
  options.postSmooth = from.PostSmooth;
  options.postSmoothIterations = from.PostSmoothIterations;
  options.stepMemoryLimit = from.StepMemoryLimit;
  options.createMorpher = method.Create;
  return options;
}

std::string GridMorpher::Morph(vtkUnstructuredGrid* grid, vtkDataObject* boundary,
  bool isDistributed, const Motion& motion, const Method& method, const Outputs& outputs,
  morph::Monitor& monitor)
{
  this->BoundaryInverted = 0;
  const MotionOptions options = this->OptionsOf(method);
  try
  {
    this->Take(grid, isDistributed, options, monitor);
    KeptMesh& kept = this->Kept();
    vtkPointSet* displaced = nullptr;
    kept.All().together([&] { displaced = Input::RequireBoundary(boundary); });
    kept.SetFeatureLines(method.Options.FeatureLines, monitor);
    this->Session.reportMesh(options, monitor);
    morph::ProgressRange morphing(monitor, 0, 0.9), writing(monitor, 0.9, 1);
    const int precision = method.Options.OutputPointsPrecision;
    std::shared_ptr<morph::StepResult> single; // a series keeps its steps
    std::shared_ptr<const morph::StepResult> result;
    if (GridMorpher::IsSeries(method.Options.Stepping, motion.Steps))
    {
      result = this->MorphSeries(displaced, motion, options, morphing);
    }
    else
    {
      const double fraction = motion.Steps.Any() ? motion.Steps.Fraction(motion.Step) : 1;
      const morph::BoundaryTargets match = this->Match(displaced, fraction, options, morphing);
      std::optional<morph::Session::AffineHandle> handle;
      if (options.Matching.displacementArray.empty())
      {
        handle = BoundaryMatch::FindHandle(displaced, match, kept.Rest()->mesh(),
          options.Matching.scaleFactor * fraction, Output::IsFloat(grid, precision), kept.All());
      }
      result = single = this->Session.morph(match, options, morphing, handle ? &*handle : nullptr);
    }
    this->NoteEffort();
    morph::FirstSpeaks first(monitor, kept.All());
    // Of a step that was kept, too; inverted cells on the way there are no news.
    if (!result->valid.warning.empty())
    {
      first.warn(result->valid.warning);
    }
    MorphOutput::WriteMesh(kept, result->moved, precision, grid, outputs.Mesh, writing);
    if (single)
    {
      single->moved.resize(0, 3); // 24 bytes a node, which the measures need
    }
    MorphOutput::WriteMeasures(kept, *result, measuresOf(method.Options),
      isDistributed ? nullptr : displaced, this->Results, outputs, writing);
    return kept.All().isFirst() ? result->valid.error : "";
  }
  catch (const morph::Validity::Infeasible& infeasible)
  {
    this->BoundaryInverted = infeasible.cells;
    throw;
  }
}

void GridMorpher::Take(vtkUnstructuredGrid* grid, bool isDistributed, const MotionOptions& options,
  morph::Monitor& monitor)
{
  if (isDistributed && !this->Distributed)
  {
    this->Distributed = OnRanks::MakeMesh();
  }
  this->IsOnRanks = isDistributed;
  this->Kept().Take(grid, options.method, options.createMorpher, monitor);
  this->Session.setMesh(this->Kept().Rest());
  this->Results.SetInteger("MirroredBodies", this->Session.mesh().mirroredBodies());
}

void GridMorpher::WriteUndeformed(vtkDataObject* input, const char* status, const Outputs& outputs)
{
  // Who stops a drag midway, or makes a mistake, wants to see the mesh it began with.
  if (Version::AbortRequested(this->Filter))
  {
    Version::KeepAbortedOutput(this->Filter);
  }
  this->NoteEffort();
  MorphOutput::WriteUndeformed(
    input, status, std::exchange(this->BoundaryInverted, 0), this->Results, outputs.Mesh);
  this->Kept().WriteUndeformedSurface(outputs.Mesh, outputs.Surface);
}

void GridMorpher::NoteEffort()
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

morph::BoundaryTargets GridMorpher::Match(vtkPointSet* boundary, double fraction,
  const MotionOptions& options, morph::Monitor& monitor, BoundaryMatch::Followers* followers) const
{
  BoundaryMatch::Options matching = options.Matching;
  matching.scaleFactor *= fraction;
  const morph::Communicator& all = this->Session.mesh().all();
  morph::BoundaryTargets match = this->Kept().Match(boundary, matching, followers);
  morph::FirstSpeaks first(monitor, all);
  morph::warnOf(match, first);
  all.together([&] { monitor.check(); });
  return match;
}

std::shared_ptr<const morph::StepResult> GridMorpher::MorphSeries(vtkPointSet* displaced,
  const Motion& motion, const MotionOptions& options, morph::Monitor& monitor)
{
  const bool varies = motion.Boundary != nullptr;
  // A process without cells has no series, and would not know which step to ask the boundary for.
  if (varies && !this->IsOnRanks && filters::Ranks::Processes() > 1)
  {
    throw morph::Error("Relative steps with a boundary of their own need a mesh with cells on "
                       "several MPI processes, or a single process. Distribute the mesh, or set "
                       "`Stepping` to Absolute.");
  }
  const auto boundaryOf = [&](int step)
  {
    vtkPointSet* ofStep = displaced;
    if (varies)
    {
      this->Session.mesh().all().together(
        [&] { ofStep = Input::RequireBoundary(motion.Boundary(step)); });
    }
    return morph::inStep(step, [&]
      { return this->Match(ofStep, varies ? 1 : motion.Steps.Fraction(step), options, monitor); });
  };
  morph::BoundaryTargets whole;
  if (!varies)
  {
    whole = this->Match(displaced, 1, options, monitor);
  }
  return this->Session.morphSeries(
    motion.Step, boundaryOf, varies ? nullptr : &whole, options, monitor);
}

void GridMorpher::Transpose(vtkUnstructuredGrid* rest, vtkDataObject* boundary, bool isDistributed,
  vtkDataArray* gradient, const Method& method, vtkDoubleArray* boundaryGradient,
  morph::Monitor& monitor)
{
  const MotionOptions options = this->OptionsOf(method);
  this->Take(rest, isDistributed, options, monitor);
  const KeptMesh& kept = this->Kept();
  const morph::Communicator& all = kept.All();
  vtkPointSet* displaced = nullptr;
  morph::Points nodes = morph::Points::Zero(kept.Rest()->mesh().numberOfNodes(), 3);
  all.together(
    [&]
    {
      displaced = Input::RequireBoundary(boundary);
      if (rest->GetNumberOfPoints() > 0) // other processes have no arrays
      {
        nodes.topRows(kept.Grid().numberOfNodes()) = Gradient::Require(gradient,
          kept.Grid().numberOfNodes(), [&](morph::Index node) { return kept.Owns(node); });
      }
    });
  BoundaryMatch::Followers followers;
  const morph::BoundaryTargets match = this->Match(displaced, 1, options, monitor, &followers);
  morph::requirePlane(match, all);
  const morph::Points prescribed =
    this->Session.transpose(match.ids, std::move(nodes), options, monitor);
  this->NoteEffort();
  const std::string& status = this->Results.Text("MorphStatus");
  if (options.postSmooth || status == "SubStepped" || status == "Repaired" || status == "Partial")
  {
    morph::FirstSpeaks(monitor, all)
      .warn("`PostSmooth` or `Validity` changes the mesh after the method has made it; the "
            "gradient is that of the method alone.");
  }
  BoundaryMatch::SendBack(
    followers, options.Matching.scaleFactor * prescribed, all, displaced, boundaryGradient);
}
}
