// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/BridgingTetrahedra.h"

#include "LinearMethods/SimplexLinear.h"
#include "Meshes.h"
#include "Motions.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>

using namespace morph;
using Row = Eigen::RowVector3d;

namespace
{
using Inside = std::function<bool(const Row&)>;

/// The cells of `mesh` whose centre is inside; all of its nodes.
Mesh carved(const Mesh& mesh, const Inside& inside)
{
  Mesh result;
  result.points = mesh.points;
  result.offsets.push_back(0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const std::vector<Index> nodes(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
    if (inside(meshes::rows(mesh.points, nodes).colwise().mean()))
    {
      meshes::add(result, mesh.types[c], nodes);
    }
  }
  return result;
}

struct Found
{
  Index bridging = 0;
  Index all = 0;      ///< tetrahedra of the tessellation
  Index expected = 0; ///< with their centre outside the mesh
  bool same = true;   ///< the bridging ones are those outside
};

constexpr double Flat = 1e-9; // between sites of a plane, where rounding says which side it is on

/// Among all tetrahedra of the tessellation of the outer nodes that are not flat.
Found search(const Mesh& mesh, const Inside& inside)
{
  Monitor monitor;
  const std::vector<Index> prescribed = motions::outerPartition(mesh).prescribed;
  const InterpolationSites sites(mesh.points, prescribed);
  Delaunay delaunay;
  delaunay.build(sites.coordinates(), monitor);
  std::vector<int> all;
  for (std::size_t t = 0; t < delaunay.tetrahedra().size(); ++t)
  {
    if (Delaunay::sixVolumes(delaunay.tetrahedra()[t], delaunay.sites()) > Flat)
    {
      all.push_back(static_cast<int>(t));
    }
  }
  const std::vector<int> bridging =
    bridgingTetrahedra(mesh, prescribed, sites, delaunay, all, monitor);
  Found found;
  found.all = static_cast<Index>(all.size());
  found.bridging = static_cast<Index>(bridging.size());
  for (int t : all)
  {
    Row centre = Row::Zero();
    for (int site : delaunay.tetrahedra()[t].sites)
    {
      centre += .25 * delaunay.sites().row(site);
    }
    const bool outside = !inside(centre);
    found.expected += outside ? 1 : 0;
    found.same &= outside == std::binary_search(bridging.begin(), bridging.end(), t);
  }
  return found;
}

Index bridgingCount(const Mesh& mesh)
{
  Monitor monitor;
  const NodePartition partition = motions::outerPartition(mesh);
  SimplexLinear method;
  method.prepare(mesh, partition, monitor);
  Points moved;
  const EvaluateReport report =
    method.evaluate(meshes::rows(mesh.points, partition.prescribed), moved, monitor);
  for (const Statistic& count : report.statistics)
  {
    if (count.name == "BridgingTetrahedra")
    {
      return count.value;
    }
  }
  ADD_FAILURE() << "no count";
  return -1;
}

// Lattices, whose walls the tetrahedra do not cross: each of them is inside the mesh or outside.
const Inside Ell = [](const Row& x) { return x[0] < 2 || x[1] < 3; };
const Inside Plate = [](const Row& x) { return x[0] < 2 || x[0] > 5 || x[1] < 2 || x[1] > 4; };
const Inside TwoBodies = [](const Row& x) { return x[0] < 3 || x[0] > 4; };
}

TEST(BridgingTetrahedra, AreThoseInANotchAHoleOrAGap)
{
  for (const auto& [name, inside] :
    { std::make_pair("L", Ell), std::make_pair("plate", Plate), std::make_pair("two", TwoBodies) })
  {
    for (const auto& [cells, mesh] : { std::make_pair("hexes", meshes::hexes(7, 6, 3)),
           std::make_pair("tets", meshes::tets(7, 6, 3)),
           std::make_pair("wedges", meshes::wedges(7, 6, 3)) })
    {
      const Found found = search(carved(mesh, inside), inside);
      EXPECT_GT(found.bridging, 10) << name << " of " << cells;
      EXPECT_LT(found.bridging, found.all - 10) << name << " of " << cells;
      EXPECT_EQ(found.bridging, found.expected) << name << " of " << cells;
      EXPECT_TRUE(found.same) << name << " of " << cells;
    }
  }
}

TEST(BridgingTetrahedra, AreFoundInATurnedAndScaledMesh)
{
  const Eigen::Matrix3d R =
    Eigen::AngleAxisd(.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (const Inside& inside : { Ell, Plate, TwoBodies })
  {
    Mesh mesh = carved(meshes::hexes(7, 6, 3), inside);
    meshes::transform(mesh, [&](const Row& x) { return Row(2.5 * x * R); });
    const Found found = search(mesh, [&](const Row& x) { return inside(.4 * x * R.transpose()); });
    EXPECT_GT(found.bridging, 10);
    EXPECT_TRUE(found.same);
  }
}

TEST(BridgingTetrahedra, AreFoundInAMirroredMesh)
{
  for (const Inside& inside : { Ell, Plate, TwoBodies })
  {
    Mesh mesh = carved(meshes::hexes(7, 6, 3), inside);
    mesh.points.col(2) *= -1;
    const Found found = search(mesh, inside);
    EXPECT_GT(found.bridging, 10);
    EXPECT_TRUE(found.same);
  }
}

TEST(BridgingTetrahedra, ConvexMeshesHaveNone)
{
  for (const auto& [name, mesh] : meshes::all(4, 4, 4))
  {
    const Found found = search(mesh, [](const Row&) { return true; });
    EXPECT_EQ(found.bridging, 0) << name;
  }
}

TEST(BridgingTetrahedra, BodiesThatTouchHaveNone)
{
  // Nodes of their own in the common face, and not all of it: the first body is twice as high.
  const Mesh high = meshes::hexes(3, 3, 6), low = meshes::hexes(3, 3, 3);
  Mesh mesh = high;
  mesh.points.conservativeResize(high.numberOfNodes() + low.numberOfNodes(), 3);
  mesh.points.bottomRows(low.numberOfNodes()) = low.points.rowwise() + Row(3, 0, 0);
  for (Index c = 0; c < low.numberOfCells(); ++c)
  {
    std::vector<Index> nodes(low.cell(c), low.cell(c) + 8);
    for (Index& node : nodes)
    {
      node += high.numberOfNodes();
    }
    meshes::add(mesh, Hexahedron, nodes);
  }
  const Inside inside = [](const Row& x) { return x[0] < 3 || x[2] < 3; };
  const Found found = search(mesh, inside);
  EXPECT_GT(found.bridging, 10);
  EXPECT_TRUE(found.same);
}

TEST(BridgingTetrahedra, CornersOfHalfATurnAreNoObstacle)
{
  // The edges of the gap cut off so that the quadrilaterals at their ends have such corners.
  const Eigen::Matrix3d R =
    Eigen::AngleAxisd(.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  Mesh mesh = carved(meshes::hexes(7, 6, 3), TwoBodies);
  meshes::transform(mesh, [](const Row& x)
    { return x[1] > 0 || x[0] < 3 || x[0] > 4 ? x : Row(x[0] < 3.5 ? 2.5 : 4.5, .5, x[2]); });
  const Inside inside = [](const Row& x)
  { return (x[0] < 3 && x[0] - x[1] < 2) || (x[0] > 4 && x[0] + x[1] > 5); };
  const Found straight = search(mesh, inside);
  EXPECT_GT(straight.bridging, 10);
  EXPECT_TRUE(straight.same);
  // Turned, rounding takes the place of the corner's normal.
  meshes::transform(mesh, [&](const Row& x) { return Row(x * R); });
  const Found turned = search(mesh, [&](const Row& x) { return inside(x * R.transpose()); });
  EXPECT_GT(turned.bridging, 10);
  EXPECT_TRUE(turned.same);
}

TEST(BridgingTetrahedra, ASlotNarrowerThanTheSpacingIsCounted)
{
  // Cells ten times as long as the slot is wide.
  const Inside slot = [](const Row& x) { return x[0] < 3 || x[0] > 4 || x[2] < 1; };
  Mesh mesh = carved(meshes::hexes(7, 4, 6), slot);
  EXPECT_EQ(bridgingCount(mesh), 0); // the slot's tetrahedra hold no nodes
  meshes::transform(mesh,
    [](const Row& x)
    {
      const double thin = x[0] < 3 ? x[0] : x[0] < 4 ? 3 + .1 * (x[0] - 3) : x[0] - .9;
      return Row(.2 * thin, x[1], x[2]);
    });
  meshes::jitterInterior(mesh, .02, meshes::seed());
  const Index stretched = bridgingCount(mesh);
  EXPECT_GT(stretched, 0);
}
