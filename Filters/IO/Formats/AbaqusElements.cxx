// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/AbaqusElements.h"

#include <cctype>
#include <cstdlib>

namespace morph::io
{
namespace
{
bool startsWith(const std::string& text, const char* start)
{
  return text.rfind(start, 0) == 0;
}

/// The number that follows the first letters (and "3D") of a type.
int numberAfter(const std::string& type, const char* start)
{
  return std::atoi(type.c_str() + std::string(start).size());
}

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
      return { QuadraticTriangle, 6 };
    case 8:
      return { QuadraticQuad, 8 };
    default:
      return {};
  }
}
}

AbaqusElement abaqusElement(const std::string& type)
{
  for (const char* planar : { "CPE", "CPS", "CAX", "CGAX", "DC2D", "DCAX", "AC2D", "ACAX", "F2D" })
  {
    if (startsWith(type, planar))
    {
      AbaqusElement element;
      element.isPlanar = true;
      return element;
    }
  }
  for (const char* solid : { "C3D", "DC3D", "AC3D", "F3D", "DCC3D", "Q3D" })
  {
    if (startsWith(type, solid))
    {
      return volume(numberAfter(type, solid));
    }
  }
  if (startsWith(type, "SC6") || startsWith(type, "SC8")) // continuum shells
  {
    return volume(numberAfter(type, "SC"));
  }
  if (type == "STRI3" || type == "STRI65")
  {
    return surface(type == "STRI3" ? 3 : 6);
  }
  for (const char* flat : { "SFM3D", "M3D", "R3D", "DS", "S" })
  {
    if (startsWith(type, flat) && std::isdigit(type[std::string(flat).size()]))
    {
      return surface(numberAfter(type, flat));
    }
  }
  for (const char* line : { "T3D", "B3" })
  {
    if (startsWith(type, line))
    {
      const bool isQuadratic = type == "B32" || startsWith(type, "T3D3");
      return isQuadratic ? AbaqusElement{ QuadraticEdge, 3 } : AbaqusElement{ Line, 2 };
    }
  }
  return {};
}

std::vector<int> abaqusFace(std::uint8_t cellType, int face)
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
  const bool exists = faces && face >= 1 && face <= static_cast<int>(faces->size());
  return exists ? (*faces)[static_cast<std::size_t>(face - 1)] : std::vector<int>();
}
}
