// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/FaceTable.h"

#include "Support/Parallel.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace morph
{
namespace
{
/// Finds the equal faces among those of one lowest corner, and numbers them by the first. `sorted`:
/// the corners of all faces, in their places in table.corners, those of each face ascending.
void matchFaces(const std::vector<Index>& sorted, std::vector<Index>& faces, FaceTable& table)
{
  const auto compare = [&](Index a, Index b)
  {
    const auto first = [&](Index face) { return sorted.begin() + table.corners.offsets[face]; };
    const auto last = [&](Index face) { return first(face) + table.size(face); };
    const auto [x, y] = std::mismatch(first(a), last(a), first(b), last(b));
    return x == last(a) || y == last(b) ? table.size(a) - table.size(b) : *x - *y;
  };
  std::sort(faces.begin(), faces.end(),
    [&](Index a, Index b)
    {
      const Index order = compare(a, b);
      return order != 0 ? order < 0 : a < b;
    });
  for (std::size_t i = 0; i < faces.size();)
  {
    std::size_t end = i + 1;
    while (end < faces.size() && compare(faces[end], faces[i]) == 0)
    {
      ++end;
    }
    const Index lowest = faces[i];
    const Index uses = static_cast<Index>(end - i);
    for (; i < end; ++i)
    {
      table.first[faces[i]] = lowest;
      table.uses[faces[i]] = uses;
    }
  }
}
}

FaceTable faceTable(const Mesh& mesh, Monitor& monitor)
{
  FaceTable table;
  table.start.push_back(0);
  std::vector<Index>& values = table.corners.values;
  values.reserve(mesh.faces.size() + 3 * mesh.connectivity.size());
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    forEachSide(mesh, c,
      [&](const Index* nodes, Index size)
      {
        const auto begin = static_cast<std::ptrdiff_t>(values.size());
        for (Index k = 0; k < size; ++k)
        {
          if (std::find(values.begin() + begin, values.end(), nodes[k]) == values.end())
          {
            values.push_back(nodes[k]);
          }
        }
        table.corners.offsets.push_back(static_cast<Index>(values.size()));
      });
    table.start.push_back(static_cast<Index>(table.corners.offsets.size()) - 1);
  }
  monitor.check();

  const Index faces = table.start.back(), nodes = mesh.numberOfNodes();
  table.first.resize(faces);
  table.uses.resize(faces);
  std::vector<Index> sorted = values;
  parallel(faces, monitor,
    [&](Index f)
    {
      std::sort(
        sorted.begin() + table.corners.offsets[f], sorted.begin() + table.corners.offsets[f + 1]);
    });
  // A collapsed face may have no corners left but one, never none.
  const auto lowestCorner = [&](Index face) { return sorted[table.corners.offsets[face]]; };
  Adjacency buckets;
  buckets.offsets.assign(nodes + 1, 0);
  for (Index f = 0; f < faces; ++f)
  {
    ++buckets.offsets[lowestCorner(f) + 1];
  }
  std::partial_sum(buckets.offsets.begin(), buckets.offsets.end(), buckets.offsets.begin());
  buckets.values.resize(faces);
  std::vector<Index> next(buckets.offsets.begin(), buckets.offsets.end() - 1);
  for (Index f = 0; f < faces; ++f)
  {
    buckets.values[next[lowestCorner(f)]++] = f;
  }
  monitor.parallelFor(nodes, 1024,
    [&](Index begin, Index end)
    {
      std::vector<Index> some;
      for (Index n = begin; n < end; ++n)
      {
        some.assign(buckets.begin(n), buckets.end(n));
        matchFaces(sorted, some, table);
      }
    });
  monitor.check();
  return table;
}
}
