// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Piece.h"

#include "Support/Error.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <sstream>
#include <string>
#include <tuple>

namespace morph::distributed
{
namespace
{
using Position = std::array<double, 3>;

/// The rank that numbers the nodes at a position.
int placeOf(const Position& x, int ranks)
{
  std::uint64_t hash = 1469598103934665603ULL;
  for (double value : x)
  {
    std::uint64_t bits = 0;
    value += 0.; // -0 is 0
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 0x9E3779B97F4A7C15ULL;
    hash ^= hash >> 32;
  }
  return static_cast<int>(hash % static_cast<std::uint64_t>(ranks));
}

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

struct Sent
{
  Position x;
  std::int64_t isUsed;
};

struct Met
{
  Position x;
  bool isGhost; ///< those that are not come first
  int rank;
  Index number; ///< in the order of what the rank sent
};
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
  std::vector<std::vector<Sent>> to(ranks.count());
  std::vector<std::vector<Index>> senders(ranks.count());
  for (Index n = 0; n < nodes; ++n)
  {
    const Position x = { piece.mesh.points(n, 0), piece.mesh.points(n, 1),
      piece.mesh.points(n, 2) };
    const int place = placeOf(x, ranks.count());
    to[place].push_back({ x, isUsed[n] });
    senders[place].push_back(n);
  }
  const auto from = ranks.exchange(to);

  std::vector<Met> met;
  std::vector<std::vector<std::int64_t>> answers(ranks.count());
  for (int r = 0; r < ranks.count(); ++r)
  {
    answers[r].resize(from[r].size());
    for (std::size_t i = 0; i < from[r].size(); ++i)
    {
      met.push_back({ from[r][i].x, from[r][i].isUsed == 0, r, static_cast<Index>(i) });
    }
  }
  std::sort(met.begin(), met.end(),
    [](const Met& a, const Met& b)
    {
      return std::tie(a.x, a.isGhost, a.rank, a.number) <
             std::tie(b.x, b.isGhost, b.rank, b.number);
    });
  std::int64_t ids = 0;
  std::string problem;
  for (std::size_t first = 0, last = 0; first < met.size(); first = last)
  {
    bool isTwice = false, isShared = false;
    for (last = first; last < met.size() && met[last].x == met[first].x; ++last)
    {
      isTwice =
        isTwice || (last > first && !met[last].isGhost && met[last].rank == met[last - 1].rank);
      isShared = isShared || met[last].isGhost || met[last].rank != met[first].rank;
    }
    if (isTwice && isShared && problem.empty())
    {
      std::ostringstream text;
      text.precision(9);
      text << "Several nodes of one MPI rank and one of another are at the same position ("
           << met[first].x[0] << ", " << met[first].x[1] << ", " << met[first].x[2]
           << "), so positions do not tell which of them are one node. Give the mesh global point "
              "ids before it is distributed.";
      problem = text.str();
    }
    for (std::size_t k = first; k < last; ++k)
    {
      // Nodes of one rank stay apart, as the two sides of a crack.
      ids += isTwice && k > first ? 1 : 0;
      answers[met[k].rank][met[k].number] = ids;
    }
    ++ids;
  }
  ranks.together(
    [&]
    {
      if (!problem.empty())
      {
        throw Error(problem);
      }
    });
  const std::int64_t offset = ranks.sumBefore(ids);
  for (auto& answer : answers)
  {
    for (std::int64_t& id : answer)
    {
      id += offset;
    }
  }
  const auto answered = ranks.exchange(answers);
  piece.nodeIds.resize(nodes);
  for (int r = 0; r < ranks.count(); ++r)
  {
    for (std::size_t i = 0; i < senders[r].size(); ++i)
    {
      piece.nodeIds[senders[r][i]] = answered[r][i];
    }
  }
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
