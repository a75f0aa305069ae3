// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/Session.h"

#include "Mesh/Polyhedra.h"
#include "Mesh/PolyhedronPieces.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Private/Data/DataCheck.h"
#include "Private/Data/Gradient.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/MeshNotes.h"
#include "Private/Data/Quality.h"
#include "Private/Morph/PolyhedralRepair.h"
#include "Private/Morph/PostSmoothing.h"
#include "Private/Pipeline/Input.h"
#include "Quality/BoundaryDetermined.h"
#include "Quality/MovableQuality.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"
#include "Untangling/HigherOrderUntangling.h"
#include "Untangling/InversionFree.h"
#include "Untangling/SmoothMesh.h"

#include <vtkPointSet.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace morph::filters
{
namespace
{
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Whether there are more bad cells or, with as many, a lower minimum.
bool isWorse(const morph::Quality& after, const morph::Quality& before)
{
  const auto bad = [](const morph::Quality& quality)
  { return quality.inverted + quality.degenerate; };
  return bad(after) > bad(before) ||
         (bad(after) == bad(before) && !(after.minimum >= before.minimum));
}

/// The options for the cells of `mesh`, as a method that is not prepared.
std::unique_ptr<morph::Morpher> settingsFor(
  const Session::Options& options, const morph::Mesh& mesh)
{
  auto method = options.CreateMorpher();
  if (morph::hasPolyhedra(mesh))
  {
    PolyhedralRepair::Adapt(*method);
  }
  return method;
}

/// A method with these options, not prepared, for the cells of `mesh`.
std::unique_ptr<morph::Morpher> makeMethod(const Session::Options& options, const morph::Mesh& mesh)
{
  auto method = settingsFor(options, mesh);
  return morph::hasPolyhedra(mesh) ? morph::morpherForPolyhedra(std::move(method))
                                   : std::move(method);
}

/// Smooths `moved` and returns the steps that led to it.
morph::Index smoothAfterwards(const morph::Mesh& rest, const std::vector<std::int8_t>& orientation,
  const morph::NodePartition& partition, int iterationLimit, morph::Points& moved,
  morph::Monitor& monitor)
{
  const morph::SmoothingOptions options = postSmoothing(iterationLimit);
  morph::SmoothingReport report;
  if (morph::hasPolyhedra(rest))
  {
    const morph::PolyhedronPieces pieces(rest, monitor);
    const morph::Mesh& mesh = pieces.mesh();
    morph::Points all = pieces.extend(moved);
    report = morph::smoothMesh(mesh, morph::cellSigns(mesh, morph::connectedComponents(mesh)),
      pieces.extend(partition), options, all, monitor);
    const morph::Points smoothed = all.topRows(moved.rows());
    const auto measure = [&](const morph::Points& points)
    { return morph::measureQuality(rest, points, orientation, {}, monitor); };
    // What is better for the pieces may be worse for the polyhedra.
    if (isWorse(measure(smoothed), measure(moved)))
    {
      return 0;
    }
    moved = smoothed;
  }
  else
  {
    report = morph::smoothMesh(rest, orientation, partition, options, moved, monitor);
  }
  return report.wasKept ? 0 : report.untangleSteps + report.newtonSteps;
}
}

void Session::SetGrid(vtkUnstructuredGrid* grid, morph::Monitor& monitor)
{
  if (this->Kept.Take(grid, monitor))
  {
    this->Method.reset();
    this->Modes.clear();
    this->Samples.reset();
    this->Attached = {};
    this->Partition = std::make_shared<morph::NodePartition>();
    this->Steps.Clear();
  }
}

void Session::ReportMesh(const Options& options, morph::Monitor& monitor)
{
  this->Results.SetInteger("MirroredBodies", static_cast<vtkIdType>(this->Kept.MirroredBodies()));
  if (this->Kept.MirroredBodies() > 0)
  {
    const auto first =
      std::find(this->Kept.Orientation().begin(), this->Kept.Orientation().end(), -1);
    monitor.warn(std::to_string(this->Kept.MirroredBodies()) +
                 " bodies of the mesh are mirrored: in VTK's order of nodes all their cells of a "
                 "type are inverted, the first is cell " +
                 std::to_string(first - this->Kept.Orientation().begin()) +
                 ". They are morphed and measured as if they were not. Reverse their order of "
                 "nodes if a solver expects VTK's.");
  }
  MeshNotes::WarnOfShared(this->Kept.RepeatedCells(), this->Kept.TouchingNodes(), monitor);
  if (options.MeasureAll)
  {
    const std::string note = Validity::Note(options.Validity, this->Kept.Before(monitor).cells());
    if (!note.empty())
    {
      monitor.warn(note);
    }
  }
}

BoundaryMatch::Result Session::Match(
  vtkPointSet* boundary, double fraction, const Options& options, morph::Monitor& monitor) const
{
  BoundaryMatch::Options matching = options.Matching;
  matching.ScaleFactor *= fraction;
  BoundaryMatch::Result match = BoundaryMatch::Match(
    boundary, this->Kept.Mesh(), this->Kept.OuterFaces(), this->Kept.Size(), matching);
  for (const std::string& warning : match.Warnings)
  {
    monitor.warn(warning);
  }
  BoundaryMatch::WarnIfNothingStays(match, monitor);
  monitor.check();
  return match;
}

std::shared_ptr<StepResult> Session::Morph(
  vtkPointSet* boundary, double fraction, const Options& options, morph::Monitor& monitor)
{
  const BoundaryMatch::Result match = this->Match(boundary, fraction, options, monitor);
  std::optional<AffineHandle> handle;
  if (options.Matching.DisplacementArray.empty())
  {
    handle = AffineHandle::Of(
      boundary, match, this->Kept.Mesh(), options.Matching.ScaleFactor * fraction, options.IsFloat);
  }
  return std::make_shared<StepResult>(
    this->MorphStep(this->Kept.Mesh(), match, handle, options, 0, 0.9, monitor));
}

std::shared_ptr<const StepResult> Session::MorphSeries(
  const Motion& motion, const Options& options, morph::Monitor& monitor)
{
  // Of a last step that is kept.
  this->Results.SetNumber("PrepareSeconds", 0);
  this->Results.SetNumber("EvaluateSeconds", 0);
  if (!motion.Varies)
  {
    BoundaryMatch::Result whole = this->Match(motion.Boundary(motion.Step), 1, options, monitor);
    if (whole.Ids != this->Whole.Ids || whole.Targets != this->Whole.Targets)
    {
      this->Steps.Clear();
      this->Whole = std::move(whole);
    }
  }
  auto [step, result] = this->Steps.LastUntil(motion.Step);
  const double first = step;
  constexpr int Most = 10; // messages about steps before the last; a million help nobody
  int partial = 0;
  while (step < motion.Step)
  {
    ++step;
    vtkPointSet* boundary = motion.Boundary(step);
    morph::Mesh from = this->Kept.Mesh();
    if (result)
    {
      from.points = result->Moved;
    }
    const auto progress = [&](int n) { return 0.9 * (n - first) / (motion.Step - first); };
    try
    {
      auto made = std::make_shared<StepResult>(
        this->MorphStep(from, this->Match(boundary, motion.Fraction(step), options, monitor), {},
          options, progress(step - 1), progress(step), monitor));
      made->Valid.Measured = {}; // a series keeps meshes alone
      result = std::move(made);
    }
    catch (const Validity::Infeasible& infeasible)
    {
      throw Validity::Infeasible(
        "Step " + std::to_string(step) + ": " + infeasible.what(), infeasible.Cells);
    }
    catch (const morph::Error& error)
    {
      throw morph::Error(error.kind(), "Step " + std::to_string(step) + ": " + error.what());
    }
    if (step < motion.Step && !result->Valid.Error.empty() && ++partial <= Most)
    {
      monitor.warn("Step " + std::to_string(step) + ": " + result->Valid.Error);
    }
    this->Steps.Keep(step, result, options.StepMemoryLimit);
  }
  if (partial > Most)
  {
    monitor.warn(std::to_string(partial - Most) + " more steps came only part of the way.");
  }
  return result;
}

StepResult Session::MorphStep(const morph::Mesh& from, const BoundaryMatch::Result& match,
  const std::optional<AffineHandle>& handle, const Options& options, double first, double last,
  morph::Monitor& monitor)
{
  const auto part = [&](double a, double b)
  { return morph::ProgressRange(monitor, first + a * (last - first), first + b * (last - first)); };
  const morph::NodePartition& partition = this->PartitionOf(match.Ids);
  static const morph::InvertedBefore none{};
  const morph::InvertedBefore& before =
    options.MeasureAll ? Validity::BeforeFor(options.Validity, this->Kept.Before(monitor)) : none;
  const Validity validity{ options.Validity, options.MaximumSubSteps, from,
    this->Kept.Mesh().points, before, partition, this->Kept.Orientation(), match.Targets,
    this->Kept.OuterFaces(),
    dynamic_cast<morph::InversionFree*>(options.CreateMorpher().get()) != nullptr,
    [&options, &from] { return makeMethod(options, from); } };
  validity.RequireFeasible();

  auto preparing = part(0.05, 0.45);
  this->Prepare(from, options, preparing);

  auto evaluating = part(0.45, 0.75);
  const auto start = Clock::now();
  StepResult result;
  const morph::EvaluateReport report = this->Evaluate(match, handle, result.Moved, evaluating);
  if (validity.IsInversionFree && morph::hasPolyhedra(from))
  {
    auto repairing = part(0.7, 0.75);
    const auto bad = [&](const morph::Points& points)
    { return morph::invertedCells(from, points, this->Kept.Orientation(), repairing); };
    PolyhedralRepair::Run(from, this->Kept.Mesh().points, partition, bad, result.Moved, repairing);
  }
  if (validity.IsInversionFree)
  {
    auto untangling = part(0.74, 0.75);
    morph::untangleHigherOrder(from, partition, this->Kept.Orientation(), result.Moved, untangling);
  }
  if (const auto wrong = DataCheck::Immoderate(result.Moved, &evaluating); !wrong.empty())
  {
    throw morph::Error(
      "The method gave positions that are not finite or beyond 1e50, at node ids " +
      morph::listIds(wrong) +
      ". Check the boundary for huge values, and the mesh for cells without "
      "volume.");
  }
  result.Statistics = report.statistics;
  if (options.PostSmooth)
  {
    auto smoothing = part(0.75, 0.85);
    result.Statistics.push_back(
      { "PostSmoothSteps", smoothAfterwards(this->Kept.Mesh(), this->Kept.Orientation(), partition,
                             options.PostSmoothIterations, result.Moved, smoothing) });
  }
  double seconds = secondsSince(start);
  auto checking = part(options.PostSmooth ? 0.85 : 0.75, 1);
  if (options.MeasureAll)
  {
    result.Valid = validity.Ensure(result.Moved, checking);
    if (!this->Samples)
    {
      this->Samples = std::make_unique<morph::MovableQuality>(
        this->Kept.Mesh(), this->Kept.Orientation(), partition.free);
    }
    const double minimum = this->Samples->fixedMinimum(result.Moved);
    result.BoundaryMinimum =
      std::isfinite(minimum) ? minimum : std::numeric_limits<double>::quiet_NaN();
  }
  else
  {
    result.Valid.Status = "Unmeasured";
    result.Valid.LargestValidStep = std::numeric_limits<double>::quiet_NaN();
  }
  this->Attached.apply(result.Moved);
  result.Attached = static_cast<morph::Index>(this->Attached.nodes().size());
  result.Loose = this->Attached.loose();
  const std::string& status = result.Valid.Status;
  if (status != "Valid" && status != "Inverted" && status != "Unmeasured")
  {
    seconds = secondsSince(start); // cells were not measured alone, but repaired
  }
  this->Results.SetNumber("EvaluateSeconds", seconds);
  if (result.Valid.Status == "Inverted")
  {
    result.BoundaryInverted =
      static_cast<morph::Index>(before
                                  .without(morph::boundaryDeterminedInversions(
                                    from, partition, this->Kept.Orientation(), result.Moved))
                                  .size());
  }
  result.Iterations = report.iterations;
  result.Prescribed = static_cast<morph::Index>(match.Ids.size());
  result.Unmatched = match.Unmatched;
  return result;
}

morph::EvaluateReport Session::Evaluate(const BoundaryMatch::Result& match,
  const std::optional<AffineHandle>& handle, morph::Points& moved, morph::Monitor& monitor)
{
  const auto* linear = dynamic_cast<const morph::LinearMorpher*>(this->Method.get());
  if (!handle || !linear)
  {
    return this->Method->evaluate(match.Targets, moved, monitor);
  }
  // Always, not from the second motion on: a result must not depend on what ran before.
  if (!this->Modes.isPreparedFor(*linear, handle->Fields))
  {
    this->Modes.prepare(*linear, handle->Fields, monitor);
  }
  return this->Modes.evaluate(*linear, handle->Motion, match.Targets, moved, monitor);
}

const morph::NodePartition& Session::PartitionOf(const std::vector<morph::Index>& prescribed)
{
  if (this->Partition->prescribed.empty() || this->Partition->prescribed != prescribed)
  {
    this->Samples.reset();
    this->Partition =
      std::make_shared<morph::NodePartition>(morph::partitionNodes(this->Kept.Mesh(), prescribed));
    this->Attached = morph::AttachedNodes(this->Kept.Mesh(), *this->Partition);
  }
  return *this->Partition;
}

void Session::Prepare(const morph::Mesh& from, const Options& options, morph::Monitor& monitor)
{
  this->Results.SetNumber("PrepareSeconds", 0);
  // SetGrid() drops the method with the mesh that it is prepared for.
  const bool isOfKept = &from == &this->Kept.Mesh();
  std::unique_ptr<morph::Morpher> settings = settingsFor(options, from);
  if (this->Method && this->Settings->preparesLike(*settings) &&
      this->Method->partition().prescribed == this->Partition->prescribed &&
      ((isOfKept && this->MethodIsOfKept) || this->Method->restPoints() == from.points))
  {
    morph::methodOf(*this->Method).takeEvaluateOptions(*settings);
    return;
  }
  const auto start = Clock::now();
  this->Method.reset();
  this->Modes.clear();
  std::unique_ptr<morph::Morpher> morpher = makeMethod(options, from);
  if (!isOfKept && from.points != this->Kept.Mesh().points)
  {
    morpher->setReference(this->Kept.Mesh().points);
  }
  if (isOfKept)
  {
    morpher->prepare(this->Kept.SharedMesh(), this->Partition, monitor);
  }
  else
  {
    morpher->prepare(from, *this->Partition, monitor);
  }
  this->Method = std::move(morpher);
  this->MethodIsOfKept = isOfKept;
  this->Settings = std::move(settings);
  this->Results.SetInteger("PrepareCount", this->Results.Integer("PrepareCount") + 1);
  this->Results.SetNumber("PrepareSeconds", secondsSince(start));
}

void Session::Transpose(vtkUnstructuredGrid* rest, vtkDataObject* boundary, vtkDataArray* gradient,
  const Options& options, vtkDoubleArray* boundaryGradient, morph::Monitor& monitor)
{
  morph::Points nodes = Gradient::Require(gradient, rest->GetNumberOfPoints());
  vtkPointSet* displaced = Input::RequireBoundary(boundary);
  this->SetGrid(rest, monitor);
  const BoundaryMatch::Result match = this->Match(displaced, 1, options, monitor);
  morph::ProgressRange preparing(monitor, 0.05, 0.5);
  this->PartitionOf(match.Ids);
  this->Prepare(this->Kept.Mesh(), options, preparing);
  auto* linear = dynamic_cast<morph::LinearMorpher*>(this->Method.get());
  if (!linear)
  {
    throw morph::Error(options.Method +
                       " is not a linear method, so it has no adjoint that is the same for all "
                       "motions. Use one that is, FEMWARP for instance.");
  }
  const std::string& status = this->Results.Text("MorphStatus");
  if (options.PostSmooth || status == "SubStepped" || status == "Repaired" || status == "Partial")
  {
    monitor.warn("PostSmooth or Validity changes the mesh after the method has made it; the "
                 "gradient is that of the method alone.");
  }
  morph::ProgressRange applying(monitor, 0.5, 1);
  morph::Points prescribed;
  this->Attached.applyTranspose(nodes);
  linear->applyTranspose(nodes, prescribed, applying);
  Gradient::Gather(options.Matching.ScaleFactor * prescribed, match.Sources,
    displaced->GetNumberOfPoints(), boundaryGradient);
}
}
