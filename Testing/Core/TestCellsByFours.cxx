// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CellShape.h"
#include "Meshes.h"
#include "Quality/ScaledJacobian.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace
{
using namespace morph;

const std::uint32_t Seed = meshes::seed();

/// Cells with nodes of their own, of all sizes: some valid, some inverted, some without an edge or
/// with a coordinate that is not finite. Hexahedra and tetrahedra alternate in groups.
Mesh cellsOfAllKinds(Index count)
{
  std::mt19937 random(Seed);
  std::uniform_real_distribution<double> offset(-0.6, 0.6);
  std::uniform_int_distribution<int> exponent(-170, 120), kind(0, 19), group(0, 6);
  const Mesh hex = meshes::hexes(1, 1, 1);
  Mesh mesh;
  std::vector<Eigen::RowVector3d> points;
  std::uint8_t type = Hexahedron;
  for (Index c = 0; c < count; ++c)
  {
    if (group(random) == 0)
    {
      type = type == Tetra ? Hexahedron : Tetra;
    }
    const int corners = type == Tetra ? 4 : 8;
    const std::size_t first = points.size();
    const double scale = kind(random) < 15 ? 1 : std::pow(10., exponent(random));
    for (int k = 0; k < corners; ++k)
    {
      // The corners 0, 1, 3 and 4 of a box make a tetrahedron.
      const int corner = type == Tetra ? (k < 2 ? k : k + 1) : k;
      Eigen::RowVector3d x = hex.points.row(hex.cell(0)[corner]);
      x += Eigen::RowVector3d::NullaryExpr([&] { return offset(random); });
      mesh.connectivity.push_back(static_cast<Index>(points.size()));
      points.push_back(scale * x);
    }
    switch (kind(random))
    {
      case 0:
        points[first + 1] = points[first];
        break;
      case 1:
        points[first + 2][1] = std::numeric_limits<double>::quiet_NaN();
        break;
      case 2:
        points[first + 3][2] = -std::numeric_limits<double>::infinity();
        break;
      case 3:
        points[first + 3][0] = 1e200; // its square overflows
        break;
      default:
        break;
    }
    mesh.types.push_back(type);
    mesh.offsets.push_back(static_cast<Index>(mesh.connectivity.size()));
  }
  mesh.points.resize(static_cast<Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    mesh.points.row(static_cast<Index>(i)) = points[i];
  }
  return mesh;
}

double oneByOne(const Mesh& mesh, Index c)
{
  double corners[8][3];
  copyCorners(mesh, c, *cellShape(mesh.types[c]), mesh.points, corners[0]);
  return scaledJacobian(*cellShape(mesh, c), corners);
}

/// Whether two corners on an edge are in the same place.
bool isCollapsed(const Mesh& mesh, Index c)
{
  const auto areOne = [&](int a, int b)
  { return mesh.points.row(mesh.cell(c)[a]) == mesh.points.row(mesh.cell(c)[b]); };
  if (mesh.types[c] == Tetra)
  {
    return areOne(0, 1) || areOne(0, 2) || areOne(0, 3) || areOne(1, 2) || areOne(1, 3) ||
           areOne(2, 3);
  }
  bool any = false;
  for (const auto& edges : HexAxisEdges)
  {
    for (const int(&ends)[2] : edges)
    {
      any = any || areOne(ends[0], ends[1]);
    }
  }
  return any;
}

bool sameBits(double a, double b)
{
  return std::memcmp(&a, &b, sizeof(a)) == 0 || (std::isnan(a) && std::isnan(b));
}

TEST(ScaledJacobian, CellsByFoursHaveTheBitsOfOneByOne)
{
  const Mesh mesh = cellsOfAllKinds(20001);
  for (const int threads : { 1, 3 })
  {
    meshes::ThreadedMonitor monitor(threads);
    const Quality quality = measureQuality(mesh, mesh.points, {}, {}, monitor);
    Index inverted = 0, collapsed = 0, notMeasured = 0;
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      const double value = quality.scaledJacobian[c];
      ASSERT_TRUE(sameBits(value, oneByOne(mesh, c))) << "cell " << c << ", seed " << Seed;
      const bool isFlat = !std::isnan(value) && isCollapsed(mesh, c);
      inverted += value <= 0 && !isFlat;
      collapsed += isFlat;
      notMeasured += std::isnan(value);
    }
    EXPECT_EQ(quality.inverted, inverted);
    EXPECT_EQ(quality.degenerate, collapsed);
    EXPECT_EQ(quality.measured, mesh.numberOfCells() - notMeasured);
    // All kinds were there.
    EXPECT_GT(inverted, 1000);
    EXPECT_GT(collapsed, 300);
    EXPECT_GT(notMeasured, 1000);
  }
}

TEST(ScaledJacobian, CellsByFoursHaveTheSignOfZero)
{
  // Two corners in the middle of the diagonal beside them: flat corners with edges of all lengths.
  Mesh mesh = meshes::hexes(8, 1, 1);
  for (Index c = 0; c < mesh.numberOfCells(); c += 2)
  {
    const Index* n = mesh.cell(c);
    mesh.points.row(n[1]) = (mesh.points.row(n[0]) + mesh.points.row(n[2])) / 2;
    mesh.points.row(n[5]) = (mesh.points.row(n[4]) + mesh.points.row(n[6])) / 2;
  }
  Monitor monitor;
  const Quality quality = measureQuality(mesh, mesh.points, {}, {}, monitor);
  Index zeros = 0;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    zeros += quality.scaledJacobian[c] == 0;
    EXPECT_TRUE(sameBits(quality.scaledJacobian[c], oneByOne(mesh, c))) << "cell " << c;
  }
  EXPECT_GT(zeros, 0);
}
}
