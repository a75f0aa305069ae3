// SPDX-License-Identifier: BSD-3-Clause
#include "Session/AfterMotion.h"

#include "Mesh/HigherOrderNodes.h"
#include "Mesh/PolyhedronPieces.h"
#include "Mesh/Topology.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Quality/BoundaryDetermined.h"
#include "Quality/ScaledJacobian.h"
#include "Support/ProgressRange.h"
#include "Untangling/InversionFree.h"

#include <algorithm>
#include <utility>

namespace morph
{
namespace
{
/// Whether there are more bad cells or, with as many, a lower minimum.
bool isWorse(const Quality& after, const Quality& before)
{
  const auto bad = [](const Quality& quality) { return quality.inverted + quality.degenerate; };
  return bad(after) > bad(before) ||
         (bad(after) == bad(before) && !(after.minimum >= before.minimum));
}

/// Returns the cells, ascending, that no position of the free nodes makes valid.
std::vector<Index> cellsThatStay(const PolyhedronPieces& pieces, const NodePartition& partition,
  const Points& points, Monitor& monitor)
{
  const Mesh& mesh = pieces.mesh();
  const std::vector<std::int8_t> signs =
    cellSigns(mesh, connectedComponents(mesh, monitor), monitor);
  std::vector<Index> cells = boundaryDeterminedInversions(mesh, partition, signs, points);
  const auto cellOf = [&](Index piece) { return pieces.cellOf(piece); };
  std::transform(cells.begin(), cells.end(), cells.begin(), cellOf);
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
  const Points& before, Points& after)
{
  if (!hanging.empty() && !partition.higherOrderNodes.empty())
  {
    HigherOrderNodes followers;
    followers.prepare(mesh, partition);
    Points change = after - before;
    followers.apply(change);
    for (const Index node : partition.higherOrderNodes)
    {
      after.row(node) = before.row(node) + change.row(node);
    }
  }
  hanging.place(mesh.points, after);
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
  Monitor& monitor)
{
  constexpr int Rounds = 4;
  std::vector<Index> left = bad(moved);
  if (left.empty())
  {
    return true;
  }
  ProgressRange preparing(monitor, 0, 0.3);
  const PolyhedronPieces pieces(hanging.conforming(mesh), preparing);
  const NodePartition ofPieces = pieces.extend(hanging.extend(partition));
  const std::vector<Index> stay = cellsThatStay(pieces, ofPieces, pieces.extend(moved), preparing);
  const auto canBeMended = [&]
  { return !std::includes(stay.begin(), stay.end(), left.begin(), left.end()); };
  if (!canBeMended())
  {
    return false;
  }
  InversionFree repair;
  repair.setReference(pieces.extend(reference));
  repair.prepare(pieces.mesh(), ofPieces, preparing);
  for (int round = 0; round < Rounds && canBeMended(); ++round)
  {
    ProgressRange part(monitor, 0.3 + 0.7 * round / Rounds, 0.3 + 0.7 * (round + 1) / Rounds);
    Points all = pieces.extend(moved);
    repair.repair(all, part);
    Points repaired = all.topRows(moved.rows());
    placeOthers(mesh, hanging, partition, moved, repaired);
    std::vector<Index> now = bad(repaired);
    if (now.size() >= left.size())
    {
      break; // what is left cannot be mended
    }
    left.swap(now);
    moved = std::move(repaired);
  }
  return left.empty();
}

SmoothingOptions postSmoothing(int iterationLimit)
{
  SmoothingOptions options;
  options.target = SmoothingTarget::Initial;
  options.iterationLimit = iterationLimit;
  options.neverWorse = true;
  return options;
}

Index smoothAfterwards(const Mesh& rest, const HangingNodes& hanging,
  const std::vector<std::int8_t>& orientation, const NodePartition& partition, int iterationLimit,
  Points& moved, Monitor& monitor)
{
  const SmoothingOptions options = postSmoothing(iterationLimit);
  SmoothingReport report;
  if (needsPieces(rest, hanging))
  {
    const PolyhedronPieces pieces(hanging.conforming(rest), monitor);
    const Mesh& mesh = pieces.mesh();
    Points all = pieces.extend(moved);
    report = smoothMesh(mesh, cellSigns(mesh, connectedComponents(mesh)),
      pieces.extend(hanging.extend(partition)), options, all, monitor);
    Points smoothed = all.topRows(moved.rows());
    placeOthers(rest, hanging, partition, moved, smoothed);
    const auto measure = [&](const Points& points)
    { return measureQuality(rest, points, orientation, {}, monitor); };
    // What is better for the pieces may be worse for the polyhedra.
    if (isWorse(measure(smoothed), measure(moved)))
    {
      return 0;
    }
    moved = smoothed;
  }
  else
  {
    report = smoothMesh(rest, orientation, partition, options, moved, monitor);
  }
  return report.wasKept ? 0 : report.untangleSteps + report.newtonSteps;
}
}
