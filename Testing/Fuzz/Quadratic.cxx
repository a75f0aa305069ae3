// SPDX-License-Identifier: BSD-3-Clause
#include "Quadratic.h"

#include "../Core/Meshes.h"
#include "Mesh/CellShape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace fuzz
{
using morph::Index;
using morph::Mesh;

namespace
{
/// The type itself where it has no such form.
std::uint8_t formOf(std::uint8_t linear, int order, Random& random)
{
  switch (linear)
  {
    case morph::Tetra:
      return morph::QuadraticTetra;
    case morph::Pyramid:
      return morph::QuadraticPyramid;
    case morph::Hexahedron:
      return order == 1            ? morph::QuadraticHexahedron
             : random.happens(0.5) ? morph::TriquadraticHexahedron
                                   : morph::BiquadraticQuadraticHexahedron;
    case morph::Wedge:
      return order == 1   ? morph::QuadraticWedge
             : order == 2 ? morph::BiquadraticQuadraticWedge
                          : morph::QuadraticLinearWedge;
    default:
      return linear;
  }
}

/// A Lagrange or Bezier cell; that itself where there is none.
const morph::CellShape* anyOrder(std::uint8_t& type, Random& random)
{
  const std::map<std::uint8_t, std::array<Index, 2>> sizes = { { morph::Tetra, { 10, 20 } },
    { morph::Hexahedron, { 27, 64 } }, { morph::Wedge, { 18, 40 } } }; // of order 2 and 3
  const std::map<std::uint8_t, std::uint8_t> types = { { morph::Tetra, morph::LagrangeTetrahedron },
    { morph::Hexahedron, morph::LagrangeHexahedron }, { morph::Wedge, morph::LagrangeWedge } };
  const bool isThird = random.happens(0.5), isBezier = random.happens(0.3);
  const auto size = sizes.find(type);
  if (size == sizes.end())
  {
    return morph::cellShape(type);
  }
  constexpr int ToBezier = morph::BezierTetrahedron - morph::LagrangeTetrahedron;
  type = static_cast<std::uint8_t>(types.at(type) + (isBezier ? ToBezier : 0));
  return morph::shapeOfAnyOrder(type, size->second[isThird]);
}
}

Mesh quadratic(const Mesh& mesh, int order, double part, Random random)
{
  Mesh result;
  std::vector<Eigen::RowVector3d> places;
  std::map<std::map<Index, long>, Index> known; // by shares of corners
  const std::uint64_t sameForm = random.bits();
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    Random form(sameForm); // neighbors have the same face nodes
    std::uint8_t type = mesh.types[c];
    const bool isRaised = random.happens(part);
    type = isRaised && order < 4 ? formOf(type, order, form) : type;
    const morph::CellShape& shape =
      *(isRaised && order == 4 ? anyOrder(type, form) : morph::cellShape(type));
    std::vector<Index> nodes(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
    for (int k = static_cast<int>(nodes.size()); k < shape.numberOfNodes; ++k)
    {
      double N[8];
      morph::shapeFunctions(shape.shape, shape.extraNodes[k - shape.numberOfCorners], N, nullptr);
      std::map<Index, long> between;
      Eigen::RowVector3d place = Eigen::RowVector3d::Zero();
      for (int a = 0; a < shape.numberOfCorners; ++a)
      {
        if (N[a] > 0)
        {
          between[nodes[a]] += std::lround(N[a] * 1e6);
          place += N[a] * mesh.points.row(nodes[a]);
        }
      }
      if (between.size() == 1) // an edge without length
      {
        nodes.push_back(between.begin()->first);
        continue;
      }
      const auto [found, isNew] =
        known.emplace(between, mesh.numberOfNodes() + static_cast<Index>(places.size()));
      if (isNew)
      {
        places.push_back(place);
      }
      nodes.push_back(found->second);
    }
    meshes::add(result, type, nodes);
  }
  result.points.resize(mesh.numberOfNodes() + static_cast<Index>(places.size()), 3);
  result.points.topRows(mesh.numberOfNodes()) = mesh.points;
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    result.points.row(mesh.numberOfNodes() + static_cast<Index>(i)) = places[i];
  }
  return result;
}
}
