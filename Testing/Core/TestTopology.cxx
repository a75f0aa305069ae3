// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Motions.h"

#include "Mesh/NodePartition.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/Topology.h"
#include "Support/Error.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <set>

using namespace morph;

namespace
{
std::vector<Index> onBox(const Mesh& mesh)
{
  const Eigen::RowVector3d low = mesh.points.colwise().minCoeff();
  const Eigen::RowVector3d high = mesh.points.colwise().maxCoeff();
  std::vector<Index> ids;
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    const auto p = mesh.points.row(n).array();
    if ((p == low.array()).any() || (p == high.array()).any())
    {
      ids.push_back(n);
    }
  }
  return ids;
}
}

TEST(Topology, BoundaryNodesAreThoseOnTheBoxForEveryCellType)
{
  Monitor monitor;
  for (const auto& [name, mesh] : meshes::all(3, 4, 2))
  {
    EXPECT_EQ(boundaryFaces(mesh, monitor).nodes, onBox(mesh)) << name;
  }
}

TEST(Topology, BoundaryFacesCloseAndPointOutward)
{
  Monitor monitor;
  for (const auto& [name, mesh] : meshes::all(3, 4, 2))
  {
    const BoundaryFaces faces = boundaryFaces(mesh, monitor);
    Eigen::RowVector3d area = Eigen::RowVector3d::Zero();
    double volume = 0; // by the divergence theorem
    for (std::size_t f = 0; f < faces.cells.size(); ++f)
    {
      const Index first = faces.offsets[f], size = faces.offsets[f + 1] - first;
      const auto at = [&, &m = mesh](Index k)
      { return Eigen::RowVector3d(m.points.row(faces.connectivity[first + k])); };
      for (Index k = 1; k + 1 < size; ++k)
      {
        const Eigen::RowVector3d normal = (at(k) - at(0)).cross(at(k + 1) - at(0)) / 2;
        area += normal;
        volume += normal.dot(at(0)) / 3;
      }
    }
    EXPECT_NEAR(area.norm(), 0, 1e-12) << name;
    EXPECT_NEAR(volume, 24, 1e-12) << name;
  }
}

TEST(Topology, BoundaryFacesKnowTheirSideAndWhatLiesInTheMiddle)
{
  Monitor monitor;
  for (const auto& [name, mesh] : meshes::all(3, 4, 2))
  {
    const BoundaryFaces faces = boundaryFaces(mesh, monitor);
    for (std::size_t f = 0; f < faces.cells.size(); ++f)
    {
      const CellShape& shape = *cellShape(mesh.types[faces.cells[f]]);
      const FaceShape& side = shape.faces[faces.sides[f]];
      ASSERT_EQ(side.size, faces.offsets[f + 1] - faces.offsets[f]) << name;
      for (int k = 0; k < side.size; ++k)
      {
        EXPECT_EQ(mesh.cell(faces.cells[f])[shape.cornerNode[side.corner[k]]],
          faces.connectivity[faces.offsets[f] + k]);
      }
    }

    const std::set<Index> corners(faces.connectivity.begin(), faces.connectivity.end());
    ASSERT_EQ(faces.between.offsets.size(), faces.nodes.size() + 1) << name;
    for (std::size_t i = 0; i < faces.nodes.size(); ++i)
    {
      const Index k = static_cast<Index>(i);
      const auto count = faces.between.end(k) - faces.between.begin(k);
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      for (const Index* corner = faces.between.begin(k); corner != faces.between.end(k); ++corner)
      {
        EXPECT_TRUE(corners.count(*corner)) << name;
        sum += mesh.points.row(*corner);
      }
      if (corners.count(faces.nodes[i]))
      {
        EXPECT_EQ(count, 0) << name;
        continue;
      }
      EXPECT_TRUE(count == 2 || count == 4) << name;
      EXPECT_LT((sum / static_cast<double>(count) - mesh.points.row(faces.nodes[i])).norm(), 1e-14)
        << name;
    }
  }
}

TEST(Topology, SimplicialDecompositionCoversEveryMesh)
{
  for (auto [name, mesh] : meshes::all(3, 4, 2))
  {
    meshes::jitterInterior(mesh, 0.15, meshes::seed());
    double volume = 0;
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      const CellShape& shape = *cellShape(mesh.types[c]);
      double corners[8][3];
      for (int a = 0; a < shape.numberOfCorners; ++a)
      {
        const auto p = mesh.points.row(mesh.cell(c)[a]);
        std::copy(p.data(), p.data() + 3, corners[a]);
      }
      volume += signedVolume(shape.shape, corners);
    }
    EXPECT_NEAR(volume, 24, 1e-11) << name;
  }
}

TEST(Topology, BodiesUnusedPointsAndLowerDimensions)
{
  Mesh mesh = meshes::hexes(2, 2, 2);
  const Mesh other = meshes::tets(1, 1, 1);
  const Index shift = mesh.numberOfNodes() + 3; // three unused points between
  mesh.points.conservativeResize(shift + other.numberOfNodes(), 3);
  mesh.points.middleRows(shift - 3, 3).setConstant(7);
  mesh.points.bottomRows(other.numberOfNodes()) = other.points.array() + 100;
  for (Index c = 0; c < other.numberOfCells(); ++c)
  {
    std::vector<Index> nodes(other.cell(c), other.cell(c) + 4);
    for (Index& n : nodes)
    {
      n += shift;
    }
    meshes::add(mesh, Tetra, nodes);
  }
  meshes::add(mesh, Quad, { 0, 1, 4, 3 }); // a surface cell on the first body
  meshes::add(mesh, Vertex, { 28 });       // an unused point with a vertex cell

  const ConnectedComponents parts = connectedComponents(mesh);
  EXPECT_EQ(parts.count, 2);
  EXPECT_EQ(parts.ofCell[0], 0);
  EXPECT_EQ(parts.ofCell[8], 1);
  EXPECT_EQ(parts.ofCell[13], -1);
  EXPECT_EQ(parts.ofNode[27], -1);
  EXPECT_EQ(parts.ofNode[shift], 1);

  Monitor monitor;
  const BoundaryFaces faces = boundaryFaces(mesh, monitor);
  EXPECT_EQ(faces.cells.size(), 24u + 12u);
  EXPECT_EQ(faces.nodes.size(), 26u + 8u);

  const NodePartition partition = partitionNodes(mesh, faces.nodes);
  EXPECT_EQ(partition.free, (std::vector<Index>{ 13 }));
  EXPECT_TRUE(partition.higherOrderNodes.empty());
}

TEST(Topology, FacesSharedByMoreThanTwoCellsAreNotBoundary)
{
  Mesh mesh = meshes::hexes(1, 1, 1);
  std::vector<Index> nodes(mesh.cell(0), mesh.cell(0) + 8);
  meshes::add(mesh, Hexahedron, nodes);
  meshes::add(mesh, Hexahedron, nodes);
  Monitor monitor;
  EXPECT_TRUE(boundaryFaces(mesh, monitor).cells.empty());
}

TEST(Topology, OrientationFollowsTheBody)
{
  Mesh mesh = meshes::wedges(2, 2, 2);
  EXPECT_EQ(cellSigns(mesh, connectedComponents(mesh)), std::vector<std::int8_t>(16, 1));
  // One inverted cell stays the exception; a mirrored body does not.
  std::swap(mesh.connectivity[0], mesh.connectivity[1]);
  std::swap(mesh.connectivity[3], mesh.connectivity[4]);
  EXPECT_EQ(cellSigns(mesh, connectedComponents(mesh)), std::vector<std::int8_t>(16, 1));
  mesh.points.col(0) *= -1;
  EXPECT_EQ(cellSigns(mesh, connectedComponents(mesh)), std::vector<std::int8_t>(16, -1));

  Mesh single = meshes::hexes(1, 1, 1);
  single.points.col(0) *= -1;
  EXPECT_EQ(cellSigns(single, connectedComponents(single)), std::vector<std::int8_t>(1, 1));
}

TEST(Mesh, ValidateNamesWhatIsWrong)
{
  const Mesh good = meshes::hexes(2, 1, 1);
  EXPECT_NO_THROW(validate(good));

  Mesh mesh = good;
  mesh.types[1] = 74; // Lagrange pyramid
  EXPECT_NE(motions::messageOf([&] { validate(mesh); }).find("higher order"), std::string::npos);
  EXPECT_NE(motions::messageOf([&] { validate(mesh); }).find("cell ids 1"), std::string::npos);

  mesh = good;
  mesh.types[1] = Wedge;
  EXPECT_NE(
    motions::messageOf([&] { validate(mesh); }).find("wrong number of nodes"), std::string::npos);

  mesh = good;
  mesh.connectivity[9] = 12;
  EXPECT_NE(motions::messageOf([&] { validate(mesh); }).find("outside 0 to 11"), std::string::npos);

  mesh = good;
  mesh.points(5, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(motions::messageOf([&] { validate(mesh); }).find("node ids 5"), std::string::npos);

  mesh = good;
  mesh.offsets.pop_back();
  EXPECT_NE(motions::messageOf([&] { validate(mesh); }).find("offsets"), std::string::npos);
}

TEST(NodePartition, NamesWrongAndRepeatedIds)
{
  const Mesh mesh = meshes::hexes(2, 2, 2);
  EXPECT_NE(motions::messageOf(
              [&] {
                partitionNodes(mesh, { 0, -3, 27 });
              })
              .find("-3, 27"),
    std::string::npos);
  EXPECT_NE(motions::messageOf(
              [&] {
                partitionNodes(mesh, { 4, 1, 4 });
              })
              .find("more than once: 4"),
    std::string::npos);
}

TEST(NodePartition, QuadraticCellsSplitIntoFreeAndFollowers)
{
  const Mesh mesh = meshes::quadraticHexes(3, 3, 3, true);
  Monitor monitor;
  const NodePartition partition = partitionNodes(mesh, boundaryFaces(mesh, monitor).nodes);
  EXPECT_EQ(partition.prescribed.size(), 218u);       // 7^3 - 5^3
  EXPECT_EQ(partition.free.size(), 8u);               // inner lattice points
  EXPECT_EQ(partition.higherOrderNodes.size(), 117u); // 5^3 - 8
}
