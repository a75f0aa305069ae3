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

InnerFaces innerFaces(const Mesh& mesh, const BoundaryFaces& outer,
  const std::vector<std::uint8_t>& isMarked, Monitor& monitor)
{
  std::map<Corners, int> cells = flatCells(mesh, isMarked);
  for (std::size_t f = 0; f + 1 < outer.offsets.size() && !cells.empty(); ++f)
  {
    cells.erase(cornersOfCell(mesh, outer, static_cast<Index>(f)));
  }
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
}
