// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/Untangling.h"

#include "Boundary/FoldedFaces.h"
#include "Mesh/KRing.h"
#include "Quality/ScaledJacobian.h"
#include "Support/ProgressRange.h"

#include <algorithm>
#include <tuple>

namespace morph
{
namespace
{
constexpr int Rounds = 3;
constexpr int Rings = 5; // of cells
// Maximum numbers of stages with folds. The whole mesh needs few: then only single places are
// tangled. Cells near folded faces become valid soon or never.
constexpr int StagesOfAll = 12, StagesNear = 60, StagesWithFolds = 12;
constexpr int StagesAfter = 1; // of a mesh that is untangled but for its folds
}

Untangling::Untangling(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const NodePartition& partition, const BoundaryFaces& faces, const Classification& geometry,
  const Communicator& communicator)
  : mesh_(mesh)
  , orientation_(orientation)
  , faces_(faces)
  , geometry_(geometry)
  , communicator_(communicator)
  , free_(partition.free)
  , isFixed_(mesh.numberOfNodes(), 0)
{
  for (Index node : partition.prescribed)
  {
    this->isFixed_[node] = 1;
  }
}

bool Untangling::InvertedCounts::operator<(const InvertedCounts& other) const
{
  return std::tie(this->others, this->folds) < std::tie(other.others, other.folds);
}

std::vector<Index> Untangling::cellsBehind(const std::vector<Index>& folded) const
{
  std::vector<Index> cells(folded.size());
  std::transform(
    folded.begin(), folded.end(), cells.begin(), [&](Index f) { return this->faces_.cells[f]; });
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

Untangling::InvertedCounts Untangling::countInverted(
  const std::vector<Index>& cellsBehind, const Points& points, Monitor& monitor) const
{
  InvertedCounts result;
  // By corners: nodes between them follow last.
  for (Index c :
    invertedCells(measureCorners(this->mesh_, points, this->orientation_, {}, monitor)))
  {
    if (std::binary_search(cellsBehind.begin(), cellsBehind.end(), c))
    {
      result.onFolds.push_back(c);
    }
    else
    {
      ++result.others;
    }
  }
  result.others = this->communicator_.sum(result.others);
  result.folds = this->communicator_.sum(static_cast<Index>(result.onFolds.size()));
  return result;
}

bool Untangling::untanglePatch(const std::vector<Index>& cells, int rings,
  const TargetMatrices& targets, FoldoverContinuation& stages, int most, Points& points,
  Monitor& monitor) const
{
  MeshEnergy energy(this->mesh_,
    kRingOfCells(
      this->mesh_, nodeToCells(this->mesh_), this->free_, cells, rings, this->communicator_)
      .nodes,
    this->communicator_);
  energy.setTargets(targets);
  FoldoverContinuation near(energy);
  const bool done = near.untangle(points, monitor, most);
  stages.include(near.effort());
  return done;
}

bool Untangling::untangleAwayFromFolds(TargetMatrices& targets, MeshEnergy& energy,
  FoldoverContinuation& stages, Points& points, Monitor& monitor) const
{
  for (int round = 0; round <= Rounds; ++round)
  {
    const double part = 1. / (Rounds + 1);
    ProgressRange own(monitor, part * round, part * (round + 0.5));
    ProgressRange whole(monitor, part * (round + 0.5), part * (round + 1));
    const std::vector<Index> tangled = tangledCells(this->mesh_, points, targets);
    if (round > 0)
    {
      const Index excluded =
        excludeInvertedAtFixedNodes(this->mesh_, this->isFixed_, points, targets);
      if (this->communicator_.all(excluded == 0))
      {
        return false;
      }
    }
    if (this->untanglePatch(tangled, Rings, targets, stages, StagesNear, points, own))
    {
      energy.setTargets(targets);
      return stages.untangle(points, whole, StagesAfter);
    }
  }
  return false;
}

Untangling::Result Untangling::run(const std::function<TargetMatrices()>& targets,
  MeshEnergy& energy, FoldoverContinuation& stages, Points& points, Monitor& monitor) const
{
  const std::vector<Index> folded = foldedFaces(this->mesh_.points, points, this->faces_,
                             this->geometry_, this->isFixed_),
                           cellsBehind = this->cellsBehind(folded);
  Points besides;
  ProgressRange first(monitor, 0, 0.5), second(monitor, 0.5, 0.8), third(monitor, 0.8, 0.9),
    last(monitor, 0.9, 1);
  if (this->communicator_.all(folded.empty()))
  {
    energy.setTargets(targets());
    if (stages.untangle(points, first))
    {
      return { true, {} };
    }
    besides = points;
    TargetMatrices others = targets();
    this->untangleAwayFromFolds(others, energy, stages, besides, second);
  }
  else
  {
    besides = points;
    TargetMatrices others = targets();
    excludeOnFoldedFaces(this->mesh_, this->faces_, folded, others);
    energy.setTargets(others);
    if (!stages.untangle(besides, first, StagesOfAll))
    {
      this->untangleAwayFromFolds(others, energy, stages, besides, second);
    }
    points = besides;
    others = targets();
    if (this->untanglePatch(cellsBehind, Rings, others, stages, StagesWithFolds, points, third))
    {
      energy.setTargets(others);
      if (stages.untangle(points, last))
      {
        return { true, {} };
      }
    }
  }
  InvertedCounts all = this->countInverted(cellsBehind, points, monitor);
  const InvertedCounts fewer = this->countInverted(cellsBehind, besides, monitor);
  if (!(all < fewer))
  {
    points = besides;
    all = fewer;
  }
  return { false, all.onFolds };
}
}
