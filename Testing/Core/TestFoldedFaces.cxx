// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/FaceQuality.h"
#include "ClassifiedShape.h"
#include "Motions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace
{
using namespace morph;
using Row = Eigen::RowVector3d;

struct Boundary : shapes::ClassifiedShape
{
  using ClassifiedShape::ClassifiedShape;

  Points moved(const std::function<Row(const Row&)>& motion) const
  {
    return motions::mapped(this->mesh.points, motion);
  }
  std::vector<Index> folded(const Points& moved) const
  {
    return morph::foldedFaces(this->mesh.points, moved, this->faces, this->geometry);
  }
  /// Of faces in the plane z = 6, whose vector area looks down.
  std::vector<Index> downOnTop(const Points& moved) const
  {
    std::vector<Index> result;
    for (std::size_t f = 0; f < this->faces.cells.size(); ++f)
    {
      const Index first = this->faces.offsets[f], size = this->faces.offsets[f + 1] - first;
      const Index* nodes = this->faces.connectivity.data() + first;
      if (std::all_of(nodes, nodes + size, [&](Index n) { return this->mesh.points(n, 2) == 6; }) &&
          morph::vectorArea(moved, nodes, size)[2] <= 0)
      {
        result.push_back(static_cast<Index>(f));
      }
    }
    return result;
  }
};

/// A node of the top goes past its neighbors.
Row pastNeighbors(const Row& x)
{
  return x == Row(3, 3, 6) ? Row(3.2, 5.3, 6) : x;
}

TEST(FoldedFaces, TrianglesThatAreTurnedOver)
{
  const Boundary b(meshes::tets(6, 6, 6));
  const Points moved = b.moved(pastNeighbors);
  ASSERT_FALSE(b.downOnTop(moved).empty());
  EXPECT_EQ(b.folded(moved), b.downOnTop(moved));
}

TEST(FoldedFaces, QuadrilateralsWithOneCornerTurnedOver)
{
  const Boundary b(meshes::hexes(6, 6, 6));
  const Points moved =
    b.moved([](const Row& x) { return x == Row(3, 3, 6) ? Row(3.7, 3.7, 6) : x; });
  EXPECT_TRUE(b.downOnTop(moved).empty()); // its area still looks up
  const std::vector<Index> folded = b.folded(moved);
  ASSERT_EQ(folded.size(), 1u);
  const Index* nodes = b.faces.connectivity.data() + b.faces.offsets[folded[0]];
  Row center = Row::Zero();
  for (int k = 0; k < 4; ++k)
  {
    center += b.mesh.points.row(nodes[k]) / 4;
  }
  EXPECT_EQ(center, Row(3.5, 3.5, 6));
}

TEST(FoldedFaces, ASurfaceThatBendsIsNotFolded)
{
  // A strip rolled up by three quarters of a circle: by the sign alone many faces are reversed.
  const Boundary b(meshes::hexes(24, 4, 1));
  const Points moved = b.moved(
    [](const Row& x)
    {
      const double angle = 1.5 * M_PI * x[0] / 24, radius = 6 - x[2];
      return Row(radius * std::sin(angle), x[1], 6 - radius * std::cos(angle));
    });
  EXPECT_FALSE(morph::faceQuality(b.mesh.points, moved, b.faces, b.geometry).folded.empty());
  EXPECT_TRUE(b.folded(moved).empty());
}

TEST(FoldedFaces, NoneAtRestAndUnderRotations)
{
  const Boundary b(meshes::hexes(3, 3, 3));
  EXPECT_TRUE(b.folded(b.mesh.points).empty());
  EXPECT_TRUE(b.folded(b.moved([](const Row& x) { return Row(-x[0], x[1], -x[2]); })).empty());
}
}
