// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/SharedCorners.h"

#include "Mesh/CellShape.h"
#include "Mesh/Polyhedra.h"
#include "Support/Lists.h"
#include "Support/UnionFind.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <mutex>
#include <numeric>
#include <set>
#include <utility>

namespace morph
{
namespace
{
/// Of a volume cell, or of a poly-vertex, whose nodes they are; 0 of another cell.
Index numberOfCorners(const Mesh& mesh, Index cell)
{
  if (mesh.types[cell] == PolyVertex)
  {
    return mesh.cellSize(cell);
  }
  const CellShape* shape = volumeShape(mesh, cell);
  return shape ? cornerCount(mesh, cell, *shape) : 0;
}

/// Whether the faces around a node are one fan in which every edge has two of them. `ends`: at each
/// edge the node at its other end, and the face.
bool areOneFan(std::vector<std::pair<Index, Index>>& ends)
{
  std::sort(ends.begin(), ends.end());
  std::map<Index, Index> numberOf;
  for (const auto& end : ends)
  {
    numberOf.emplace(end.second, static_cast<Index>(numberOf.size()));
  }
  UnionFind<Index> fans(static_cast<Index>(numberOf.size()));
  for (std::size_t i = 0; i < ends.size(); i += 2)
  {
    const bool isPair = i + 1 < ends.size() && ends[i].first == ends[i + 1].first &&
                        (i + 2 == ends.size() || ends[i + 2].first != ends[i].first);
    if (!isPair)
    {
      return false;
    }
    fans.join(numberOf[ends[i].second], numberOf[ends[i + 1].second]);
  }
  return std::all_of(numberOf.begin(), numberOf.end(),
    [&](const auto& face) { return fans.root(face.second) == 0; });
}

/// The nodes where the outer faces are not one fan, ascending.
std::vector<Index> withoutFan(const Mesh& mesh, const BoundaryFaces& faces)
{
  Monitor serial;
  const Index count = static_cast<Index>(faces.offsets.size()) - 1;
  const Adjacency facesOf = sortIntoBuckets(count, mesh.numberOfNodes(), serial,
    [&faces](Index first, Index last, const auto& add)
    {
      for (Index f = first; f < last; ++f)
      {
        for (Index k = faces.offsets[f]; k < faces.offsets[f + 1]; ++k)
        {
          add(faces.connectivity[k], f);
        }
      }
    });
  std::vector<Index> result;
  std::vector<std::pair<Index, Index>> ends;
  for (const Index node : faces.nodes)
  {
    ends.clear();
    for (const Index* f = facesOf.begin(node); f != facesOf.end(node); ++f)
    {
      const Index *first = faces.connectivity.data() + faces.offsets[*f],
                  *last = faces.connectivity.data() + faces.offsets[*f + 1];
      const Index* at = std::find(first, last, node);
      ends.emplace_back(at == first ? last[-1] : at[-1], *f);
      ends.emplace_back(at + 1 == last ? *first : at[1], *f);
    }
    if (!areOneFan(ends))
    {
      result.push_back(node);
    }
  }
  return result;
}

/// Whether the cells are in one group by three common corners. `corners`: of each, ascending.
bool areJoined(const std::vector<std::vector<Index>>& corners)
{
  UnionFind<Index> groups(static_cast<Index>(corners.size()));
  std::vector<Index> common;
  for (std::size_t a = 0; a < corners.size(); ++a)
  {
    for (std::size_t b = 0; b < a; ++b)
    {
      common.clear();
      std::set_intersection(corners[a].begin(), corners[a].end(), corners[b].begin(),
        corners[b].end(), std::back_inserter(common));
      if (common.size() >= 3)
      {
        groups.join(static_cast<Index>(a), static_cast<Index>(b));
      }
    }
  }
  for (std::size_t a = 0; a < corners.size(); ++a)
  {
    if (groups.root(static_cast<Index>(a)) != 0)
    {
      return false;
    }
  }
  return true;
}
}

std::vector<Index> cornersOf(const Mesh& mesh, Index cell)
{
  const Index* nodes = mesh.cell(cell);
  std::vector<Index> corners(nodes, nodes + numberOfCorners(mesh, cell));
  sortUnique(corners);
  return corners;
}

std::vector<Index> repeatedCells(const Mesh& mesh, Monitor& monitor)
{
  const Adjacency byLowest = sortIntoBuckets(mesh.numberOfCells(), mesh.numberOfNodes(), monitor,
    [&mesh](Index first, Index last, const auto& add)
    {
      for (Index c = first; c < last; ++c)
      {
        const Index corners = numberOfCorners(mesh, c);
        if (corners > 0)
        {
          add(*std::min_element(mesh.cell(c), mesh.cell(c) + corners), c);
        }
      }
    });
  std::vector<Index> result;
  std::mutex mutex;
  monitor.parallelFor(mesh.numberOfNodes(), 4096,
    [&](Index first, Index last)
    {
      std::vector<Index> found;
      std::vector<std::pair<Index, Index>> cells; // the sum of the corners, and the cell
      const auto sum = [&mesh](Index c)
      {
        const Index* nodes = mesh.cell(c);
        return std::accumulate(nodes, nodes + numberOfCorners(mesh, c), Index(0));
      };
      for (Index n = first; n < last; ++n)
      {
        cells.clear();
        for (const Index* c = byLowest.begin(n); c != byLowest.end(n); ++c)
        {
          cells.emplace_back(sum(*c), *c);
        }
        std::sort(cells.begin(), cells.end());
        for (std::size_t i = 1; i < cells.size(); ++i)
        {
          for (std::size_t j = i; j-- > 0 && cells[j].first == cells[i].first;)
          {
            const Index one = cells[i].second, other = cells[j].second;
            if ((mesh.types[one] != PolyVertex || mesh.types[other] != PolyVertex) &&
                cornersOf(mesh, one) == cornersOf(mesh, other))
            {
              found.insert(found.end(), { one, other });
            }
          }
        }
      }
      const std::lock_guard<std::mutex> lock(mutex);
      result.insert(result.end(), found.begin(), found.end());
    });
  sortUnique(result);
  return result;
}

std::vector<Index> touchingNodes(const Mesh& mesh, const BoundaryFaces& faces)
{
  const std::vector<Index> candidates = withoutFan(mesh, faces);
  if (candidates.empty())
  {
    return {};
  }
  std::map<Index, std::vector<std::vector<Index>>> around;
  for (const Index node : candidates)
  {
    around[node];
  }
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (mesh.types[c] == PolyVertex)
    {
      continue;
    }
    const std::vector<Index> corners = cornersOf(mesh, c);
    for (const Index node : corners)
    {
      if (std::binary_search(candidates.begin(), candidates.end(), node))
      {
        around[node].push_back(corners);
      }
    }
  }
  std::set<Index> touching;
  for (const auto& [node, cells] : around)
  {
    if (!areJoined(cells))
    {
      touching.insert(node);
    }
  }
  std::vector<Index> ofWholeFaces;
  for (std::size_t f = 0; f + 1 < faces.offsets.size(); ++f)
  {
    const auto first = faces.connectivity.begin() + faces.offsets[f],
               last = faces.connectivity.begin() + faces.offsets[f + 1];
    if (std::all_of(first, last, [&](Index node) { return touching.count(node) > 0; }))
    {
      ofWholeFaces.insert(ofWholeFaces.end(), first, last);
    }
  }
  for (const Index node : ofWholeFaces)
  {
    touching.erase(node);
  }
  return { touching.begin(), touching.end() };
}

Index mirroredBodies(const ConnectedComponents& bodies, const std::vector<std::int8_t>& orientation,
  const Communicator& processes)
{
  std::vector<double> isMirrored(static_cast<std::size_t>(bodies.count), 0);
  for (std::size_t c = 0; c < orientation.size(); ++c)
  {
    if (orientation[c] < 0)
    {
      isMirrored[bodies.ofCell[c]] = 1;
    }
  }
  processes.maximum(isMirrored.data(), static_cast<int>(bodies.count));
  return std::count(isMirrored.begin(), isMirrored.end(), 1);
}
}
