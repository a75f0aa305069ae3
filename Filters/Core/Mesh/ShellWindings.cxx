// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/ShellWindings.h"

#include "Mesh/StandingCells.h"
#include "Support/Error.h"
#include "Support/Lists.h"
#include "Support/UnionFind.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace morph
{
namespace
{
/// What hangs together of a surface across edges of two fronts, on this process.
struct Parts
{
  std::vector<Index> ofCell;         ///< #cells, -1: no front
  std::vector<std::int8_t> windings; ///< #cells: 1 or -1, alike in neighbors; 0: no front
  std::vector<double> areas;         ///< of each, so wound; in a plane about its normal
};

/// A side of a cell, and whether it runs from the lower to the higher id.
struct Side
{
  Index low, high, cell;
  bool isUp;
};

/// Two cells, and whether they are wound alike (1) or not (-1).
struct Relation
{
  Index cell, other;
  std::int8_t same;

  Relation(const Side& a, const Side& b, bool areFolded)
    : cell(a.cell)
    , other(b.cell)
    , same((a.isUp == b.isUp) == areFolded ? 1 : -1)
  {
  }
};

/// Relates the sheets that meet at an edge, each to the one that goes on from it most smoothly.
/// Those at less than 60 degrees are folded onto each other.
void relateSheets(const Mesh& shell, const Points& points, const std::vector<Side>& sheets,
  std::vector<Relation>& relations)
{
  const auto low = points.row(sheets[0].low), high = points.row(sheets[0].high);
  const Eigen::RowVector3d along = (high - low).stableNormalized();
  std::vector<Eigen::RowVector3d> inward;
  for (const Side& side : sheets)
  {
    const Eigen::RowVector3d d =
      points(frontOf(shell, side.cell), allColumns).colwise().mean() - low;
    inward.push_back(Eigen::RowVector3d(d - d.dot(along) * along).stableNormalized());
  }
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs; // by the cosine but for rounding
  for (std::size_t k = 0; k < sheets.size(); ++k)
  {
    for (std::size_t i = 0; i < k; ++i)
    {
      pairs.emplace_back(std::round(1e6 * inward[i].dot(inward[k])), i, k);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  UnionFind<std::size_t> known(sheets.size());
  for (const auto& [cosine, i, k] : pairs)
  {
    if (known.root(i) != known.root(k))
    {
      known.join(i, k);
      relations.emplace_back(sheets[i], sheets[k], cosine > 0.5e6);
    }
  }
}

/// Cells at edges of two fronts, and the sheets that meet at edges of more in a curved shell. All
/// cells at an edge are here if one of them is no copy.
struct Relations
{
  std::vector<Relation> beside, across;
};

Relations relationsOf(const Mesh& shell, const Points& points, const Communicator& processes)
{
  std::vector<Side> sides;
  for (Index c = 0; c < shell.numberOfCells(); ++c)
  {
    const std::vector<Index> corners = frontOf(shell, c);
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
      const auto [low, high] = std::minmax(corners[k], corners[(k + 1) % corners.size()]);
      sides.push_back({ low, high, c, corners[k] == low });
    }
  }
  std::sort(sides.begin(), sides.end(),
    [](const Side& a, const Side& b)
    { return std::tie(a.low, a.high, a.cell) < std::tie(b.low, b.high, b.cell); });
  Relations result;
  for (auto first = sides.begin(), last = first; first != sides.end(); first = last)
  {
    last = std::find_if(first, sides.end(),
      [&](const Side& side) { return side.low != first->low || side.high != first->high; });
    const bool isWhole =
      std::any_of(first, last, [&](const Side& side) { return !processes.isCopy(side.cell); });
    if (isWhole && last - first == 2 && first->cell != first[1].cell)
    {
      result.beside.emplace_back(first[0], first[1], false);
    }
    else if (isWhole && last - first > 2 && shell.layer.isCurved())
    {
      // In an order that is the same on all processes.
      std::vector<Side> sheets(first, last);
      std::sort(sheets.begin(), sheets.end(),
        [&](const Side& a, const Side& b) {
          return processes.idsOfCells({ a.cell }).front() <
                 processes.idsOfCells({ b.cell }).front();
        });
      relateSheets(shell, points, sheets, result.across);
    }
  }
  return result;
}

[[noreturn]] void throwOneSided(std::vector<Index> ids)
{
  sortUnique(ids);
  throw Error(
    "The shell has one side alone, as a Möbius strip: no winding of its cells agrees with "
    "all neighbors, at cell ids " +
    listIds(ids) + ". Cut it along edges there, by nodes of their own on each side.");
}

/// `points`: of the front; `beside`: cells at edges of two fronts.
Parts partsOf(const Mesh& shell, const Points& points, const std::vector<Relation>& beside,
  const Communicator& processes)
{
  std::vector<std::vector<std::pair<Index, std::int8_t>>> neighbors(shell.numberOfCells());
  for (const Relation& relation : beside)
  {
    neighbors[relation.cell].emplace_back(relation.other, relation.same);
    neighbors[relation.other].emplace_back(relation.cell, relation.same);
  }
  const ShellLayer& layer = shell.layer;
  Parts parts;
  parts.ofCell.assign(shell.numberOfCells(), -1);
  parts.windings.assign(shell.numberOfCells(), 0);
  std::vector<Index> part;
  for (Index seed = 0; seed < shell.numberOfCells(); ++seed)
  {
    if (parts.windings[seed] != 0 || frontOf(shell, seed).empty())
    {
      continue;
    }
    parts.windings[seed] = 1;
    part.assign(1, seed);
    double area = 0;
    for (std::size_t i = 0; i < part.size(); ++i)
    {
      const Index c = part[i];
      parts.ofCell[c] = static_cast<Index>(parts.areas.size());
      if (!processes.isCopy(c))
      {
        const Eigen::RowVector3d own = areaOf(points, frontOf(shell, c));
        area += parts.windings[c] * (layer.isCurved() ? own.stableNorm() : own.dot(layer.normal));
      }
      for (const auto& [other, same] : neighbors[c])
      {
        const auto asked = static_cast<std::int8_t>(same * parts.windings[c]);
        if (parts.windings[other] == -asked && layer.isCurved())
        {
          throwOneSided(processes.idsOfCells({ c, other }));
        }
        if (parts.windings[other] == 0)
        {
          parts.windings[other] = asked;
          part.push_back(other);
        }
      }
    }
    parts.areas.push_back(area);
  }
  return parts;
}

/// Two parts that have a cell in common, or sheets that meet, by their numbers among those of all
/// processes.
struct Link
{
  double part, other;
  double same;  ///< 1: they wind it alike, -1
  double cell;  ///< its id
  double sheet; ///< of sheets that meet, the other's id; else -1
};

/// A copy of a cell is of a part here, and of another part on its own process.
std::vector<Link> linksOf(const Parts& parts, const std::vector<Relation>& across, Index first,
  const Communicator& processes)
{
  std::vector<double> mine, theirs;
  for (std::size_t c = 0; c < parts.ofCell.size(); ++c)
  {
    mine.push_back(parts.windings[c] * static_cast<double>(first + parts.ofCell[c] + 1));
  }
  theirs = mine;
  processes.completeCells(theirs);
  std::map<std::array<double, 3>, double> links;
  for (std::size_t c = 0; c < mine.size(); ++c)
  {
    const auto cell = static_cast<Index>(c);
    if (mine[c] != 0 && processes.isCopy(cell))
    {
      links.emplace(std::array<double, 3>{ std::abs(mine[c]) - 1, std::abs(theirs[c]) - 1,
                      mine[c] * theirs[c] > 0 ? 1. : -1. },
        processes.idsOfCells({ cell }).front());
    }
  }
  std::vector<double> flat;
  for (const auto& [link, cell] : links)
  {
    flat.insert(flat.end(), link.begin(), link.end());
    flat.insert(flat.end(), { static_cast<double>(cell), -1 });
  }
  for (const Relation& sheets : across)
  {
    for (const Index cell : { sheets.cell, sheets.other })
    {
      flat.push_back(static_cast<double>(first + parts.ofCell[cell]));
    }
    flat.push_back(sheets.same * parts.windings[sheets.cell] * parts.windings[sheets.other]);
    for (const Index cell : { sheets.cell, sheets.other })
    {
      flat.push_back(static_cast<double>(processes.idsOfCells({ cell }).front()));
    }
  }
  flat = processes.gather(flat);
  std::vector<Link> all;
  for (std::size_t i = 0; i < flat.size(); i += 5)
  {
    all.push_back({ flat[i], flat[i + 1], flat[i + 2], flat[i + 3], flat[i + 4] });
  }
  // Sheets come last, in an order that is the same for any number of processes, and join parts
  // that nothing before them does.
  std::stable_sort(all.begin(), all.end(),
    [](const Link& a, const Link& b)
    {
      const bool isA = a.sheet >= 0, isB = b.sheet >= 0;
      return isA != isB ? isB : isA && std::tie(a.cell, a.sheet) < std::tie(b.cell, b.sheet);
    });
  return all;
}
}

Eigen::RowVector3d areaOf(const Points& points, const std::vector<Index>& corners)
{
  const auto at = [&](std::size_t k) -> Eigen::RowVector3d
  { return points.row(corners[k]) - points.row(corners[0]); };
  return corners.size() == 3 ? at(1).cross(at(2)) / 2
                             : (at(2)).cross(at(3) - at(1)) / 2; // of the diagonals
}

std::vector<std::int8_t> windingsOf(
  const Mesh& shell, const Points& points, const Communicator& processes)
{
  const Relations relations = relationsOf(shell, points, processes);
  Parts parts;
  processes.together([&] { parts = partsOf(shell, points, relations.beside, processes); });
  const auto count = static_cast<Index>(parts.areas.size());
  const Index first = processes.sumBefore(count), all = processes.sum(count);
  std::vector<double> areas(all, 0);
  std::copy(parts.areas.begin(), parts.areas.end(), areas.begin() + first);
  processes.sum(areas.data(), static_cast<int>(all));
  std::vector<std::vector<Link>> links(all);
  UnionFind<Index> known(all);
  for (const Link& link : linksOf(parts, relations.across, first, processes))
  {
    const auto part = static_cast<Index>(link.part), other = static_cast<Index>(link.other);
    if (link.sheet < 0 || known.root(part) != known.root(other))
    {
      links[part].push_back(link);
      links[other].push_back({ link.other, link.part, link.same, link.cell, link.sheet });
    }
    known.join(part, other);
  }
  std::vector<double> sign(all, 0);
  std::vector<Index> joined;
  for (Index seed = 0; seed < all; ++seed)
  {
    if (sign[seed] != 0)
    {
      continue;
    }
    sign[seed] = 1;
    joined.assign(1, seed);
    double area = 0;
    for (std::size_t i = 0; i < joined.size(); ++i)
    {
      const Index part = joined[i];
      area += sign[part] * areas[part];
      for (const Link& link : links[part])
      {
        double& other = sign[static_cast<Index>(link.other)];
        const double asked = link.same * sign[part];
        if (other == -asked && shell.layer.isCurved())
        {
          throwOneSided({ static_cast<Index>(link.cell) });
        }
        if (other == 0)
        {
          other = asked;
          joined.push_back(static_cast<Index>(link.other));
        }
      }
    }
    for (const Index part : joined)
    {
      sign[part] *= area < 0 ? -1 : 1;
    }
  }
  for (std::size_t c = 0; c < parts.windings.size(); ++c)
  {
    const double turn = parts.ofCell[c] < 0 ? 1 : sign[first + parts.ofCell[c]];
    parts.windings[c] = static_cast<std::int8_t>(turn * parts.windings[c]);
  }
  return parts.windings;
}
}
