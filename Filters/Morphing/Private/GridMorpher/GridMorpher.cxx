// SPDX-License-Identifier: BSD-3-Clause
#include "Private/GridMorpher/GridMorpher.h"

#include "Private/Data/Gradient.h"
#include "Private/Data/Output.h"
#include "Private/Data/Version.h"
#include "Private/Morph/BoundaryMatch.h"
#include "Private/Morph/MorphOutput.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Ranks.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"
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
double fractionOf(const GridMorpher::Motion& motion)
{
  return motion.Steps.Any() ? motion.Steps.Fraction(motion.Step) : 1;
}

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
  options.Matching.BoundaryIdArray = Input::ArrayName(from.BoundaryIdArray);
  options.Matching.displacementArray = Input::ArrayName(from.DisplacementArray);
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
  this->IsOnRanks = isDistributed;
  try
  {
    if (!isDistributed)
    {
      return this->MorphAlone(grid, boundary, motion, method, outputs, monitor);
    }
    const bool varies = motion.Boundary != nullptr;
    const OnRanks::Motion series = { motion.Step, varies,
      [&](int step) { return varies ? 1 : motion.Steps.Fraction(step); },
      [&](int step) { return Input::RequireBoundary(varies ? motion.Boundary(step) : boundary); } };
    const std::string error = this->Ranks().Run(
      { grid, boundary, fractionOf(motion),
        GridMorpher::IsSeries(method.Options.Stepping, motion.Steps) ? &series : nullptr,
        method.Options.OutputPointsPrecision, measuresOf(method.Options),
        method.Options.FeatureLines, outputs },
      this->OptionsOf(method), monitor);
    this->NoteEffort();
    return error;
  }
  catch (const morph::Validity::Infeasible& infeasible)
  {
    this->BoundaryInverted = infeasible.cells;
    throw;
  }
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
  if (this->IsOnRanks)
  {
    this->Ranks().WriteUndeformedSurface(outputs.Mesh, outputs.Surface);
    return;
  }
  this->Kept.WriteUndeformedSurface(outputs.Mesh, outputs.Surface);
}

std::string GridMorpher::MorphAlone(vtkUnstructuredGrid* grid, vtkDataObject* boundary,
  const Motion& motion, const Method& method, const Outputs& outputs, morph::Monitor& monitor)
{
  const int precision = method.Options.OutputPointsPrecision;
  vtkPointSet* displaced = Input::RequireBoundary(boundary);
  this->Kept.Take(grid, monitor);
  this->Session.setMesh(this->Kept.Rest());
  this->Kept.SetFeatureLines(method.Options.FeatureLines);
  const MotionOptions options = this->OptionsOf(method);
  this->Results.SetInteger(
    "MirroredBodies", static_cast<vtkIdType>(this->Session.mesh().mirroredBodies()));
  this->Session.reportMesh(options, monitor);
  std::shared_ptr<morph::StepResult> single; // a series keeps its steps
  std::shared_ptr<const morph::StepResult> result;
  morph::ProgressRange morphing(monitor, 0, 0.9), writing(monitor, 0.9, 1);
  if (GridMorpher::IsSeries(method.Options.Stepping, motion.Steps))
  {
    result = this->MorphSeries(displaced, motion, options, morphing);
  }
  else
  {
    const double fraction = fractionOf(motion);
    const morph::BoundaryTargets match = this->Match(displaced, fraction, options, morphing);
    std::optional<morph::Session::AffineHandle> handle;
    if (options.Matching.displacementArray.empty())
    {
      handle = BoundaryMatch::FindHandle(displaced, match, this->Session.mesh().mesh(),
        options.Matching.scaleFactor * fraction, Output::IsFloat(grid, precision));
    }
    result = single = this->Session.morph(match, options, morphing, handle ? &*handle : nullptr);
  }
  this->NoteEffort();
  // Of a step that was kept, too; inverted cells on the way there are no news.
  if (!result->valid.warning.empty())
  {
    monitor.warn(result->valid.warning);
  }
  MorphOutput::WriteMesh(this->Kept, result->moved, precision, grid, outputs.Mesh, writing);
  if (single)
  {
    single->moved.resize(0, 3); // 24 bytes a node, which the measures need
  }
  MorphOutput::WriteMeasures(
    this->Kept, *result, measuresOf(method.Options), displaced, this->Results, outputs, writing);
  return result->valid.error;
}

OnRanks::Morphing& GridMorpher::Ranks()
{
  if (!this->Distributed)
  {
    this->Distributed = OnRanks::MakeMorphing(this->Results, this->Session);
  }
  return *this->Distributed;
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
  const MotionOptions& options, morph::Monitor& monitor) const
{
  BoundaryMatch::Options matching = options.Matching;
  matching.scaleFactor *= fraction;
  const morph::UndeformedMesh& rest = this->Session.mesh();
  morph::BoundaryTargets match =
    BoundaryMatch::Match(boundary, rest.mesh(), rest.outerFaces(), rest.size(), matching);
  morph::warnOf(match, monitor);
  monitor.check();
  return match;
}

std::shared_ptr<const morph::StepResult> GridMorpher::MorphSeries(vtkPointSet* displaced,
  const Motion& motion, const MotionOptions& options, morph::Monitor& monitor)
{
  const bool varies = motion.Boundary != nullptr;
  // A process without cells has no series, and would not know which step to ask the boundary for.
  if (varies && filters::Ranks::Processes() > 1)
  {
    throw morph::Error("Relative steps with a boundary of their own need a mesh with cells on "
                       "several MPI processes, or a single process. Distribute the mesh, or set "
                       "`Stepping` to Absolute.");
  }
  const auto boundaryOf = [&](int step)
  {
    vtkPointSet* ofStep = varies ? Input::RequireBoundary(motion.Boundary(step)) : displaced;
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
  this->IsOnRanks = isDistributed;
  if (isDistributed)
  {
    this->Ranks().Transpose(rest, boundary, gradient, options, boundaryGradient, monitor);
    this->NoteEffort();
    return;
  }
  morph::Points nodes = Gradient::Require(gradient, rest->GetNumberOfPoints());
  vtkPointSet* displaced = Input::RequireBoundary(boundary);
  this->Kept.Take(rest, monitor);
  this->Session.setMesh(this->Kept.Rest());
  const morph::BoundaryTargets match = this->Match(displaced, 1, options, monitor);
  morph::requirePlane(match);
  const morph::Points prescribed =
    this->Session.transpose(match.ids, std::move(nodes), options, monitor);
  this->NoteEffort();
  const std::string& status = this->Results.Text("MorphStatus");
  if (options.postSmooth || status == "SubStepped" || status == "Repaired" || status == "Partial")
  {
    monitor.warn("`PostSmooth` or `Validity` changes the mesh after the method has made it; the "
                 "gradient is that of the method alone.");
  }
  Gradient::Gather(options.Matching.scaleFactor * prescribed, match.sources,
    displaced->GetNumberOfPoints(), boundaryGradient);
}
}
