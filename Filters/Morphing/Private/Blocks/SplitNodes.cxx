// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Blocks/SplitNodes.h"

#include "Mesh/Polyhedra.h"
#include "Private/Blocks/SharedNodes.h"
#include "Private/Data/Faces.h"
#include "Support/Lists.h"
#include "Support/UnionFind.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

namespace morph::filters::SplitNodes
{
namespace
{
using morph::Index;

/// A face of a part: its points by their places.
struct Face
{
  std::size_t Part;
  std::map<Index, Index> PointAt;
};
using FacesByPlaces = std::map<std::vector<Index>, std::vector<Face>>;

/// The places in a cell of all nodes of each of its faces.
std::vector<std::set<int>> facesOf(const morph::CellShape& shape)
{
  std::vector<std::set<int>> faces;
  for (int f = 0; f < shape.numberOfFaces; ++f)
  {
    std::set<int>& nodes = faces.emplace_back();
    for (const Faces::Polygon& piece : Faces::Pieces(shape, f))
    {
      nodes.insert(piece.begin(), piece.end());
    }
  }
  return faces;
}

/// Adds the faces of a part that have a point at a place with several nodes. `places`: of the
/// nodes, the first node there; `isSplit`: of the nodes.
void addFaces(const Part& part, std::size_t number, const std::vector<Index>& places,
  const std::vector<std::uint8_t>& isSplit, FacesByPlaces& faces)
{
  std::map<std::uint8_t, std::vector<std::set<int>>> shapes;
  const auto addFace = [&](const std::vector<Index>& points)
  {
    Face face = { number, {} };
    std::vector<Index> key;
    bool hasSplit = false;
    for (const Index point : points)
    {
      face.PointAt[places[part.Nodes[point]]] = point;
      hasSplit = hasSplit || isSplit[part.Nodes[point]];
    }
    if (hasSplit)
    {
      for (const auto& [place, point] : face.PointAt)
      {
        key.push_back(place);
      }
      faces[key].push_back(std::move(face));
    }
  };
  for (Index c = 0; c < part.Mesh.numberOfCells(); ++c)
  {
    const Index* corners = part.Mesh.cell(c);
    const morph::CellShape* shape = morph::cellShape(part.Mesh.types[c]);
    const bool isAny = shape && shape->dimension == 3 &&
                       std::any_of(corners, corners + part.Mesh.cellSize(c),
                         [&](Index point) { return isSplit[part.Nodes[point]] != 0; });
    if (!isAny)
    {
      continue;
    }
    if (morph::isPolyhedron(part.Mesh, c))
    {
      morph::forEachFace(part.Mesh, c,
        [&](const Index* nodes, Index size) { addFace(std::vector<Index>(nodes, nodes + size)); });
      continue;
    }
    const auto [known, isNew] = shapes.try_emplace(part.Mesh.types[c]);
    if (isNew)
    {
      known->second = facesOf(*shape);
    }
    for (const std::set<int>& nodes : known->second)
    {
      std::vector<Index> points;
      std::transform(nodes.begin(), nodes.end(), std::back_inserter(points),
        [corners](int node) { return corners[node]; });
      addFace(points);
    }
  }
}
}

std::vector<morph::Index> Join(
  const SharedNodes& shared, std::vector<Part>& parts, morph::Index& number)
{
  std::vector<Index> renamed = consecutive(number);
  std::vector<std::uint8_t> isSplit;
  const std::vector<Index> places = shared.Places(isSplit);
  if (std::find(isSplit.begin(), isSplit.end(), 1) == isSplit.end())
  {
    return renamed;
  }
  Index copies = 0; // points at places with several nodes, in groups that are one node each
  std::vector<std::vector<Index>> copyOf;
  FacesByPlaces faces;
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    std::vector<Index>& own = copyOf.emplace_back(parts[p].Nodes.size(), -1);
    std::map<Index, Index> ofNode; // points that the block itself shares, at a seam, stay so
    for (std::size_t i = 0; i < own.size(); ++i)
    {
      const Index node = parts[p].Nodes[i];
      if (isSplit[node])
      {
        const auto [known, isNew] = ofNode.try_emplace(node, -1);
        own[i] = known->second = isNew ? copies++ : known->second;
      }
    }
    addFaces(parts[p], p, places, isSplit, faces);
  }
  morph::UnionFind<Index> groups(copies);
  for (const auto& [key, same] : faces)
  {
    // Two faces of one part are inside it, or are the two sides of a crack.
    std::vector<const Face*> outer;
    for (const Face& face : same)
    {
      const auto ofPart = std::count_if(
        same.begin(), same.end(), [&](const Face& other) { return other.Part == face.Part; });
      if (ofPart == 1)
      {
        outer.push_back(&face);
      }
    }
    for (std::size_t i = 1; i < outer.size(); ++i)
    {
      for (const Index place : key)
      {
        const Index a = copyOf[outer[0]->Part][outer[0]->PointAt.at(place)];
        const Index b = copyOf[outer[i]->Part][outer[i]->PointAt.at(place)];
        if (a >= 0 && b >= 0)
        {
          groups.join(a, b);
        }
      }
    }
  }

  std::fill(renamed.begin(), renamed.end(), Index(-1));
  std::map<Index, Index> ofCopies;
  number = 0;
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    for (std::size_t i = 0; i < parts[p].Nodes.size(); ++i)
    {
      Index& node = parts[p].Nodes[i];
      Index& known = copyOf[p][i] < 0
                       ? renamed[node]
                       : ofCopies.try_emplace(groups.root(copyOf[p][i]), -1).first->second;
      if (known < 0)
      {
        known = number++;
      }
      if (isSplit[node] && renamed[places[node]] < 0)
      {
        renamed[places[node]] = known; // for a block that follows
      }
      node = known;
    }
  }
  for (std::size_t node = 0; node < renamed.size(); ++node)
  {
    renamed[node] = renamed[node] < 0 ? renamed[places[node]] : renamed[node];
  }
  return renamed;
}
}
