// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/InnerFaces.h"

#include "Mesh/CellShape.h"
#include "Mesh/FaceTable.h"
#include "Mesh/Polyhedra.h"
#include "Support/Lists.h"

#include <algorithm>
#include <set>

namespace morph
{
Corners sortedCorners(const Index* begin, const Index* end)
{
  Corners corners(begin, end);
  std::sort(corners.begin(), corners.end());
  return corners;
}

Corners cornersOfCell(const Mesh& mesh, const BoundaryFaces& faces, Index face)
{
  const Index *begin = faces.connectivity.data() + faces.offsets[face],
              *end = faces.connectivity.data() + faces.offsets[face + 1];
  Corners corners = sortedCorners(begin, end);
  const Index cell = faces.cells[face];
  if (!isPolyhedron(mesh, cell))
  {
    const Index* last = mesh.cell(cell) + cellShape(mesh, cell)->numberOfCorners;
    corners.erase(std::remove_if(corners.begin(), corners.end(),
                    [&](Index node) { return std::find(mesh.cell(cell), last, node) == last; }),
      corners.end());
  }
  return corners;
}

std::map<Corners, int> flatCells(const Mesh& mesh, const std::vector<std::uint8_t>& isMarked)
{
  std::map<Corners, int> cells;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const CellShape* shape = isMarked[c] ? cellShape(mesh.types[c]) : nullptr;
    if (shape && shape->dimension == 2)
    {
      const Index size = shape->numberOfCorners > 0 ? shape->numberOfCorners : mesh.cellSize(c);
      ++cells[sortedCorners(mesh.cell(c), mesh.cell(c) + size)];
    }
  }
  return cells;
}

namespace
{
/// flatCells() that lie on no outer face.
std::map<Corners, int> flatCellsInside(
  const Mesh& mesh, const BoundaryFaces& outer, const std::vector<std::uint8_t>& isMarked)
{
  std::map<Corners, int> cells = flatCells(mesh, isMarked);
  for (std::size_t f = 0; f + 1 < outer.offsets.size() && !cells.empty(); ++f)
  {
    cells.erase(cornersOfCell(mesh, outer, static_cast<Index>(f)));
  }
  return cells;
}
}

InnerFaces innerFaces(const Mesh& mesh, const BoundaryFaces& outer,
  const std::vector<std::uint8_t>& isMarked, Monitor& monitor)
{
  const std::map<Corners, int> cells = flatCellsInside(mesh, outer, isMarked);
  InnerFaces result;
  if (cells.empty())
  {
    return result;
  }
  const FaceTable table = faceTable(mesh, monitor);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (Index f = table.start[c]; f < table.start[c + 1]; ++f)
    {
      if (table.first[f] != f || table.uses[f] < 2)
      {
        continue;
      }
      const auto found = cells.find(sortedCorners(table.corners.begin(f), table.corners.end(f)));
      if (found != cells.end())
      {
        InnerFaces::Places& places = found->second > 1 ? result.baffles : result.sheets;
        places.emplace_back(c, static_cast<int>(f - table.start[c]));
      }
    }
  }
  return result;
}

namespace
{
using Pair = std::pair<Index, Index>;

/// The parts of each cell.
Adjacency partsOfCells(const std::vector<NamedCells>& parts, Index numberOfCells, Monitor& monitor)
{
  return sortIntoBuckets(static_cast<Index>(parts.size()), numberOfCells, monitor,
    [&](Index first, Index last, const auto& add)
    {
      for (Index part = first; part < last; ++part)
      {
        for (const Index cell : parts[part].cells)
        {
          add(cell, part);
        }
      }
    });
}

/// The pairs of parts that have a cell in common.
std::set<Pair> overlapping(const Adjacency& partsOf)
{
  std::set<std::vector<Index>> several;
  for (std::size_t c = 0; c + 1 < partsOf.offsets.size(); ++c)
  {
    const Index *first = partsOf.begin(static_cast<Index>(c)),
                *last = partsOf.end(static_cast<Index>(c));
    if (last - first > 1)
    {
      several.emplace(first, last);
    }
  }
  std::set<Pair> result;
  for (const std::vector<Index>& parts : several)
  {
    for (std::size_t i = 1; i < parts.size(); ++i)
    {
      for (std::size_t j = 0; j < i; ++j)
      {
        result.emplace(parts[j], parts[i]);
      }
    }
  }
  return result;
}

/// The cell of each face of the table.
std::vector<Index> cellsOf(const FaceTable& table)
{
  std::vector<Index> result(table.first.size());
  for (std::size_t c = 0; c + 1 < table.start.size(); ++c)
  {
    std::fill(
      result.begin() + table.start[c], result.begin() + table.start[c + 1], static_cast<Index>(c));
  }
  return result;
}

/// Adds the faces between two parts.
void addInterfaces(const std::vector<NamedCells>& parts, const FaceTable& table,
  const std::vector<Index>& cellOf, Monitor& monitor, std::vector<InnerSurface>& result)
{
  const Adjacency partsOf =
    partsOfCells(parts, static_cast<Index>(table.start.size()) - 1, monitor);
  const std::set<Pair> overlap = overlapping(partsOf);
  std::map<Pair, InnerFaces::Places> between;
  for (std::size_t f = 0; f < table.first.size(); ++f)
  {
    const Index same = table.first[f];
    if (same == static_cast<Index>(f) || table.uses[f] != 2)
    {
      continue;
    }
    const Index c = cellOf[f], other = cellOf[same];
    for (const Index* a = partsOf.begin(other); a != partsOf.end(other); ++a)
    {
      for (const Index* b = partsOf.begin(c); b != partsOf.end(c); ++b)
      {
        const Pair pair(std::min(*a, *b), std::max(*a, *b));
        if (*a != *b && overlap.count(pair) == 0)
        {
          between[pair].emplace_back(other, static_cast<int>(same - table.start[other]));
        }
      }
    }
  }
  for (auto& [pair, places] : between)
  {
    std::sort(places.begin(), places.end());
    result.push_back(
      { parts[pair.first].name + " | " + parts[pair.second].name, std::move(places) });
  }
}

/// Adds the faces inside whose corners are in the set, if these are all that it has inside.
/// `isInside`: #nodes, corners of no outer face.
void addSet(const NamedNodes& set, const FaceTable& table, const std::vector<Index>& cellOf,
  const std::vector<std::uint8_t>& isInside, std::vector<InnerSurface>& result)
{
  std::set<Index> left;
  for (std::size_t n = 0; n < isInside.size(); ++n)
  {
    if (isInside[n] && set.isNode[n])
    {
      left.insert(static_cast<Index>(n));
    }
  }
  if (left.empty())
  {
    return;
  }
  InnerSurface surface{ set.name, {} };
  std::vector<Index> markedFaces(table.start.size() - 1, 0); // of each cell
  for (std::size_t f = 0; f < table.first.size(); ++f)
  {
    const Index face = static_cast<Index>(f), c = cellOf[f];
    const Index *first = table.corners.begin(face), *last = table.corners.end(face);
    if (!std::all_of(first, last, [&](Index n) { return set.isNode[n] != 0; }))
    {
      continue;
    }
    if (++markedFaces[c] == table.start[c + 1] - table.start[c] || table.uses[f] == 1)
    {
      return;
    }
    if (table.first[f] == face)
    {
      surface.places.emplace_back(c, static_cast<int>(face - table.start[c]));
      std::for_each(first, last, [&](Index n) { left.erase(n); });
    }
  }
  if (left.empty())
  {
    result.push_back(std::move(surface));
  }
}
}

std::vector<InnerSurface> innerSurfaces(const Mesh& mesh, const std::vector<NamedCells>& parts,
  const std::vector<NamedNodes>& sets, Monitor& monitor)
{
  std::vector<InnerSurface> result;
  if (parts.size() < 2 && sets.empty())
  {
    return result;
  }
  const FaceTable table = faceTable(mesh, monitor);
  const std::vector<Index> cellOf = cellsOf(table);
  addInterfaces(parts, table, cellOf, monitor, result);
  std::vector<std::uint8_t> isInside(mesh.numberOfNodes(), 0);
  for (const std::uint8_t inside : { 1, 0 })
  {
    for (std::size_t f = 0; f < table.first.size(); ++f)
    {
      if (inside || table.uses[f] == 1)
      {
        const Index face = static_cast<Index>(f);
        std::for_each(table.corners.begin(face), table.corners.end(face),
          [&](Index n) { isInside[n] = inside; });
      }
    }
  }
  for (const NamedNodes& set : sets)
  {
    addSet(set, table, cellOf, isInside, result);
  }
  return result;
}

namespace
{
/// For each cell the number of its list of parts, the same on all processes, or 0 if it is in none.
/// Adds the first cell of each list to `first`.
std::vector<double> listsOfParts(const Mesh& mesh, const std::vector<NamedCells>& parts,
  const Communicator& processes, std::vector<Index>& first, Monitor& monitor)
{
  const Adjacency partsOf = partsOfCells(parts, mesh.numberOfCells(), monitor);
  std::map<std::vector<Index>, double> numberOf;
  std::vector<double> mine; // the lists of this process, each behind its size
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const std::vector<Index> list(partsOf.begin(c), partsOf.end(c));
    if (!list.empty() && numberOf.emplace(list, 0).second)
    {
      first.push_back(c);
      mine.push_back(static_cast<double>(list.size()));
      mine.insert(mine.end(), list.begin(), list.end());
    }
  }
  numberOf.clear();
  const std::vector<double> all = processes.gather(mine);
  for (auto at = all.begin(); at != all.end();)
  {
    const auto size = static_cast<std::ptrdiff_t>(*at++);
    numberOf.emplace(std::vector<Index>(at, at + size), static_cast<double>(numberOf.size() + 1));
    at += size;
  }
  std::vector<double> result(mesh.numberOfCells(), 0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (partsOf.begin(c) != partsOf.end(c))
    {
      result[c] = numberOf.at({ partsOf.begin(c), partsOf.end(c) });
    }
  }
  processes.completeCells(result);
  return result;
}

/// Flags the nodes around which cells are in different lists of parts, but for none.
void flagWherePartsMeet(
  const Mesh& mesh, const std::vector<double>& lists, std::vector<std::uint8_t>& isNode)
{
  std::vector<double> found(mesh.numberOfNodes(), 0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (Index k = 0; k < mesh.cellSize(c) && lists[c] > 0; ++k)
    {
      const Index node = mesh.cell(c)[k];
      isNode[node] |= found[node] > 0 && found[node] != lists[c];
      found[node] = lists[c];
    }
  }
}

/// The first own cell all of whose faces the set has, or -1.
Index wholeCell(const Mesh& mesh, const NamedNodes& set, const Communicator& processes)
{
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    bool isVolume = false, hasAll = !processes.isCopy(c);
    const auto see = [&](const Index* nodes, Index size)
    {
      isVolume = true;
      hasAll =
        hasAll && std::all_of(nodes, nodes + size, [&](Index n) { return set.isNode[n] != 0; });
    };
    forEachSide(mesh, c, see);
    if (isVolume && hasAll)
    {
      return c;
    }
  }
  return -1;
}

/// Whether the set has all corners of a face.
bool hasFace(const NamedNodes& set, const BoundaryFaces& faces)
{
  for (std::size_t f = 0; f + 1 < faces.offsets.size(); ++f)
  {
    if (std::all_of(faces.connectivity.begin() + faces.offsets[f],
          faces.connectivity.begin() + faces.offsets[f + 1],
          [&](Index n) { return set.isNode[n] != 0; }))
    {
      return true;
    }
  }
  return false;
}
}

std::vector<Index> cellsAtInnerFaces(const Mesh& mesh, const BoundaryFaces& outer,
  const std::vector<NamedCells>& parts, const std::vector<NamedNodes>& sets,
  std::vector<std::uint8_t> isMarked, const Communicator& processes, Monitor& monitor)
{
  std::vector<Index> cells;
  std::vector<std::uint8_t> isNode(mesh.numberOfNodes(), 0);
  if (parts.size() > 1)
  {
    flagWherePartsMeet(mesh, listsOfParts(mesh, parts, processes, cells, monitor), isNode);
  }
  for (NamedNodes set : sets)
  {
    set.isNode.resize(mesh.numberOfNodes(), 0);
    const Index whole = wholeCell(mesh, set, processes);
    if (whole >= 0)
    {
      cells.push_back(whole);
    }
    if (processes.all(whole < 0 && !hasFace(set, outer)))
    {
      std::transform(isNode.begin(), isNode.end(), set.isNode.begin(), isNode.begin(),
        [](std::uint8_t a, std::uint8_t b) { return a | b; });
    }
  }
  isMarked.resize(mesh.numberOfCells(), 0);
  for (const auto& [corners, count] : flatCellsInside(mesh, outer, isMarked))
  {
    std::for_each(corners.begin(), corners.end(), [&](Index n) { isNode[n] = 1; });
  }
  std::vector<Index> nodes;
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    if (isNode[n])
    {
      nodes.push_back(n);
    }
  }
  processes.spread(nodes);
  std::for_each(nodes.begin(), nodes.end(), [&](Index n) { isNode[n] = 1; });
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    bool isAt = false;
    forEachSide(mesh, c,
      [&](const Index* corners, Index size)
      { isAt = isAt || std::any_of(corners, corners + size, [&](Index n) { return isNode[n]; }); });
    if (isAt && !processes.isCopy(c))
    {
      cells.push_back(c);
    }
  }
  sortUnique(cells);
  return cells;
}
}
