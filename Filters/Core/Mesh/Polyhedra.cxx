// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Polyhedra.h"

#include "Support/Error.h"
#include "Support/Lists.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace morph
{
namespace
{
/// One face at one of its edges.
struct Side
{
  Index low, high; ///< the edge's nodes
  Index face;      ///< number in the cell
  bool isForward;  ///< the face runs from `low` to `high`

  bool operator<(const Side& other) const
  {
    return std::tie(this->low, this->high, this->face) <
           std::tie(other.low, other.high, other.face);
  }
  bool isAt(const Side& other) const { return this->low == other.low && this->high == other.high; }
};

/// Returns the sides of a cell's faces, sorted, and counts the faces.
Index sidesOf(const Mesh& mesh, Index cell, std::vector<Side>& sides)
{
  sides.clear();
  Index faces = 0;
  forEachFace(mesh, cell,
    [&](const Index* nodes, Index size)
    {
      for (Index k = 0; k < size; ++k)
      {
        const Index a = nodes[k], b = nodes[(k + 1) % size];
        sides.push_back({ std::min(a, b), std::max(a, b), faces, a < b });
      }
      ++faces;
    });
  std::sort(sides.begin(), sides.end());
  return faces;
}

/// Whether each edge belongs to two faces. `sides`: sorted.
bool areSidesPaired(const std::vector<Side>& sides)
{
  for (std::size_t i = 0; i < sides.size(); i += 2)
  {
    const bool isPair = i + 1 < sides.size() && sides[i].isAt(sides[i + 1]) &&
                        sides[i].face != sides[i + 1].face &&
                        (i + 2 == sides.size() || !sides[i].isAt(sides[i + 2]));
    if (!isPair)
    {
      return false;
    }
  }
  return true;
}

/// For each face whether it runs against the first one; 0 or 1, and 2 where no path of edges leads
/// to it. `sides`: paired.
std::vector<char> turnsOf(const std::vector<Side>& sides, Index faces)
{
  constexpr char Unknown = 2;
  std::vector<std::vector<std::pair<Index, bool>>> neighbors(faces); // and whether it runs against
  for (std::size_t i = 0; i < sides.size(); i += 2)
  {
    const bool against = sides[i].isForward == sides[i + 1].isForward;
    neighbors[sides[i].face].emplace_back(sides[i + 1].face, against);
    neighbors[sides[i + 1].face].emplace_back(sides[i].face, against);
  }
  std::vector<char> turns(faces, Unknown);
  std::vector<Index> next = { 0 };
  turns[0] = 0;
  while (!next.empty())
  {
    const Index face = next.back();
    next.pop_back();
    for (const auto& [other, against] : neighbors[face])
    {
      if (turns[other] == Unknown)
      {
        turns[other] = static_cast<char>(against ? 1 - turns[face] : turns[face]);
        next.push_back(other);
      }
    }
  }
  return turns;
}

bool isConsistent(const std::vector<Side>& sides)
{
  for (std::size_t i = 0; i < sides.size(); i += 2)
  {
    if (sides[i].isForward == sides[i + 1].isForward)
    {
      return false;
    }
  }
  return true;
}

/// Whether no walk over the surface comes back reversed, as on a Moebius strip.
bool isOrientable(const std::vector<Side>& sides, const std::vector<char>& turns)
{
  for (std::size_t i = 0; i < sides.size(); i += 2)
  {
    const bool against = sides[i].isForward == sides[i + 1].isForward;
    if ((turns[sides[i].face] != turns[sides[i + 1].face]) != against)
    {
      return false;
    }
  }
  return true;
}

/// Whether the counts of the cell's faces end where its faces end.
bool areSizesRight(const Mesh& mesh, Index cell)
{
  Index at = mesh.faceOffsets[cell];
  const Index end = mesh.faceOffsets[cell + 1];
  while (at < end)
  {
    if (mesh.faces[at] < 0 || mesh.faces[at] > end - at - 1)
    {
      return false;
    }
    at += mesh.faces[at] + 1;
  }
  return at == end;
}

enum class Flaw
{
  None,
  Faces, ///< fewer than four, or counts that do not fit
  Nodes, ///< of a face: fewer than three, repeated or not the cell's
  Open   ///< not a closed surface
};

Flaw flawOf(const Mesh& mesh, Index cell, std::vector<Index>& own, std::vector<Side>& sides)
{
  if (!areSizesRight(mesh, cell))
  {
    return Flaw::Faces;
  }
  own.assign(mesh.cell(cell), mesh.cell(cell) + mesh.cellSize(cell));
  sortUnique(own);
  bool areNodesRight = true;
  std::vector<Index> face, used;
  forEachFace(mesh, cell,
    [&](const Index* nodes, Index size)
    {
      face.assign(nodes, nodes + size);
      std::sort(face.begin(), face.end());
      areNodesRight =
        areNodesRight && size >= 3 && std::adjacent_find(face.begin(), face.end()) == face.end();
      used.insert(used.end(), face.begin(), face.end());
    });
  sortUnique(used);
  if (!areNodesRight || used != own)
  {
    return Flaw::Nodes;
  }
  const Index faces = sidesOf(mesh, cell, sides);
  if (faces < 4)
  {
    return Flaw::Faces;
  }
  if (!areSidesPaired(sides))
  {
    return Flaw::Open;
  }
  if (isConsistent(sides) && faces < 8)
  {
    return Flaw::None; // so few faces cannot make two closed surfaces
  }
  const std::vector<char> turns = turnsOf(sides, faces);
  return std::find(turns.begin(), turns.end(), char(2)) == turns.end() && isOrientable(sides, turns)
           ? Flaw::None
           : Flaw::Open;
}

void require(const std::vector<Index>& cells, const char* flaw)
{
  if (!cells.empty())
  {
    throw Error("Polyhedra that " + std::string(flaw) + ": cell ids " + listIds(cells) +
                ". Write their faces again, or remove these cells.");
  }
}
}

void requireClosedPolyhedra(const Mesh& mesh)
{
  const Index cells = mesh.numberOfCells();
  std::vector<Index> without;
  for (Index c = 0; c < cells; ++c)
  {
    if (isPolyhedron(mesh, c) &&
        (!hasPolyhedra(mesh) || static_cast<Index>(mesh.faceOffsets.size()) != cells + 1))
    {
      without.push_back(c);
    }
  }
  require(without, "have no faces");
  if (!hasPolyhedra(mesh))
  {
    return;
  }
  if (mesh.faceOffsets.front() != 0 ||
      mesh.faceOffsets.back() != static_cast<Index>(mesh.faces.size()) ||
      !std::is_sorted(mesh.faceOffsets.begin(), mesh.faceOffsets.end()))
  {
    throw Error("The offsets of the polyhedra's faces do not match the faces. Write them again.");
  }
  std::vector<Index> wrongFaces, wrongNodes, open, own;
  std::vector<Side> sides;
  for (Index c = 0; c < cells; ++c)
  {
    if (!isPolyhedron(mesh, c))
    {
      continue;
    }
    const Flaw flaw = flawOf(mesh, c, own, sides);
    if (flaw != Flaw::None)
    {
      (flaw == Flaw::Faces ? wrongFaces : flaw == Flaw::Nodes ? wrongNodes : open).push_back(c);
    }
  }
  require(wrongFaces, "have fewer than four faces, or faces whose numbers of nodes do not add up");
  require(wrongNodes,
    "have a face with fewer than three nodes or a node twice, or other nodes than their faces");
  require(open, "are not closed (each edge needs two faces, and all faces must hang together)");
}

void orientPolyhedra(Mesh& mesh)
{
  std::vector<Side> sides;
  for (Index c = 0; hasPolyhedra(mesh) && c < mesh.numberOfCells(); ++c)
  {
    if (!isPolyhedron(mesh, c))
    {
      continue;
    }
    const Index faces = sidesOf(mesh, c, sides);
    if (isConsistent(sides))
    {
      continue;
    }
    const std::vector<char> turns = turnsOf(sides, faces);
    const auto turn = [&](auto&& isTurned)
    {
      Index number = 0;
      for (Index at = mesh.faceOffsets[c]; at < mesh.faceOffsets[c + 1]; at += mesh.faces[at] + 1)
      {
        if (isTurned(number++))
        {
          const auto first = mesh.faces.begin() + at + 1;
          std::reverse(first, first + mesh.faces[at]);
        }
      }
    };
    turn([&](Index face) { return turns[face] == 1; });
    if (polyhedronVolume(mesh, c, mesh.points) < 0)
    {
      turn([](Index) { return true; });
    }
  }
}

double polyhedronVolume(const Mesh& mesh, Index cell, const ConstPoints& points)
{
  const Eigen::RowVector3d origin = points.row(mesh.cell(cell)[0]);
  double volume = 0;
  forEachFace(mesh, cell,
    [&](const Index* nodes, Index size)
    {
      Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
      for (Index k = 0; k < size; ++k)
      {
        mean += (points.row(nodes[k]) - origin) / static_cast<double>(size);
      }
      for (Index k = 0; k < size; ++k)
      {
        const Eigen::RowVector3d a = points.row(nodes[k]) - origin;
        const Eigen::RowVector3d b = points.row(nodes[(k + 1) % size]) - origin;
        volume += a.cross(b).dot(mean) / 6;
      }
    });
  return volume;
}
}
