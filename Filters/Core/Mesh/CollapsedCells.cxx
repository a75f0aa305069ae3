// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CollapsedCells.h"

#include "Mesh/CellShape.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace morph
{
namespace
{
using NodeList = std::vector<Index>;

struct Replacement
{
  std::uint8_t type = EmptyCell; ///< EmptyCell: none is known
  NodeList nodes;
};

NodeList ascending(NodeList nodes)
{
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

/// The different nodes of a list, in its order.
NodeList different(const NodeList& nodes)
{
  NodeList result;
  for (const Index node : nodes)
  {
    if (std::find(result.begin(), result.end(), node) == result.end())
    {
      result.push_back(node);
    }
  }
  return result;
}

/// The faces of a cell that have an area and do not cover one another, outward.
std::vector<NodeList> facesOf(const CellShape& shape, const NodeList& corners)
{
  std::vector<NodeList> faces;
  for (int f = 0; f < shape.numberOfFaces; ++f)
  {
    NodeList face;
    for (int k = 0; k < shape.faces[f].size; ++k)
    {
      face.push_back(corners[shape.faces[f].corner[k]]);
    }
    face = different(face);
    if (face.size() < 3)
    {
      continue;
    }
    const auto same = std::find_if(faces.begin(), faces.end(),
      [&](const NodeList& other) { return ascending(other) == ascending(face); });
    if (same == faces.end())
    {
      faces.push_back(face);
    }
    else
    {
      faces.erase(same);
    }
  }
  return faces;
}

/// The corners of the linear cell with these faces, in VTK's order; none for another shape.
Replacement cellWith(const std::vector<NodeList>& faces, const NodeList& corners)
{
  std::vector<NodeList> triangles, quads;
  for (const NodeList& face : faces)
  {
    (face.size() == 3 ? triangles : quads).push_back(face);
  }
  const auto isOn = [](const NodeList& face, Index node)
  { return std::find(face.begin(), face.end(), node) != face.end(); };
  const std::size_t count = corners.size();
  if ((count == 4 && triangles.size() == 4 && quads.empty()) ||
      (count == 5 && triangles.size() == 4 && quads.size() == 1))
  {
    const NodeList& base = count == 4 ? triangles[0] : quads[0];
    NodeList nodes(base.rbegin(), base.rend());
    nodes.push_back(
      *std::find_if(corners.begin(), corners.end(), [&](Index n) { return !isOn(base, n); }));
    return { count == 4 ? Tetra : Pyramid, nodes };
  }
  if (count != 6 || triangles.size() != 2 || quads.size() != 3)
  {
    return {};
  }
  NodeList nodes(triangles[0].rbegin(), triangles[0].rend());
  for (int k = 0; k < 3; ++k)
  {
    for (const NodeList& quad : quads)
    {
      for (int i = 0; i < 4; ++i)
      {
        const Index one = quad[i], next = quad[(i + 1) % 4];
        if (one == nodes[k] && isOn(triangles[1], next))
        {
          nodes.push_back(next);
        }
      }
    }
  }
  return nodes.size() == 6 && ascending(nodes) == ascending(corners) ? Replacement{ Wedge, nodes }
                                                                     : Replacement{};
}

/// The numbers of the two corners that a node of a shape is between; of none for a face or body.
std::pair<int, int> edgeOf(const CellShape& shape, int node)
{
  double N[8];
  shapeFunctions(shape.shape, shape.extraNodes[node - shape.numberOfCorners], N, nullptr);
  std::vector<int> ends;
  for (int a = 0; a < shape.numberOfCorners; ++a)
  {
    if (N[a] != 0)
    {
      ends.push_back(a);
    }
  }
  return ends.size() == 2 ? std::pair(ends[0], ends[1]) : std::pair(-1, -1);
}

/// Adds the mid-side nodes of a cell to its replacement. Makes it none where they do not fit.
void addMidNodes(
  const CellShape& shape, const Index* cell, const NodeList& corners, Replacement& replacement)
{
  std::map<std::pair<Index, Index>, Index> middle;
  for (int k = shape.numberOfCorners; k < shape.numberOfNodes; ++k)
  {
    const auto [a, b] = edgeOf(shape, k);
    const std::pair<Index, Index> edge =
      a < 0 ? std::pair<Index, Index>(-1, -1) : std::minmax({ corners[a], corners[b] });
    const Index expected =
      edge.first == edge.second ? edge.first : middle.try_emplace(edge, cell[k]).first->second;
    if (a < 0 || expected != cell[k])
    {
      replacement = {};
      return;
    }
  }
  static const std::map<std::uint8_t, std::uint8_t> Quadratic = { { Tetra, QuadraticTetra },
    { Pyramid, QuadraticPyramid }, { Wedge, QuadraticWedge } };
  const auto type = Quadratic.find(replacement.type);
  if (type == Quadratic.end())
  {
    return; // no volume
  }
  replacement.type = type->second;
  const CellShape& to = *cellShape(replacement.type);
  const NodeList ends = replacement.nodes;
  for (int k = to.numberOfCorners; k < to.numberOfNodes; ++k)
  {
    const auto [a, b] = edgeOf(to, k);
    const auto found = middle.find(std::minmax({ ends[a], ends[b] }));
    if (found == middle.end())
    {
      replacement = {};
      return;
    }
    replacement.nodes.push_back(found->second);
  }
}

bool repeatsCorners(const CellShape& shape, const Index* cell)
{
  const Index* end = cell + shape.numberOfCorners; // of all types they come first
  return std::any_of(
    cell, end, [&](const Index& node) { return std::find(&node + 1, end, node) != end; });
}

Replacement replacementOf(const CellShape& shape, const Index* cell)
{
  NodeList corners;
  for (int k = 0; k < shape.numberOfCorners; ++k)
  {
    corners.push_back(cell[shape.cornerNode[k]]);
  }
  const NodeList distinct = different(corners);
  const std::vector<NodeList> faces = facesOf(shape, corners);
  Replacement replacement = cellWith(faces, distinct);
  if (faces.empty())
  {
    constexpr std::uint8_t Types[] = { EmptyCell, Vertex, Line, Triangle };
    replacement = { distinct.size() < 4 ? Types[distinct.size()] : std::uint8_t(Polygon),
      distinct };
  }
  if (replacement.type != EmptyCell && shape.numberOfNodes > shape.numberOfCorners)
  {
    addMidNodes(shape, cell, corners, replacement);
  }
  return replacement;
}
}

bool replaceCollapsedCells(Mesh& mesh)
{
  std::map<Index, Replacement> replaced;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const CellShape* shape = cellShape(mesh, c);
    if (!shape || shape->dimension != 3 || mesh.cellSize(c) != shape->numberOfNodes ||
        !repeatsCorners(*shape, mesh.cell(c)))
    {
      continue;
    }
    Replacement replacement = replacementOf(*shape, mesh.cell(c));
    if (replacement.type != EmptyCell)
    {
      replaced.emplace(c, std::move(replacement));
    }
  }
  if (replaced.empty())
  {
    return false;
  }
  std::vector<Index> offsets = { 0 }, connectivity;
  connectivity.reserve(mesh.connectivity.size());
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const auto found = replaced.find(c);
    if (found == replaced.end())
    {
      connectivity.insert(connectivity.end(), mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
    }
    else
    {
      const NodeList& nodes = found->second.nodes;
      connectivity.insert(connectivity.end(), nodes.begin(), nodes.end());
      mesh.types[c] = found->second.type;
    }
    offsets.push_back(static_cast<Index>(connectivity.size()));
  }
  mesh.offsets = std::move(offsets);
  mesh.connectivity = std::move(connectivity);
  return true;
}
}
