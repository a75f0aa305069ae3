// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/StiffnessFactors.h"

#include "Geometry/NearestNodes.h"
#include "Mesh/CellShape.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Support/Error.h"
#include "Support/Parallel.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <string>

namespace morph
{
namespace
{
constexpr Index Grain = 1024;
constexpr double LeastRatio = 1e-10;   // to the stiffest cell; beyond it the solver loses digits
constexpr double LeastDistance = 1e-3; // of the mean one
constexpr double LeastVolume = 1e-12;  // of the mean one: a flat cell has a finite stiffness

/// Returns for each volume cell value(cell), and 0 for the others.
template <typename Value>
std::vector<double> ofCells(const Mesh& mesh, Monitor& monitor, const Value& value)
{
  std::vector<double> result(mesh.numberOfCells(), 0);
  parallel(mesh.numberOfCells(), Grain, monitor,
    [&](Index c)
    {
      if (hasCorners(mesh, c))
      {
        result[c] = value(c);
      }
    });
  return result;
}

std::vector<double> volumes(const Mesh& mesh, Monitor& monitor)
{
  return ofCells(mesh, monitor,
    [&](Index c)
    {
      const CellShape& shape = *cellShape(mesh, c);
      double corners[8][3];
      copyCorners(mesh, c, shape, mesh.points, corners[0]);
      return std::abs(signedVolume(shape.shape, corners));
    });
}

std::vector<double> wallDistances(const Mesh& mesh, const Points& walls, Monitor& monitor)
{
  const NearestNodes nearest(walls);
  return ofCells(mesh, monitor,
    [&](Index c)
    {
      const CellShape& shape = *cellShape(mesh, c);
      double corners[8][3] = {};
      copyCorners(mesh, c, shape, mesh.points, corners[0]);
      return nearest.distance(
        Eigen::Map<const Points>(corners[0], shape.numberOfCorners, 3).colwise().mean());
    });
}

/// Returns 1 / value^exponent; values below `least` of the mean count as this.
std::vector<double> inversePower(const Mesh& mesh, std::vector<double> value, double exponent,
  double least, const Communicator& processes)
{
  double sum = 0, count = 0;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (!processes.isCopy(c))
    {
      sum += value[c];
      count += hasCorners(mesh, c);
    }
  }
  sum = processes.sum(sum);
  count = processes.sum(count);
  const double floor = count > 0 ? least * sum / count : 0;
  for (double& v : value)
  {
    v = floor > 0 ? std::pow(std::max(v, floor), -exponent) : 1;
  }
  return value;
}

void requireExponent(double exponent)
{
  if (!(exponent >= 0 && exponent <= 4))
  {
    throw Error(
      "The exponent of the stiffness must lie in [0, 4]; it is " + std::to_string(exponent) + ".");
  }
}

/// The positions of the walls of all processes.
Points wallsOf(const Mesh& mesh, const std::vector<Index>& prescribed,
  const CellStiffness& stiffness, const Communicator& processes)
{
  const bool isNamed = !processes.all(stiffness.walls.empty());
  if (!isNamed && !stiffness.noWalls.empty())
  {
    throw Error(stiffness.noWalls);
  }
  std::vector<Index> walls = isNamed ? stiffness.walls : prescribed, wrong;
  if (isNamed && stiffness.areWallsGlobal)
  {
    walls = processes.nodesOf(walls); // the boundary may be on another process than its nodes
  }
  std::copy_if(walls.begin(), walls.end(), std::back_inserter(wrong),
    [&](Index node) { return node < 0 || node >= mesh.numberOfNodes(); });
  if (!wrong.empty())
  {
    throw Error("The walls of the stiffness name nodes that do not exist: ids " + listIds(wrong) +
                ". The mesh has nodes 0 to " + std::to_string(mesh.numberOfNodes() - 1) + ".");
  }
  return processes.gather(mesh.points, walls);
}

void requireValues(
  const Mesh& mesh, const std::vector<double>& values, const Communicator& processes)
{
  if (static_cast<Index>(values.size()) != mesh.numberOfCells())
  {
    throw Error("The stiffness has " + std::to_string(values.size()) + " values; the mesh has " +
                std::to_string(mesh.numberOfCells()) + " cells.");
  }
  std::vector<Index> wrong;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (hasCorners(mesh, c) && !(values[c] > 0 && std::isfinite(values[c])))
    {
      wrong.push_back(c);
    }
  }
  wrong = processes.gatherCells(wrong);
  if (!wrong.empty())
  {
    throw Error("The stiffness is not positive and finite at cell ids " + listIds(wrong) +
                ". Give each volume cell a positive number.");
  }
}

/// Divides by the largest of the volume cells, and limits the ratios.
void normalize(const Mesh& mesh, const Communicator& processes, std::vector<double>& factors)
{
  double largest = 0;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    largest = hasCorners(mesh, c) ? std::max(largest, factors[c]) : largest;
  }
  largest = processes.maximum(largest);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    factors[c] = hasCorners(mesh, c) ? std::max(factors[c] / largest, LeastRatio) : 1;
  }
}
}

std::vector<double> stiffnessFactors(const Mesh& mesh, const std::vector<Index>& prescribed,
  const CellStiffness& stiffness, Monitor& monitor, const Communicator& processes)
{
  const bool hasValues = !processes.all(stiffness.values.empty());
  if (stiffness.kind == CellStiffness::Kind::Uniform && !hasValues)
  {
    return {};
  }
  requireExponent(stiffness.exponent);
  std::vector<double> factors(mesh.numberOfCells(), 1);
  if (stiffness.kind == CellStiffness::Kind::InverseVolume)
  {
    factors =
      inversePower(mesh, volumes(mesh, monitor), stiffness.exponent, LeastVolume, processes);
  }
  else if (stiffness.kind == CellStiffness::Kind::WallDistance)
  {
    const Points walls = wallsOf(mesh, prescribed, stiffness, processes);
    factors = inversePower(
      mesh, wallDistances(mesh, walls, monitor), stiffness.exponent, LeastDistance, processes);
  }
  if (hasValues)
  {
    std::vector<double> values = stiffness.values;
    processes.completeCells(values);
    requireValues(mesh, values, processes);
    std::transform(
      factors.begin(), factors.end(), values.begin(), factors.begin(), std::multiplies<>());
  }
  normalize(mesh, processes, factors);
  return factors;
}
}
