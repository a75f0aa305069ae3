// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/AbaqusElements.h"

#include <cctype>
#include <cstdlib>
#include <cstring>

namespace morph::io
{
namespace
{
AbaqusElement volume(int nodes)
{
  switch (nodes)
  {
    case 4:
      return { Tetra, 4 };
    case 5:
      return { Pyramid, 5 };
    case 6:
      return { Wedge, 6 };
    case 8:
      return { Hexahedron, 8 };
    case 10:
      return { QuadraticTetra, 10 };
    case 15:
      return { QuadraticWedge, 15 };
    case 20:
      return { QuadraticHexahedron, 20 };
    default:
      return {};
  }
}

AbaqusElement surface(int nodes)
{
  switch (nodes)
  {
    case 3:
      return { Triangle, 3 };
    case 4:
      return { Quad, 4 };
    case 6:
    case 65: // STRI65 has five degrees of freedom at a node
      return { QuadraticTriangle, 6 };
    case 8:
      return { QuadraticQuad, 8 };
    default:
      return {};
  }
}

AbaqusElement plane(int nodes)
{
  AbaqusElement element = surface(nodes);
  element.isPlane = true;
  return element;
}

AbaqusElement line(int nodes)
{
  return nodes == 3 ? AbaqusElement{ QuadraticEdge, 3 } : AbaqusElement{ Line, 2 };
}

/// Types that begin so, with their number of nodes after it.
struct Family
{
  const char* start;
  AbaqusElement (*element)(int nodes);
};

/// The first that fits is taken: SC8 and STRI3 are no S.
constexpr Family Families[] = {
  { "CPEG", plane },
  { "CPE", plane },
  { "CPS", plane },
  { "CAX", plane },
  { "CGAX", plane },
  { "DC2D", plane },
  { "DCAX", plane },
  { "AC2D", plane },
  { "ACAX", plane },
  { "F2D", plane },
  { "C3D", volume },
  { "DC3D", volume },
  { "AC3D", volume },
  { "F3D", volume },
  { "DCC3D", volume },
  { "Q3D", volume },
  { "SC", volume }, // continuum shells
  { "RB3D", [](int) { return line(2); } },
  { "STRI", surface },
  { "SFM3D", surface },
  { "M3D", surface },
  { "R3D", surface },
  { "DS", surface },
  { "S", surface },
  { "T3D", line },
  { "B31", [](int) { return line(2); } },
  { "B32", [](int) { return line(3); } },
  { "B33", [](int) { return line(2); } },
};
}

AbaqusElement abaqusElement(const std::string& type)
{
  if (type.rfind("C3D15V", 0) == 0)
  {
    return {}; // has 15 to 18 nodes
  }
  for (const Family& family : Families)
  {
    if (type.rfind(family.start, 0) == 0)
    {
      return family.element(std::atoi(type.c_str() + std::strlen(family.start)));
    }
  }
  return {};
}

std::optional<std::vector<int>> abaqusSide(
  std::uint8_t cellType, bool isPlane, const std::string& side)
{
  static const std::vector<std::vector<int>> tetra = { { 0, 1, 2 }, { 0, 3, 1 }, { 1, 3, 2 },
    { 2, 3, 0 } };
  static const std::vector<std::vector<int>> hexahedron = { { 0, 1, 2, 3 }, { 4, 7, 6, 5 },
    { 0, 4, 5, 1 }, { 1, 5, 6, 2 }, { 2, 6, 7, 3 }, { 3, 7, 4, 0 } };
  static const std::vector<std::vector<int>> wedge = { { 0, 1, 2 }, { 3, 5, 4 }, { 0, 3, 4, 1 },
    { 1, 4, 5, 2 }, { 2, 5, 3, 0 } };
  static const std::vector<std::vector<int>> pyramid = { { 0, 1, 2, 3 }, { 0, 4, 1 }, { 1, 4, 2 },
    { 2, 4, 3 }, { 3, 4, 0 } };
  const auto* faces = cellType == Tetra || cellType == QuadraticTetra             ? &tetra
                      : cellType == Hexahedron || cellType == QuadraticHexahedron ? &hexahedron
                      : cellType == Wedge || cellType == QuadraticWedge           ? &wedge
                      : cellType == Pyramid                                       ? &pyramid
                                                                                  : nullptr;
  const bool hasNumber = side.size() == 2 && std::isdigit(static_cast<unsigned char>(side[1]));
  const int number = hasNumber ? side[1] - '0' : 0;
  if (faces)
  {
    const bool isFace = number >= 1 && number <= static_cast<int>(faces->size()) && side[0] == 'S';
    return isFace         ? std::make_optional((*faces)[static_cast<std::size_t>(number - 1)])
           : side.empty() ? std::make_optional(std::vector<int>())
                          : std::nullopt;
  }
  const CellShape* shape = cellShape(cellType);
  const bool isOneSided = isPlane || side[0] == 'E';
  if (!shape || shape->dimension < 2 || number == 0 || (!isOneSided && number <= 2))
  {
    return std::vector<int>();
  }
  const int edge = isOneSided ? number - 1 : number - 3;
  return edge < shape->numberOfCorners
           ? std::make_optional(std::vector<int>{ edge, (edge + 1) % shape->numberOfCorners })
           : std::nullopt;
}
}
