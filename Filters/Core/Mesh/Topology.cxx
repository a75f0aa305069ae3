// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Topology.h"

#include "Mesh/CellShape.h"
#include "Mesh/FaceTable.h"
#include "Mesh/HangingNodes.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/ShapeWindings.h"
#include "Support/Lists.h"
#include "Support/Parallel.h"
#include "Support/UnionFind.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace morph
{
namespace
{
constexpr Index NoNode = std::numeric_limits<Index>::max();

/// Collects the distinct corner nodes of a face in its order, and returns their number: collapsed
/// hexahedra repeat some. 0 for a face that covers itself.
int faceNodes(const Mesh& mesh, Index cell, const CellShape& shape, int face, Index nodes[4])
{
  const FaceShape& f = shape.faces[face];
  Index all[4];
  int size = 0;
  for (int k = 0; k < f.size; ++k)
  {
    all[k] = mesh.cell(cell)[shape.cornerNode[f.corner[k]]];
    if (std::find(nodes, nodes + size, all[k]) == nodes + size)
    {
      nodes[size++] = all[k];
    }
  }
  return coversItself(all, f.size) ? 0 : size;
}

/// The key that two cells sharing a face agree on: its corner nodes, ascending, padded with NoNode.
/// The key of a face collapsed to an edge or a point starts with NoNode.
std::array<Index, 4> faceKey(const Mesh& mesh, Index cell, const CellShape& shape, int face)
{
  std::array<Index, 4> key = { NoNode, NoNode, NoNode, NoNode };
  if (faceNodes(mesh, cell, shape, face, key.data()) < 3)
  {
    key.fill(NoNode);
  }
  std::sort(key.begin(), key.end());
  return key;
}

constexpr int MostFaces = 6;

/// A face by its cell and its number there.
struct Place
{
  Index cell;
  int side;
};

/// Returns the faces that one cell alone uses, ascending, where the mesh has polyhedra.
std::vector<Place> outerFacesAmongAll(const Mesh& mesh, Monitor& monitor)
{
  const FaceTable table = faceTable(mesh, monitor);
  std::vector<Place> faces;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (Index f = table.start[c]; f < table.start[c + 1]; ++f)
    {
      if (table.uses[f] == 1 && table.size(f) >= 3)
      {
        faces.push_back({ c, static_cast<int>(f - table.start[c]) });
      }
    }
  }
  return faces;
}
}

Adjacency nodeToCells(const Mesh& mesh)
{
  Monitor serial;
  return nodeToCells(mesh, serial);
}

Adjacency nodeToCells(const Mesh& mesh, Monitor& monitor)
{
  return sortIntoBuckets(mesh.numberOfCells(), mesh.numberOfNodes(), monitor,
    [&mesh](Index first, Index last, const auto& add)
    {
      for (Index c = first; c < last; ++c)
      {
        if (const CellShape* shape = volumeShape(mesh, c))
        {
          const Index *begin = mesh.cell(c), *end = begin + cornerCount(mesh, c, *shape);
          for (const Index* node = begin; node != end; ++node)
          {
            if (std::find(begin, node, *node) == node) // a collapsed cell repeats nodes
            {
              add(*node, c);
            }
          }
        }
      }
    });
}

namespace
{
/// Returns the faces that one cell alone uses, ascending.
std::vector<Place> outerFaces(const Mesh& mesh, Monitor& monitor)
{
  // Buckets the faces by their lowest corner: equal faces are in one bucket.
  const Index nodes = mesh.numberOfNodes();
  const Index cells = mesh.numberOfCells();
  Adjacency buckets = sortIntoBuckets(cells, nodes, monitor,
    [&mesh](Index first, Index last, const auto& add)
    {
      for (Index c = first; c < last; ++c)
      {
        if (const CellShape* shape = volumeShape(mesh, c))
        {
          for (int f = 0; f < shape->numberOfFaces; ++f)
          {
            Index lowest = NoNode;
            for (int k = 0; k < shape->faces[f].size; ++k)
            {
              lowest = std::min(lowest, mesh.cell(c)[shape->cornerNode[shape->faces[f].corner[k]]]);
            }
            add(lowest, c * MostFaces + f);
          }
        }
      }
    });
  const std::vector<Index>& offsets = buckets.offsets;
  std::vector<Index>& faces = buckets.values;
  monitor.check();

  // In a bucket, a face whose key is unique is on the boundary; the others are marked -1.
  monitor.parallelFor(nodes, 4096,
    [&](Index first, Index last)
    {
      std::vector<std::pair<std::array<Index, 4>, Index*>> keys;
      for (Index n = first; n < last; ++n)
      {
        keys.clear();
        for (Index* face = faces.data() + offsets[n]; face != faces.data() + offsets[n + 1]; ++face)
        {
          const Index cell = *face / MostFaces;
          keys.emplace_back(
            faceKey(mesh, cell, *volumeShape(mesh, cell), static_cast<int>(*face % MostFaces)),
            face);
        }
        std::sort(keys.begin(), keys.end());
        for (std::size_t i = 0; i < keys.size();)
        {
          std::size_t end = i + 1;
          while (end < keys.size() && keys[end].first == keys[i].first)
          {
            ++end;
          }
          const bool alone = end == i + 1 && keys[i].first[0] != NoNode;
          for (; i < end; ++i)
          {
            if (!alone)
            {
              *keys[i].second = -1;
            }
          }
        }
      }
    });

  faces.erase(std::remove(faces.begin(), faces.end(), -1), faces.end());
  std::sort(faces.begin(), faces.end());

  std::vector<Place> places;
  places.reserve(faces.size());
  for (Index face : faces)
  {
    places.push_back({ face / MostFaces, static_cast<int>(face % MostFaces) });
  }
  return places;
}

void addPolyhedronFace(const Mesh& mesh, const Place& place, BoundaryFaces& result)
{
  int side = 0;
  forEachFace(mesh, place.cell,
    [&](const Index* nodes, Index size)
    {
      if (side++ == place.side)
      {
        result.connectivity.insert(result.connectivity.end(), nodes, nodes + size);
      }
    });
}

/// Describes the faces at these places.
BoundaryFaces describeFaces(const Mesh& mesh, const std::vector<Place>& faces)
{
  const Index nodes = mesh.numberOfNodes();
  BoundaryFaces result;
  std::vector<std::uint8_t> onBoundary(
    nodes, 0);                               // 1: as a corner, 2: in the middle of an edge or face
  std::vector<std::array<Index, 5>> middles; // mid-side and face nodes with their corners
  result.offsets.reserve(faces.size() + 1);
  result.cells.reserve(faces.size());
  for (const Place& face : faces)
  {
    const Index cell = face.cell;
    result.cells.push_back(cell);
    result.sides.push_back(face.side);
    if (isPolyhedron(mesh, cell))
    {
      addPolyhedronFace(mesh, face, result);
      for (Index k = result.offsets.back(); k < static_cast<Index>(result.connectivity.size()); ++k)
      {
        onBoundary[result.connectivity[k]] = 1;
      }
      result.offsets.push_back(static_cast<Index>(result.connectivity.size()));
      continue;
    }
    const CellShape& shape = *volumeShape(mesh, cell);
    bool isOn[8] = {};
    Index corners[4];
    const int size = faceNodes(mesh, cell, shape, face.side, corners);
    for (int k = 0; k < size; ++k)
    {
      result.connectivity.push_back(corners[k]);
      onBoundary[corners[k]] = 1;
    }
    for (int a = 0; a < shape.numberOfCorners; ++a) // two corners may be one node
    {
      const Index node = mesh.cell(cell)[shape.cornerNode[a]];
      isOn[a] = std::find(corners, corners + size, node) != corners + size;
    }
    // A mid-side or face node lies on the face if only the face's corners contribute to it.
    for (int k = shape.numberOfCorners; k < shape.numberOfNodes; ++k)
    {
      double N[8];
      shapeFunctions(shape.shape, shape.extraNodes[k - shape.numberOfCorners], N, nullptr);
      bool inside = true;
      for (int a = 0; a < shape.numberOfCorners; ++a)
      {
        inside = inside && (isOn[a] || N[a] == 0);
      }
      const Index node = mesh.cell(cell)[k];
      if (!inside || onBoundary[node])
      {
        continue;
      }
      onBoundary[node] = 2;
      middles.push_back({ node, NoNode, NoNode, NoNode, NoNode });
      int corner = 0;
      for (int a = 0; a < shape.numberOfCorners; ++a)
      {
        if (N[a] != 0)
        {
          middles.back()[++corner] = mesh.cell(cell)[shape.cornerNode[a]];
        }
      }
    }
    result.offsets.push_back(static_cast<Index>(result.connectivity.size()));
  }

  std::sort(middles.begin(), middles.end());
  auto middle = middles.begin();
  for (Index n = 0; n < nodes; ++n)
  {
    const bool isMiddle = middle != middles.end() && middle->front() == n;
    if (onBoundary[n])
    {
      result.nodes.push_back(n);
      if (onBoundary[n] == 2)
      {
        std::copy_if(middle->begin() + 1, middle->end(), std::back_inserter(result.between.values),
          [](Index corner) { return corner != NoNode; });
      }
      result.between.offsets.push_back(static_cast<Index>(result.between.values.size()));
    }
    middle += isMiddle;
  }
  return result;
}

/// Whether all corners of a face of a layer are on one side of it.
bool isFrontOrBack(const Mesh& mesh, const Place& place)
{
  const CellShape& shape = *volumeShape(mesh, place.cell);
  Index corners[4];
  const int size = faceNodes(mesh, place.cell, shape, place.side, corners);
  return std::all_of(corners, corners + size,
    [&](Index node) { return (node < mesh.layer.nodes) == (corners[0] < mesh.layer.nodes); });
}
}

BoundaryFaces boundaryFaces(const Mesh& mesh, Monitor& monitor)
{
  HangingNodes hanging;
  return boundaryFaces(mesh, hanging, monitor);
}

BoundaryFaces facesOfOneCell(const Mesh& mesh, Monitor& monitor)
{
  std::vector<Place> places =
    hasPolyhedra(mesh) ? outerFacesAmongAll(mesh, monitor) : outerFaces(mesh, monitor);
  if (mesh.layer.nodes > 0)
  {
    places.erase(std::remove_if(places.begin(), places.end(),
                   [&](const Place& place) { return isFrontOrBack(mesh, place); }),
      places.end());
  }
  return describeFaces(mesh, places);
}

BoundaryFaces boundaryFaces(const Mesh& mesh, HangingNodes& hanging, Monitor& monitor)
{
  BoundaryFaces faces = facesOfOneCell(mesh, monitor);
  hanging.find(mesh, faces, monitor);
  return hanging.empty() ? faces : boundaryFaces(mesh, faces, hanging);
}

BoundaryFaces boundaryFaces(
  const Mesh& mesh, const BoundaryFaces& faces, const HangingNodes& hanging)
{
  std::vector<Place> outside;
  for (std::size_t f = 0; f < faces.cells.size(); ++f)
  {
    if (!hanging.isInside(faces.cells[f], faces.sides[f]))
    {
      outside.push_back({ faces.cells[f], faces.sides[f] });
    }
  }
  BoundaryFaces result = describeFaces(mesh, outside);
  hanging.divideEdges(result);
  return result;
}

BoundaryFaces facesOfCells(
  const Mesh& mesh, const BoundaryFaces& faces, const std::vector<std::uint8_t>& isOf)
{
  std::vector<Place> places;
  for (std::size_t face = 0; face < faces.cells.size(); ++face)
  {
    if (isOf[faces.cells[face]] != 0)
    {
      places.push_back({ faces.cells[face], faces.sides[face] });
    }
  }
  return describeFaces(mesh, places);
}

void setCorners(std::vector<Index> offsets, std::vector<Index> connectivity, BoundaryFaces& faces)
{
  std::map<Index, std::vector<Index>> between;
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    const Index k = static_cast<Index>(i);
    between[faces.nodes[i]].assign(faces.between.begin(k), faces.between.end(k));
  }
  for (const Index node : connectivity)
  {
    between[node].clear();
  }
  faces.nodes.clear();
  faces.between = {};
  for (const auto& [node, corners] : between)
  {
    faces.nodes.push_back(node);
    faces.between.add(corners.begin(), corners.end());
  }
  faces.offsets = std::move(offsets);
  faces.connectivity = std::move(connectivity);
}

void BoundaryFaces::takeNodes()
{
  this->nodes = this->connectivity;
  sortUnique(this->nodes);
  this->between.offsets.assign(this->nodes.size() + 1, 0);
}

BoundaryFaces facesBetween(const Mesh& mesh, const BoundaryFaces& faces, Index first, Index last)
{
  std::vector<Place> places;
  for (Index f = first; f < last; ++f)
  {
    places.push_back({ faces.cells[f], faces.sides[f] });
  }
  BoundaryFaces result = describeFaces(mesh, places);
  std::vector<Index> offsets;
  for (Index f = first; f <= last; ++f)
  {
    offsets.push_back(faces.offsets[f] - faces.offsets[first]);
  }
  const std::vector<Index> connectivity(faces.connectivity.begin() + faces.offsets[first],
    faces.connectivity.begin() + faces.offsets[last]);
  if (connectivity != result.connectivity)
  {
    setCorners(std::move(offsets), connectivity, result);
  }
  return result;
}

BoundaryFaces facesAt(const Mesh& mesh, const std::vector<std::pair<Index, int>>& places)
{
  std::vector<Place> faces;
  for (const auto& [cell, side] : places)
  {
    faces.push_back({ cell, side });
  }
  return describeFaces(mesh, faces);
}

std::vector<Index> bodyOfNodes(const Mesh& mesh, const ConnectedComponents& bodies)
{
  std::vector<Index> result = bodies.ofNode;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (Index k = 0; bodies.ofCell[c] >= 0 && k < mesh.cellSize(c); ++k)
    {
      result[mesh.cell(c)[k]] = bodies.ofCell[c];
    }
  }
  return result;
}

ConnectedComponents connectedComponents(const Mesh& mesh)
{
  Monitor serial;
  return connectedComponents(mesh, serial);
}

ConnectedComponents connectedComponents(
  const Mesh& mesh, Monitor& monitor, const Communicator& processes)
{
  if (processes.bodies())
  {
    return *processes.bodies();
  }
  constexpr Index None = -1;
  const Index nodes = mesh.numberOfNodes(), cells = mesh.numberOfCells();
  UnionFind<Index> bodies(nodes);
  parallel(cells, monitor,
    [&](Index c)
    {
      const CellShape* shape = volumeShape(mesh, c);
      const Index corners = shape ? cornerCount(mesh, c, *shape) : 0;
      for (Index k = 1, root = corners > 0 ? mesh.cell(c)[0] : None; k < corners; ++k)
      {
        root = bodies.join(root, mesh.cell(c)[k]);
      }
    });

  // Each cell gets its root, and the roots numbers in the order of their first cell.
  ConnectedComponents result;
  result.ofCell.resize(cells);
  parallel(cells, monitor,
    [&](Index c)
    { result.ofCell[c] = volumeShape(mesh, c) ? bodies.root(mesh.cell(c)[0]) : None; });
  std::vector<Index> number(nodes, None);
  for (const Index root : result.ofCell)
  {
    if (root != None && number[root] == None)
    {
      number[root] = result.count++;
    }
  }
  result.ofNode.resize(nodes);
  parallel(nodes, monitor, [&](Index i) { result.ofNode[i] = number[bodies.root(i)]; });
  result.count = processes.join(result.ofNode);
  parallel(cells, monitor,
    [&](Index c)
    { result.ofCell[c] = result.ofCell[c] == None ? None : result.ofNode[result.ofCell[c]]; });
  return result;
}

std::vector<std::int8_t> cellSigns(const Mesh& mesh, const ConnectedComponents& bodies)
{
  Monitor serial;
  return cellSigns(mesh, bodies, serial);
}

std::vector<std::int8_t> cellSigns(const Mesh& mesh, const ConnectedComponents& bodies,
  Monitor& monitor, const Communicator& processes)
{
  if (processes.orientation())
  {
    return *processes.orientation();
  }
  std::vector<std::int8_t> result =
    cellSigns(mesh, bodies, shapeVolumes(mesh, bodies, monitor, processes));
  alignShapeSigns(mesh, bodies, result, processes);
  return result;
}

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
