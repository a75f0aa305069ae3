// SPDX-License-Identifier: BSD-3-Clause
#include "Motions.h"

#include "Topology.h"

#include <gtest/gtest.h>

#include <cmath>

namespace meshes
{
using namespace morph;

namespace
{
const Eigen::Matrix3d Shear =
  (Eigen::Matrix3d() << 1.1, .3, .2, -.1, 1.4, .05, .2, .1, .9).finished();
}

Eigen::RowVector3d affine(const Eigen::RowVector3d& x)
{
  return x * Shear + Eigen::RowVector3d(3, -2, .5);
}

Eigen::RowVector3d twist(const Eigen::RowVector3d& x, double w, double h, double angle)
{
  const double a = angle * x[2] / h, dx = x[0] - w / 2, dy = x[1] - w / 2;
  return { w / 2 + dx * std::cos(a) - dy * std::sin(a), w / 2 + dx * std::sin(a) + dy * std::cos(a),
    1.5 * x[2] };
}

NodePartition outerPartition(const Mesh& mesh)
{
  Monitor monitor;
  return partitionNodes(mesh, boundaryFaces(mesh, monitor).nodes);
}

Points targets(const Mesh& mesh, const NodePartition& partition,
  const std::function<Eigen::RowVector3d(const Eigen::RowVector3d&)>& map)
{
  Mesh copy = mesh;
  transform(copy, map);
  return rows(copy.points, partition.prescribed);
}

std::vector<std::pair<std::string, Mesh>> jittered()
{
  auto list = all(4, 4, 4);
  for (auto& [name, mesh] : list)
  {
    jitterInterior(mesh, name == "hexes, pyramids and tets" ? 0.1 : 0.15, seed());
  }
  return list;
}

Error::Kind kindOf(const std::function<void()>& call, std::string& message)
{
  try
  {
    call();
  }
  catch (const Error& error)
  {
    message = error.what();
    return error.kind();
  }
  ADD_FAILURE() << "no error";
  return Error::Kind::InvalidInput;
}
}
