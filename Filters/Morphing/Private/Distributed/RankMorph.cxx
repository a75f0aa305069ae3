// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/AttachedNodes.h"
#include "Distributed/DistributedMesh.h"
#include "Distributed/Methods.h"
#include "Distributed/RankCommunicator.h"
#include "Mesh/Extent.h"
#include "Mesh/NodePartition.h"
#include "Private/Data/Gradient.h"
#include "Private/Data/Results.h"
#include "Private/Distributed/OnRanks.h"
#include "Private/Distributed/RankMatch.h"
#include "Private/Distributed/RankMesh.h"
#include "Private/Distributed/RankOutput.h"
#include "Private/Distributed/RankPolyhedra.h"
#include "Private/Distributed/RankValidity.h"
#include "Private/Pipeline/Input.h"
#include "Quality/MovableQuality.h"
#include "Session/Series.h"
#include "Session/UndeformedMesh.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"
#include "Support/Stopwatch.h"
#include "Untangling/InversionFree.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace morph::filters::OnRanks
{
namespace
{
using morph::distributed::DistributedMesh;
using morph::distributed::RankCommunicator;

/// A copy with zeros where another process owns the node. A set's points may be such nodes, which
/// have no values here.
vtkSmartPointer<vtkDataArray> ofOwned(vtkDataArray* gradient, const DistributedMesh& mesh)
{
  if (!gradient)
  {
    return nullptr;
  }
  const auto copy = vtkSmartPointer<vtkDataArray>::Take(gradient->NewInstance());
  copy->DeepCopy(gradient);
  const morph::Index count = std::min<morph::Index>(copy->GetNumberOfTuples(), mesh.pieceNodes());
  for (morph::Index n = 0; n < count; ++n)
  {
    for (int j = 0; !mesh.owns(n) && j < copy->GetNumberOfComponents(); ++j)
    {
      copy->SetComponent(static_cast<vtkIdType>(n), j, 0);
    }
  }
  return copy;
}

/// The motion of the nodes that do not hang, which move the others by their ties.
morph::BoundaryTargets withoutHanging(
  const morph::BoundaryTargets& match, const DistributedMesh& mesh)
{
  morph::BoundaryTargets result = match;
  result.ids = mesh.hanging().without(match.ids);
  morph::Points all = mesh.mesh().points;
  all(match.ids, morph::allColumns) = match.targets;
  result.targets = all(result.ids, morph::allColumns);
  return result;
}

/// Warns on the first process of nodes that hang and are not where the boundary puts them.
void warnOfDropped(const DistributedMesh& mesh, const morph::BoundaryTargets& match,
  const morph::Points& moved, morph::Monitor& monitor)
{
  if (!mesh.hasHanging())
  {
    return;
  }
  std::vector<morph::Index> ids = morph::droppedTargets(match, mesh.hanging(), moved, mesh.size());
  ids.erase(
    std::remove_if(ids.begin(), ids.end(), [&](morph::Index node) { return !mesh.owns(node); }),
    ids.end());
  ids = mesh.ranks().gatherSorted(mesh.idsOfNodes(ids));
  if (!ids.empty() && mesh.ranks().rank() == 0)
  {
    monitor.warn(morph::noteOfDropped(ids));
  }
}

class RankMorphing : public Morphing
{
public:
  explicit RankMorphing(filters::Results& results)
    : Results(results)
  {
  }
  std::string Run(const Task& task, const MotionOptions& options, morph::Monitor& monitor) override;
  void WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* surface) const override
  {
    this->Mesh.WriteUndeformedSurface(grid, surface);
  }
  void CheckSeries(vtkMTimeType options, bool varies, vtkMTimeType boundary) override
  {
    this->Steps.check(options, varies, boundary);
  }
  void Transpose(vtkUnstructuredGrid* rest, vtkDataObject* boundary, vtkDataArray* gradient,
    const MotionOptions& options, vtkDoubleArray* boundaryGradient,
    morph::Monitor& monitor) override;

private:
  filters::Results& Results;
  RankMesh Mesh;
  morph::Series Steps;
  morph::BoundaryTargets WholeMotion; ///< for Steps, of a boundary that does not vary

  /// Takes the mesh that the method works on, and reports mirrored bodies.
  void Take(vtkUnstructuredGrid* grid, const MotionOptions& options, morph::Monitor& monitor);
  morph::BoundaryTargets Match(vtkDataObject* boundary, double fraction,
    const MotionOptions& options, std::vector<RankMatch::Follower>* followers,
    morph::Monitor& monitor) const;
  /// Prepares the method for the undeformed mesh, unless it is prepared.
  morph::Morpher& Prepare(
    const morph::NodePartition& partition, const MotionOptions& options, morph::Monitor& monitor);
  /// `from`: null for the undeformed mesh.
  morph::StepResult Step(const DistributedMesh* from, const morph::BoundaryTargets& match,
    const MotionOptions& options, morph::Monitor& monitor);
  std::shared_ptr<const morph::StepResult> MorphSeries(
    const Motion& motion, const MotionOptions& options, morph::Monitor& monitor);
  std::unique_ptr<morph::Morpher> Make(const MotionOptions& options) const;
  morph::NodePartition PartitionOf(
    const std::vector<morph::Index>& prescribed, morph::Monitor& monitor) const;
  /// The last step until `number` that all ranks keep.
  std::pair<int, morph::Series::Step> LastUntil(int number) const;

  std::unique_ptr<morph::Morpher> Prepared;
  std::vector<morph::Index> PreparedFor; ///< the prescribed nodes of Prepared
  std::unique_ptr<const morph::Morpher> PreparedLike;
};
}

std::unique_ptr<Morphing> MakeMorphing(Results& results)
{
  return std::make_unique<RankMorphing>(results);
}

void RankMorphing::Take(
  vtkUnstructuredGrid* grid, const MotionOptions& options, morph::Monitor& monitor)
{
  const std::unique_ptr<morph::Morpher> sample =
    morph::distributed::makeMethod(options.createMorpher());
  if (!sample)
  {
    throw morph::Error(options.method +
                       " needs one MPI rank, and the mesh is distributed over several. Run on one, "
                       "or use another method, Morph Inversion Free for instance.");
  }
  if (this->Mesh.Take(grid, sample->layers(), GridMesh::UnknownCells::Refuse, monitor))
  {
    this->Prepared.reset();
    this->Steps.clear();
  }
  this->Mesh.RequireVolumeCells();
  const DistributedMesh& whole = this->Mesh.Whole();
  this->Results.SetInteger("MirroredBodies", whole.mirroredBodies());
  morph::Index first = std::numeric_limits<morph::Index>::max();
  for (morph::Index c = 0; c < whole.pieceCells(); ++c)
  {
    if (whole.isGhost()[c] == 0 && whole.orientation()[c] < 0)
    {
      first = std::min<morph::Index>(first, whole.cellId(c));
    }
  }
  first = whole.ranks().minimum(first);
  if (whole.ranks().rank() == 0)
  {
    morph::warnOfMirrored(whole.mirroredBodies(), first, monitor);
  }
}

morph::BoundaryTargets RankMorphing::Match(vtkDataObject* boundary, double fraction,
  const MotionOptions& options, std::vector<RankMatch::Follower>* followers,
  morph::Monitor& monitor) const
{
  const auto& ranks = this->Mesh.Ranks();
  vtkPointSet* displaced = nullptr;
  ranks.together([&] { displaced = Input::RequireBoundary(boundary); });
  BoundaryMatch::Options matching = options.Matching;
  matching.scaleFactor *= fraction;
  morph::BoundaryTargets match =
    RankMatch::Match(displaced, this->Mesh.Whole(), matching, followers);
  if (ranks.rank() == 0)
  {
    morph::warnOf(match, monitor);
  }
  return match;
}

std::unique_ptr<morph::Morpher> RankMorphing::Make(const MotionOptions& options) const
{
  const bool onPieces = this->Mesh.NeedsPieces();
  return morph::distributed::makeMethod(options.settings(onPieces), onPieces);
}

morph::NodePartition RankMorphing::PartitionOf(
  const std::vector<morph::Index>& prescribed, morph::Monitor& monitor) const
{
  morph::NodePartition partition;
  this->Mesh.Ranks().together(
    [&]
    {
      monitor.check();
      partition =
        morph::partitionNodes(this->Mesh.Whole().mesh(), this->Mesh.Whole().hanging(), prescribed);
    });
  return partition;
}

morph::Morpher& RankMorphing::Prepare(
  const morph::NodePartition& partition, const MotionOptions& options, morph::Monitor& monitor)
{
  const auto& ranks = this->Mesh.Ranks();
  this->Results.SetNumber("PrepareSeconds", 0);
  std::unique_ptr<morph::Morpher> settings = options.settings(this->Mesh.NeedsPieces());
  const bool same = this->Prepared && this->PreparedFor == partition.prescribed &&
                    this->PreparedLike->preparesLike(*settings);
  if (ranks.sum(morph::Index(!same)) > 0)
  {
    const morph::Stopwatch watch;
    this->Prepared.reset();
    std::unique_ptr<morph::Morpher> method = this->Make(options);
    method->prepare(this->Mesh.Whole().mesh(), partition, monitor,
      std::make_shared<RankCommunicator>(this->Mesh.Whole()));
    this->Prepared = std::move(method);
    this->PreparedFor = partition.prescribed;
    this->Results.SetInteger("PrepareCount", this->Results.Integer("PrepareCount") + 1);
    this->Results.SetNumber("PrepareSeconds", ranks.maximum(watch.seconds()));
  }
  this->Prepared->takeEvaluateOptions(*settings);
  this->PreparedLike = std::move(settings);
  return *this->Prepared;
}

morph::StepResult RankMorphing::Step(const DistributedMesh* from,
  const morph::BoundaryTargets& given, const MotionOptions& options, morph::Monitor& monitor)
{
  const DistributedMesh& whole = from ? *from : this->Mesh.Whole();
  const auto& ranks = whole.ranks();
  const morph::BoundaryTargets match = withoutHanging(given, whole);
  const morph::NodePartition partition = this->PartitionOf(match.ids, monitor);
  static const morph::InvertedBefore none{};
  const morph::InvertedBefore& before =
    options.measureAll ? morph::Validity::beforeFor(options.validity, this->Mesh.Before(monitor))
                       : none;
  const RankValidity validity{ options, whole, this->Mesh.Whole().mesh().points, before, partition,
    match.targets, this->Mesh.NeedsPieces(), [&] { return this->Make(options); } };
  morph::StepResult result;
  result.boundaryInverted = validity.RequireFeasible();

  morph::ProgressRange preparing(monitor, 0.05, 0.5), evaluating(monitor, 0.5, 0.8),
    checking(monitor, 0.8, 1);
  std::unique_ptr<morph::Morpher> ofStep;
  if (from)
  {
    ofStep = this->Make(options);
    ofStep->setReference(this->Mesh.Whole().mesh().points);
    const morph::Stopwatch watch;
    ofStep->prepare(whole.mesh(), partition, preparing, std::make_shared<RankCommunicator>(whole));
    this->Results.SetInteger("PrepareCount", this->Results.Integer("PrepareCount") + 1);
    this->Results.SetNumber("PrepareSeconds", ranks.maximum(watch.seconds()));
  }
  const morph::Morpher& method = from ? *ofStep : this->Prepare(partition, options, preparing);
  const morph::Stopwatch watch;
  const morph::EvaluateReport report = method.evaluate(match.targets, result.moved, evaluating);
  const morph::Index followers =
    ranks.sum(static_cast<morph::Index>(partition.higherOrderNodes.size()));
  if (dynamic_cast<morph::InversionFree*>(options.createMorpher().get()) &&
      (followers > 0 || this->Mesh.NeedsPieces()))
  {
    // The method has moved corners of cells or pieces; nodes between them have followed.
    RankPolyhedra::Repair(whole, this->Mesh.Whole().mesh().points, partition,
      this->Mesh.NeedsPieces(), {}, result.moved, evaluating);
  }
  result.statistics = report.statistics;
  const std::vector<morph::Index> wrong = morph::immoderateRows(result.moved);
  ranks.together(
    [&]
    {
      if (!wrong.empty())
      {
        throw morph::Error(
          "The method gave positions that are not finite or beyond 1e50, at node ids " +
          morph::listIds(whole.idsOfNodes(wrong)) +
          ". Check the boundary for huge values, and the mesh for cells without volume.");
      }
    });
  if (options.postSmooth)
  {
    result.statistics.push_back({ "PostSmoothSteps",
      RankPolyhedra::Smooth(whole, this->Mesh.Whole().mesh().points, partition,
        this->Mesh.NeedsPieces(), options.postSmoothIterations, result.moved, evaluating) });
  }
  double seconds = watch.seconds();
  if (options.measureAll)
  {
    result.valid = validity.Ensure(result.moved, checking);
    if (result.valid.status != "Valid" && result.valid.status != "Inverted")
    {
      seconds = watch.seconds();
    }
    double minimum = 0;
    ranks.together(
      [&]
      {
        minimum = morph::MovableQuality(whole.mesh(), whole.orientation(), partition.free)
                    .fixedMinimum(result.moved);
      });
    minimum = ranks.minimum(minimum);
    result.boundaryMinimum =
      std::isfinite(minimum) ? minimum : std::numeric_limits<double>::quiet_NaN();
  }
  else
  {
    result.valid = { "Unmeasured", std::numeric_limits<double>::quiet_NaN() };
  }
  this->Results.SetNumber("EvaluateSeconds", ranks.maximum(seconds));
  if (options.measureAll && result.valid.status != "Inverted")
  {
    result.boundaryInverted = 0;
  }
  if (result.valid.error.empty())
  {
    warnOfDropped(whole, given, result.moved, monitor);
  }
  const morph::AttachedNodes attached =
    morph::distributed::attachedNodes(this->Mesh.Whole(), partition);
  attached.apply(result.moved);
  whole.copyToDoubles(result.moved);
  result.attached = static_cast<morph::Index>(attached.nodes().size());
  result.loose = attached.loose();
  result.iterations = report.iterations;
  morph::Index prescribed = 0;
  for (const morph::Index node : match.ids)
  {
    prescribed += whole.owns(node);
  }
  result.prescribed = ranks.sum(prescribed);
  result.unmatched = match.unmatched;
  return result;
}

std::pair<int, morph::Series::Step> RankMorphing::LastUntil(int number) const
{
  // Ranks have meshes of different sizes, and may keep different steps.
  while (true)
  {
    const auto kept = this->Steps.lastUntil(number);
    const auto least = static_cast<int>(this->Mesh.Ranks().minimum(morph::Index(kept.first)));
    if (this->Mesh.Ranks().sum(morph::Index(kept.first != least)) == 0)
    {
      return kept;
    }
    number = least;
  }
}

std::shared_ptr<const morph::StepResult> RankMorphing::MorphSeries(
  const Motion& motion, const MotionOptions& options, morph::Monitor& monitor)
{
  const auto& ranks = this->Mesh.Ranks();
  // Of a last step that is kept.
  this->Results.SetNumber("PrepareSeconds", 0);
  this->Results.SetNumber("EvaluateSeconds", 0);
  const auto boundaryOf = [&](int step)
  {
    vtkPointSet* boundary = nullptr;
    ranks.together([&] { boundary = motion.Boundary(step); });
    return boundary;
  };
  if (!motion.Varies)
  {
    morph::BoundaryTargets whole =
      this->Match(boundaryOf(motion.Step), 1, options, nullptr, monitor);
    const bool differs =
      whole.ids != this->WholeMotion.ids || whole.targets != this->WholeMotion.targets;
    if (ranks.sum(morph::Index(differs)) > 0)
    {
      this->Steps.clear();
      this->WholeMotion = std::move(whole);
    }
  }
  auto [step, result] = this->LastUntil(motion.Step);
  const double first = step;
  while (step < motion.Step)
  {
    ++step;
    morph::ProgressRange part(
      monitor, (step - 1 - first) / (motion.Step - first), (step - first) / (motion.Step - first));
    std::unique_ptr<DistributedMesh> from;
    if (result)
    {
      from = std::make_unique<DistributedMesh>(this->Mesh.Whole().at(result->moved));
    }
    result = morph::inStep(step,
      [&, step = step]
      {
        const morph::BoundaryTargets match =
          this->Match(boundaryOf(step), motion.Fraction(step), options, nullptr, part);
        return std::make_shared<const morph::StepResult>(
          this->Step(from.get(), match, options, part));
      });
    if (step < motion.Step && !result->valid.error.empty() && ranks.rank() == 0)
    {
      monitor.warn("Step " + std::to_string(step) + ": " + result->valid.error);
    }
    this->Steps.keep(step, result, options.stepMemoryLimit);
  }
  return result;
}

std::string RankMorphing::Run(
  const Task& task, const MotionOptions& options, morph::Monitor& monitor)
{
  this->Take(task.Grid, options, monitor);
  this->Mesh.SetFeatureLines(task.FeatureLines, monitor);
  const bool isFirst = this->Mesh.Ranks().rank() == 0;
  this->Mesh.WarnOfShared(monitor);
  if (options.measureAll)
  {
    const std::string note = morph::Validity::note(
      options.validity, this->Mesh.Whole().gatherCells(this->Mesh.Before(monitor).cells()));
    if (!note.empty() && isFirst)
    {
      monitor.warn(note);
    }
  }
  morph::ProgressRange morphing(monitor, 0.02, 0.9), writing(monitor, 0.9, 1);
  std::shared_ptr<const morph::StepResult> step;
  if (task.Series)
  {
    step = this->MorphSeries(*task.Series, options, morphing);
  }
  else
  {
    const morph::BoundaryTargets match =
      this->Match(task.Boundary, task.Fraction, options, nullptr, monitor);
    step = std::make_shared<morph::StepResult>(this->Step(nullptr, match, options, morphing));
  }
  if (!step->valid.warning.empty() && isFirst)
  {
    monitor.warn(step->valid.warning);
  }
  RankOutput::Write(this->Mesh, task, *step, this->Results, writing);
  return isFirst ? step->valid.error : "";
}

void RankMorphing::Transpose(vtkUnstructuredGrid* rest, vtkDataObject* boundary,
  vtkDataArray* gradient, const MotionOptions& options, vtkDoubleArray* boundaryGradient,
  morph::Monitor& monitor)
{
  this->Take(rest, options, monitor);
  const DistributedMesh& whole = this->Mesh.Whole();
  const auto& ranks = whole.ranks();
  morph::Points nodes = morph::Points::Zero(whole.mesh().numberOfNodes(), 3);
  ranks.together(
    [&]
    {
      if (rest->GetNumberOfPoints() > 0) // others have no arrays
      {
        nodes.topRows(whole.pieceNodes()) =
          Gradient::Require(ofOwned(gradient, whole), rest->GetNumberOfPoints());
      }
    });
  std::vector<RankMatch::Follower> followers;
  const morph::BoundaryTargets match = this->Match(boundary, 1, options, &followers, monitor);
  const morph::NodePartition partition =
    this->PartitionOf(whole.hanging().without(match.ids), monitor);
  morph::ProgressRange preparing(monitor, 0.05, 0.5), applying(monitor, 0.5, 1);
  const auto* linear =
    dynamic_cast<const morph::LinearMorpher*>(&this->Prepare(partition, options, preparing));
  if (!linear || !dynamic_cast<const morph::LinearMorpher*>(this->PreparedLike.get()))
  {
    throw morph::Error(options.method +
                       " is not a linear method, so it has no adjoint that is the same for all "
                       "motions. Use one that is, FEMWARP for instance.");
  }
  const std::string& status = this->Results.Text("MorphStatus");
  if ((options.postSmooth || status == "SubStepped" || status == "Repaired" ||
        status == "Partial") &&
      ranks.rank() == 0)
  {
    monitor.warn("`PostSmooth` or `Validity` changes the mesh after the method has made it; the "
                 "gradient is that of the method alone.");
  }
  morph::Points prescribed;
  morph::distributed::attachedNodes(whole, partition).applyTranspose(nodes);
  whole.halo().add(ranks, nodes);
  linear->applyTranspose(nodes, prescribed, applying);
  morph::Points all = morph::Points::Zero(nodes.rows(), 3); // what hangs moves by its ties
  all(partition.prescribed, morph::allColumns) = options.Matching.scaleFactor * prescribed;
  RankMatch::SendBack(ranks, match.ids, all(match.ids, morph::allColumns), followers,
    Input::RequireBoundary(boundary)->GetNumberOfPoints(), boundaryGradient);
}
}
