// SPDX-License-Identifier: BSD-3-Clause
#include "Quadratic.h"

#include "../Core/Meshes.h"
#include "Mesh/CellShape.h"

#include <algorithm>
#include <map>

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
}

Mesh quadratic(const Mesh& mesh, int order, double part, Random random)
{
  Mesh result;
  result.offsets.push_back(0);
  std::vector<Eigen::RowVector3d> places;
  std::map<std::vector<Index>, Index> known;
  const std::uint64_t sameForm = random.bits();
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    Random form(sameForm); // neighbors have the same face nodes
    const std::uint8_t type =
      random.happens(part) ? formOf(mesh.types[c], order, form) : mesh.types[c];
    const morph::CellShape& shape = *morph::cellShape(type);
    std::vector<Index> nodes(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
    for (int k = static_cast<int>(nodes.size()); k < shape.numberOfNodes; ++k)
    {
      double N[8];
      morph::shapeFunctions(shape.shape, shape.extraNodes[k - shape.numberOfCorners], N, nullptr);
      std::vector<Index> between;
      Eigen::RowVector3d place = Eigen::RowVector3d::Zero();
      for (int a = 0; a < shape.numberOfCorners; ++a)
      {
        if (N[a] > 0)
        {
          between.push_back(nodes[a]);
          place += N[a] * mesh.points.row(nodes[a]);
        }
      }
      std::sort(between.begin(), between.end());
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
