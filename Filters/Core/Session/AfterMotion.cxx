// SPDX-License-Identifier: BSD-3-Clause
#include "Session/AfterMotion.h"

#include "Mesh/HigherOrderNodes.h"
#include "Mesh/OwnCells.h"
#include "Mesh/PolyhedronPieces.h"
#include "Mesh/Topology.h"
#include "Quality/BoundaryDetermined.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Monitor.h"
#include "Untangling/InversionFree.h"
#include "Untangling/SmoothMesh.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace morph
{
namespace
{
/// Returns the cells, ascending, that no position of the free nodes makes valid.
std::vector<Index> cellsThatStay(const CellPieces& pieces, const NodePartition& partition,
  const Points& points, const Communicator& processes, Monitor& monitor)
{
  const Mesh& mesh = pieces.mesh();
  const std::vector<std::int8_t> signs =
    cellSigns(mesh, connectedComponents(mesh, monitor, processes), monitor, processes);
  const auto cellOf = [&](Index piece) { return pieces.cellOf(piece); };
  std::vector<Index> cells;
  for (const Index piece : boundaryDeterminedInversions(mesh, partition, signs, points))
  {
    cells.push_back(cellOf(piece));
  }
  for (const NodeWithoutPlace& node : nodesWithoutPlace(mesh, partition, signs, points, monitor))
  {
    // One of several cells stays inverted, but not each.
    const Index cell = cellOf(node.cells.front());
    if (std::all_of(
          node.cells.begin(), node.cells.end(), [&](Index piece) { return cellOf(piece) == cell; }))
    {
      cells.push_back(cell);
    }
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

/// Places what the pieces of cells do not have where their nodes have gone, from `before` to
/// `after`: nodes between corners, and then those that hang.
void placeOthers(const Mesh& mesh, const HangingNodes& hanging, const NodePartition& partition,
  const Communicator& processes, const Points& before, Points& after)
{
  const std::unique_ptr<CopiedRows> copies = processes.rows();
  if (!hanging.empty() && !partition.higherOrderNodes.empty())
  {
    HigherOrderNodes followers;
    followers.prepare(mesh, partition);
    followers.carry(before, after);
  }
  copies->update(after);
  hanging.place(mesh.points, after);
  copies->update(after);
}

SmoothingReport smoothOwnCells(const Mesh& rest, const std::vector<std::int8_t>& orientation,
  const NodePartition& partition, const SmoothingOptions& options, Points& moved,
  const Communicator& processes, Monitor& monitor)
{
  const OwnCells own(rest, partition, orientation, processes);
  Points points = own.take(moved);
  const SmoothingReport report = smoothMesh(
    own.mesh(), own.orientation(), own.partition(), options, points, monitor, own.communicator());
  moved(own.nodes(), allColumns) = points;
  processes.rows()->update(moved);
  return report;
}
}

void adaptToPieces(Morpher& method)
{
  if (auto* inversionFree = dynamic_cast<InversionFree*>(&method))
  {
    inversionFree->setRaisesValid(false);
  }
}

bool repairPolyhedra(const Mesh& mesh, const HangingNodes& hanging, const Points& reference,
  const NodePartition& partition,
  const std::function<std::vector<Index>(const Points& points)>& bad, Points& moved,
  Monitor& monitor, const Communicator& processes)
{
  constexpr int Rounds = 4;
  std::vector<Index> left = bad(moved);
  if (processes.all(left.empty()))
  {
    return true;
  }
  ProgressRange preparing(monitor, 0, 0.3);
  const auto pieces = cutCells(mesh, hanging, processes, 1, preparing);
  const std::shared_ptr<const Communicator> ofPieces = pieces->processes();
  const NodePartition nodes = pieces->extend(hanging.extend(partition));
  const std::vector<Index> stay =
    cellsThatStay(*pieces, nodes, pieces->extend(moved), *ofPieces, preparing);
  const auto canBeMended = [&]
  { return !processes.all(std::includes(stay.begin(), stay.end(), left.begin(), left.end())); };
  if (!canBeMended())
  {
    return false;
  }
  InversionFree repair;
  repair.setReference(pieces->extend(reference));
  repair.prepare(pieces->mesh(), nodes, preparing, ofPieces);
  const auto count = [&](const std::vector<Index>& cells)
  { return processes.sum(static_cast<Index>(cells.size())); };
  for (int round = 0; round < Rounds && canBeMended(); ++round)
  {
    ProgressRange part(monitor, 0.3 + 0.7 * round / Rounds, 0.3 + 0.7 * (round + 1) / Rounds);
    Points all = pieces->extend(moved);
    repair.repair(all, part);
    Points repaired = pieces->reduce(all, moved);
    placeOthers(mesh, hanging, partition, processes, moved, repaired);
    std::vector<Index> now = bad(repaired);
    if (count(now) >= count(left))
    {
      break; // what is left cannot be mended
    }
    left.swap(now);
    moved = std::move(repaired);
  }
  return processes.all(left.empty());
}

Index smoothAfterwards(const Mesh& rest, const HangingNodes& hanging, bool onPieces,
  const std::vector<std::int8_t>& orientation, const NodePartition& partition, int iterationLimit,
  Points& moved, Monitor& monitor, const Communicator& processes)
{
  SmoothingOptions options;
  options.target = SmoothingTarget::Initial;
  options.iterationLimit = iterationLimit;
  options.neverWorse = true;
  SmoothingReport report;
  if (onPieces)
  {
    const auto pieces = cutCells(rest, hanging, processes, 1, monitor);
    const std::shared_ptr<const Communicator> shared = pieces->processes();
    const Communicator& ofPieces = *shared;
    const Mesh& mesh = pieces->mesh();
    Points all = pieces->extend(moved);
    report = smoothOwnCells(mesh,
      cellSigns(mesh, connectedComponents(mesh, monitor, ofPieces), monitor, ofPieces),
      pieces->extend(hanging.extend(partition)), options, all, ofPieces, monitor);
    Points smoothed = pieces->reduce(all, moved);
    placeOthers(rest, hanging, partition, processes, moved, smoothed);
    const std::vector<std::uint8_t> others = OwnCells::others(rest, processes);
    // Bad cells, and the minimum.
    const auto measure = [&](const Points& points)
    {
      const Quality quality = measureQuality(rest, points, orientation, others, monitor);
      return std::pair(
        processes.sum(quality.inverted + quality.degenerate), minimumOfAll(quality, processes));
    };
    // What is better for the pieces may be worse for the polyhedra.
    const auto [bad, minimum] = measure(smoothed);
    const auto [badBefore, minimumBefore] = measure(moved);
    if (bad > badBefore || (bad == badBefore && !(minimum >= minimumBefore)))
    {
      return 0;
    }
    moved = smoothed;
  }
  else
  {
    report = smoothOwnCells(rest, orientation, partition, options, moved, processes, monitor);
  }
  return report.wasKept ? 0 : report.untangleSteps + report.newtonSteps;
}
}
