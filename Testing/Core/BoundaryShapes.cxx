// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryShapes.h"

#include <cmath>

namespace shapes
{
Mesh cut(const Mesh& mesh, const std::function<bool(const Row&)>& keep)
{
  Mesh result;
  result.points = mesh.points;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const std::vector<Index> nodes(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
    if (keep(meshes::rows(mesh.points, nodes).colwise().mean()))
    {
      meshes::add(result, mesh.types[c], nodes);
    }
  }
  return result;
}

Mesh together(const Mesh& a, const Mesh& b)
{
  Mesh result = a;
  result.points.conservativeResize(a.numberOfNodes() + b.numberOfNodes(), 3);
  result.points.bottomRows(b.numberOfNodes()) = b.points;
  for (Index c = 0; c < b.numberOfCells(); ++c)
  {
    std::vector<Index> nodes(b.cell(c), b.cell(c) + b.cellSize(c));
    for (Index& node : nodes)
    {
      node += a.numberOfNodes();
    }
    meshes::add(result, b.types[c], nodes);
  }
  return result;
}

Mesh cylinder(int n, int layers, double height)
{
  Mesh mesh = meshes::hexes(n, n, layers);
  meshes::transform(mesh,
    [&](const Row& x)
    {
      const double u = 2 * x[0] / n - 1, v = 2 * x[1] / n - 1;
      const double r = std::max(std::abs(u), std::abs(v));
      if (r == 0)
      {
        return Row(0, 0, x[2] * height / layers);
      }
      // Equal steps along the square's side are equal angles.
      const double quarter = std::acos(-1.) / 4;
      const bool steep = std::abs(v) > std::abs(u);
      const double a = steep ? (v > 0 ? 2 : 6) * quarter - u / v * quarter
                             : (u > 0 ? 0 : 4) * quarter + v / u * quarter;
      return Row(r * std::cos(a), r * std::sin(a), x[2] * height / layers);
    });
  return mesh;
}

Mesh ball(int n)
{
  Mesh mesh = meshes::hexes(n, n, n);
  meshes::transform(mesh,
    [&](const Row& x)
    {
      const Row u = (2 * x / n).array() - 1;
      const double r = u.cwiseAbs().maxCoeff();
      // tan() spaces the nodes evenly.
      const Row direction = r > 0 ? Row((u / r * std::acos(-1.) / 4).array().tan()) : u;
      return r > 0 ? Row(direction.normalized() * r) : u;
    });
  return mesh;
}

Mesh hollowBall(int n)
{
  return cut(ball(n), [](const Row& center) { return center.norm() > 0.5; });
}

Mesh boxWithHole(int around, int through, int layers)
{
  Mesh mesh;
  mesh.points.resize(static_cast<Index>(around) * (through + 1) * (layers + 1), 3);
  const auto id = [&](int a, int r, int z)
  { return a % around + static_cast<Index>(around) * (r + static_cast<Index>(through + 1) * z); };
  for (int z = 0; z <= layers; ++z)
  {
    for (int r = 0; r <= through; ++r)
    {
      for (int a = 0; a < around; ++a)
      {
        const double angle = 2 * std::acos(-1.) * a / around, t = static_cast<double>(r) / through;
        const double c = std::cos(angle), s = std::sin(angle);
        const double square = 2 / std::max(std::abs(c), std::abs(s));
        const double radius = (1 - t) + t * square;
        mesh.points.row(id(a, r, z)) = Row(radius * c, radius * s, z);
        if (z < layers && r < through)
        {
          meshes::add(mesh, morph::Hexahedron,
            { id(a, r, z), id(a, r + 1, z), id(a + 1, r + 1, z), id(a + 1, r, z), id(a, r, z + 1),
              id(a, r + 1, z + 1), id(a + 1, r + 1, z + 1), id(a + 1, r, z + 1) });
        }
      }
    }
  }
  return mesh;
}

Mesh creasedPlate()
{
  Mesh mesh = meshes::hexes(6, 4, 1);
  meshes::transform(mesh,
    [](const Row& x)
    {
      const double lift = x[2] * std::max(0., 1 - x[0] / 4) * std::max(0., 1 - std::abs(x[1] - 2));
      return Row(x + Row(0, 0, lift));
    });
  return mesh;
}
}
