// SPDX-License-Identifier: BSD-3-Clause
// Cells that name a corner twice, and cells that are there twice.
#include "Mesh/CollapsedCells.h"
#include "Mesh/SharedCorners.h"
#include "Mesh/Topology.h"
#include "PolyhedralMeshes.h"
#include "Quality/BoundaryDetermined.h"
#include "Quality/Certificate.h"
#include "Quality/Criteria.h"
#include "Quality/ScaledJacobian.h"
#include "Quality/ValidRange.h"
#include "Session/Session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace
{
using namespace morph;

/// One cell with the corners of a box, and the middle of its top.
Mesh cellOf(std::uint8_t type, const std::vector<Index>& nodes)
{
  Mesh mesh;
  mesh.points.resize(9, 3);
  mesh.points << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1, .5, .5, 1;
  meshes::add(mesh, type, nodes);
  return mesh;
}

/// The same, recognized.
Mesh recognized(Mesh mesh)
{
  morph::Monitor serial;
  morph::recognizeCells(mesh, serial);
  EXPECT_NO_THROW(morph::validate(mesh));
  return mesh;
}

morph::Quality qualityOf(const Mesh& mesh)
{
  morph::Monitor silent;
  return morph::measureQuality(mesh, mesh.points, {}, {}, silent);
}

struct Kind
{
  std::uint8_t type;
  std::vector<Index> nodes;
  std::uint8_t becomes;
};
}

TEST(CollapsedCells, BecomeTheCellsThatTheyAre)
{
  const std::vector<Kind> kinds = {
    { morph::Hexahedron, { 0, 1, 2, 2, 4, 5, 6, 6 }, morph::Wedge },
    { morph::Hexahedron, { 0, 1, 2, 3, 4, 4, 7, 7 }, morph::Wedge },
    { morph::Voxel, { 0, 1, 3, 2, 4, 4, 7, 7 }, morph::Wedge },
    { morph::Hexahedron, { 0, 1, 2, 3, 8, 8, 8, 8 }, morph::Pyramid },
    { morph::Hexahedron, { 0, 1, 3, 3, 4, 4, 4, 4 }, morph::Tetra },
    { morph::Hexahedron, { 0, 1, 2, 3, 4, 4, 6, 7 }, morph::Polyhedron },
    { morph::Voxel, { 0, 1, 3, 2, 4, 4, 7, 6 }, morph::Polyhedron },
    { morph::Hexahedron, { 0, 1, 2, 3, 4, 4, 4, 7 }, morph::Polyhedron },
    { morph::Hexahedron, { 0, 1, 2, 3, 8, 5, 8, 7 }, morph::Polyhedron }, // across a face
    { morph::Wedge, { 0, 1, 2, 0, 5, 6 }, morph::Pyramid },
    { morph::Wedge, { 0, 1, 3, 4, 4, 4 }, morph::Tetra },
    { morph::Pyramid, { 0, 1, 3, 3, 4 }, morph::Tetra },
  };
  for (const Kind& kind : kinds)
  {
    SCOPED_TRACE(testing::PrintToString(kind.nodes));
    const Mesh mesh = recognized(cellOf(kind.type, kind.nodes));
    EXPECT_EQ(int(mesh.types[0]), int(kind.becomes));
    EXPECT_GT(qualityOf(mesh).minimum, 0.05);
    EXPECT_EQ(qualityOf(mesh).degenerate, 0);
  }
}

TEST(CollapsedCells, OfNoClosedShapeStay)
{
  const std::vector<Index> nodes = { 0, 1, 2, 3, 4, 5, 0, 7 }; // two corners across the cell
  const Mesh mesh = recognized(cellOf(morph::Hexahedron, nodes));
  EXPECT_EQ(int(mesh.types[0]), int(morph::Hexahedron));
  EXPECT_EQ(std::vector<Index>(mesh.cell(0), mesh.cell(0) + 8), nodes);
}

TEST(CollapsedCells, OfCellsThatAreThereTwiceTheFirstCounts)
{
  const Mesh once = meshes::hexes(2, 2, 2);
  Mesh mesh = once;
  const Index* c = once.cell(0);
  const std::vector<Index> turned = { c[1], c[2], c[3], c[0], c[5], c[6], c[7], c[4] };
  meshes::add(mesh, morph::PolyVertex, turned); // one of the user
  meshes::add(mesh, morph::Hexahedron, turned);
  meshes::add(mesh, morph::Hexahedron, turned);
  mesh = recognized(mesh);
  EXPECT_EQ(int(mesh.types[0]), int(morph::Hexahedron));
  EXPECT_EQ(int(mesh.types[9]), int(morph::PolyVertex));
  EXPECT_EQ(int(mesh.types[10]), int(morph::PolyVertex));
  morph::Monitor serial;
  EXPECT_EQ(morph::boundaryFaces(mesh, serial).nodes, morph::boundaryFaces(once, serial).nodes);
  EXPECT_EQ(morph::repeatedCells(mesh, serial), (std::vector<Index>{ 0, 8, 9, 10 }));
}

TEST(CollapsedCells, KeepTheirMidSideNodes)
{
  // Each corner and middle of a hexahedron with an edge of no length above and below.
  Mesh mesh = meshes::quadraticHexes(1, 1, 1, false);
  const std::vector<Index> cell(mesh.cell(0), mesh.cell(0) + 20);
  std::vector<Index> to(mesh.numberOfNodes());
  std::iota(to.begin(), to.end(), Index{ 0 });
  for (const auto& [from, into] : { std::pair(3, 2), { 10, 2 }, { 7, 6 }, { 14, 6 }, { 19, 18 } })
  {
    to[cell[from]] = cell[into];
  }
  for (Index& node : mesh.connectivity)
  {
    node = to[node];
  }
  mesh = recognized(mesh);
  ASSERT_EQ(int(mesh.types[0]), int(morph::QuadraticWedge));
  // The middle of 0 and 3 is that of 0 and 2 now.
  const std::vector<Index> nodes(mesh.cell(0), mesh.cell(0) + 15);
  EXPECT_EQ(std::count(nodes.begin(), nodes.end(), cell[11]), 1);
}

TEST(CollapsedCells, WithoutVolumeAreNoVolumeCells)
{
  const std::vector<Kind> kinds = {
    { morph::Hexahedron, { 0, 1, 2, 3, 0, 1, 2, 3 }, morph::Polygon },
    { morph::Tetra, { 0, 0, 2, 3 }, morph::Triangle },
    { morph::Wedge, { 0, 1, 1, 0, 1, 1 }, morph::Line },
    { morph::Pyramid, { 4, 4, 4, 4, 4 }, morph::Vertex },
  };
  for (const Kind& kind : kinds)
  {
    EXPECT_EQ(int(recognized(cellOf(kind.type, kind.nodes)).types[0]), int(kind.becomes));
  }
}

TEST(CollapsedCells, OfHigherOrderAreMeasuredByTheirCornersWhereTheyAreNoKnownCell)
{
  // The bottom edge at y = 0 has no length, and in the second mesh that at y = 1 neither.
  Mesh seven = meshes::hexes(2, 1, 1), wedge = seven;
  std::replace(seven.connectivity.begin(), seven.connectivity.end(), 0, 1);
  wedge.connectivity = seven.connectivity;
  std::replace(wedge.connectivity.begin(), wedge.connectivity.end(), 3, 4);
  const meshes::CellKind kinds[] = { { morph::QuadraticHexahedron, 20 },
    { morph::BiquadraticQuadraticHexahedron, 24 }, { morph::TriquadraticHexahedron, 27 },
    { morph::LagrangeHexahedron, 64 } };
  for (const auto& [linear, first] : { std::pair(seven, 0), { wedge, 1 } })
  {
    const Mesh corners = first == 0 ? recognized(linear) : meshes::asPolyhedra(recognized(linear));
    ASSERT_EQ(int(corners.types[0]), int(morph::Polyhedron));
    for (int k = first; k < 4; ++k) // of 20 nodes the wedge is one
    {
      const Mesh mesh =
        recognized(meshes::withNodesBetween(linear, { { morph::Hexahedron, kinds[k] } }));
      EXPECT_EQ(mesh.types[0], kinds[k].type);
      EXPECT_EQ(mesh.cellSize(0), kinds[k].nodes);
      const morph::Quality quality = qualityOf(mesh);
      EXPECT_NEAR(quality.scaledJacobian[0], qualityOf(corners).scaledJacobian[0], 1e-14);
      EXPECT_EQ(quality.degenerate, 0);
      morph::Monitor serial;
      EXPECT_EQ(
        morph::certify(mesh, mesh.points, {}, {}, serial).cells[0], morph::Certificate::Undecided);
      EXPECT_EQ(morph::unmappedCells(mesh).front(), 0);
      EXPECT_TRUE(morph::unrecognizedCells(mesh, { 0, 1 }).empty());
      EXPECT_EQ(morph::boundaryFaces(mesh, serial).cells.size(),
        morph::boundaryFaces(corners, serial).cells.size());
      EXPECT_EQ(int(morph::HangingNodes().conforming(mesh).types[0]), int(morph::Polyhedron));
      std::vector<Index> held = corners.connectivity; // no undeformed cell is inverted
      morph::sortUnique(held);
      EXPECT_TRUE(morph::boundaryDeterminedInversions(
        mesh, morph::partitionNodes(mesh, held), { 1, 1 }, mesh.points)
                    .empty());
      for (const morph::Criterion& criterion : morph::criteria())
      {
        const bool isOfCorners =
          !criterion.measure || criterion.name == std::string("JacobianRatio");
        const auto measured = [&](const Mesh& of) {
          return morph::measureCriterion(criterion, of, of.points, { 1, 1 }, { 0, 0 }, {}, serial);
        };
        for (std::size_t c = 0; c < 2 && !isOfCorners; ++c)
        {
          EXPECT_NEAR(measured(mesh)[c], measured(corners)[c], 1e-12) << criterion.name << " " << c;
        }
      }
      Points flatter = Points::Zero(mesh.numberOfNodes(), 3);
      flatter.col(2) = -0.25 * mesh.points.col(2);
      const morph::NodeMotion motion = { &mesh.points, &flatter, {} };
      EXPECT_NEAR(morph::validRange(mesh, motion, { 1, 1 }, {}, serial).highest, 4, 1e-9);
    }
  }
}

TEST(CollapsedCells, OfNoClosedShapeAreNamed)
{
  Mesh mesh = meshes::hexes(2, 1, 1);
  mesh.connectivity[6] = mesh.connectivity[0]; // across the first cell
  mesh =
    recognized(meshes::withNodesBetween(mesh, { { Hexahedron, { QuadraticHexahedron, 20 } } }));
  EXPECT_EQ(morph::unrecognizedCells(mesh, { 0, 1 }), std::vector<Index>{ 0 });
  meshes::ThreadedMonitor monitor;
  morph::Session session;
  session.setMesh(mesh, monitor);
  session.reportMesh({}, monitor);
  ASSERT_EQ(monitor.warnings.size(), 1u); // none of how to repair it
  EXPECT_NE(monitor.warnings[0].find("no cell of a known type: cell ids 0."), std::string::npos);
}
