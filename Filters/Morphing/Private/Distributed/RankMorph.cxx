// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/DistributedMesh.h"
#include "Morpher/SiteMethod.h"
#include "Private/Data/Gradient.h"
#include "Private/Data/Results.h"
#include "Private/Distributed/OnRanks.h"
#include "Private/Distributed/RankMatch.h"
#include "Private/Distributed/RankMesh.h"
#include "Private/Distributed/RankOutput.h"
#include "Private/Pipeline/Input.h"
#include "Session/Session.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <string>
#include <utility>

namespace morph::filters::OnRanks
{
namespace
{
using morph::distributed::DistributedMesh;

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

class RankMorphing : public Morphing
{
public:
  RankMorphing(filters::Results& results, morph::Session& session)
    : Results(results)
    , Session(session)
  {
  }
  std::string Run(const Task& task, const MotionOptions& options, morph::Monitor& monitor) override;
  void WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* surface) const override
  {
    this->Mesh.WriteUndeformedSurface(grid, surface);
  }
  void Transpose(vtkUnstructuredGrid* rest, vtkDataObject* boundary, vtkDataArray* gradient,
    const MotionOptions& options, vtkDoubleArray* boundaryGradient,
    morph::Monitor& monitor) override;

private:
  filters::Results& Results;
  morph::Session& Session;
  RankMesh Mesh;

  /// Takes the mesh that the method works on.
  void Take(vtkUnstructuredGrid* grid, const MotionOptions& options, morph::Monitor& monitor);
  morph::BoundaryTargets Match(vtkDataObject* boundary, double fraction,
    const MotionOptions& options, std::vector<RankMatch::Follower>* followers,
    morph::Monitor& monitor) const;
  std::shared_ptr<const morph::StepResult> MorphSeries(
    const Motion& motion, const MotionOptions& options, morph::Monitor& monitor);
};
}

std::unique_ptr<Morphing> MakeMorphing(Results& results, morph::Session& session)
{
  return std::make_unique<RankMorphing>(results, session);
}

void RankMorphing::Take(
  vtkUnstructuredGrid* grid, const MotionOptions& options, morph::Monitor& monitor)
{
  const std::unique_ptr<morph::Morpher> sample = morph::onProcesses(options.createMorpher());
  if (!sample)
  {
    throw morph::Error(options.method +
                       " needs one MPI rank, and the mesh is distributed over several. Run on one, "
                       "or use another method, Morph Inversion Free for instance.");
  }
  this->Mesh.Take(grid, sample->layers(), GridMesh::UnknownCells::Refuse, monitor);
  this->Mesh.RequireVolumeCells();
  this->Session.setMesh(this->Mesh.Rest());
  this->Results.SetInteger("MirroredBodies", this->Session.mesh().mirroredBodies());
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

std::shared_ptr<const morph::StepResult> RankMorphing::MorphSeries(
  const Motion& motion, const MotionOptions& options, morph::Monitor& monitor)
{
  const auto boundaryOf = [&](int step)
  {
    vtkPointSet* boundary = nullptr;
    this->Mesh.Ranks().together([&] { boundary = motion.Boundary(step); });
    return boundary;
  };
  morph::BoundaryTargets whole;
  if (!motion.Varies)
  {
    whole = this->Match(boundaryOf(motion.Step), 1, options, nullptr, monitor);
  }
  return this->Session.morphSeries(
    motion.Step,
    [&](int step)
    {
      vtkPointSet* boundary = boundaryOf(step);
      return morph::inStep(step,
        [&] { return this->Match(boundary, motion.Fraction(step), options, nullptr, monitor); });
    },
    motion.Varies ? nullptr : &whole, options, monitor);
}

std::string RankMorphing::Run(
  const Task& task, const MotionOptions& options, morph::Monitor& monitor)
{
  this->Take(task.Grid, options, monitor);
  this->Mesh.SetFeatureLines(task.FeatureLines, monitor);
  this->Session.reportMesh(options, monitor);
  const bool isFirst = this->Mesh.Ranks().rank() == 0;
  morph::ProgressRange morphing(monitor, 0.02, 0.9), writing(monitor, 0.9, 1);
  const std::shared_ptr<const morph::StepResult> step =
    task.Series
      ? this->MorphSeries(*task.Series, options, morphing)
      : this->Session.morph(
          this->Match(task.Boundary, task.Fraction, options, nullptr, monitor), options, morphing);
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
  const morph::Points prescribed =
    this->Session.transpose(match.ids, std::move(nodes), options, monitor);
  const std::string& status = this->Results.Text("MorphStatus");
  if ((options.postSmooth || status == "SubStepped" || status == "Repaired" ||
        status == "Partial") &&
      ranks.rank() == 0)
  {
    monitor.warn("`PostSmooth` or `Validity` changes the mesh after the method has made it; the "
                 "gradient is that of the method alone.");
  }
  RankMatch::SendBack(ranks, match.ids, options.Matching.scaleFactor * prescribed, followers,
    Input::RequireBoundary(boundary)->GetNumberOfPoints(), boundaryGradient);
}
}
