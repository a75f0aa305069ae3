// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/PolyhedronPieces.h"

#include "Mesh/FaceTable.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/Topology.h"
#include "Motions.h"
#include "PolyhedralMeshes.h"
#include "Quality/ScaledJacobian.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace meshes;
using namespace morph;

namespace
{
double volume(const Mesh& mesh, Index first, Index last)
{
  double sum = 0;
  for (Index c = first; c < last; ++c)
  {
    if (isPolyhedron(mesh, c))
    {
      sum += polyhedronVolume(mesh, c, mesh.points);
      continue;
    }
    double corners[8][3];
    const CellShape& shape = *cellShape(mesh.types[c]);
    copyCorners(mesh, c, shape, mesh.points, corners[0]);
    sum += signedVolume(shape.shape, corners);
  }
  return sum;
}
}

TEST(PolyhedronPieces, FillTheMeshAndConform)
{
  Monitor monitor;
  for (const auto& [name, mesh] : polyhedral())
  {
    const PolyhedronPieces pieces(mesh, monitor);
    const Mesh& cut = pieces.mesh();
    ASSERT_NO_THROW(validate(cut)) << name;
    EXPECT_FALSE(hasPolyhedra(cut)) << name;
    EXPECT_EQ(cut.points.topRows(mesh.numberOfNodes()), mesh.points) << name;
    EXPECT_EQ(measureQuality(cut, cut.points, {}, {}, monitor).inverted, 0) << name;
    EXPECT_NEAR(volume(cut, 0, cut.numberOfCells()), volume(mesh, 0, mesh.numberOfCells()), 1e-10)
      << name;
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      EXPECT_TRUE(isPolyhedron(mesh, c) || cut.types[c] == mesh.types[c]) << name;
    }
    // Conforming: every face of the pieces belongs to one cell or two, and those of one are outer.
    const FaceTable table = faceTable(cut, monitor);
    EXPECT_LE(*std::max_element(table.uses.begin(), table.uses.end()), 2) << name;
    const BoundaryFaces whole = boundaryFaces(mesh, monitor), outer = boundaryFaces(cut, monitor);
    for (const Index node : outer.nodes)
    {
      EXPECT_TRUE(node >= mesh.numberOfNodes() ||
                  std::binary_search(whole.nodes.begin(), whole.nodes.end(), node))
        << name;
    }
  }
}

TEST(PolyhedronPieces, TetrahedraAndHexahedraStayWholeWhereTheyAreValid)
{
  Monitor monitor;
  for (const Mesh& mesh : { tets(3, 3, 3), hexes(3, 3, 3) })
  {
    Mesh polyhedra = asPolyhedra(mesh);
    const PolyhedronPieces whole(polyhedra, monitor);
    EXPECT_EQ(whole.mesh().types, mesh.types);
    EXPECT_EQ(whole.mesh().numberOfNodes(), mesh.numberOfNodes());
    EXPECT_NEAR(volume(whole.mesh(), 0, mesh.numberOfCells()), 27, 1e-12);
    EXPECT_NEAR(measureQuality(whole.mesh(), mesh.points, {}, {}, monitor).minimum,
      measureQuality(mesh, mesh.points, {}, {}, monitor).minimum, 1e-14);
    polyhedra.points.col(0) *= -1; // inside out
    EXPECT_GT(PolyhedronPieces(polyhedra, monitor).mesh().numberOfCells(), mesh.numberOfCells());
  }
  // A corner pushed in: no valid hexahedron.
  Mesh concave = asPolyhedra(hexes(1, 1, 1));
  concave.points.row(7) = Eigen::RowVector3d(0.6, 0.6, 0.6);
  const PolyhedronPieces pieces(concave, monitor);
  EXPECT_EQ(pieces.mesh().numberOfCells(), 6);
  EXPECT_EQ(pieces.mesh().numberOfNodes(), 9);
}

TEST(PolyhedronPieces, AHexahedronThatIsCutHasSixPyramidsAndOneCenter)
{
  Monitor monitor;
  const PolyhedronPieces pieces(asPolyhedra(hexes(3, 3, 3)), monitor, true);
  EXPECT_EQ(pieces.mesh().numberOfNodes(), 64 + 27);
  EXPECT_EQ(pieces.mesh().types, std::vector<std::uint8_t>(6 * 27, Pyramid));
}

TEST(PolyhedronPieces, CentersFollowAffineMotionsAndTheirGradientReturns)
{
  Monitor monitor;
  for (const auto& [name, mesh] : polyhedral())
  {
    const PolyhedronPieces pieces(mesh, monitor);
    const Points moved = motions::mapped(mesh.points, motions::affine);
    EXPECT_LT(motions::difference(
                pieces.extend(moved), motions::mapped(pieces.mesh().points, motions::affine)),
      1e-13 * size(moved))
      << name;
    const Points x = Points::Random(mesh.numberOfNodes(), 3);
    const Points g = Points::Random(pieces.mesh().numberOfNodes(), 3);
    EXPECT_NEAR((pieces.extend(x).array() * g.array()).sum(),
      (x.array() * pieces.extendTranspose(g).array()).sum(), 1e-11)
      << name;
  }
}

TEST(PolyhedronPieces, CentersOfPrescribedFacesArePrescribed)
{
  Monitor monitor;
  const Mesh mesh = honeycomb(2);
  const NodePartition outer = motions::outerPartition(mesh);
  const PolyhedronPieces pieces(mesh, monitor);
  const NodePartition all = pieces.extend(outer);
  // Every cell's hexagons are on the bottom or top of the mesh, or between its two layers.
  const Index hexagons = 2 * 4;
  EXPECT_GE(all.prescribed.size(), outer.prescribed.size() + hexagons);
  EXPECT_TRUE(std::equal(outer.prescribed.begin(), outer.prescribed.end(), all.prescribed.begin()));
  EXPECT_EQ(all.prescribed.size() + all.free.size(),
    static_cast<std::size_t>(pieces.mesh().numberOfNodes()));
}
