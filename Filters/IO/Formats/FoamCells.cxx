// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/FoamCells.h"

#include <algorithm>
#include <set>

namespace morph::io
{
namespace
{
using Face = std::vector<Index>;

/// The node that an edge joins to `node`, on a face, outside of `base`; -1 where there is none.
Index oppositeOf(const std::vector<Face>& faces, const Face& base, Index node)
{
  Index found = -1;
  for (const Face& face : faces)
  {
    const auto at = std::find(face.begin(), face.end(), node);
    if (at == face.end())
    {
      continue;
    }
    const auto i = static_cast<std::size_t>(at - face.begin());
    for (const Index other :
      { face[(i + 1) % face.size()], face[(i + face.size() - 1) % face.size()] })
    {
      if (std::find(base.begin(), base.end(), other) == base.end())
      {
        if (found >= 0 && found != other)
        {
          return -1;
        }
        found = other;
      }
    }
  }
  return found;
}

bool hasFace(const std::vector<Face>& faces, std::set<Index> nodes)
{
  return std::any_of(faces.begin(), faces.end(),
    [&](const Face& face) { return std::set<Index>(face.begin(), face.end()) == nodes; });
}

/// A prism over `base`, or a pyramid: its nodes; none where the other faces are not those of one.
Face extruded(const std::vector<Face>& faces, const Face& base, bool isPyramid)
{
  Face nodes = base;
  for (const Index node : base)
  {
    const Index other = oppositeOf(faces, base, node);
    if (other < 0)
    {
      return {};
    }
    nodes.push_back(other);
  }
  const std::size_t n = base.size();
  for (std::size_t i = 0; i < n; ++i)
  {
    const std::size_t next = (i + 1) % n;
    if (!hasFace(faces, { nodes[i], nodes[next], nodes[n + i], nodes[n + next] }))
    {
      return {};
    }
  }
  if (isPyramid)
  {
    nodes.resize(n + 1);
  }
  else if (!hasFace(
             faces, std::set<Index>(nodes.begin() + static_cast<std::ptrdiff_t>(n), nodes.end())))
  {
    return {};
  }
  return nodes;
}
}

FoamCell foamCell(const std::vector<std::vector<Index>>& faces)
{
  std::set<Index> nodes;
  std::size_t triangles = 0, quads = 0;
  for (const Face& face : faces)
  {
    nodes.insert(face.begin(), face.end());
    triangles += face.size() == 3;
    quads += face.size() == 4;
  }
  struct Kind
  {
    std::size_t nodes, triangles, quads, base;
    std::uint8_t type;
  };
  static constexpr Kind kinds[] = { { 8, 0, 6, 4, Hexahedron }, { 6, 2, 3, 3, Wedge },
    { 5, 4, 1, 4, Pyramid }, { 4, 4, 0, 3, Tetra } };
  for (const Kind& kind : kinds)
  {
    if (faces.size() != triangles + quads || nodes.size() != kind.nodes ||
        triangles != kind.triangles || quads != kind.quads)
    {
      continue;
    }
    Face base = *std::find_if(
      faces.begin(), faces.end(), [&](const Face& face) { return face.size() == kind.base; });
    std::reverse(base.begin(), base.end()); // its normal points into the cell
    FoamCell cell;
    cell.nodes = extruded(faces, base, kind.type == Pyramid || kind.type == Tetra);
    cell.type = cell.nodes.size() == kind.nodes ? kind.type : std::uint8_t(0);
    return cell;
  }
  return {};
}
}
