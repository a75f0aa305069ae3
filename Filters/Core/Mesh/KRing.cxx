// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/KRing.h"

#include "Mesh/CellShape.h"

#include <algorithm>
#include <iterator>

namespace morph
{
namespace
{
constexpr char Marked = 1, Visited = 2;
}

KRing kRingOfCells(const Mesh& mesh, const Adjacency& around, const std::vector<Index>& free,
  const std::vector<Index>& seeds, int rings, const Communicator& communicator)
{
  KRing patch;
  patch.cells = seeds;
  std::vector<char> isNode(mesh.numberOfNodes(), 0), isCell(mesh.numberOfCells(), 0);
  for (Index c : seeds)
  {
    isCell[c] = 1;
  }
  std::size_t from = 0;
  std::vector<Index> nodes;
  for (int ring = 0; ring <= rings; ++ring)
  {
    nodes.clear();
    for (const std::size_t until = patch.cells.size(); from < until; ++from)
    {
      const Index c = patch.cells[from];
      for (int a = 0; a < cellShape(mesh, c)->numberOfCorners; ++a)
      {
        const Index node = mesh.cell(c)[a];
        if (isNode[node] == 0)
        {
          isNode[node] = Marked;
          nodes.push_back(node);
        }
      }
    }
    communicator.spread(nodes);
    for (const Index node : nodes)
    {
      if (isNode[node] == Visited)
      {
        continue;
      }
      isNode[node] = Visited;
      for (const Index* next = around.begin(node); next != around.end(node); ++next)
      {
        if (!isCell[*next])
        {
          isCell[*next] = 1;
          patch.cells.push_back(*next);
        }
      }
    }
  }
  std::copy_if(free.begin(), free.end(), std::back_inserter(patch.nodes),
    [&](Index node) { return isNode[node] != 0; });
  patch.cells.clear(); // sorting them would take longer than this pass
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (isCell[c])
    {
      patch.cells.push_back(c);
    }
  }
  return patch;
}
}
