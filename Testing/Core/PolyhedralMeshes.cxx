// SPDX-License-Identifier: BSD-3-Clause
#include "PolyhedralMeshes.h"

#include "Mesh/CellShape.h"
#include "Mesh/Topology.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>

namespace meshes
{
using namespace morph;

namespace
{
/// Moves the nodes that no outer face has.
void jitterAllInside(Mesh& mesh, double amount)
{
  Monitor monitor;
  const std::vector<Index> outer = boundaryFaces(mesh, monitor).nodes;
  std::mt19937 random(seed());
  std::uniform_real_distribution<double> shift(-amount, amount);
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    const Eigen::RowVector3d by(shift(random), shift(random), shift(random));
    if (!std::binary_search(outer.begin(), outer.end(), n))
    {
      mesh.points.row(n) += by;
    }
  }
}

/// Numbers places, equal to 1e-6, in the order in which they are asked for.
class Nodes
{
public:
  Index at(double x, double y, double z)
  {
    const auto round = [](double v) { return std::lround(v * 1e6); };
    const auto [found, isNew] =
      this->numbers_.try_emplace({ round(x), round(y), round(z) }, this->points_.size());
    if (isNew)
    {
      this->points_.emplace_back(x, y, z);
    }
    return static_cast<Index>(found->second);
  }
  Points points() const
  {
    Points result(static_cast<Index>(this->points_.size()), 3);
    for (Index i = 0; i < result.rows(); ++i)
    {
      result.row(i) = this->points_[i];
    }
    return result;
  }

private:
  std::map<std::array<long, 3>, std::size_t> numbers_;
  std::vector<Eigen::RowVector3d> points_;
};
}

void addPolyhedron(Mesh& mesh, const std::vector<std::vector<Index>>& faces)
{
  std::set<Index> nodes;
  mesh.faceOffsets.resize(mesh.types.size() + 1, static_cast<Index>(mesh.faces.size()));
  for (const std::vector<Index>& face : faces)
  {
    nodes.insert(face.begin(), face.end());
    mesh.faces.push_back(static_cast<Index>(face.size()));
    mesh.faces.insert(mesh.faces.end(), face.begin(), face.end());
  }
  add(mesh, Polyhedron, { nodes.begin(), nodes.end() });
  mesh.faceOffsets.push_back(static_cast<Index>(mesh.faces.size()));
}

Mesh asPolyhedra(const Mesh& mesh, const std::function<bool(Index cell)>& isChosen)
{
  Mesh result;
  result.points = mesh.points;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (isChosen && !isChosen(c))
    {
      add(result, mesh.types[c], { mesh.cell(c), mesh.cell(c) + mesh.cellSize(c) });
      continue;
    }
    const CellShape& shape = *cellShape(mesh.types[c]);
    std::vector<std::vector<Index>> faces;
    for (int f = 0; f < shape.numberOfFaces; ++f)
    {
      faces.emplace_back();
      for (int k = 0; k < shape.faces[f].size; ++k)
      {
        faces.back().push_back(mesh.cell(c)[shape.cornerNode[shape.faces[f].corner[k]]]);
      }
    }
    addPolyhedron(result, faces);
  }
  result.faceOffsets.resize(result.types.size() + 1, static_cast<Index>(result.faces.size()));
  return result;
}

Mesh honeycomb(int n)
{
  const double height = std::sqrt(3.);
  Mesh mesh;
  Nodes nodes;
  for (int k = 0; k < n; ++k)
  {
    for (int j = 0; j < n; ++j)
    {
      for (int i = 0; i < n; ++i)
      {
        const double x = 1.5 * i, y = height * (j + 0.5 * (i % 2));
        std::vector<Index> low, high;
        for (int corner = 0; corner < 6; ++corner)
        {
          const double angle = std::acos(-1.) / 3 * corner;
          low.push_back(nodes.at(x + std::cos(angle), y + std::sin(angle), k));
          high.push_back(nodes.at(x + std::cos(angle), y + std::sin(angle), k + 1));
        }
        std::vector<std::vector<Index>> faces = { { low.rbegin(), low.rend() }, high };
        for (int corner = 0; corner < 6; ++corner)
        {
          const int next = (corner + 1) % 6;
          faces.push_back({ low[corner], low[next], high[next], high[corner] });
        }
        addPolyhedron(mesh, faces);
      }
    }
  }
  mesh.points = nodes.points();
  return mesh;
}

Mesh refinedLayer(int n)
{
  Mesh mesh;
  Nodes nodes;
  const auto at = [&](int x, int y, int z) { return nodes.at(x, y, z); };
  for (int j = 0; j < 2 * n; j += 2)
  {
    for (int i = 0; i < 2 * n; i += 2)
    {
      const auto top = [&](int x, int y) { return at(i + x, j + y, 2); };
      const auto low = [&](int x, int y) { return at(i + x, j + y, 0); };
      std::vector<std::vector<Index>> faces = { { low(0, 0), low(0, 2), low(2, 2), low(2, 0) },
        { low(0, 0), low(2, 0), top(2, 0), top(1, 0), top(0, 0) },
        { low(2, 0), low(2, 2), top(2, 2), top(2, 1), top(2, 0) },
        { low(2, 2), low(0, 2), top(0, 2), top(1, 2), top(2, 2) },
        { low(0, 2), low(0, 0), top(0, 0), top(0, 1), top(0, 2) } };
      for (int y = 0; y < 2; ++y)
      {
        for (int x = 0; x < 2; ++x)
        {
          faces.push_back({ top(x, y), top(x + 1, y), top(x + 1, y + 1), top(x, y + 1) });
        }
      }
      addPolyhedron(mesh, faces);
    }
  }
  for (int k = 2; k < 4; ++k)
  {
    for (int j = 0; j < 2 * n; ++j)
    {
      for (int i = 0; i < 2 * n; ++i)
      {
        add(mesh, Hexahedron,
          { at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k), at(i, j, k + 1),
            at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1) });
      }
    }
  }
  mesh.points = nodes.points();
  mesh.faceOffsets.resize(mesh.types.size() + 1, static_cast<Index>(mesh.faces.size()));
  return mesh;
}

Mesh voronoi(int n)
{
  using Vector = Eigen::Vector3d;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Vector> sites;
  for (int i = 0; i < n * n * n; ++i)
  {
    const Vector shift = Vector::NullaryExpr([&] { return uniform(random); });
    sites.push_back(Vector(i % n, i / n % n, i / (n * n)) + shift);
  }
  Mesh mesh;
  Nodes points;
  const Mesh box = hexes(1, 1, 1);
  const CellShape& cube = *cellShape(Hexahedron);
  for (const Vector& site : sites)
  {
    std::vector<std::vector<Vector>> faces;
    for (int f = 0; f < cube.numberOfFaces; ++f)
    {
      faces.emplace_back();
      for (const int corner : cube.faces[f].corner)
      {
        faces.back().push_back(n * box.points.row(box.cell(0)[corner]).transpose());
      }
    }
    for (const Vector& other : sites)
    {
      if (&other == &site || (other - site).norm() > 4)
      {
        continue;
      }
      const Vector normal = (other - site).normalized();
      const auto beyond = [&](const Vector& x) { return normal.dot(x - (site + other) / 2); };
      std::vector<std::vector<Vector>> kept;
      std::vector<Vector> cut; // the corners of the new face
      for (const std::vector<Vector>& face : faces)
      {
        std::vector<Vector> part;
        for (std::size_t k = 0; k < face.size(); ++k)
        {
          const Vector &a = face[k], &b = face[(k + 1) % face.size()];
          const double da = beyond(a), db = beyond(b);
          if (da <= 0)
          {
            part.push_back(a);
          }
          if ((da <= 0) != (db <= 0))
          {
            cut.push_back(a + da / (da - db) * (b - a));
            part.push_back(cut.back());
          }
        }
        if (part.size() > 2)
        {
          kept.push_back(part);
        }
      }
      if (cut.size() > 2)
      {
        const Vector center =
          std::accumulate(cut.begin(), cut.end(), Vector(0, 0, 0)) / double(cut.size());
        const Vector u = cut[0] - center, v = normal.cross(u);
        const auto angle = [&](const Vector& x)
        { return std::atan2(v.dot(x - center), u.dot(x - center)); };
        std::sort(cut.begin(), cut.end(),
          [&](const Vector& a, const Vector& b) { return angle(a) < angle(b); });
        kept.push_back(cut);
      }
      faces = kept;
    }
    std::vector<std::vector<Index>> ids;
    for (const std::vector<Vector>& face : faces)
    {
      std::vector<Index> nodes;
      for (const Vector& x : face)
      {
        const Index node = points.at(x[0], x[1], x[2]); // each edge was cut twice
        if (std::find(nodes.begin(), nodes.end(), node) == nodes.end())
        {
          nodes.push_back(node);
        }
      }
      if (nodes.size() > 2)
      {
        ids.push_back(nodes);
      }
    }
    addPolyhedron(mesh, ids);
  }
  mesh.points = points.points();
  return mesh;
}

Mesh collapsed(const CellKind& kind)
{
  Mesh linear = hexes(4, 4, 4);
  const Index from = 31, into = 32, last = 124; // at (1, 1, 1), (2, 1, 1) and the end
  linear.points(into, 0) = 1.5;
  std::replace(linear.connectivity.begin(), linear.connectivity.end(), from, into);
  std::replace(linear.connectivity.begin(), linear.connectivity.end(), last, from);
  linear.points.row(from) = linear.points.row(last);
  linear.points.conservativeResize(last, 3);
  return withNodesBetween(linear, { { Hexahedron, kind } });
}

std::vector<std::pair<std::string, Mesh>> polyhedral()
{
  const auto isEven = [](Index cell) { return cell % 2 == 0; };
  std::vector<std::pair<std::string, Mesh>> result = { { "hexes as polyhedra",
                                                         asPolyhedra(hexes(4, 4, 4)) },
    { "every other hex", asPolyhedra(hexes(4, 4, 4), isEven) },
    { "mixed", asPolyhedra(hexesAndPyramids(4, 4, 4), isEven) }, { "honeycomb", honeycomb(4) },
    { "refined layer", refinedLayer(2) } };
  for (auto& [name, mesh] : result)
  {
    jitterAllInside(mesh, 0.08);
  }
  return result;
}
}
