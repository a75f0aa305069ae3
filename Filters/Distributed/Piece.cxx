// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Piece.h"

#include "Distributed/SharedPlaces.h"
#include "Support/Error.h"

#include <algorithm>
#include <iterator>
#include <string>

namespace morph::distributed
{
namespace
{
/// Whether there are ids on all ranks that have `items`; throws where some have them only.
bool haveIds(const Ranks& ranks, bool isHere, bool hasItems, const char* what)
{
  const Index with = ranks.sum(Index(hasItems && isHere));
  const Index without = ranks.sum(Index(hasItems && !isHere));
  if (with > 0 && without > 0)
  {
    throw Error("Global " + std::string(what) + " ids are on " + std::to_string(with) +
                " MPI ranks of " + std::to_string(with + without) +
                ". Make them on all (Generate Global Ids), or remove them.");
  }
  return with > 0;
}
}

std::vector<std::uint8_t> usedNodes(const Mesh& mesh, const std::vector<std::uint8_t>& isGhost)
{
  std::vector<std::uint8_t> isUsed(mesh.numberOfNodes(), 0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (Index k = 0; k < mesh.cellSize(c) && (isGhost.empty() || isGhost[c] == 0); ++k)
    {
      isUsed[mesh.cell(c)[k]] = 1;
    }
  }
  return isUsed;
}

void requireNodeIds(const Ranks& ranks, Piece& piece)
{
  const Index nodes = piece.mesh.numberOfNodes();
  if (haveIds(ranks, !piece.nodeIds.empty(), nodes > 0, "point"))
  {
    return;
  }
  const std::vector<std::uint8_t> isUsed = usedNodes(piece.mesh, piece.isGhost);
  std::vector<SharedPlaces::Node> places;
  for (Index n = 0; n < nodes; ++n)
  {
    const auto x = piece.mesh.points.row(n);
    places.push_back({ { x[0], x[1], x[2] }, -1, 0, 0, isUsed[n] });
  }
  piece.nodeIds = SharedPlaces(ranks, places).ids();
}

std::vector<std::int64_t> newCellIds(const Ranks& ranks, const std::vector<std::uint8_t>& isGhost)
{
  std::int64_t next = ranks.sumBefore(std::count(isGhost.begin(), isGhost.end(), 0));
  std::vector<std::int64_t> ids;
  std::transform(isGhost.begin(), isGhost.end(), std::back_inserter(ids),
    [&next](std::uint8_t ghost) { return ghost != 0 ? -1 : next++; });
  return ids;
}

void requireCellIds(const Ranks& ranks, Piece& piece)
{
  if (!haveIds(ranks, !piece.cellIds.empty(), piece.mesh.numberOfCells() > 0, "cell"))
  {
    std::vector<std::uint8_t> isGhost = piece.isGhost;
    isGhost.resize(piece.mesh.types.size(), 0);
    piece.cellIds = newCellIds(ranks, isGhost);
  }
}
}
