// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/SolverMesh.h"

#include "Mesh/CollapsedCells.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <algorithm>
#include <array>
#include <map>

namespace morph::io
{
void SolverMesh::addNode(Index number, double x, double y, double z)
{
  this->nodeNumbers.push_back(number);
  this->coordinates.insert(this->coordinates.end(), { x, y, z });
}

namespace
{
/// The linear cell of a quadratic one, and the edges that its further nodes are on.
struct Edges
{
  std::uint8_t linear;
  std::vector<std::array<std::size_t, 2>> ends;
};

const Edges& edgesOf(std::uint8_t quadratic)
{
  static const std::map<std::uint8_t, Edges> table = {
    { QuadraticTriangle, { Triangle, { { 0, 1 }, { 1, 2 }, { 2, 0 } } } },
    { QuadraticQuad, { Quad, { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 } } } },
    { QuadraticTetra, { Tetra, { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } } } },
    { QuadraticPyramid, { Pyramid, { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 0, 4 }, { 1, 4 },
                                     { 2, 4 }, { 3, 4 } } } },
    { QuadraticWedge, { Wedge, { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 3, 4 }, { 4, 5 }, { 5, 3 },
                                 { 0, 3 }, { 1, 4 }, { 2, 5 } } } },
    { QuadraticHexahedron,
      { Hexahedron, { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 4, 5 }, { 5, 6 }, { 6, 7 },
                      { 7, 4 }, { 0, 4 }, { 1, 5 }, { 2, 6 }, { 3, 7 } } } },
  };
  return table.at(quadratic);
}
}

Index SolverMesh::addCell(std::uint8_t type, const std::vector<Index>& nodes, Index number)
{
  if (std::find(nodes.begin(), nodes.end(), -1) != nodes.end())
  {
    const Edges& edges = edgesOf(type);
    const auto middles = nodes.end() - static_cast<std::ptrdiff_t>(edges.ends.size());
    const Index cell = this->addCell(edges.linear, { nodes.begin(), middles }, number);
    for (std::size_t i = 0; i < edges.ends.size(); ++i)
    {
      const auto& [first, last] = edges.ends[i];
      if (const Index middle = middles[static_cast<std::ptrdiff_t>(i)]; middle >= 0)
      {
        this->addCell(QuadraticEdge, { nodes[first], nodes[last], middle }, -1);
      }
    }
    return cell;
  }
  if (type == QuadraticPyramid && nodes.size() == 14)
  {
    const Index cell = this->addCell(type, { nodes.begin(), nodes.end() - 1 }, number);
    std::vector<Index> base = { nodes[0], nodes[1], nodes[2], nodes[3] };
    base.insert(base.end(), { nodes[5], nodes[6], nodes[7], nodes[8], nodes[13] });
    this->addCell(BiquadraticQuad, base, -1);
    return cell;
  }
  this->cellTypes.push_back(type);
  this->connectivity.insert(this->connectivity.end(), nodes.begin(), nodes.end());
  this->offsets.push_back(static_cast<Index>(this->connectivity.size()));
  this->cellNumbers.push_back(number);
  if (!this->faceOffsets.empty())
  {
    this->faceOffsets.push_back(static_cast<Index>(this->faces.size()));
  }
  return this->cells() - 1;
}

Index SolverMesh::addPolyhedron(const std::vector<std::vector<Index>>& faces, Index number)
{
  this->faceOffsets.resize(this->offsets.size(), 0);
  std::vector<Index> nodes;
  for (const std::vector<Index>& face : faces)
  {
    this->faces.push_back(static_cast<Index>(face.size()));
    this->faces.insert(this->faces.end(), face.begin(), face.end());
    nodes.insert(nodes.end(), face.begin(), face.end());
  }
  sortUnique(nodes);
  return this->addCell(Polyhedron, nodes, number);
}

NamedSet& SolverMesh::set(const std::string& name)
{
  const auto found = std::find_if(
    this->sets.begin(), this->sets.end(), [&](const NamedSet& set) { return set.name == name; });
  if (found != this->sets.end())
  {
    return *found;
  }
  this->sets.push_back({ name, {}, {} });
  return this->sets.back();
}

namespace
{
/// For each of `count` positions its place in `positions`; -1: none.
std::vector<Index> placesOf(const std::vector<Index>& positions, Index count)
{
  std::vector<Index> places(static_cast<std::size_t>(count), -1);
  for (std::size_t i = 0; i < positions.size(); ++i)
  {
    places[positions[i]] = static_cast<Index>(i);
  }
  return places;
}

std::vector<Index> kept(const std::vector<Index>& members, const std::vector<Index>& places)
{
  std::vector<Index> result;
  for (const Index member : members)
  {
    if (places[member] >= 0)
    {
      result.push_back(places[member]);
    }
  }
  return result;
}

/// Adds a cell of `mesh` to a part of it, whose nodes have these places.
void addCopy(const SolverMesh& mesh, Index cell, const std::vector<Index>& places, SolverMesh& part)
{
  const auto map = [&places](const Index* begin, const Index* end)
  {
    std::vector<Index> result(begin, end);
    std::transform(
      result.begin(), result.end(), result.begin(), [&](Index node) { return places[node]; });
    return result;
  };
  if (mesh.cellTypes[cell] == Polyhedron)
  {
    std::vector<std::vector<Index>> faces;
    for (Index at = mesh.faceOffsets[cell]; at < mesh.faceOffsets[cell + 1];
         at += mesh.faces[at] + 1)
    {
      const Index* face = mesh.faces.data() + at + 1;
      faces.push_back(map(face, face + mesh.faces[at]));
    }
    part.addPolyhedron(faces, mesh.cellNumbers[cell]);
    return;
  }
  const Index* nodes = mesh.connectivity.data();
  part.addCell(mesh.cellTypes[cell],
    map(nodes + mesh.offsets[cell], nodes + mesh.offsets[cell + 1]), mesh.cellNumbers[cell]);
}
}

Mesh coreMesh(const SolverMesh& mesh)
{
  Mesh result;
  result.points = Eigen::Map<const Points>(mesh.coordinates.data(), mesh.nodes(), 3);
  result.types = mesh.cellTypes;
  result.offsets = mesh.offsets;
  result.connectivity = mesh.connectivity;
  result.faceOffsets = mesh.faceOffsets;
  result.faces = mesh.faces;
  validate(result);
  Monitor serial;
  recognizeCells(result, serial);
  return result;
}

SolverMesh partOf(
  const SolverMesh& mesh, const std::vector<Index>& nodes, const std::vector<Index>& cells)
{
  SolverMesh part;
  part.displacementName = mesh.displacementName;
  const std::vector<Index> placeOfNode = placesOf(nodes, mesh.nodes());
  const std::vector<Index> placeOfCell = placesOf(cells, mesh.cells());
  for (const Index node : nodes)
  {
    const double* x = mesh.coordinates.data() + 3 * node;
    part.addNode(mesh.nodeNumbers[node], x[0], x[1], x[2]);
    for (Index j = 3 * node; !mesh.displacements.empty() && j < 3 * node + 3; ++j)
    {
      part.displacements.push_back(mesh.displacements[j]);
    }
  }
  for (const Index cell : cells)
  {
    addCopy(mesh, cell, placeOfNode, part);
  }
  for (const NamedSet& set : mesh.sets)
  {
    part.sets.push_back({ set.name, kept(set.nodes, placeOfNode), kept(set.cells, placeOfCell) });
  }
  return part;
}

int dimensionOf(std::uint8_t type)
{
  const CellShape* shape = cellShape(type);
  return shape ? shape->dimension : 3;
}
}
