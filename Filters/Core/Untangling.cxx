// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling.h"

#include "FoldedFaces.h"
#include "SubSteps.h"

#include <algorithm>
#include <tuple>

namespace morph
{
namespace
{
constexpr int Rounds = 3;
constexpr int StagesWithFolds = 12; // the cells on folded faces come right soon or not at all
}

Untangling::Untangling(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const NodePartition& partition, const BoundaryFaces& faces, const Classification& geometry)
  : mesh_(mesh)
  , orientation_(orientation)
  , faces_(faces)
  , geometry_(geometry)
  , isFixed_(mesh.numberOfNodes(), 0)
{
  for (Index node : partition.prescribed)
  {
    this->isFixed_[node] = 1;
  }
}

bool Untangling::Tangle::operator<(const Tangle& other) const
{
  return std::make_tuple(this->others, this->onFolds.size()) <
         std::make_tuple(other.others, other.onFolds.size());
}

Untangling::Tangle Untangling::tangle(
  const std::vector<Index>& folded, const Points& points, Monitor& monitor) const
{
  std::vector<Index> behind(folded.size());
  std::transform(
    folded.begin(), folded.end(), behind.begin(), [&](Index f) { return this->faces_.cells[f]; });
  std::sort(behind.begin(), behind.end());
  Tangle result;
  for (Index c : invertedCells(this->mesh_, points, this->orientation_, monitor))
  {
    if (std::binary_search(behind.begin(), behind.end(), c))
    {
      result.onFolds.push_back(c);
    }
    else
    {
      ++result.others;
    }
  }
  return result;
}

std::vector<Index> Untangling::foldedBoundary(const Points& points) const
{
  std::vector<Index> folded =
    foldedFaces(this->mesh_.points, points, this->faces_, this->geometry_);
  const Index* nodes = this->faces_.connectivity.data();
  const auto end = std::remove_if(folded.begin(), folded.end(),
    [&](Index f)
    {
      return !std::all_of(nodes + this->faces_.offsets[f], nodes + this->faces_.offsets[f + 1],
        [&](Index node) { return this->isFixed_[node] != 0; });
    });
  folded.erase(end, folded.end());
  return folded;
}

bool Untangling::runBesides(TargetShapes targets, MeshEnergy& energy, FoldoverStages& stages,
  Points& points, Monitor& monitor) const
{
  for (int round = 0; round < Rounds; ++round)
  {
    if (dropFolded(this->mesh_, this->isFixed_, points, targets) == 0)
    {
      break;
    }
    energy.setTargets(targets);
    if (stages.untangle(points, monitor))
    {
      return true;
    }
  }
  return false;
}

Untangling::Result Untangling::run(const TargetShapes& targets, MeshEnergy& energy,
  FoldoverStages& stages, Points& points, Monitor& monitor) const
{
  const std::vector<Index> folded = this->foldedBoundary(points);
  Points besides = points;
  if (folded.empty())
  {
    energy.setTargets(targets);
    if (stages.untangle(points, monitor))
    {
      return { true, {} };
    }
    besides = points;
    this->runBesides(targets, energy, stages, besides, monitor);
  }
  else
  {
    TargetShapes others = targets;
    dropBehind(this->mesh_, this->faces_, folded, others);
    energy.setTargets(others);
    if (!stages.untangle(besides, monitor))
    {
      this->runBesides(others, energy, stages, besides, monitor);
    }
    points = besides;
    energy.setTargets(targets);
    if (stages.untangle(points, monitor, StagesWithFolds))
    {
      return { true, {} };
    }
  }
  Tangle all = this->tangle(folded, points, monitor);
  const Tangle fewer = this->tangle(folded, besides, monitor);
  if (!(all < fewer))
  {
    points = besides;
    all = fewer;
  }
  return { false, all.onFolds };
}
}
