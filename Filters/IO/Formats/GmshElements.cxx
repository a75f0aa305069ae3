// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/GmshElements.h"

#include <cstddef>
#include <iterator>

namespace morph::io
{
GmshElement gmshElement(Index type)
{
  static constexpr GmshElement Elements[] = { {}, { Line, 2 }, { Triangle, 3 }, { Quad, 4 },
    { Tetra, 4 }, { Hexahedron, 8 }, { Wedge, 6 }, { Pyramid, 5 }, { QuadraticEdge, 3 },
    { QuadraticTriangle, 6 }, { BiquadraticQuad, 9 }, { QuadraticTetra, 10 },
    { TriquadraticHexahedron, 27 }, { BiquadraticQuadraticWedge, 18 }, { QuadraticPyramid, 14 },
    { Vertex, 1 }, { QuadraticQuad, 8 }, { QuadraticHexahedron, 20 }, { QuadraticWedge, 15 },
    { QuadraticPyramid, 13 } };
  return type > 0 && type < Index(std::size(Elements)) ? Elements[type] : GmshElement();
}

void gmshToVtkOrder(std::uint8_t cellType, std::vector<Index>& nodes)
{
  // The place in Gmsh's order of each node after the corners.
  static const std::vector<std::size_t> tetra = { 4, 5, 6, 7, 9, 8 };
  static const std::vector<std::size_t> hexahedron = { 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14,
    15 };
  static const std::vector<std::size_t> triquadratic = { 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14,
    15, 22, 23, 21, 24, 20, 25, 26 };
  static const std::vector<std::size_t> wedge = { 6, 9, 7, 12, 14, 13, 8, 10, 11 };
  static const std::vector<std::size_t> biquadratic = { 6, 9, 7, 12, 14, 13, 8, 10, 11, 15, 17,
    16 };
  static const std::vector<std::size_t> pyramid = { 5, 8, 10, 6, 7, 9, 11, 12, 13 };
  const std::vector<std::size_t>* from = nullptr;
  switch (cellType)
  {
    case QuadraticTetra:
      from = &tetra;
      break;
    case QuadraticHexahedron:
      from = &hexahedron;
      break;
    case TriquadraticHexahedron:
      from = &triquadratic;
      break;
    case QuadraticWedge:
      from = &wedge;
      break;
    case BiquadraticQuadraticWedge:
      from = &biquadratic;
      break;
    case QuadraticPyramid:
      from = &pyramid;
      break;
    default:
      return;
  }
  const std::vector<Index> old = nodes;
  const auto corners = static_cast<std::size_t>(cellShape(cellType)->numberOfCorners);
  for (std::size_t i = corners; i < nodes.size(); ++i)
  {
    nodes[i] = old[(*from)[i - corners]];
  }
}
}
