// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/PolyhedralRepair.h"

#include "Mesh/PolyhedronPieces.h"
#include "Mesh/Topology.h"
#include "Quality/BoundaryDetermined.h"
#include "Support/ProgressRange.h"
#include "Untangling/InversionFree.h"

#include <algorithm>
#include <utility>

namespace morph::filters::PolyhedralRepair
{
void Adapt(morph::Morpher& method)
{
  if (auto* inversionFree = dynamic_cast<morph::InversionFree*>(&method))
  {
    inversionFree->setRaisesValid(false);
  }
}

namespace
{
/// Returns the cells, ascending, that no position of the free nodes makes valid.
std::vector<morph::Index> cellsThatStay(const morph::PolyhedronPieces& pieces,
  const morph::NodePartition& partition, const morph::Points& points, morph::Monitor& monitor)
{
  const morph::Mesh& mesh = pieces.mesh();
  const std::vector<std::int8_t> signs =
    morph::cellSigns(mesh, morph::connectedComponents(mesh, monitor), monitor);
  std::vector<morph::Index> cells =
    morph::boundaryDeterminedInversions(mesh, partition, signs, points);
  const auto cellOf = [&](morph::Index piece) { return pieces.cellOf(piece); };
  std::transform(cells.begin(), cells.end(), cells.begin(), cellOf);
  for (const morph::NodeWithoutPlace& node :
    morph::nodesWithoutPlace(mesh, partition, signs, points, monitor))
  {
    // One of several cells stays inverted, but not each.
    const morph::Index cell = cellOf(node.cells.front());
    if (std::all_of(node.cells.begin(), node.cells.end(),
          [&](morph::Index piece) { return cellOf(piece) == cell; }))
    {
      cells.push_back(cell);
    }
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}
}

bool Run(const morph::Mesh& mesh, const morph::Points& reference,
  const morph::NodePartition& partition,
  const std::function<std::vector<morph::Index>(const morph::Points& points)>& bad,
  morph::Points& moved, morph::Monitor& monitor)
{
  constexpr int Rounds = 4;
  std::vector<morph::Index> left = bad(moved);
  if (left.empty())
  {
    return true;
  }
  morph::ProgressRange preparing(monitor, 0, 0.3);
  const morph::PolyhedronPieces pieces(mesh, preparing);
  const morph::NodePartition ofPieces = pieces.extend(partition);
  const std::vector<morph::Index> stay =
    cellsThatStay(pieces, ofPieces, pieces.extend(moved), preparing);
  const auto canBeMended = [&]
  { return !std::includes(stay.begin(), stay.end(), left.begin(), left.end()); };
  if (!canBeMended())
  {
    return false;
  }
  morph::InversionFree repair;
  repair.setReference(pieces.extend(reference));
  repair.prepare(pieces.mesh(), ofPieces, preparing);
  for (int round = 0; round < Rounds && canBeMended(); ++round)
  {
    morph::ProgressRange part(
      monitor, 0.3 + 0.7 * round / Rounds, 0.3 + 0.7 * (round + 1) / Rounds);
    morph::Points all = pieces.extend(moved);
    repair.repair(all, part);
    morph::Points repaired = all.topRows(moved.rows());
    std::vector<morph::Index> now = bad(repaired);
    if (now.size() >= left.size())
    {
      break; // what is left cannot be mended
    }
    left.swap(now);
    moved = std::move(repaired);
  }
  return left.empty();
}
}
