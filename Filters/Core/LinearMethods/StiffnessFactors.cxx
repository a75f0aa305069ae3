// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/StiffnessFactors.h"

#include "Geometry/NearestNodes.h"
#include "Mesh/CellShape.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Support/Error.h"

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

bool isVolumeCell(const Mesh& mesh, Index cell)
{
  return numberOfCorners(cellShape(mesh, cell)->shape) > 0;
}

/// Returns for each volume cell value(cell), and 0 for the others.
template <typename Value>
std::vector<double> ofCells(const Mesh& mesh, Monitor& monitor, const Value& value)
{
  std::vector<double> result(mesh.numberOfCells(), 0);
  monitor.parallelFor(mesh.numberOfCells(), Grain,
    [&](Index first, Index last)
    {
      for (Index c = first; c < last; ++c)
      {
        if (isVolumeCell(mesh, c))
        {
          result[c] = value(c);
        }
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
  double least, const StiffnessPart& part)
{
  double sum = 0, count = 0;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (part.isGhost[c] == 0)
    {
      sum += value[c];
      count += isVolumeCell(mesh, c);
    }
  }
  sum = part.sum(sum);
  count = part.sum(count);
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

void requireWalls(const Mesh& mesh, const CellStiffness& stiffness)
{
  const std::vector<Index>& walls = stiffness.walls;
  if (walls.empty() && !stiffness.noWalls.empty())
  {
    throw Error(stiffness.noWalls);
  }
  std::vector<Index> wrong;
  std::copy_if(walls.begin(), walls.end(), std::back_inserter(wrong),
    [&](Index node) { return node < 0 || node >= mesh.numberOfNodes(); });
  if (!wrong.empty())
  {
    throw Error("The walls of the stiffness name nodes that do not exist: ids " + listIds(wrong) +
                ". The mesh has nodes 0 to " + std::to_string(mesh.numberOfNodes() - 1) + ".");
  }
}

void requireValues(const Mesh& mesh, const std::vector<double>& values)
{
  if (static_cast<Index>(values.size()) != mesh.numberOfCells())
  {
    throw Error("The stiffness has " + std::to_string(values.size()) + " values; the mesh has " +
                std::to_string(mesh.numberOfCells()) + " cells.");
  }
  std::vector<Index> wrong;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (isVolumeCell(mesh, c) && !(values[c] > 0 && std::isfinite(values[c])))
    {
      wrong.push_back(c);
    }
  }
  if (!wrong.empty())
  {
    throw Error("The stiffness is not positive and finite at cell ids " + listIds(wrong) +
                ". Give each volume cell a positive number.");
  }
}

/// Divides by the largest of the volume cells, and limits the ratios.
void normalize(const Mesh& mesh, const StiffnessPart& part, std::vector<double>& factors)
{
  double largest = 0;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    largest = isVolumeCell(mesh, c) ? std::max(largest, factors[c]) : largest;
  }
  largest = part.maximum(largest);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    factors[c] = isVolumeCell(mesh, c) ? std::max(factors[c] / largest, LeastRatio) : 1;
  }
}
}

std::vector<double> stiffnessFactors(const Mesh& mesh, const std::vector<Index>& prescribed,
  const CellStiffness& stiffness, Monitor& monitor)
{
  if (stiffness.kind == CellStiffness::Kind::Uniform && stiffness.values.empty())
  {
    return {};
  }
  const std::vector<std::uint8_t> isGhost(mesh.numberOfCells(), 0);
  const auto same = [](double value) { return value; };
  StiffnessPart whole{ isGhost, Points(0, 3), same, same };
  if (stiffness.kind == CellStiffness::Kind::WallDistance)
  {
    requireWalls(mesh, stiffness);
    whole.walls = mesh.points(stiffness.walls.empty() ? prescribed : stiffness.walls, allColumns);
  }
  return stiffnessFactors(mesh, stiffness, whole, monitor);
}

std::vector<double> stiffnessFactors(
  const Mesh& mesh, const CellStiffness& stiffness, const StiffnessPart& part, Monitor& monitor)
{
  requireExponent(stiffness.exponent);
  std::vector<double> factors(mesh.numberOfCells(), 1);
  if (stiffness.kind == CellStiffness::Kind::InverseVolume)
  {
    factors = inversePower(mesh, volumes(mesh, monitor), stiffness.exponent, LeastVolume, part);
  }
  else if (stiffness.kind == CellStiffness::Kind::WallDistance)
  {
    factors = inversePower(
      mesh, wallDistances(mesh, part.walls, monitor), stiffness.exponent, LeastDistance, part);
  }
  if (!stiffness.values.empty())
  {
    requireValues(mesh, stiffness.values);
    std::transform(factors.begin(), factors.end(), stiffness.values.begin(), factors.begin(),
      std::multiplies<>());
  }
  normalize(mesh, part, factors);
  return factors;
}
}
