// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CollapsedCells.h"

#include "Mesh/CellShape.h"
#include "Mesh/FaceTable.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/SharedCorners.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <map>
#include <set>
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
  NodeList faces = {}; ///< as in Mesh::faces
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
    const bool hasArea = !coversItself(face.data(), shape.faces[f].size);
    face = different(face);
    if (!hasArea || face.size() < 3)
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

/// The polyhedron with these faces; none where they are no closed surface like that of a sphere.
Replacement polyhedronWith(const std::vector<NodeList>& faces, const NodeList& corners)
{
  Replacement result = { Polyhedron, corners };
  std::set<std::pair<Index, Index>> edges; // each as its face runs
  std::size_t sides = 0;
  for (const NodeList& face : faces)
  {
    result.faces.push_back(static_cast<Index>(face.size()));
    result.faces.insert(result.faces.end(), face.begin(), face.end());
    sides += face.size();
    for (std::size_t k = 0; k < face.size(); ++k)
    {
      edges.emplace(face[k], face[(k + 1) % face.size()]);
    }
  }
  const bool isClosed =
    edges.size() == sides && std::all_of(edges.begin(), edges.end(),
                               [&](const auto& edge) {
                                 return edges.count({ edge.second, edge.first });
                               });
  const bool isSphere = corners.size() + faces.size() == sides / 2 + 2; // Euler's formula
  return isClosed && isSphere && faces.size() >= 4 ? result : Replacement{};
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

/// `type`: the cell's own.
Replacement replacementOf(std::uint8_t type, const CellShape& shape, const Index* cell)
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
  const bool isLinear = shape.numberOfNodes == shape.numberOfCorners;
  if (replacement.type != EmptyCell && !isLinear)
  {
    addMidNodes(shape, cell, corners, replacement);
  }
  if (replacement.type == EmptyCell)
  {
    replacement = polyhedronWith(faces, distinct);
    if (replacement.type != EmptyCell && !isLinear)
    {
      replacement.type = type;
      replacement.nodes.assign(cell, cell + shape.numberOfNodes);
    }
  }
  return replacement;
}

void replace(const std::map<Index, Replacement>& replaced, Mesh& mesh)
{
  if (replaced.empty())
  {
    return;
  }
  const bool hasFaces =
    hasPolyhedra(mesh) || std::any_of(replaced.begin(), replaced.end(),
                            [](const auto& cell) { return !cell.second.faces.empty(); });
  const auto add = [](std::vector<Index>& to, const Index* first, const Index* last)
  { to.insert(to.end(), first, last); };
  Mesh result;
  result.offsets = { 0 };
  result.connectivity.reserve(mesh.connectivity.size());
  result.faceOffsets.assign(hasFaces ? 1 : 0, 0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const auto found = replaced.find(c);
    if (found != replaced.end())
    {
      const auto& [type, nodes, faces] = found->second;
      mesh.types[c] = type;
      add(result.connectivity, nodes.data(), nodes.data() + nodes.size());
      add(result.faces, faces.data(), faces.data() + faces.size());
    }
    else
    {
      add(result.connectivity, mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
      forEachFace(mesh, c,
        [&](const Index* nodes, Index size) { add(result.faces, nodes - 1, nodes + size); });
    }
    result.offsets.push_back(static_cast<Index>(result.connectivity.size()));
    if (hasFaces)
    {
      result.faceOffsets.push_back(static_cast<Index>(result.faces.size()));
    }
  }
  mesh.offsets = std::move(result.offsets);
  mesh.connectivity = std::move(result.connectivity);
  mesh.faceOffsets = std::move(result.faceOffsets);
  mesh.faces = std::move(result.faces);
}

std::map<Index, Replacement> collapsedCells(const Mesh& mesh)
{
  std::map<Index, Replacement> result;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const CellShape* shape = cellShape(mesh, c);
    if (!shape || shape->dimension != 3 || mesh.cellSize(c) != shape->numberOfNodes ||
        !repeatsCorners(*shape, mesh.cell(c)))
    {
      continue;
    }
    Replacement replacement = replacementOf(mesh.types[c], *shape, mesh.cell(c));
    if (replacement.type != EmptyCell)
    {
      result.emplace(c, std::move(replacement));
    }
  }
  return result;
}

/// All but the first of volume cells with the same corners, as poly-vertices of these. `isBefore`:
/// the order.
template <typename Order>
std::map<Index, Replacement> laterCopies(const Mesh& mesh, const Order& isBefore, Monitor& monitor)
{
  std::map<Index, Replacement> result;
  std::set<NodeList> known;
  NodeList cells = repeatedCells(mesh, monitor);
  std::sort(cells.begin(), cells.end(), isBefore);
  for (const Index cell : cells)
  {
    const NodeList corners = cornersOf(mesh, cell);
    if (mesh.types[cell] != PolyVertex && !known.insert(corners).second)
    {
      result[cell] = { PolyVertex, corners };
    }
  }
  return result;
}
}

void recognizeCells(Mesh& mesh, Monitor& monitor)
{
  replace(collapsedCells(mesh), mesh);
  replace(laterCopies(mesh, std::less<Index>(), monitor), mesh);
  orientPolyhedra(mesh);
}

void keepFirstCopies(Mesh& mesh, const std::vector<std::int64_t>& ids, Monitor& monitor)
{
  const auto isBefore = [&ids](Index a, Index b) { return ids[a] < ids[b]; };
  replace(laterCopies(mesh, isBefore, monitor), mesh);
}

std::vector<Index> unrecognizedCells(const Mesh& mesh, const std::vector<Index>& cells)
{
  std::vector<Index> result;
  std::copy_if(cells.begin(), cells.end(), std::back_inserter(result),
    [&](Index cell)
    { return !hasFaces(mesh, cell) && repeatsCorners(*cellShape(mesh, cell), mesh.cell(cell)); });
  return result;
}
}
