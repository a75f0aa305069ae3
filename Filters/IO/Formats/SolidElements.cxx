// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/SolidElements.h"

#include <algorithm>
#include <map>

namespace morph::io
{
namespace
{
/// What a hexahedron is whose corners are equal from the first to the last of each range.
struct Collapsed
{
  std::vector<std::pair<std::size_t, std::size_t>> equal;
  std::uint8_t type, quadratic;
  std::vector<std::size_t> corners, middles; ///< that remain
};

const std::vector<Collapsed>& collapsedHexahedra()
{
  static const std::vector<Collapsed> table = {
    { { { 3, 7 } }, Tetra, EmptyCell, { 0, 1, 2, 3 }, {} },
    { { { 2, 3 }, { 4, 7 } }, Tetra, QuadraticTetra, { 0, 1, 2, 4 }, { 8, 9, 11, 16, 17, 18 } },
    { { { 4, 7 } }, Pyramid, QuadraticPyramid, { 0, 1, 2, 3, 4 },
      { 8, 9, 10, 11, 16, 17, 18, 19 } },
    { { { 2, 3 }, { 6, 7 } }, Wedge, QuadraticWedge, { 0, 1, 2, 4, 5, 6 },
      { 8, 9, 11, 12, 13, 15, 16, 17, 18 } },
    { { { 4, 5 }, { 6, 7 } }, Wedge, EmptyCell, { 0, 4, 1, 3, 6, 2 }, {} },
  };
  return table;
}
}

std::pair<std::uint8_t, std::vector<Index>> solidElement(const std::vector<Index>& nodes)
{
  static const std::vector<std::pair<std::size_t, std::uint8_t>> whole = { { 4, Tetra },
    { 8, Hexahedron }, { 10, QuadraticTetra }, { 20, QuadraticHexahedron } };
  const bool isHexahedron = nodes.size() == 8 || nodes.size() == 20;
  const std::vector<Collapsed>& table = collapsedHexahedra();
  for (std::size_t row = 0; isHexahedron && row < table.size(); ++row)
  {
    const Collapsed& one = table[row];
    const bool fits = std::all_of(one.equal.begin(), one.equal.end(),
      [&nodes](const auto& range)
      {
        const auto first = nodes.begin() + static_cast<std::ptrdiff_t>(range.first);
        const auto end = nodes.begin() + static_cast<std::ptrdiff_t>(range.second) + 1;
        return std::all_of(first, end, [&](Index node) { return node == *first; });
      });
    if (!fits)
    {
      continue;
    }
    std::vector<Index> kept;
    for (const std::size_t corner : one.corners)
    {
      kept.push_back(nodes[corner]);
    }
    for (std::size_t i = 0; nodes.size() == 20 && i < one.middles.size(); ++i)
    {
      kept.push_back(nodes[one.middles[i]]);
    }
    return { nodes.size() == 20 ? one.quadratic : one.type, kept };
  }
  const auto found = std::find_if(
    whole.begin(), whole.end(), [&nodes](const auto& one) { return one.first == nodes.size(); });
  return { found == whole.end() ? std::uint8_t(EmptyCell) : found->second, nodes };
}

std::pair<std::uint8_t, std::vector<Index>> shellElement(std::vector<Index> nodes)
{
  if (nodes.size() == 4 && (nodes[2] == nodes[3] || nodes[3] == 0))
  {
    nodes.pop_back();
  }
  if (nodes.size() == 8 && nodes[2] == nodes[3])
  {
    nodes = { nodes[0], nodes[1], nodes[2], nodes[4], nodes[5], nodes[7] };
  }
  static const std::map<std::size_t, std::uint8_t> types = { { 3, Triangle }, { 4, Quad },
    { 6, QuadraticTriangle }, { 8, QuadraticQuad } };
  const auto found = types.find(nodes.size());
  return { found == types.end() ? std::uint8_t(EmptyCell) : found->second, nodes };
}
}
