// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/FaceTable.h"

#include "Mesh/Polyhedra.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace morph
{
namespace
{
/// Calls visit(nodes, size) for each face of a volume cell; collapsed cells repeat nodes.
template <typename Visit>
void forEachFaceOfAny(const Mesh& mesh, Index cell, Visit&& visit)
{
  if (isPolyhedron(mesh, cell))
  {
    forEachFace(mesh, cell, visit);
    return;
  }
  const CellShape* shape = cellShape(mesh.types[cell]);
  for (int f = 0; shape && shape->dimension == 3 && f < shape->numberOfFaces; ++f)
  {
    Index nodes[4];
    const FaceShape& face = shape->faces[f];
    std::transform(face.corner, face.corner + face.size, nodes,
      [&](int k) { return mesh.cell(cell)[shape->cornerNode[k]]; });
    visit(nodes, face.size);
  }
}

/// Finds the equal faces among those of one lowest corner, and numbers them by the first.
void matchFaces(const std::vector<Index>& faces, FaceTable& table)
{
  std::vector<std::pair<std::vector<Index>, Index>> keys;
  for (const Index face : faces)
  {
    std::vector<Index> key(table.corners.begin(face), table.corners.end(face));
    std::sort(key.begin(), key.end());
    keys.emplace_back(std::move(key), face);
  }
  std::sort(keys.begin(), keys.end());
  for (std::size_t i = 0; i < keys.size();)
  {
    std::size_t end = i + 1;
    while (end < keys.size() && keys[end].first == keys[i].first)
    {
      ++end;
    }
    const Index lowest = keys[i].second;
    const Index uses = static_cast<Index>(end - i);
    for (; i < end; ++i)
    {
      table.first[keys[i].second] = lowest;
      table.uses[keys[i].second] = uses;
    }
  }
}
}

FaceTable faceTable(const Mesh& mesh, Monitor& monitor)
{
  FaceTable table;
  table.start.push_back(0);
  table.corners.offsets.push_back(0);
  std::vector<Index>& values = table.corners.values;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    forEachFaceOfAny(mesh, c,
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
  const auto lowestCorner = [&](Index face)
  { return *std::min_element(table.corners.begin(face), table.corners.end(face)); };
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
        matchFaces(some, table);
      }
    });
  monitor.check();
  return table;
}
}
