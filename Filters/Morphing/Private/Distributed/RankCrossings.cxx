// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/RankCrossings.h"

#include "Boundary/CrossingFaces.h"
#include "Private/Data/WrittenPoints.h"

#include <algorithm>
#include <numeric>
#include <sstream>
#include <string>

namespace morph::filters::RankCrossings
{
namespace
{
using morph::Index;
using morph::distributed::Ranks;

/// What a process tells of its outer faces, and of each of their corners.
///@{
struct FaceRecord
{
  std::int64_t cell, side, corners, sign;
};
struct CornerRecord
{
  std::int64_t node;
  double rest[3], moved[3];
};
///@}

struct Part
{
  std::vector<FaceRecord> faces;
  std::vector<CornerRecord> corners;
};

/// `moved`: #nodes x 3 at least.
Part ownPart(const RankMesh& mesh, const morph::ConstPoints& moved)
{
  Part part;
  const auto& whole = mesh.Whole();
  const morph::BoundaryFaces& outer = whole.outerFaces();
  for (std::size_t f = 0; f < outer.cells.size(); ++f)
  {
    const Index begin = outer.offsets[f], end = outer.offsets[f + 1];
    part.faces.push_back({ whole.cellId(outer.cells[f]), outer.sides[f], end - begin,
      whole.orientation()[outer.cells[f]] });
    for (Index k = begin; k < end; ++k)
    {
      const Index node = outer.connectivity[k];
      CornerRecord& corner = part.corners.emplace_back();
      corner.node = whole.nodeId(node);
      for (int d = 0; d < 3; ++d)
      {
        corner.rest[d] = mesh.Piece().points(node, d);
        corner.moved[d] = moved(node, d);
      }
    }
  }
  return part;
}

/// The outer faces of all processes, by cell and side: the order of one process.
struct Gathered
{
  morph::BoundaryFaces faces; ///< `cells` are their own numbers
  std::vector<std::int8_t> orientation;
  std::vector<Index> cells; ///< global ids
  std::vector<Index> sides;
  morph::Points rest, moved;

  /// Collective.
  Gathered(const Ranks& ranks, const Part& mine)
  {
    const Part all = { ranks.gather(mine.faces), ranks.gather(mine.corners) };
    std::vector<Index> begin(all.faces.size() + 1, 0), order(all.faces.size());
    std::vector<std::int64_t> ids;
    for (std::size_t f = 0; f < all.faces.size(); ++f)
    {
      begin[f + 1] = begin[f] + all.faces[f].corners;
    }
    for (const CornerRecord& corner : all.corners)
    {
      ids.push_back(corner.node);
    }
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    this->rest.resize(static_cast<Index>(ids.size()), 3);
    this->moved = this->rest;
    std::iota(order.begin(), order.end(), Index(0));
    const auto key = [&](Index f) { return std::pair(all.faces[f].cell, all.faces[f].side); };
    std::sort(order.begin(), order.end(), [&](Index f, Index g) { return key(f) < key(g); });
    this->faces.offsets = { 0 };
    for (const Index f : order)
    {
      for (Index k = begin[f]; k < begin[f + 1]; ++k)
      {
        const CornerRecord& corner = all.corners[k];
        const Index node = std::lower_bound(ids.begin(), ids.end(), corner.node) - ids.begin();
        this->faces.connectivity.push_back(node);
        this->rest.row(node) = Eigen::Map<const Eigen::RowVector3d>(corner.rest);
        this->moved.row(node) = Eigen::Map<const Eigen::RowVector3d>(corner.moved);
      }
      this->faces.offsets.push_back(static_cast<Index>(this->faces.connectivity.size()));
      this->faces.cells.push_back(static_cast<Index>(this->cells.size()));
      this->orientation.push_back(static_cast<std::int8_t>(all.faces[f].sign));
      this->cells.push_back(all.faces[f].cell);
      this->sides.push_back(all.faces[f].side);
    }
  }

  /// Collective.
  Crossings::Pairs Pairs(const RankMesh& mesh, morph::Monitor& monitor) const
  {
    Crossings::Pairs pairs;
    mesh.Ranks().together(
      [&]
      {
        pairs =
          morph::crossingFaces(this->rest, this->moved, this->faces, this->orientation, monitor);
      });
    return pairs;
  }

  Index FaceAt(Index cell, Index side) const
  {
    Index face =
      std::lower_bound(this->cells.begin(), this->cells.end(), cell) - this->cells.begin();
    while (this->sides[face] != side)
    {
      ++face;
    }
    return face;
  }
};

/// The names of the surfaces of some faces. Each process names its own, whose numbers among its
/// outer faces go to `own`.
std::map<Index, std::string> namesOf(const std::vector<Index>& some, const Gathered& gathered,
  const RankMesh& mesh, vtkUnstructuredGrid* output, std::vector<Index>& own)
{
  const auto& whole = mesh.Whole();
  const morph::BoundaryFaces& outer = whole.outerFaces();
  std::vector<char> mine;
  mesh.Ranks().together(
    [&]
    {
      std::map<Index, Index> faceOf;
      for (std::size_t f = 0; f < outer.cells.size(); ++f)
      {
        const Index face = gathered.FaceAt(whole.cellId(outer.cells[f]), outer.sides[f]);
        if (std::binary_search(some.begin(), some.end(), face))
        {
          own.push_back(static_cast<Index>(f));
          faceOf[static_cast<Index>(f)] = face;
        }
      }
      std::string text;
      if (!own.empty())
      {
        for (const auto& [f, name] : Crossings::NamesOf(own, mesh.Piece(), outer, output, nullptr))
        {
          text += std::to_string(faceOf[f]) + " " + name + "\n";
        }
      }
      mine.assign(text.begin(), text.end());
    });
  const std::vector<char> all = mesh.Ranks().gather(mine);
  std::istringstream lines(std::string(all.begin(), all.end()));
  std::map<Index, std::string> names;
  for (std::string line; std::getline(lines, line);)
  {
    const std::size_t space = line.find(' ');
    names[std::stoll(line.substr(0, space))] = line.substr(space + 1);
  }
  return names;
}
}

Crossings::Found Find(const RankMesh& mesh, vtkUnstructuredGrid* output, morph::Monitor& monitor)
{
  const auto& ranks = mesh.Ranks();
  Part mine;
  ranks.together(
    [&]
    {
      if (!mesh.Whole().outerFaces().cells.empty())
      {
        withPoints(output, [&](const morph::ConstPoints& moved) { mine = ownPart(mesh, moved); });
      }
    });
  const Gathered gathered(ranks, mine);
  const Crossings::Pairs pairs = gathered.Pairs(mesh, monitor);
  const std::vector<Index> faces = Crossings::FacesOf(pairs);
  std::vector<Index> own;
  const auto names = namesOf(faces, gathered, mesh, output, own);
  Crossings::Found found =
    Crossings::Describe(pairs, names, gathered.faces, gathered.cells, gathered.moved);
  found.Own = std::move(own);
  return found;
}

bool Any(const RankMesh& mesh, const morph::Points& moved, morph::Monitor& monitor)
{
  Part mine;
  mesh.Ranks().together([&] { mine = ownPart(mesh, morph::ConstPoints(moved)); });
  const Gathered gathered(mesh.Ranks(), mine);
  return !gathered.Pairs(mesh, monitor).empty();
}
}
