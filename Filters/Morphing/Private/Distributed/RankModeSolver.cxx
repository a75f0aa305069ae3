// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/DistributedMesh.h"
#include "Distributed/Quality.h"
#include "Morpher/SiteMethod.h"
#include "Private/Data/Quality.h"
#include "Private/Distributed/OnRanks.h"
#include "Private/Distributed/RankCrossings.h"
#include "Private/Distributed/RankMatch.h"
#include "Private/Distributed/RankMesh.h"
#include "Private/Distributed/RankOutput.h"

#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

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
    const int layers = morph::onProcesses(create())->layers();
    const bool isTaken = this->Pieces.Take(grid, layers, GridMesh::UnknownCells::Refuse, monitor);
    if (isTaken)
    {
      this->Forget();
    }
    this->Pieces.RequireVolumeCells();
    this->Pieces.Rest(); // by all
    return isTaken;
  }
  void SetFeatureLines(bool on, morph::Monitor& monitor) override
  {
    this->Pieces.SetFeatureLines(on, monitor);
  }
  const morph::UndeformedMesh& Rest() const override { return *this->Pieces.Rest(); }
  morph::Index GridNodes() const override { return this->Pieces.Whole().pieceNodes(); }
  bool Owns(morph::Index node) const override { return this->Pieces.Whole().owns(node); }
  morph::BoundaryTargets Match(
    vtkPointSet* boundary, const BoundaryMatch::Options& options) const override
  {
    return RankMatch::Match(boundary, this->Pieces.Whole(), options);
  }
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
};
}

std::unique_ptr<ModeSolver> MakeModeSolver()
{
  return std::make_unique<RankModeSolver>();
}
}
