// SPDX-License-Identifier: BSD-3-Clause
// Long rows of faces that learn from each other: the work grows with their number, not with its
// square.
#include "Boundary/GivenSurfaces.h"
#include "Boundary/SurfaceEdges.h"
#include "Meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace morph;

namespace
{
/// n squares in a row along x, `width` wide; nodes 2 i and 2 i + 1 at x = i.
struct Strip
{
  Points points;
  BoundaryFaces faces;

  Strip(Index n, double width)
    : points(2 * n + 2, 3)
  {
    for (Index i = 0; i <= n; ++i)
    {
      const double x = static_cast<double>(i);
      this->points.row(2 * i) << x, 0, 0;
      this->points.row(2 * i + 1) << x, width, 0;
      if (i < n)
      {
        const Index a = 2 * i;
        const Index corners[] = { a, a + 2, a + 3, a + 1 };
        this->faces.add(corners, corners + 4);
      }
    }
  }

  Index size() const { return static_cast<Index>(this->faces.offsets.size()) - 1; }
};
}

TEST(LinearCost, NormalsReachARowOfFlatFaces)
{
  for (const Index n : { 50, 500, 5000 })
  {
    Strip strip(n, 0);
    strip.points.row(2 * n + 1) << static_cast<double>(n), 0, 1; // the last face has an area
    Monitor monitor;
    const SurfaceEdges edges = surfaceEdges(strip.points, strip.faces, monitor);
    for (Index f = 0; f < n - 1; ++f)
    {
      const Index e = edges.find(2 * f + 2, 2 * f + 3);
      ASSERT_GE(e, 0);
      EXPECT_EQ(edges.angle[e], 0); // it continues its neighbor
    }
    EXPECT_LE(edges.visits, 5 * n);
  }
}

TEST(LinearCost, SurfaceIdsSpreadAlongARow)
{
  for (const Index n : { 50, 500, 5000 })
  {
    const Strip strip(n, 1);
    ClassificationOptions options;
    // One corner lies on surface 7; the other nodes on the two curves along the row.
    const std::size_t nodes = static_cast<std::size_t>(strip.points.rows());
    options.given.dimension.assign(nodes, 1);
    options.given.id.resize(nodes);
    for (std::size_t i = 0; i < nodes; ++i)
    {
      options.given.id[i] = static_cast<Index>(i % 2);
    }
    options.given.parameter.assign(nodes, std::numeric_limits<double>::quiet_NaN());
    options.given.dimension[0] = 2;
    options.given.id[0] = 7;
    Monitor monitor;
    const GivenSurfaces given = givenSurfaces(
      strip.points, strip.faces, surfaceEdges(strip.points, strip.faces, monitor), options);
    EXPECT_EQ(given.id, std::vector<Index>(static_cast<std::size_t>(n), 7));
    EXPECT_LE(given.visits, 10 * n);
  }
}
