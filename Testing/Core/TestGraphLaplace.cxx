// SPDX-License-Identifier: BSD-3-Clause
// The graph-Laplace mesh, and meshes whose inner nodes say nothing.
#include "LinearMethods/GraphLaplace.h"
#include "Mesh/ShapeWindings.h"
#include "Mesh/Topology.h"
#include "Meshes.h"
#include "Motions.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"
#include "Untangling/InversionFree.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace
{
using namespace morph;

/// Places free nodes at random in the box, or all in its middle.
void scramble(Mesh& mesh, const NodePartition& partition, double spread)
{
  const Eigen::RowVector3d low = mesh.points.colwise().minCoeff(),
                           high = mesh.points.colwise().maxCoeff();
  for (Index node : partition.free)
  {
    mesh.points.row(node) =
      (low + high) / 2 + spread * Eigen::RowVector3d::Random().cwiseProduct(high - low) / 2;
  }
}

std::vector<std::int8_t> signsOf(const Mesh& mesh)
{
  return morph::cellSigns(mesh, morph::connectedComponents(mesh));
}
}

TEST(GraphLaplace, FreeNodesLieAtTheMeanOfTheirNeighbors)
{
  // On a lattice the lattice itself has this property.
  Mesh mesh = meshes::hexes(5, 4, 6);
  mesh.points.rowwise() += Eigen::RowVector3d(1e6, 0, -3e5);
  const Points expected = mesh.points;
  const NodePartition partition = motions::outerPartition(mesh);
  std::srand(meshes::seed());
  scramble(mesh, partition, 1);
  meshes::ThreadedMonitor one(1), three(3);
  const Points result = morph::graphLaplaceMesh(mesh, partition, mesh.points, one);
  EXPECT_LT(motions::difference(result, expected), 1e-4);
  EXPECT_TRUE(
    motions::identical(result, morph::graphLaplaceMesh(mesh, partition, mesh.points, three)));
  EXPECT_TRUE(motions::identical(
    meshes::rows(result, partition.prescribed), meshes::rows(expected, partition.prescribed)));
}

TEST(GraphLaplace, MeshesWithInnerNodesAnywhereComeOutValid)
{
  for (const auto& [name, rest] : meshes::all(4, 4, 4))
  {
    for (const double spread : { 0., 1. })
    {
      SCOPED_TRACE(name + ", " + std::to_string(spread));
      Mesh mesh = rest;
      const NodePartition partition = motions::outerPartition(mesh);
      std::srand(meshes::seed());
      scramble(mesh, partition, spread);
      meshes::ThreadedMonitor monitor(2);
      morph::InversionFree method;
      Points moved = motions::morphed(
        method, mesh, partition, meshes::rows(rest.points, partition.prescribed), monitor);
      const morph::Quality quality = morph::measureCorners(rest, moved, signsOf(rest), {}, monitor);
      EXPECT_EQ(quality.inverted + quality.degenerate, 0);
      EXPECT_GT(quality.minimum, 0.3);
      EXPECT_TRUE(motions::identical(meshes::rows(moved, partition.prescribed),
        meshes::rows(rest.points, partition.prescribed)));
    }
  }
}

TEST(GraphLaplace, ABodyWithoutAPrescribedNodeIsAnErrorInAFlatMeshToo)
{
  Mesh mesh = meshes::hexes(3, 3, 3);
  mesh.points.setZero();
  for (Index i = 0; i < 4; ++i)
  {
    mesh.points(i, 0) = static_cast<double>(i);
  }
  meshes::ThreadedMonitor monitor;
  morph::InversionFree method;
  EXPECT_THROW(method.prepare(mesh, morph::partitionNodes(mesh, {}), monitor), morph::Error);
}

TEST(ShapeWindings, SignsOfTangledMixedMeshesAreThoseOfTheirValidMeshes)
{
  for (const Mesh& valid : { meshes::hexesAndPyramids(4, 4, 4), meshes::hexesAndWedges(4, 4, 4) })
  {
    for (const bool mirrored : { false, true })
    {
      Mesh mesh = valid;
      if (mirrored)
      {
        mesh.points.col(0) *= -1;
      }
      const auto expected = signsOf(mesh);
      const NodePartition partition = motions::outerPartition(mesh);
      for (unsigned seed = 1; seed <= 20; ++seed)
      {
        std::srand(seed);
        scramble(mesh, partition, 1);
        EXPECT_EQ(signsOf(mesh), expected) << seed;
      }
    }
  }
}

TEST(ShapeWindings, ShapesOfOppositeNodeOrderAreToldByTheFacesTheyShare)
{
  Mesh mesh = meshes::hexesAndWedges(4, 4, 4);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (mesh.types[c] == morph::Wedge)
    {
      Index* node = mesh.connectivity.data() + mesh.offsets[c];
      std::swap_ranges(node, node + 3, node + 3);
    }
  }
  const auto expected = signsOf(mesh);
  ASSERT_NE(std::count(expected.begin(), expected.end(), 1), 0);
  ASSERT_NE(std::count(expected.begin(), expected.end(), -1), 0);
  std::srand(meshes::seed());
  scramble(mesh, motions::outerPartition(mesh), 1);
  EXPECT_EQ(signsOf(mesh), expected);
}
