// SPDX-License-Identifier: BSD-3-Clause
// What is particular to natural neighbors; TestLinearMorphers.cxx has what they share with the
// other methods.
#include "LinearMethods/SimplexNaturalNeighbor.h"

#include "Meshes.h"
#include "Motions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace morph;
using motions::count;
using motions::difference;
using motions::jittered;
using motions::outerPartition;
using motions::targets;
using motions::twistOf;
using Row = Eigen::RowVector3d;

namespace
{
Points morphed(const Mesh& mesh, const NodePartition& partition, const Points& target)
{
  Monitor monitor;
  SimplexNaturalNeighbor method;
  return motions::morphed(method, mesh, partition, target, monitor);
}

}

TEST(SimplexNaturalNeighbor, SymmetricMotionsStaySymmetric)
{
  const Mesh mesh = meshes::hexes(6, 6, 6);
  const NodePartition partition = outerPartition(mesh);
  const auto bulge = [](const Row& x)
  {
    const double r = (x.head<2>().array() - 3).matrix().squaredNorm();
    return Row(x[0], x[1], x[2] + .05 * r * x[2]);
  };
  const Points moved = morphed(mesh, partition, targets(mesh, partition, bulge));
  const auto height = [&](int i, int j, int k) { return moved(i + 7 * (j + 7 * k), 2); };
  for (int k = 1; k < 6; ++k)
  {
    for (int j = 1; j < 6; ++j)
    {
      for (int i = 1; i < 6; ++i)
      {
        EXPECT_NEAR(height(i, j, k), height(6 - i, j, k), 1e-10);
        EXPECT_NEAR(height(i, j, k), height(j, i, k), 1e-10);
      }
    }
  }
}

TEST(SimplexNaturalNeighbor, TheMemoryLimitChangesNoResult)
{
  for (const auto& [name, mesh] : jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    const Points target = targets(mesh, partition, twistOf(4));
    meshes::ThreadedMonitor silent, monitor(3);
    SimplexNaturalNeighbor stored, anew;
    anew.setMemoryLimit(100);
    stored.prepare(mesh, partition, silent);
    anew.prepare(mesh, partition, monitor);
    EXPECT_TRUE(silent.warnings.empty());
    ASSERT_EQ(monitor.warnings.size(), 1u);
    EXPECT_NE(monitor.warnings[0].find("memory limit of 1e-07 GB"), std::string::npos)
      << monitor.warnings[0];

    Points one, other;
    const EvaluateReport first = stored.evaluate(target, one, silent);
    const EvaluateReport second = anew.evaluate(target, other, monitor);
    EXPECT_TRUE(motions::identical(one, other)) << name;
    EXPECT_EQ(count(first, "WeightsStored"), 1);
    EXPECT_EQ(count(second, "WeightsStored"), 0);
    EXPECT_EQ(count(first, "BarycentricNodes"), count(second, "BarycentricNodes"));
    stored.applyTranspose(mesh.points, one, silent);
    anew.applyTranspose(mesh.points, other, monitor);
    EXPECT_TRUE(motions::identical(one, other)) << name;
  }
}

TEST(SimplexNaturalNeighbor, NodesOnEdgesOfTheHullAndBeyondAreCounted)
{
  const Mesh mesh = meshes::hexes(6, 6, 6);
  std::vector<Index> ids;
  for (Index id = 0; id < mesh.numberOfNodes(); ++id)
  {
    const Row x = mesh.points.row(id);
    const bool corner = (x.array() == 0 || x.array() == 4).all();
    if (corner)
    {
      ids.push_back(id);
    }
  }
  ASSERT_EQ(ids.size(), 8u);
  const NodePartition partition = partitionNodes(mesh, ids);
  const auto beyond = std::count_if(partition.free.begin(), partition.free.end(),
    [&](Index id) { return mesh.points.row(id).maxCoeff() > 4; });
  Monitor monitor;
  SimplexNaturalNeighbor method;
  method.prepare(mesh, partition, monitor);
  Points moved;
  const EvaluateReport report =
    method.evaluate(targets(mesh, partition, motions::affine), moved, monitor);
  EXPECT_EQ(count(report, "ExtrapolatedNodes"), beyond);
  const Index within = 3 * 3 * 3 + 6 * 3 * 3;
  EXPECT_EQ(count(report, "BarycentricNodes"), static_cast<Index>(partition.free.size()) - within);
  EXPECT_LT(difference(moved, motions::mapped(mesh.points, motions::affine)),
    1e-10 * meshes::size(mesh.points));
}

TEST(SimplexNaturalNeighbor, NoNodeInsideFallsBack)
{
  for (const auto& [name, mesh] : jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    Monitor monitor;
    SimplexNaturalNeighbor method;
    method.prepare(mesh, partition, monitor);
    Points moved;
    const EvaluateReport report =
      method.evaluate(targets(mesh, partition, motions::affine), moved, monitor);
    EXPECT_EQ(count(report, "BarycentricNodes"), 0) << name;
  }
}
