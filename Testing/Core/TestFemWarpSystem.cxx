// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/ElementStiffness.h"
#include "LinearMethods/FemWarp.h"
#include "Meshes.h"
#include "Motions.h"

#include <gtest/gtest.h>

#include <map>

using namespace morph;

namespace
{
constexpr Index BandRows = 65536;

/// Adds a cell's stiffness to the rows of the nodes in `wanted`.
void addCell(const Mesh& mesh, Index cell, std::map<Index, std::map<Index, double>>& wanted)
{
  double corners[8][3], K[triangleSize(8)];
  const Index* nodes = mesh.cell(cell);
  copyCorners(mesh, cell, *cellShape(Hexahedron), mesh.points, corners[0]);
  ASSERT_EQ(elementStiffness(Shape::Hex, corners, K), 1);
  for (int a = 0; a < 8; ++a)
  {
    const auto row = wanted.find(nodes[a]);
    for (int b = 0; row != wanted.end() && b < 8; ++b)
    {
      row->second[nodes[b]] += K[triangleIndex(8, a, b)];
    }
  }
}
}

TEST(FemWarpSystem, RowsAreSumsOverTheirCells)
{
  Mesh mesh = meshes::hexes(44, 44, 44);
  meshes::jitterInterior(mesh, 0.2, meshes::seed());
  const NodePartition partition = motions::outerPartition(mesh);
  ASSERT_GT(static_cast<Index>(partition.free.size()), BandRows);
  meshes::ThreadedMonitor monitor(2);
  FemWarpSystem system = femWarpSystem(mesh, partition.free, partition.prescribed, {}, monitor);
  EXPECT_FALSE(system.hasBadCells);

  constexpr Index Layer = 43 * 43; // the nodes of a layer: cells of both bands have some
  std::map<Index, std::map<Index, double>> expected; // by node ids
  for (Index row = BandRows - Layer - 50; row < BandRows + Layer + 50; ++row)
  {
    expected[partition.free[row]];
  }
  for (Index cell = 0; cell < mesh.numberOfCells(); ++cell)
  {
    addCell(mesh, cell, expected);
  }
  for (Index row = BandRows - Layer - 50; row < BandRows + Layer + 50; ++row)
  {
    std::map<Index, double> found;
    for (CsrMatrix::InnerIterator entry(system.interior, static_cast<int>(row)); entry; ++entry)
    {
      found[partition.free[entry.col()]] = entry.value();
    }
    for (CsrMatrix::InnerIterator entry(system.coupling, static_cast<int>(row)); entry; ++entry)
    {
      found[partition.prescribed[entry.col()]] = entry.value();
    }
    const std::map<Index, double>& sums = expected[partition.free[row]];
    ASSERT_EQ(found.size(), sums.size()) << "row " << row;
    for (const auto& [node, value] : sums)
    {
      ASSERT_TRUE(found.count(node)) << "row " << row;
      EXPECT_NEAR(found[node], value, 1e-13) << "row " << row << ", node " << node;
    }
  }
}

TEST(FemWarpSystem, TheSignOfACellWithoutAFreeNodeIsFound)
{
  Mesh mesh = meshes::hexes(1, 1, 2);
  mesh.points.row(0).swap(mesh.points.row(3)); // the lower cell's base is turned over
  NodePartition partition = partitionNodes(mesh, { 0, 1, 2, 3, 4, 5, 6, 7 });
  Monitor monitor;
  const FemWarpSystem system =
    femWarpSystem(mesh, partition.free, partition.prescribed, {}, monitor);
  EXPECT_TRUE(system.hasBadCells);
  EXPECT_EQ(system.cellSign[0], 0);
  EXPECT_EQ(system.cellSign[1], 1);
}
