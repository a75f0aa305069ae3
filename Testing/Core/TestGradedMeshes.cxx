// SPDX-License-Identifier: BSD-3-Clause
// The inversion-free morph on boundary layers, whose first cells are far smaller than the others.
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/SimplexLinear.h"
#include "Mesh/Topology.h"
#include "Meshes.h"
#include "Motions.h"
#include "Quality/MovableQuality.h"
#include "Untangling/InversionFree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace morph;
using motions::Row;

namespace
{
/// A hump of the layers' wall, which the opposite side does not follow.
motions::Map hump(double height)
{
  return [height](const Row& x) -> Row
  {
    const double h = height * std::sin(M_PI * x[0]) * std::sin(M_PI * x[1]);
    return { x[0], x[1], x[2] + h * (1 - x[2]) };
  };
}

/// Turns the inner side of meshes::ring() by this angle.
motions::Map turn(double degrees)
{
  return [degrees](const Row& x) -> Row
  {
    const double angle = degrees * M_PI / 180 * (2 - std::hypot(x[0], x[1]));
    return { std::cos(angle) * x[0] - std::sin(angle) * x[1],
      std::sin(angle) * x[0] + std::cos(angle) * x[1], x[2] };
  };
}

/// Bends the layers by this angle.
motions::Map bend(double degrees)
{
  return [degrees](const Row& x) -> Row
  {
    const double angle = degrees * M_PI / 180, radius = 1 / angle - (x[0] - 0.5);
    return { 1 / angle - radius * std::cos(angle * x[2]), x[1], radius * std::sin(angle * x[2]) };
  };
}

struct Case
{
  std::string Name;
  Mesh Rest;
  motions::Map Map;
};

struct Compared
{
  MovableQuality::Result FemWarp, SimplexLinear, InversionFree;
};

Compared compare(const Case& each)
{
  const NodePartition partition = motions::outerPartition(each.Rest);
  const Points target = motions::targets(each.Rest, partition, each.Map);
  const auto orientation = cellSigns(each.Rest, connectedComponents(each.Rest));
  const MovableQuality quality(each.Rest, orientation, partition.free);
  meshes::ThreadedMonitor monitor(2);
  const auto run = [&](Morpher&& method)
  {
    Points moved;
    method.prepare(each.Rest, partition, monitor);
    method.evaluate(target, moved, monitor);
    return quality.measure(moved, monitor);
  };
  return { run(FemWarp()), run(SimplexLinear()), run(InversionFree()) };
}
}

TEST(GradedMeshes, ComeOutValidWhereBothLinearMethodsInvert)
{
  const Case cases[] = { { "layers 1e-4", meshes::layered(meshes::hexes, 5, 1e-4, 1.2), hump(0.5) },
    { "ring 1e-3", meshes::ring(48, 3, 1e-3), turn(90) } };
  for (const Case& each : cases)
  {
    SCOPED_TRACE(each.Name);
    const Compared result = compare(each);
    EXPECT_GT(result.FemWarp.inverted, 0);
    EXPECT_GT(result.SimplexLinear.inverted, 0);
    EXPECT_EQ(result.InversionFree.inverted, 0);
    EXPECT_GT(result.InversionFree.minimum, 0.01);
  }
}

TEST(GradedMeshes, AreNeverWorseThanTheLinearMethodsMeshes)
{
  // Boundaries that admit no valid mesh.
  const Case cases[] = { { "ring", meshes::ring(32, 2, 1e-2), turn(200) },
    { "tetrahedra", meshes::layered(meshes::tets, 6, 1e-3, 1.3), bend(120) },
    { "layers", meshes::layered(meshes::hexes, 4, 1e-2, 1.4), hump(1.05) } };
  for (const Case& each : cases)
  {
    SCOPED_TRACE(each.Name);
    const Compared result = compare(each);
    EXPECT_GT(result.InversionFree.inverted, 0);
    EXPECT_FALSE(result.InversionFree < std::max(result.FemWarp, result.SimplexLinear));
  }
}
