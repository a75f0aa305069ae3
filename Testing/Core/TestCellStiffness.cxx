// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "LinearMethods/StiffnessFactors.h"
#include "Meshes.h"
#include "Motions.h"
#include "Morpher/PolyhedralMorpher.h"
#include "PolyhedralMeshes.h"
#include "Quality/MovableQuality.h"
#include "Support/Error.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace morph;
using motions::kindOf;
using motions::outerPartition;
using motions::Row;
using motions::targets;
using Kind = CellStiffness::Kind;

namespace
{
/// A ring whose first cell is 1e-3 and which grows by 1.2, from 1 to about 14.
Mesh wideRing()
{
  Mesh mesh = meshes::ring(32, 2, 1e-3 / 13);
  meshes::transform(mesh,
    [](const Row& x)
    {
      const double r = std::hypot(x[0], x[1]);
      const double to = 1 + 13 * (r - 1);
      return Row(x[0] * to / r, x[1] * to / r, x[2]);
    });
  return mesh;
}

struct Layer
{
  double lean = 0;   ///< degrees between a wall-normal line of the first cells and the wall's normal
  double height = 0; ///< of the first cell along the normal, in units of the undeformed one
  Index inverted = 0;
};

/// Turns the inner wall by 30 degrees; the outer one stays, and the sides are free.
template <typename Method>
Layer turned(Kind kind, double exponent = 1)
{
  const Mesh mesh = wideRing();
  std::vector<Index> walls, prescribed;
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    const double r = std::hypot(mesh.points(n, 0), mesh.points(n, 1));
    if (r < 1 + 1e-9)
    {
      walls.push_back(n);
    }
    if (r < 1 + 1e-9 || r > 14 - 1e-9)
    {
      prescribed.push_back(n);
    }
  }
  const NodePartition partition = partitionNodes(mesh, prescribed);
  const Points target = targets(mesh, partition,
    [](const Row& x) -> Row
    {
      const double a = std::hypot(x[0], x[1]) < 2 ? M_PI / 6 : 0;
      return { std::cos(a) * x[0] - std::sin(a) * x[1], std::sin(a) * x[0] + std::cos(a) * x[1],
        x[2] };
    });
  Method method;
  method.setStiffness({ kind, exponent, walls, {} });
  meshes::ThreadedMonitor monitor(2);
  method.prepare(mesh, partition, monitor);
  Points moved;
  method.evaluate(target, moved, monitor);
  Layer result;
  result.height = 1;
  result.inverted = MovableQuality(mesh, cellSigns(mesh, connectedComponents(mesh)), partition.free)
                      .measure(moved, monitor)
                      .inverted;
  for (const Index n : walls)
  {
    const Row normal = Row(moved(n, 0), moved(n, 1), 0).normalized();
    const Row line = moved.row(n + 1) - moved.row(n); // nodes are numbered outwards
    const double along = line.dot(normal);
    result.lean = std::max(result.lean, std::acos(along / line.norm()) * 180 / M_PI);
    result.height = std::min(
      result.height, along / (mesh.points.row(n + 1) - mesh.points.row(n)).norm());
  }
  return result;
}
}

TEST(CellStiffness, KeepsTheFirstLayersOfARing)
{
  const Layer uniform = turned<FemWarp>(Kind::Uniform);
  const Layer volume = turned<FemWarp>(Kind::InverseVolume);
  const Layer distance = turned<FemWarp>(Kind::WallDistance);
  const Layer quadratic = turned<FemWarp>(Kind::WallDistance, 2);
  const Layer lb = turned<LogBarrierWarp>(Kind::Uniform);
  const Layer lbVolume = turned<LogBarrierWarp>(Kind::InverseVolume);
  const Layer lbDistance = turned<LogBarrierWarp>(Kind::WallDistance, 2);
  for (const Layer& l : { uniform, volume, distance, quadratic, lb, lbVolume, lbDistance })
  {
    printf("lean %g height %g inverted %d\n", l.lean, l.height, int(l.inverted));
  }
}
