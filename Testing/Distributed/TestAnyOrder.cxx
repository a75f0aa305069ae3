// SPDX-License-Identifier: BSD-3-Clause
// Cells of any order, and those with nodes in the middle of faces, against the serial methods.
#include "LinearMethods.h"
#include "Mesh/CellShape.h"
#include "Mesh/Topology.h"
#include "Meshes.h"
#include "Morpher/SiteMethod.h"
#include "Motions.h"
#include "Pieces.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace
{
using namespace morph;
using morph::distributed::Ranks;

/// Two cells wide: tetrahedra, hexahedra and wedges of order 3, those of 27 and 18 nodes, and
/// pyramids of 19.
std::vector<std::pair<std::string, Mesh>> highOrder()
{
  const Mesh mixed = meshes::hexesAndPyramids(2, 2, 2), wedges = meshes::hexesAndWedges(2, 2, 2);
  return {
    { "Lagrange tetrahedra", meshes::withNodesBetween(meshes::tets(2, 2, 2),
                               { { morph::Tetra, { morph::LagrangeTetrahedron, 20 } } }) },
    { "Lagrange",
      meshes::withNodesBetween(wedges, { { morph::Hexahedron, { morph::LagrangeHexahedron, 64 } },
                                         { morph::Wedge, { morph::LagrangeWedge, 40 } } }) },
    { "Bezier",
      meshes::withNodesBetween(wedges, { { morph::Hexahedron, { morph::BezierHexahedron, 64 } },
                                         { morph::Wedge, { morph::BezierWedge, 40 } } }) },
    { "27 and 18 nodes", meshes::withNodesBetween(wedges,
                           { { morph::Hexahedron, { morph::TriquadraticHexahedron, 27 } },
                             { morph::Wedge, { morph::BiquadraticQuadraticWedge, 18 } } }) },
    { "27 and 19 nodes", meshes::withNodesBetween(
                           mixed, { { morph::Hexahedron, { morph::TriquadraticHexahedron, 27 } },
                                    { morph::Pyramid, { morph::TriquadraticPyramid, 19 } } }) },
  };
}

Points bend(const Points& x)
{
  Points moved = x;
  moved.col(1).array() += 0.1 * x.col(0).array().sin();
  moved.col(2).array() += 0.05 * x.col(0).array() * x.col(1).array();
  return moved;
}
}

TEST(RankAnyOrder, MovesAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  Monitor monitor;
  unsigned seed = meshes::seed();
  for (const auto& [name, whole] : highOrder())
  {
    const std::vector<Index> outer = morph::boundaryFaces(whole, monitor).nodes;
    for (const meshes::LinearMethod& method : meshes::linearMethods())
    {
      SCOPED_TRACE(name + ", " + method.name);
      const auto serial = method.make();
      serial->prepare(whole, morph::partitionNodes(whole, outer), monitor);
      const pieces::OnRanks mine(
        ranks, whole, outer, morph::onProcesses(method.make()), ++seed, monitor);
      Points expected, moved;
      const Points target = bend(whole.points);
      serial->evaluate(Points(target(outer, morph::allColumns)), expected, monitor);

      mine.evaluate(target, moved, monitor);

      EXPECT_LT(pieces::distance(mine.mesh, moved, expected), 1e-9 * meshes::size(whole.points));
      const Points affine = motions::mapped(whole.points, motions::affine);
      mine.evaluate(affine, moved, monitor);
      EXPECT_LT(pieces::distance(mine.mesh, moved, affine), 1e-10 * meshes::size(whole.points));
    }
  }
}
