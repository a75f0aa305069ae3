// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/AttachedNodes.h"
#include "Distributed/DistributedMesh.h"
#include "Distributed/InversionFree.h"
#include "Distributed/Method.h"
#include "Distributed/Methods.h"
#include "Distributed/PolyhedralMethod.h"
#include "Mesh/NodePartition.h"
#include "Private/Data/DataCheck.h"
#include "Private/Data/Gradient.h"
#include "Private/Distributed/OnRanks.h"
#include "Private/Distributed/RankMatch.h"
#include "Private/Distributed/RankMesh.h"
#include "Private/Distributed/RankOutput.h"
#include "Private/Distributed/RankPolyhedra.h"
#include "Private/Distributed/RankQuality.h"
#include "Private/Distributed/RankValidity.h"
#include "Private/Morph/PolyhedralRepair.h"
#include "Private/Morph/Series.h"
#include "Private/Pipeline/Input.h"
#include "Quality/MovableQuality.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"
#include "vtkMorphAlgorithm.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace morph::filters::OnRanks
{
namespace
{
using Clock = std::chrono::steady_clock;
using morph::distributed::DistributedMesh;
using morph::distributed::Method;

double secondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

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

bool isInversionFree(const Method& method)
{
  const auto* onPieces = dynamic_cast<const morph::distributed::PolyhedralMethod*>(&method);
  return dynamic_cast<const morph::distributed::InversionFree*>(
    onPieces ? &onPieces->method() : &method);
}
}

class Morphing::Internals
{
public:
  explicit Internals(filters::Results& results)
    : Results(results)
  {
  }

  filters::Results& Results;
  RankMesh Mesh;
  Series Steps;
  BoundaryMatch::Result WholeMotion; ///< for Steps, of a boundary that does not vary

  /// Takes the mesh that the method works on, and reports mirrored bodies.
  void Take(vtkUnstructuredGrid* grid, const Session::Options& options, morph::Monitor& monitor);
  BoundaryMatch::Result Match(vtkDataObject* boundary, double fraction,
    const Session::Options& options, std::vector<RankMatch::Follower>* followers,
    morph::Monitor& monitor) const;
  /// Prepares the method for the undeformed mesh, unless it is prepared.
  Method& Prepare(const morph::NodePartition& partition, const Session::Options& options,
    morph::Monitor& monitor);
  /// `from`: null for the undeformed mesh.
  StepResult Step(const DistributedMesh* from, const BoundaryMatch::Result& match,
    const Session::Options& options, morph::Monitor& monitor);
  std::shared_ptr<const StepResult> MorphSeries(
    const Session::Motion& motion, const Session::Options& options, morph::Monitor& monitor);

private:
  /// The serial method with its options.
  std::unique_ptr<morph::Morpher> Settings(const Session::Options& options) const;
  std::unique_ptr<Method> Make(const Session::Options& options) const;
  morph::NodePartition PartitionOf(
    const std::vector<morph::Index>& prescribed, morph::Monitor& monitor) const;
  /// The last step until `number` that all ranks keep.
  std::pair<int, Series::Step> LastUntil(int number) const;

  std::unique_ptr<Method> Prepared;
  std::vector<morph::Index> PreparedFor; ///< the prescribed nodes of Prepared
  std::unique_ptr<const morph::Morpher> PreparedLike;
};

Morphing::Morphing(Results& results)
  : Own(new Internals(results))
{
}

Morphing::~Morphing() = default;

void Morphing::CheckSeries(vtkMTimeType options, bool varies, vtkMTimeType boundary)
{
  this->Own->Steps.Check(options, varies, boundary);
}

void Morphing::WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* surface) const
{
  this->Own->Mesh.WriteUndeformedSurface(grid, surface);
}

void Morphing::Internals::Take(
  vtkUnstructuredGrid* grid, const Session::Options& options, morph::Monitor& monitor)
{
  const std::unique_ptr<Method> sample = morph::distributed::makeMethod(options.CreateMorpher());
  if (!sample)
  {
    throw morph::Error(options.Method +
                       " needs one MPI rank, and the mesh is distributed over several. Run on one, "
                       "or use another method, Morph Inversion Free for instance.");
  }
  if (this->Mesh.Take(grid, sample->layers(), GridMesh::UnknownCells::Refuse, monitor))
  {
    this->Prepared.reset();
    this->Steps.Clear();
  }
  this->Mesh.RequireVolumeCells();
  const auto& ranks = this->Mesh.Ranks();
  const morph::Index mirrored = this->Mesh.Whole().mirroredBodies();
  this->Results.SetInteger("MirroredBodies", mirrored);
  if (mirrored > 0 && ranks.rank() == 0)
  {
    monitor.warn(std::to_string(mirrored) +
                 " bodies of the mesh are mirrored: in VTK's order of nodes all their cells of a "
                 "type are inverted. They are morphed and measured as if they were not. Reverse "
                 "their order of nodes if a solver expects VTK's.");
  }
}

BoundaryMatch::Result Morphing::Internals::Match(vtkDataObject* boundary, double fraction,
  const Session::Options& options, std::vector<RankMatch::Follower>* followers,
  morph::Monitor& monitor) const
{
  const auto& ranks = this->Mesh.Ranks();
  vtkPointSet* displaced = nullptr;
  ranks.together([&] { displaced = Input::RequireBoundary(boundary); });
  BoundaryMatch::Options matching = options.Matching;
  matching.ScaleFactor *= fraction;
  BoundaryMatch::Result match =
    RankMatch::Match(displaced, this->Mesh.Whole(), matching, followers);
  for (const std::string& warning : match.Warnings)
  {
    if (ranks.rank() == 0)
    {
      monitor.warn(warning);
    }
  }
  if (ranks.rank() == 0)
  {
    BoundaryMatch::WarnIfNothingStays(match, monitor);
  }
  return match;
}

std::unique_ptr<morph::Morpher> Morphing::Internals::Settings(const Session::Options& options) const
{
  std::unique_ptr<morph::Morpher> settings = options.CreateMorpher();
  if (this->Mesh.HasPolyhedra())
  {
    PolyhedralRepair::Adapt(*settings);
  }
  return settings;
}

std::unique_ptr<Method> Morphing::Internals::Make(const Session::Options& options) const
{
  std::unique_ptr<Method> method = morph::distributed::makeMethod(this->Settings(options));
  if (this->Mesh.HasPolyhedra())
  {
    method = std::make_unique<morph::distributed::PolyhedralMethod>(std::move(method));
  }
  return method;
}

morph::NodePartition Morphing::Internals::PartitionOf(
  const std::vector<morph::Index>& prescribed, morph::Monitor& monitor) const
{
  morph::NodePartition partition;
  this->Mesh.Ranks().together(
    [&]
    {
      monitor.check();
      partition = morph::partitionNodes(this->Mesh.Whole().mesh(), prescribed);
    });
  return partition;
}

Method& Morphing::Internals::Prepare(
  const morph::NodePartition& partition, const Session::Options& options, morph::Monitor& monitor)
{
  const auto& ranks = this->Mesh.Ranks();
  this->Results.SetNumber("PrepareSeconds", 0);
  std::unique_ptr<morph::Morpher> settings = this->Settings(options);
  const bool same = this->Prepared && this->PreparedFor == partition.prescribed &&
                    this->PreparedLike->preparesLike(*settings);
  if (ranks.sum(morph::Index(!same)) > 0)
  {
    const auto start = Clock::now();
    this->Prepared.reset();
    std::unique_ptr<Method> method = this->Make(options);
    method->prepare(this->Mesh.Whole(), partition, monitor);
    this->Prepared = std::move(method);
    this->PreparedFor = partition.prescribed;
    this->Results.SetInteger("PrepareCount", this->Results.Integer("PrepareCount") + 1);
    this->Results.SetNumber("PrepareSeconds", ranks.maximum(secondsSince(start)));
  }
  this->Prepared->takeEvaluateOptions(*settings);
  this->PreparedLike = std::move(settings);
  return *this->Prepared;
}

StepResult Morphing::Internals::Step(const DistributedMesh* from,
  const BoundaryMatch::Result& match, const Session::Options& options, morph::Monitor& monitor)
{
  const DistributedMesh& whole = from ? *from : this->Mesh.Whole();
  const auto& ranks = whole.ranks();
  const morph::NodePartition partition = this->PartitionOf(match.Ids, monitor);
  static const morph::InvertedBefore none{};
  const morph::InvertedBefore& before =
    options.MeasureAll ? Validity::BeforeFor(options.Validity, this->Mesh.Before(monitor)) : none;
  const RankValidity validity{ options, whole, this->Mesh.Whole().mesh().points, before, partition,
    match.Targets, this->Mesh.HasPolyhedra(), [&] { return this->Make(options); } };
  StepResult result;
  result.BoundaryInverted = validity.RequireFeasible();

  morph::ProgressRange preparing(monitor, 0.05, 0.5), evaluating(monitor, 0.5, 0.8),
    checking(monitor, 0.8, 1);
  std::unique_ptr<Method> ofStep;
  if (from)
  {
    ofStep = this->Make(options);
    ofStep->setReference(this->Mesh.Whole().mesh().points);
    const auto begin = Clock::now();
    ofStep->prepare(whole, partition, preparing);
    this->Results.SetInteger("PrepareCount", this->Results.Integer("PrepareCount") + 1);
    this->Results.SetNumber("PrepareSeconds", ranks.maximum(secondsSince(begin)));
  }
  const Method& method = from ? *ofStep : this->Prepare(partition, options, preparing);
  const auto start = Clock::now();
  const morph::EvaluateReport report = method.evaluate(match.Targets, result.Moved, evaluating);
  const morph::Index followers =
    ranks.sum(static_cast<morph::Index>(partition.higherOrderNodes.size()));
  if (isInversionFree(method) && (followers > 0 || this->Mesh.HasPolyhedra()))
  {
    // The method has moved corners of cells or pieces; nodes between them have followed.
    RankPolyhedra::Repair(whole, this->Mesh.Whole().mesh().points, partition,
      this->Mesh.HasPolyhedra(), {}, result.Moved, evaluating);
  }
  result.Statistics = report.statistics;
  const std::vector<morph::Index> wrong = DataCheck::Immoderate(result.Moved);
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
  if (options.PostSmooth)
  {
    result.Statistics.push_back({ "PostSmoothSteps",
      RankPolyhedra::Smooth(whole, this->Mesh.Whole().mesh().points, partition,
        this->Mesh.HasPolyhedra(), options.PostSmoothIterations, result.Moved, evaluating) });
  }
  double seconds = secondsSince(start);
  if (options.MeasureAll)
  {
    result.Valid = validity.Ensure(result.Moved, checking);
    if (result.Valid.Status != "Valid" && result.Valid.Status != "Inverted")
    {
      seconds = secondsSince(start);
    }
    double minimum = 0;
    ranks.together(
      [&]
      {
        minimum = morph::MovableQuality(whole.mesh(), whole.orientation(), partition.free)
                    .fixedMinimum(result.Moved);
      });
    minimum = ranks.minimum(minimum);
    result.BoundaryMinimum =
      std::isfinite(minimum) ? minimum : std::numeric_limits<double>::quiet_NaN();
  }
  else
  {
    result.Valid.Status = "Unmeasured";
    result.Valid.LargestValidStep = std::numeric_limits<double>::quiet_NaN();
  }
  this->Results.SetNumber("EvaluateSeconds", ranks.maximum(seconds));
  if (options.MeasureAll && result.Valid.Status != "Inverted")
  {
    result.BoundaryInverted = 0;
  }
  const morph::AttachedNodes attached =
    morph::distributed::attachedNodes(this->Mesh.Whole(), partition);
  attached.apply(result.Moved);
  whole.copyToDoubles(result.Moved);
  result.Attached = static_cast<morph::Index>(attached.nodes().size());
  result.Loose = attached.loose();
  result.Iterations = report.iterations;
  morph::Index prescribed = 0;
  for (const morph::Index node : match.Ids)
  {
    prescribed += whole.owns(node);
  }
  result.Prescribed = ranks.sum(prescribed);
  result.Unmatched = match.Unmatched;
  return result;
}

std::pair<int, Series::Step> Morphing::Internals::LastUntil(int number) const
{
  // Ranks have meshes of different sizes, and may keep different steps.
  while (true)
  {
    const auto kept = this->Steps.LastUntil(number);
    const auto least = static_cast<int>(this->Mesh.Ranks().minimum(morph::Index(kept.first)));
    if (this->Mesh.Ranks().sum(morph::Index(kept.first != least)) == 0)
    {
      return kept;
    }
    number = least;
  }
}

std::shared_ptr<const StepResult> Morphing::Internals::MorphSeries(
  const Session::Motion& motion, const Session::Options& options, morph::Monitor& monitor)
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
    BoundaryMatch::Result whole =
      this->Match(boundaryOf(motion.Step), 1, options, nullptr, monitor);
    const bool differs =
      whole.Ids != this->WholeMotion.Ids || whole.Targets != this->WholeMotion.Targets;
    if (ranks.sum(morph::Index(differs)) > 0)
    {
      this->Steps.Clear();
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
      from = std::make_unique<DistributedMesh>(this->Mesh.Whole().at(result->Moved));
    }
    try
    {
      const BoundaryMatch::Result match =
        this->Match(boundaryOf(step), motion.Fraction(step), options, nullptr, part);
      result = std::make_shared<StepResult>(this->Step(from.get(), match, options, part));
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
    if (step < motion.Step && !result->Valid.Error.empty() && ranks.rank() == 0)
    {
      monitor.warn("Step " + std::to_string(step) + ": " + result->Valid.Error);
    }
    this->Steps.Keep(step, result, options.StepMemoryLimit);
  }
  return result;
}

std::string Morphing::Run(
  const Task& task, const Session::Options& options, morph::Monitor& monitor)
{
  Internals& own = *this->Own;
  own.Take(task.Grid, options, monitor);
  own.Mesh.SetFeatureLines(task.FeatureLines, monitor);
  const bool isFirst = own.Mesh.Ranks().rank() == 0;
  own.Mesh.WarnOfShared(monitor);
  if (options.MeasureAll)
  {
    const std::string note = Validity::Note(
      options.Validity, RankQuality::GatherIds(own.Mesh.Whole(), own.Mesh.Before(monitor).cells()));
    if (!note.empty() && isFirst)
    {
      monitor.warn(note);
    }
  }
  morph::ProgressRange morphing(monitor, 0.02, 0.9), writing(monitor, 0.9, 1);
  std::shared_ptr<const StepResult> step;
  if (task.Series)
  {
    step = own.MorphSeries(*task.Series, options, morphing);
  }
  else
  {
    const BoundaryMatch::Result match =
      own.Match(task.Boundary, task.Fraction, options, nullptr, monitor);
    step = std::make_shared<StepResult>(own.Step(nullptr, match, options, morphing));
  }
  if (!step->Valid.Warning.empty() && isFirst)
  {
    monitor.warn(step->Valid.Warning);
  }
  RankOutput::Write(own.Mesh, task, *step, own.Results, writing);
  return isFirst ? step->Valid.Error : "";
}

void Morphing::Transpose(vtkUnstructuredGrid* rest, vtkDataObject* boundary, vtkDataArray* gradient,
  const Session::Options& options, vtkDoubleArray* boundaryGradient, morph::Monitor& monitor)
{
  Internals& own = *this->Own;
  own.Take(rest, options, monitor);
  const DistributedMesh& whole = own.Mesh.Whole();
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
  const BoundaryMatch::Result match = own.Match(boundary, 1, options, &followers, monitor);
  morph::NodePartition partition;
  ranks.together([&] { partition = morph::partitionNodes(whole.mesh(), match.Ids); });
  morph::ProgressRange preparing(monitor, 0.05, 0.5), applying(monitor, 0.5, 1);
  const Method& method = own.Prepare(partition, options, preparing);
  const std::string& status = own.Results.Text("MorphStatus");
  if ((options.PostSmooth || status == "SubStepped" || status == "Repaired" ||
        status == "Partial") &&
      ranks.rank() == 0)
  {
    monitor.warn("PostSmooth or Validity changes the mesh after the method has made it; the "
                 "gradient is that of the method alone.");
  }
  morph::Points prescribed;
  morph::distributed::attachedNodes(whole, partition).applyTranspose(nodes);
  whole.halo().add(ranks, nodes);
  method.applyTranspose(nodes, prescribed, applying);
  prescribed *= options.Matching.ScaleFactor;
  RankMatch::SendBack(ranks, match.Ids, prescribed, followers,
    Input::RequireBoundary(boundary)->GetNumberOfPoints(), boundaryGradient);
}
}
