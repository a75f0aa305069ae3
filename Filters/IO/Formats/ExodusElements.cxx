// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/ExodusElements.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace morph::io
{
namespace
{
struct Kind
{
  const char* start; ///< of the type's name
  Index nodes;
  std::uint8_t cellType;
};

constexpr Kind Kinds[] = { { "TET", 4, Tetra }, { "TET", 10, QuadraticTetra },
  { "TET", 15, LagrangeTetrahedron }, { "HEX", 8, Hexahedron }, { "HEX", 20, QuadraticHexahedron },
  { "HEX", 27, TriquadraticHexahedron }, { "WED", 6, Wedge }, { "WED", 15, QuadraticWedge },
  { "WED", 18, BiquadraticQuadraticWedge }, { "PYR", 5, Pyramid }, { "PYR", 13, QuadraticPyramid },
  { "PYR", 14, QuadraticPyramid }, { "TRI", 3, Triangle }, { "TRI", 6, QuadraticTriangle },
  { "QUAD", 4, Quad }, { "QUAD", 8, QuadraticQuad }, { "QUAD", 9, BiquadraticQuad },
  { "SHELL", 3, Triangle }, { "SHELL", 6, QuadraticTriangle }, { "SHELL", 4, Quad },
  { "SHELL", 8, QuadraticQuad }, { "SHELL", 9, BiquadraticQuad }, { "BEAM", 2, Line },
  { "BEAM", 3, QuadraticEdge }, { "BAR", 2, Line }, { "BAR", 3, QuadraticEdge },
  { "TRUSS", 2, Line }, { "TRUSS", 3, QuadraticEdge }, { "EDGE", 2, Line },
  { "EDGE", 3, QuadraticEdge }, { "SPHERE", 1, Vertex } };
}

std::uint8_t exodusCellType(const std::string& type, Index nodes)
{
  std::string upper = type;
  std::transform(upper.begin(), upper.end(), upper.begin(),
    [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  for (const Kind& kind : Kinds)
  {
    if (upper.rfind(kind.start, 0) == 0 && nodes == kind.nodes)
    {
      return kind.cellType;
    }
  }
  return EmptyCell;
}

void exodusToVtkOrder(std::uint8_t cellType, std::vector<Index>& nodes)
{
  // Nodes between corners go bottom, sides, top; VTK's bottom, top, sides.
  if (cellType == QuadraticHexahedron || cellType == TriquadraticHexahedron)
  {
    std::rotate(nodes.begin() + 12, nodes.begin() + 16, nodes.begin() + 20);
  }
  if (cellType == TriquadraticHexahedron)
  {
    static constexpr std::array<std::size_t, 7> From = { 23, 24, 25, 26, 21, 22, 20 };
    const std::vector<Index> old = nodes;
    for (std::size_t i = 0; i < From.size(); ++i)
    {
      nodes[20 + i] = old[From[i]];
    }
  }
  if (cellType == LagrangeTetrahedron) // the node inside comes before those of the faces
  {
    std::rotate(nodes.begin() + 10, nodes.begin() + 11, nodes.end());
  }
  if (cellType == QuadraticWedge || cellType == BiquadraticQuadraticWedge)
  {
    std::rotate(nodes.begin() + 9, nodes.begin() + 12, nodes.begin() + 15);
  }
}

std::vector<int> exodusSide(std::uint8_t cellType, Index side)
{
  using Sides = std::vector<std::vector<int>>;
  static const Sides tetra = { { 0, 1, 3 }, { 1, 2, 3 }, { 0, 3, 2 }, { 0, 2, 1 } };
  static const Sides hexahedron = { { 0, 1, 5, 4 }, { 1, 2, 6, 5 }, { 2, 3, 7, 6 }, { 0, 4, 7, 3 },
    { 0, 3, 2, 1 }, { 4, 5, 6, 7 } };
  static const Sides wedge = { { 0, 1, 4, 3 }, { 1, 2, 5, 4 }, { 0, 3, 5, 2 }, { 0, 2, 1 },
    { 3, 4, 5 } };
  static const Sides pyramid = { { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 0, 4 },
    { 0, 3, 2, 1 } };
  static const Sides triangle = { { 0, 1, 2 }, { 0, 2, 1 } };
  static const Sides quad = { { 0, 1, 2, 3 }, { 0, 3, 2, 1 } };
  static const Sides none;
  const auto sidesOf = [&]() -> const Sides&
  {
    switch (cellType)
    {
      case Tetra:
      case QuadraticTetra:
      case LagrangeTetrahedron:
        return tetra;
      case Hexahedron:
      case QuadraticHexahedron:
      case TriquadraticHexahedron:
        return hexahedron;
      case Wedge:
      case QuadraticWedge:
      case BiquadraticQuadraticWedge:
        return wedge;
      case Pyramid:
      case QuadraticPyramid:
        return pyramid;
      case Triangle:
      case QuadraticTriangle:
        return triangle;
      case Quad:
      case QuadraticQuad:
      case BiquadraticQuad:
        return quad;
      default:
        return none;
    }
  };
  const Sides& sides = sidesOf();
  const bool exists = side >= 1 && side <= static_cast<Index>(sides.size());
  return exists ? sides[static_cast<std::size_t>(side - 1)] : std::vector<int>();
}
}
