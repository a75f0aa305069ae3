// SPDX-License-Identifier: BSD-3-Clause
// Shells and beams that hang on a volume.
#include "LinearMethods/AttachedNodes.h"
#include "Meshes.h"
#include "Motions.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <numeric>

namespace
{
using namespace morph;
using Row = Eigen::RowVector3d;

Index addNode(Mesh& mesh, const Row& x)
{
  mesh.points.conservativeResize(mesh.points.rows() + 1, 3);
  mesh.points.row(mesh.points.rows() - 1) = x;
  return mesh.points.rows() - 1;
}

/// The box [0, 2]^3 with a fin of two rows of quads on its top, and a beam at a corner: 8 nodes.
Mesh boxWithFin()
{
  Mesh mesh = meshes::hexes(2, 2, 2);
  const Index beam = addNode(mesh, { 0, 0, 3 });
  addNode(mesh, { 0, 1, 3.5 });
  meshes::add(mesh, morph::Line, { 18, beam });
  meshes::add(mesh, morph::Line, { beam, beam + 1 });
  Index foot[3] = { 19, 22, 25 };
  for (const double z : { 2.5, 3. })
  {
    for (int j = 0; j < 3; ++j)
    {
      addNode(mesh, { 1, 1. * j, z });
    }
    const Index first = mesh.numberOfNodes() - 3;
    meshes::add(mesh, morph::Quad, { foot[0], foot[1], first + 1, first });
    meshes::add(mesh, morph::Quad, { foot[1], foot[2], first + 2, first + 1 });
    std::iota(foot, foot + 3, first);
  }
  return mesh;
}

/// The mesh after `map` has moved the nodes of volume cells, and attached nodes have followed.
Points follow(const Mesh& mesh, const std::function<Row(const Row&)>& map, Index volume = 27)
{
  Points moved = mesh.points;
  for (Index n = 0; n < volume; ++n)
  {
    moved.row(n) = map(mesh.points.row(n));
  }
  AttachedNodes(mesh, morph::partitionNodes(mesh, { 0 })).apply(moved);
  return moved;
}
}

TEST(AttachedNodes, MoveRigidlyWithTheVolume)
{
  const Mesh mesh = boxWithFin();
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const auto rigid = [&](const Row& x) { return Row(x * turn.transpose() + Row(5, 6, 7)); };
  Points expected = mesh.points;
  for (Index n = 0; n < expected.rows(); ++n)
  {
    expected.row(n) = rigid(mesh.points.row(n));
  }
  EXPECT_LT(motions::difference(follow(mesh, rigid), expected), 1e-13);
  EXPECT_TRUE(motions::identical(follow(mesh, [](const Row& x) { return x; }), mesh.points));
}

TEST(AttachedNodes, AreCarriedWithoutTheStretchOfTheVolume)
{
  const Mesh mesh = boxWithFin();
  const Points moved = follow(mesh, [](const Row& x) { return Row(x[0], 2 * x[1], 1.5 * x[2]); });
  for (Index n = 27; n < mesh.numberOfNodes(); ++n)
  {
    EXPECT_NEAR(moved(n, 2), mesh.points(n, 2) + 1, 1e-13) << "node " << n;
  }
  // Between its anchors the fin is stretched as they are, the more the nearer.
  const double foot = moved(25, 1) - moved(19, 1), top = moved(34, 1) - moved(32, 1);
  EXPECT_DOUBLE_EQ(foot, 4);
  EXPECT_GT(top, 2.1);
  EXPECT_LT(top, 4);
}

TEST(AttachedNodes, AreLinearAlongABeamBetweenTwoBodies)
{
  Mesh mesh = meshes::hexes(1, 1, 1);
  for (Index n = 0; n < 8; ++n)
  {
    addNode(mesh, mesh.points.row(n) + Row(0, 0, 5));
  }
  meshes::add(mesh, morph::Hexahedron, { 8, 9, 11, 10, 12, 13, 15, 14 });
  const Index first = addNode(mesh, { 0, 0, 2 }), second = addNode(mesh, { 0, 0, 2.5 });
  meshes::add(mesh, morph::PolyLine, { 4, first, second, 8 });
  const Points moved = follow(
    mesh, [](const Row& x) { return Row(x[2] > 4 ? x + Row(8, 4, 0) : x); }, 16);
  EXPECT_LT((moved.row(first) - Row(2, 1, 2)).norm(), 1e-13);
  EXPECT_LT((moved.row(second) - Row(3, 1.5, 2.5)).norm(), 1e-13);
}

TEST(AttachedNodes, HangOnPrescribedNodesToo)
{
  Mesh mesh = boxWithFin();
  Points moved = mesh.points;
  moved.row(28) += Row(0, 0, 1);
  AttachedNodes(mesh, morph::partitionNodes(mesh, { 28 })).apply(moved);
  EXPECT_EQ(moved(28, 2), mesh.points(28, 2) + 1);
  EXPECT_GT(moved(27, 2), mesh.points(27, 2));
  EXPECT_TRUE(motions::identical(moved.bottomRows(6), mesh.points.bottomRows(6)));
}

TEST(AttachedNodes, LooseNodesStay)
{
  Mesh mesh = boxWithFin();
  const Index loose = addNode(mesh, { 9, 9, 9 }), other = addNode(mesh, { 9, 9, 9 });
  meshes::add(mesh, morph::Line, { loose, other });
  addNode(mesh, { 7, 7, 7 }); // of no cell
  meshes::add(mesh, morph::Vertex, { 27 });
  const AttachedNodes attached(mesh, morph::partitionNodes(mesh, { 0 }));
  EXPECT_EQ(attached.loose(), (std::vector<Index>{ loose, other }));
  EXPECT_EQ(attached.nodes(), (std::vector<Index>{ 27, 28, 29, 30, 31, 32, 33, 34 }));
  const Points moved = follow(mesh, [](const Row& x) { return Row(x + Row(1, 0, 0)); });
  EXPECT_TRUE(motions::identical(moved.bottomRows(3), mesh.points.bottomRows(3)));
}

TEST(AttachedNodes, TheAdjointAgreesWithDifferences)
{
  const Mesh mesh = boxWithFin();
  const AttachedNodes attached(mesh, morph::partitionNodes(mesh, { 0 }));
  std::srand(meshes::seed());
  const Points gradient = Points::Random(mesh.numberOfNodes(), 3);
  Points shift = Points::Random(mesh.numberOfNodes(), 3);
  shift.bottomRows(8).setZero();
  const auto at = [&](double step)
  {
    Points moved = mesh.points + step * shift;
    attached.apply(moved);
    return moved.cwiseProduct(gradient).sum();
  };
  Points adjoint = gradient;
  attached.applyTranspose(adjoint);
  EXPECT_TRUE(adjoint.bottomRows(8).isZero(0));
  EXPECT_NEAR(adjoint.cwiseProduct(shift).sum(), (at(1e-5) - at(-1e-5)) / 2e-5, 1e-7);
}
