// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/CgnsElements.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace morph::io
{
CgnsElement cgnsElement(Index type)
{
  static constexpr CgnsElement Elements[] = { {}, {}, { Vertex, 1 }, { Line, 2 },
    { QuadraticEdge, 3 }, { Triangle, 3 }, { QuadraticTriangle, 6 }, { Quad, 4 },
    { QuadraticQuad, 8 }, { BiquadraticQuad, 9 }, { Tetra, 4 }, { QuadraticTetra, 10 },
    { Pyramid, 5 }, { QuadraticPyramid, 14 }, { Wedge, 6 }, { QuadraticWedge, 15 },
    { BiquadraticQuadraticWedge, 18 }, { Hexahedron, 8 }, { QuadraticHexahedron, 20 },
    { TriquadraticHexahedron, 27 }, {}, { QuadraticPyramid, 13 } };
  return type > 0 && type < Index(std::size(Elements)) ? Elements[type] : CgnsElement();
}

void cgnsToVtkOrder(std::uint8_t cellType, std::vector<Index>& nodes)
{
  // Nodes between corners go bottom, sides, top; VTK's bottom, top, sides.
  if (cellType == QuadraticHexahedron || cellType == TriquadraticHexahedron)
  {
    std::rotate(nodes.begin() + 12, nodes.begin() + 16, nodes.begin() + 20);
  }
  if (cellType == TriquadraticHexahedron)
  {
    static constexpr std::array<std::size_t, 7> From = { 24, 22, 21, 23, 20, 25, 26 };
    const std::vector<Index> old = nodes;
    for (std::size_t i = 0; i < From.size(); ++i)
    {
      nodes[20 + i] = old[From[i]];
    }
  }
  if (cellType == QuadraticWedge || cellType == BiquadraticQuadraticWedge)
  {
    std::rotate(nodes.begin() + 9, nodes.begin() + 12, nodes.begin() + 15);
  }
}
}
