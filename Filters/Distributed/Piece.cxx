// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Piece.h"

#include "Distributed/SharedPlaces.h"
#include "Support/Error.h"

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

void requireCellIds(const Ranks& ranks, Piece& piece)
{
  const Index cells = piece.mesh.numberOfCells();
  if (haveIds(ranks, !piece.cellIds.empty(), cells > 0, "cell"))
  {
    return;
  }
  const auto isOwn = [&](Index c) { return piece.isGhost.empty() || piece.isGhost[c] == 0; };
  Index own = 0;
  for (Index c = 0; c < cells; ++c)
  {
    own += isOwn(c);
  }
  std::int64_t next = ranks.sumBefore(own);
  piece.cellIds.assign(cells, -1);
  for (Index c = 0; c < cells; ++c)
  {
    if (isOwn(c))
    {
      piece.cellIds[c] = next++;
    }
  }
}
}
