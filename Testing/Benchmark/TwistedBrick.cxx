// SPDX-License-Identifier: BSD-3-Clause
#include "TwistedBrick.h"

#include "Mesh/CellShape.h"

#include <array>
#include <cmath>
#include <random>

namespace benchmark
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr double Twist = Pi / 2;
constexpr double Stretch = 1.5;

morph::Mesh brick(const std::array<int, 3>& cells)
{
  const morph::Index nodesX = cells[0] + 1;
  const morph::Index nodesXY = nodesX * (cells[1] + 1);
  const morph::Index numberOfCells = morph::Index(cells[0]) * cells[1] * cells[2];
  morph::Mesh mesh;
  mesh.points.resize(nodesXY * (cells[2] + 1), 3);
  morph::Index node = 0;
  for (int k = 0; k <= cells[2]; ++k)
  {
    for (int j = 0; j <= cells[1]; ++j)
    {
      for (int i = 0; i <= cells[0]; ++i)
      {
        mesh.points.row(node++) << i, j, k;
      }
    }
  }
  mesh.types.assign(numberOfCells, morph::Hexahedron);
  mesh.offsets.reserve(numberOfCells + 1);
  mesh.connectivity.reserve(8 * numberOfCells);
  for (int k = 0; k < cells[2]; ++k)
  {
    for (int j = 0; j < cells[1]; ++j)
    {
      for (int i = 0; i < cells[0]; ++i)
      {
        const morph::Index low = i + nodesX * j + nodesXY * k;
        const morph::Index high = low + nodesXY;
        mesh.offsets.push_back(static_cast<morph::Index>(mesh.connectivity.size()));
        for (const morph::Index corner : { low, high })
        {
          mesh.connectivity.insert(
            mesh.connectivity.end(), { corner, corner + 1, corner + nodesX + 1, corner + nodesX });
        }
      }
    }
  }
  mesh.offsets.push_back(static_cast<morph::Index>(mesh.connectivity.size()));
  return mesh;
}

void jitterInterior(morph::Points& points, const std::array<int, 3>& cells, double jitter)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-jitter, jitter);
  for (morph::Index node = 0; node < points.rows(); ++node)
  {
    auto point = points.row(node);
    bool inside = true;
    for (int d = 0; d < 3; ++d)
    {
      inside = inside && point[d] > 0 && point[d] < cells[d];
    }
    for (int d = 0; d < 3 && inside; ++d)
    {
      point[d] += shift(random);
    }
  }
}
}

Problem twistedBrick(int nx, int ny, int nz, int axis, double jitter)
{
  const std::array<int, 3> cells = { nx, ny, nz };
  Problem problem;
  problem.name = std::to_string(nx) + " x " + std::to_string(ny) + " x " + std::to_string(nz);
  problem.mesh = brick(cells);
  if (jitter > 0)
  {
    problem.name += ", jittered";
    jitterInterior(problem.mesh.points, cells, jitter);
  }
  problem.size = std::sqrt(double(nx) * nx + double(ny) * ny + double(nz) * nz);

  const morph::Points& rest = problem.mesh.points;
  std::vector<morph::Index> boundary;
  for (morph::Index node = 0; node < rest.rows(); ++node)
  {
    bool outside = false;
    for (int d = 0; d < 3; ++d)
    {
      // Unit cells: coordinates are small integers, and exact.
      outside = outside || rest(node, d) == 0 || rest(node, d) == cells[d];
    }
    if (outside)
    {
      boundary.push_back(node);
    }
  }
  problem.partition = morph::partitionNodes(problem.mesh, std::move(boundary));

  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const double length = cells[axis];
  const double centerU = 0.5 * cells[u];
  const double centerV = 0.5 * cells[v];
  const std::vector<morph::Index>& prescribed = problem.partition.prescribed;
  problem.target.resize(static_cast<morph::Index>(prescribed.size()), 3);
  for (std::size_t i = 0; i < prescribed.size(); ++i)
  {
    const auto point = rest.row(prescribed[i]);
    const double angle = Twist * point[axis] / length;
    const double fromU = point[u] - centerU;
    const double fromV = point[v] - centerV;
    const auto row = static_cast<morph::Index>(i);
    problem.target(row, axis) = Stretch * point[axis];
    problem.target(row, u) = centerU + std::cos(angle) * fromU - std::sin(angle) * fromV;
    problem.target(row, v) = centerV + std::sin(angle) * fromU + std::cos(angle) * fromV;
  }
  return problem;
}
}
