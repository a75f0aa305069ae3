// SPDX-License-Identifier: BSD-3-Clause
#include "Motions.h"

#include "Mesh/Topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>

namespace motions
{
using namespace morph;

Row affine(const Row& x)
{
  const Eigen::Matrix3d shear =
    (Eigen::Matrix3d() << 1.1, .3, .2, -.1, 1.4, .05, .2, .1, .9).finished();
  return x * shear + Row(3, -2, .5);
}

Row twist(const Row& x, double w, double h, double angle)
{
  const double a = angle * x[2] / h, dx = x[0] - w / 2, dy = x[1] - w / 2;
  return { w / 2 + dx * std::cos(a) - dy * std::sin(a), w / 2 + dx * std::sin(a) + dy * std::cos(a),
    1.5 * x[2] };
}

Map twistOf(double size, double angle)
{
  return [=](const Row& x) { return twist(x, size, size, angle); };
}

Row bend(const Row& x)
{
  return { x[0] + .3 * std::sin(x[1]), x[1] + .1 * x[2] * x[0],
    1.2 * x[2] + .2 * std::cos(2 * x[0]) };
}

Points mapped(const Points& points, const Map& map)
{
  Points result(points.rows(), 3);
  for (Index i = 0; i < points.rows(); ++i)
  {
    result.row(i) = map(points.row(i));
  }
  return result;
}

NodePartition outerPartition(const Mesh& mesh)
{
  Monitor monitor;
  return partitionNodes(mesh, boundaryFaces(mesh, monitor).nodes);
}

Points targets(const Mesh& mesh, const NodePartition& partition, const Map& map)
{
  return mapped(meshes::rows(mesh.points, partition.prescribed), map);
}

std::vector<std::pair<std::string, Mesh>> jittered()
{
  auto list = meshes::all(4, 4, 4);
  for (auto& [name, mesh] : list)
  {
    meshes::jitterInterior(mesh, name == "hexes, pyramids and tets" ? 0.1 : 0.15, meshes::seed());
  }
  return list;
}

std::vector<std::pair<std::string, Mesh>> inGeneralPosition()
{
  auto list = meshes::all(4, 4, 4);
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> shift(-.1, .1);
  for (auto& entry : list)
  {
    entry.second.points =
      entry.second.points.unaryExpr([&](double x) { return x + shift(random); });
  }
  return list;
}

const std::vector<Eigen::Matrix3d>& symmetries()
{
  static const std::vector<Eigen::Matrix3d> list = {
    (Eigen::Matrix3d() << 0, 1, 0, -1, 0, 0, 0, 0, 1).finished(),
    (Eigen::Matrix3d() << 0, 0, 1, 0, 1, 0, -1, 0, 0).finished(),
    (Eigen::Matrix3d() << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished(),
    (Eigen::Matrix3d() << -1, 0, 0, 0, 1, 0, 0, 0, 1).finished()
  };
  return list;
}

std::vector<Index> images(const Points& points, const Eigen::Matrix3d& symmetry)
{
  std::vector<Index> result;
  for (Index i = 0; i < points.rows(); ++i)
  {
    Index image = 0;
    (points.rowwise() - Row(points.row(i) * symmetry)).rowwise().norm().minCoeff(&image);
    result.push_back(image);
  }
  return result;
}

std::vector<Index> shuffledNumbers(Index n)
{
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), Index(0));
  std::shuffle(order.begin(), order.end(), std::mt19937(meshes::seed()));
  return order;
}

Points moved(const Morpher& method, const ConstPoints& target, Monitor& monitor)
{
  Points result;
  method.evaluate(target, result, monitor);
  return result;
}

Points morphed(Morpher& method, const Mesh& mesh, const NodePartition& partition,
  const ConstPoints& target, Monitor& monitor)
{
  method.prepare(mesh, partition, monitor);
  return moved(method, target, monitor);
}

double difference(const Points& a, const Points& b)
{
  return (a - b).cwiseAbs().maxCoeff();
}

bool identical(const Points& a, const Points& b)
{
  // Without rows there is no memory to compare.
  return a.rows() == b.rows() &&
         (a.size() == 0 || std::memcmp(a.data(), b.data(), sizeof(double) * a.size()) == 0);
}

Index count(const EvaluateReport& report, const std::string& name)
{
  for (const Statistic& statistic : report.statistics)
  {
    if (statistic.name == name)
    {
      return statistic.value;
    }
  }
  ADD_FAILURE() << "no count " << name;
  return -1;
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

void expectError(const std::function<void()>& call, const std::string& part)
{
  const std::string message = messageOf(call);
  EXPECT_NE(message.find(part), std::string::npos) << part << " is not in " << message;
}

void expectError(Error::Kind kind, const std::function<void()>& call, const std::string& part)
{
  std::string message;
  EXPECT_EQ(kindOf(call, message), kind) << part;
  EXPECT_NE(message.find(part), std::string::npos) << part << " is not in " << message;
}

std::string messageOf(const std::function<void()>& call)
{
  std::string message;
  kindOf(call, message);
  return message;
}
}
