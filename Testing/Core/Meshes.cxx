// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"

#include "InThreads.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>

namespace meshes
{
using namespace morph;

namespace
{
Index lattice(int nx, int ny, int i, int j, int k)
{
  return i + (nx + 1) * (j + static_cast<Index>(ny + 1) * k);
}

/// The lattice points, and visit(box corners in VTK's hexahedron order, i, j, k) for each box.
template <typename Visit>
Mesh boxes(int nx, int ny, int nz, const Visit& visit)
{
  Mesh mesh;
  mesh.points.resize(static_cast<Index>(nx + 1) * (ny + 1) * (nz + 1), 3);
  for (int k = 0; k <= nz; ++k)
  {
    for (int j = 0; j <= ny; ++j)
    {
      for (int i = 0; i <= nx; ++i)
      {
        mesh.points.row(lattice(nx, ny, i, j, k)) = Eigen::RowVector3d(i, j, k);
      }
    }
  }
  for (int k = 0; k < nz; ++k)
  {
    for (int j = 0; j < ny; ++j)
    {
      for (int i = 0; i < nx; ++i)
      {
        const auto at = [&](int a, int b, int c) { return lattice(nx, ny, i + a, j + b, k + c); };
        visit(mesh,
          std::array<Index, 8>{ at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1),
            at(1, 0, 1), at(1, 1, 1), at(0, 1, 1) },
          i, j, k);
      }
    }
  }
  return mesh;
}

/// Adds nodes at the means of corner sets, one per set, shared between cells.
void addExtraNodes(Mesh& mesh, std::uint8_t type)
{
  const CellShape& shape = *cellShape(type);
  Mesh result;
  std::vector<Eigen::RowVector3d> extra;
  std::map<std::vector<Index>, Index> known;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    std::vector<Index> nodes(mesh.cell(c), mesh.cell(c) + shape.numberOfCorners);
    for (int k = shape.numberOfCorners; k < shape.numberOfNodes; ++k)
    {
      double N[8];
      shapeFunctions(shape.shape, shape.extraNodes[k - shape.numberOfCorners], N, nullptr);
      std::vector<Index> key;
      Eigen::RowVector3d place = Eigen::RowVector3d::Zero();
      for (int a = 0; a < shape.numberOfCorners; ++a)
      {
        if (N[a] > 0)
        {
          key.push_back(nodes[a]);
          place += N[a] * mesh.points.row(nodes[a]);
        }
      }
      std::sort(key.begin(), key.end());
      const auto found =
        known.emplace(key, mesh.numberOfNodes() + static_cast<Index>(extra.size()));
      if (found.second)
      {
        extra.push_back(place);
      }
      nodes.push_back(found.first->second);
    }
    add(result, type, nodes);
  }
  result.points.resize(mesh.numberOfNodes() + static_cast<Index>(extra.size()), 3);
  result.points.topRows(mesh.numberOfNodes()) = mesh.points;
  for (std::size_t i = 0; i < extra.size(); ++i)
  {
    result.points.row(mesh.numberOfNodes() + static_cast<Index>(i)) = extra[i];
  }
  mesh = std::move(result);
}
}

void add(Mesh& mesh, std::uint8_t type, const std::vector<Index>& nodes)
{
  mesh.add(type, nodes.begin(), nodes.end());
}

Mesh hexes(int nx, int ny, int nz)
{
  return boxes(nx, ny, nz,
    [](Mesh& mesh, const std::array<Index, 8>& b, int, int, int) {
      add(mesh, Hexahedron, { b.begin(), b.end() });
    });
}

Mesh tets(int nx, int ny, int nz)
{
  return boxes(nx, ny, nz,
    [](Mesh& mesh, const std::array<Index, 8>& b, int i, int j, int k)
    {
      static constexpr int Even[5][4] = { { 0, 1, 2, 5 }, { 0, 2, 3, 7 }, { 0, 5, 7, 4 },
        { 2, 7, 5, 6 }, { 0, 2, 7, 5 } };
      static constexpr int Odd[5][4] = { { 1, 2, 3, 6 }, { 0, 1, 3, 4 }, { 1, 6, 4, 5 },
        { 3, 4, 6, 7 }, { 1, 3, 4, 6 } };
      for (const auto& t : (i + j + k) % 2 ? Odd : Even)
      {
        add(mesh, Tetra, { b[t[0]], b[t[1]], b[t[2]], b[t[3]] });
      }
    });
}

Mesh wedges(int nx, int ny, int nz)
{
  return boxes(nx, ny, nz,
    [](Mesh& mesh, const std::array<Index, 8>& b, int, int, int)
    {
      add(mesh, Wedge, { b[0], b[1], b[2], b[4], b[5], b[6] });
      add(mesh, Wedge, { b[0], b[2], b[3], b[4], b[6], b[7] });
    });
}

Mesh hexesAndWedges(int nx, int ny, int nz)
{
  return boxes(nx, ny, nz,
    [nz](Mesh& mesh, const std::array<Index, 8>& b, int, int, int k)
    {
      if (2 * k < nz)
      {
        add(mesh, Hexahedron, { b.begin(), b.end() });
      }
      else
      {
        // Prisms along x: they meet the hexahedra below with quadrilaterals.
        add(mesh, Wedge, { b[0], b[3], b[4], b[1], b[2], b[5] });
        add(mesh, Wedge, { b[3], b[7], b[4], b[2], b[6], b[5] });
      }
    });
}

Mesh hexesAndPyramids(int nx, int ny, int nz)
{
  std::vector<Eigen::RowVector3d> centers;
  const Index latticeNodes = static_cast<Index>(nx + 1) * (ny + 1) * (nz + 1);
  Mesh mesh = boxes(nx, ny, nz,
    [&](Mesh& m, const std::array<Index, 8>& b, int i, int j, int k)
    {
      if ((i + j + k) % 2 == 0)
      {
        add(m, Hexahedron, { b.begin(), b.end() });
        return;
      }
      const Index center = latticeNodes + static_cast<Index>(centers.size());
      centers.push_back(Eigen::RowVector3d(i + .5, j + .5, k + .5));
      // Base seen from the center counter-clockwise. On the box's own surface the base is free to
      // be cut in two tets.
      static constexpr int Base[6][4] = { { 0, 3, 7, 4 }, { 1, 5, 6, 2 }, { 0, 4, 5, 1 },
        { 3, 2, 6, 7 }, { 0, 1, 2, 3 }, { 4, 7, 6, 5 } };
      const bool outer[6] = { i == 0, i == nx - 1, j == 0, j == ny - 1, k == 0, k == nz - 1 };
      for (int f = 0; f < 6; ++f)
      {
        const int* q = Base[f];
        if (outer[f])
        {
          add(m, Tetra, { b[q[0]], b[q[1]], b[q[2]], center });
          add(m, Tetra, { b[q[0]], b[q[2]], b[q[3]], center });
        }
        else
        {
          add(m, Pyramid, { b[q[0]], b[q[1]], b[q[2]], b[q[3]], center });
        }
      }
    });
  mesh.points.conservativeResize(latticeNodes + static_cast<Index>(centers.size()), 3);
  for (std::size_t i = 0; i < centers.size(); ++i)
  {
    mesh.points.row(latticeNodes + static_cast<Index>(i)) = centers[i];
  }
  return mesh;
}

Mesh quadraticHexes(int nx, int ny, int nz, bool triquadratic)
{
  Mesh mesh = hexes(nx, ny, nz);
  addExtraNodes(mesh, triquadratic ? TriquadraticHexahedron : QuadraticHexahedron);
  return mesh;
}

Mesh quadraticTets(int nx, int ny, int nz)
{
  Mesh mesh = tets(nx, ny, nz);
  addExtraNodes(mesh, QuadraticTetra);
  return mesh;
}

Mesh withNodesBetween(const Mesh& linear, const std::map<std::uint8_t, CellKind>& kinds)
{
  Mesh mesh;
  mesh.points = linear.points;
  std::map<std::map<Index, long>, Index> known; // by shares of corners
  for (Index c = 0; c < linear.numberOfCells(); ++c)
  {
    std::vector<Index> nodes(linear.cell(c), linear.cell(c) + linear.cellSize(c));
    const auto kind = kinds.find(linear.types[c]);
    if (kind == kinds.end())
    {
      add(mesh, linear.types[c], nodes);
      continue;
    }
    const auto [type, count] = kind->second;
    const morph::CellShape& shape =
      type < morph::LagrangeCurve ? *morph::cellShape(type) : *morph::shapeOfAnyOrder(type, count);
    for (Index k = shape.numberOfCorners; k < count; ++k)
    {
      double N[8];
      morph::shapeFunctions(shape.shape, shape.extraNodes[k - shape.numberOfCorners], N, nullptr);
      std::map<Index, long> between;
      Eigen::RowVector3d place = Eigen::RowVector3d::Zero();
      for (int a = 0; a < shape.numberOfCorners; ++a)
      {
        if (N[a] != 0)
        {
          between[nodes[a]] += std::lround(1e6 * N[a]);
          place += N[a] * linear.points.row(nodes[a]);
        }
      }
      if (between.size() == 1) // an edge without length
      {
        nodes.push_back(between.begin()->first);
        continue;
      }
      const auto [found, isNew] = known.emplace(between, mesh.numberOfNodes());
      if (isNew)
      {
        mesh.points.conservativeResize(found->second + 1, 3);
        mesh.points.row(found->second) = place;
      }
      nodes.push_back(found->second);
    }
    add(mesh, type, nodes);
  }
  return mesh;
}

std::vector<std::pair<std::string, Mesh>> all(int nx, int ny, int nz)
{
  return { { "hexes", hexes(nx, ny, nz) }, { "tets", tets(nx, ny, nz) },
    { "wedges", wedges(nx, ny, nz) }, { "hexes and wedges", hexesAndWedges(nx, ny, nz) },
    { "hexes, pyramids and tets", hexesAndPyramids(nx, ny, nz) },
    { "hex20", quadraticHexes(nx, ny, nz, false) }, { "hex27", quadraticHexes(nx, ny, nz, true) },
    { "tet10", quadraticTets(nx, ny, nz) } };
}

namespace
{
/// 0, first, first (1 + growth), ... 1.
std::vector<double> gradedLine(double first, double growth)
{
  std::vector<double> places = { 0 };
  for (double step = first; places.back() + step < 0.999; step *= growth)
  {
    places.push_back(places.back() + step);
  }
  places.back() = 1;
  return places;
}
}

Mesh layered(Mesh (*box)(int, int, int), int n, double first, double growth)
{
  const std::vector<double> heights = gradedLine(first, growth);
  Mesh mesh = box(n, n, static_cast<int>(heights.size()) - 1);
  transform(mesh, [&](const Eigen::RowVector3d& x)
    { return Eigen::RowVector3d(x[0] / n, x[1] / n, heights[std::lround(x[2])]); });
  return mesh;
}

Mesh closedAlongY(const Mesh& open, int around,
  const std::function<Eigen::RowVector3d(const Eigen::RowVector3d&)>& place)
{
  Mesh mesh;
  std::map<std::array<Index, 3>, Index> known;
  std::vector<Index> nodeOf(open.points.rows());
  std::vector<Eigen::RowVector3d> points;
  for (Index i = 0; i < open.points.rows(); ++i)
  {
    const Eigen::RowVector3d x = open.points.row(i);
    const auto [at, isNew] = known.emplace(
      std::array<Index, 3>{ std::lround(x[0]), std::lround(x[1]) % around, std::lround(x[2]) },
      static_cast<Index>(points.size()));
    nodeOf[i] = at->second;
    if (isNew)
    {
      points.push_back(place(x));
    }
  }
  mesh.points.resize(static_cast<Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    mesh.points.row(static_cast<Index>(i)) = points[i];
  }
  for (Index c = 0; c < open.numberOfCells(); ++c)
  {
    std::vector<Index> nodes(open.cell(c), open.cell(c) + 8);
    for (Index& node : nodes)
    {
      node = nodeOf[node];
    }
    add(mesh, open.types[c], nodes);
  }
  return mesh;
}

Mesh ring(int around, int height, double first)
{
  const std::vector<double> radii = gradedLine(first, 1.2);
  const Mesh open = hexes(static_cast<int>(radii.size()) - 1, around, height);
  return closedAlongY(open, around,
    [&](const Eigen::RowVector3d& x) -> Eigen::RowVector3d
    {
      const double angle = 2 * M_PI * x[1] / around, radius = 1 + radii[std::lround(x[0])];
      return { radius * std::cos(angle), radius * std::sin(angle), 0.8 * x[2] / height };
    });
}

void jitterInterior(Mesh& mesh, double amount, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-amount, amount);
  const Eigen::RowVector3d low = mesh.points.colwise().minCoeff();
  const Eigen::RowVector3d high = mesh.points.colwise().maxCoeff();
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    auto p = mesh.points.row(n);
    if ((p.array() > low.array()).all() && (p.array() < high.array()).all())
    {
      p += Eigen::RowVector3d(shift(random), shift(random), shift(random));
    }
  }
}

void transform(Mesh& mesh, const std::function<Eigen::RowVector3d(const Eigen::RowVector3d&)>& map)
{
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    mesh.points.row(n) = map(mesh.points.row(n));
  }
}

Mesh shifted(Mesh mesh, const Eigen::RowVector3d& by)
{
  mesh.points.rowwise() += by;
  return mesh;
}

Mesh renumbered(const Mesh& mesh, const std::vector<Index>& order)
{
  Mesh result = mesh;
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    result.points.row(order[n]) = mesh.points.row(n);
  }
  for (Index& node : result.connectivity)
  {
    node = order[node];
  }
  for (Index at = 0; at < static_cast<Index>(mesh.faces.size()); at += mesh.faces[at] + 1)
  {
    for (Index k = 1; k <= mesh.faces[at]; ++k)
    {
      result.faces[at + k] = order[mesh.faces[at + k]];
    }
  }
  return result;
}

Points rows(const Points& all, const std::vector<Index>& ids)
{
  Points some(static_cast<Index>(ids.size()), 3);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    some.row(static_cast<Index>(i)) = all.row(ids[i]);
  }
  return some;
}

double size(const Points& points)
{
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
}

unsigned seed()
{
  static const unsigned value = []
  {
    const char* text = std::getenv("MORPH_TEST_SEED");
    const unsigned s = text ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : 20111;
    std::cout << "random seed " << s << " (MORPH_TEST_SEED sets another)" << std::endl;
    return s;
  }();
  return value;
}

Points randomPoints(Index n, std::mt19937& random)
{
  std::uniform_real_distribution<double> value(-1, 1);
  return Points(n, 3).unaryExpr([&](double) { return value(random); });
}

ThreadedMonitor::ThreadedMonitor(int count)
  : count(count)
{
}

void ThreadedMonitor::progress(double fraction)
{
  this->lastProgress = fraction;
}

bool ThreadedMonitor::cancelled()
{
  return this->lastProgress >= this->cancelAt;
}

void ThreadedMonitor::warn(const std::string& message)
{
  this->warnings.push_back(message);
}

void ThreadedMonitor::share(Index n, Index grain, const std::function<void(Index, Index)>& body)
{
  // Ranges of one grain, dealt out in turn: an unusual cut shows what depends on the ranges.
  const Index ranges = (n + grain - 1) / grain;
  const auto work = [&](int t)
  {
    for (Index r = t; r < ranges; r += this->count)
    {
      body(r * grain, std::min(n, (r + 1) * grain));
    }
  };
  inThreads(static_cast<int>(std::min<Index>(this->count, ranges)), work);
}
}
