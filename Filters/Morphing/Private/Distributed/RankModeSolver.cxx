// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/AttachedNodes.h"
#include "Distributed/DistributedMesh.h"
#include "Distributed/Methods.h"
#include "Distributed/Quality.h"
#include "Distributed/RankCommunicator.h"
#include "Mesh/NodePartition.h"
#include "Private/Data/Quality.h"
#include "Private/Distributed/OnRanks.h"
#include "Private/Distributed/RankCrossings.h"
#include "Private/Distributed/RankMatch.h"
#include "Private/Distributed/RankMesh.h"
#include "Private/Distributed/RankOutput.h"

#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <utility>

namespace morph::filters::OnRanks
{
namespace
{
class RankModeSolver : public ModeSolver
{
public:
  bool Take(
    vtkUnstructuredGrid* grid, const CreateMorpher& create, morph::Monitor& monitor) override
  {
    const int layers = morph::distributed::makeMethod(create())->layers();
    const bool isTaken = this->Pieces.Take(grid, layers, GridMesh::UnknownCells::Refuse, monitor);
    if (isTaken)
    {
      this->Method.reset();
      this->Hanging = {};
    }
    this->Pieces.RequireVolumeCells();
    return isTaken;
  }
  void SetFeatureLines(bool on, morph::Monitor& monitor) override
  {
    this->Pieces.SetFeatureLines(on, monitor);
  }
  const morph::Mesh& Mesh() const override { return this->Pieces.Whole().mesh(); }
  morph::Index GridNodes() const override { return this->Pieces.Whole().pieceNodes(); }
  const std::vector<std::int8_t>& Orientation() const override
  {
    return this->Pieces.Whole().orientation();
  }
  double Size() const override { return this->Pieces.Whole().size(); }
  morph::Index MirroredBodies() const override { return this->Pieces.Whole().mirroredBodies(); }
  void ReportMesh(morph::Monitor& monitor) const override { this->Pieces.WarnOfShared(monitor); }
  const morph::InvertedBefore& Before(morph::Monitor& monitor) const override
  {
    return this->Pieces.Before(monitor);
  }
  bool Owns(morph::Index node) const override { return this->Pieces.Whole().owns(node); }
  std::int64_t NodeId(morph::Index node) const override
  {
    return this->Pieces.Whole().nodeId(node);
  }
  morph::BoundaryTargets Match(
    vtkPointSet* boundary, const BoundaryMatch::Options& options) const override
  {
    return RankMatch::Match(boundary, this->Pieces.Whole(), options);
  }
  void Prepare(std::unique_ptr<morph::LinearMorpher> method,
    const std::vector<morph::Index>& prescribed, morph::Monitor& monitor) override
  {
    this->Method.reset();
    const morph::distributed::DistributedMesh& whole = this->Pieces.Whole();
    morph::NodePartition partition;
    whole.ranks().together(
      [&]
      {
        partition =
          morph::partitionNodes(whole.mesh(), whole.hanging(), whole.hanging().without(prescribed));
      });
    auto prepared = morph::distributed::makeMethod(std::move(method), this->Pieces.NeedsPieces());
    prepared->prepare(whole.mesh(), partition, monitor,
      std::make_shared<morph::distributed::RankCommunicator>(whole));
    this->Hanging = morph::distributed::attachedNodes(whole, partition);
    this->Method.reset(dynamic_cast<morph::LinearMorpher*>(prepared.release()));
    this->Prescribed = prescribed;
  }
  std::vector<morph::Points> Basis(const std::vector<morph::Points>& displacements,
    std::vector<morph::EvaluateReport>& reports, morph::Monitor& monitor) const override
  {
    std::vector<morph::Points> given;
    for (const morph::Points& displacement : displacements)
    {
      morph::Points all = morph::Points::Zero(this->Mesh().numberOfNodes(), 3);
      all(this->Prescribed, morph::allColumns) = displacement;
      given.emplace_back(all(this->Method->partition().prescribed, morph::allColumns));
    }
    std::vector<morph::Points> fields = this->Method->basis(given, monitor, &reports);
    for (morph::Points& field : fields)
    {
      this->Pieces.Whole().copyToDoubles(field);
    }
    return fields;
  }
  const morph::AttachedNodes& Attached() const override { return this->Hanging; }
  Measured Write(vtkUnstructuredGrid* grid, const morph::Points& moved, int precision, bool all,
    const MorphOutput::Outputs& outputs, morph::Monitor& monitor) const override
  {
    Measured result;
    const morph::Quality mine =
      RankOutput::WritePoints(this->Pieces, grid, moved, precision, all, outputs.Mesh, monitor);
    if (all)
    {
      const auto& whole = this->Pieces.Whole();
      result.Whole = morph::distributed::reduce(whole.ranks(), mine, whole.cellIds());
      Quality::Write(mine, outputs.Mesh);
      result.Judged = RankOutput::Judge(this->Pieces, mine, outputs.Mesh, monitor);
    }
    result.SurfaceInverted = RankOutput::WriteParts(this->Pieces, mine, all, outputs);
    if (all)
    {
      result.Crossing = RankCrossings::Find(this->Pieces, outputs.Mesh, monitor);
      this->Pieces.Ranks().together(
        [&] { this->Pieces.Surface().MarkCrossing(result.Crossing.Own, outputs.Surface); });
    }
    return result;
  }
  bool Crosses(const morph::Points& moved, morph::Monitor& monitor) const override
  {
    return RankCrossings::Any(this->Pieces, moved, monitor);
  }
  void WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* surface) const override
  {
    this->Pieces.WriteUndeformedSurface(grid, surface);
  }

private:
  RankMesh Pieces;
  std::unique_ptr<morph::LinearMorpher> Method; ///< prepared, or null
  std::vector<morph::Index> Prescribed;         ///< by the caller
  morph::AttachedNodes Hanging;                 ///< of Method
};
}

std::unique_ptr<ModeSolver> MakeModeSolver()
{
  return std::make_unique<RankModeSolver>();
}
}
