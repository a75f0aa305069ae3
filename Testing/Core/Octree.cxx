// SPDX-License-Identifier: BSD-3-Clause
#include "Octree.h"

#include "PolyhedralMeshes.h"

#include <algorithm>
#include <random>
#include <utility>

namespace meshes
{
namespace
{
using Place = Octree::Place;

/// The nodes of a hexahedron in VTK's order, in halves of its edges.
constexpr Place NodePlaces[20] = { { 0, 0, 0 }, { 2, 0, 0 }, { 2, 2, 0 }, { 0, 2, 0 }, { 0, 0, 2 },
  { 2, 0, 2 }, { 2, 2, 2 }, { 0, 2, 2 }, { 1, 0, 0 }, { 2, 1, 0 }, { 1, 2, 0 }, { 0, 1, 0 },
  { 1, 0, 2 }, { 2, 1, 2 }, { 1, 2, 2 }, { 0, 1, 2 }, { 0, 0, 1 }, { 2, 0, 1 }, { 2, 2, 1 },
  { 0, 2, 1 } };

int nodesOf(int order)
{
  return order == 2 ? 20 : 8;
}

/// Of a box from `low` on, `step` in parts of its edges, of which there are `parts`.
Place at(const Place& low, const Place& step, int size, int parts)
{
  return { low[0] + size * step[0] / parts, low[1] + size * step[1] / parts,
    low[2] + size * step[2] / parts };
}

/// The shape function of a node, trilinear or of the serendipity family; x in [-1, 1]^3.
double shapeFunction(int order, const Place& node, const std::array<double, 3>& x)
{
  const bool isCorner = node[0] != 1 && node[1] != 1 && node[2] != 1;
  double product = 1, sum = -2;
  for (int j = 0; j < 3; ++j)
  {
    const double along = x[j] * (node[j] - 1);
    product *= node[j] == 1 ? 1 - x[j] * x[j] : (1 + along) / 2;
    sum += along;
  }
  return order == 2 && isCorner ? product * sum : product;
}
}

Octree::Octree(unsigned seed, int order, const Place& cubes)
  : cubes_(cubes)
{
  std::mt19937 random(seed);
  this->mesh.points.resize(0, 3);
  std::vector<std::pair<Place, int>> boxes, open; // corners and sizes
  const auto [nx, ny, nz] = cubes;
  for (int c = 0; c < nx * ny * nz; ++c)
  {
    open.push_back({ { 8 * (c % nx), 8 * (c / nx % ny), 8 * (c / nx / ny) }, 8 });
  }
  for (std::size_t i = 0; i < open.size(); ++i)
  {
    const auto [low, size] = open[i];
    if (size == 2 || (i != 0 && (i == 1 || random() % 3 > 0))) // the second stays whole
    {
      boxes.emplace_back(low, size);
      continue;
    }
    for (int k = 0; k < 8; ++k)
    {
      open.emplace_back(at(low, { k % 2, k / 2 % 2, k / 4 }, size, 2), size / 2);
    }
  }
  for (const auto& [low, size] : boxes)
  {
    std::vector<Index> nodes;
    for (int k = 0; k < nodesOf(order); ++k)
    {
      nodes.push_back(this->node(at(low, NodePlaces[k], size, 2)));
    }
    add(this->mesh, order == 2 ? morph::QuadraticHexahedron : morph::Hexahedron, nodes);
  }
  for (const auto& [low, size] : boxes)
  {
    this->findHanging(low, size, order);
  }
  if (order == 0)
  {
    this->mesh = asPolyhedra(this->mesh, [](Index cell) { return cell % 3 == 0; });
  }
}

std::vector<Index> Octree::outer() const
{
  std::vector<Index> nodes;
  for (const auto& [place, node] : this->nodeAt)
  {
    bool isOuter = false;
    for (int j = 0; j < 3; ++j)
    {
      isOuter = isOuter || place[j] == 0 || place[j] == 8 * this->cubes_[j];
    }
    if (isOuter)
    {
      nodes.push_back(node);
    }
  }
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

Index Octree::node(const Place& place)
{
  const auto [found, isNew] = this->nodeAt.emplace(place, this->mesh.numberOfNodes());
  if (isNew)
  {
    this->mesh.points.conservativeResize(found->second + 1, 3);
    this->mesh.points.row(found->second) << place[0] / 8., place[1] / 8., place[2] / 8.;
  }
  return found->second;
}

void Octree::findHanging(const Place& low, int size, int order)
{
  for (int k = 0; k < (size + 1) * (size + 1) * (size + 1); ++k)
  {
    const Place step = { k % (size + 1), k / (size + 1) % (size + 1), k / (size + 1) / (size + 1) };
    const auto found = this->nodeAt.find(at(low, step, size, size));
    if (found == this->nodeAt.end())
    {
      continue;
    }
    std::array<double, 3> x;
    std::transform(
      step.begin(), step.end(), x.begin(), [&](int part) { return 2. * part / size - 1; });
    Hanging own = { found->second, {}, {} };
    for (int a = 0; a < nodesOf(order); ++a)
    {
      if (const double weight = shapeFunction(order, NodePlaces[a], x); weight != 0)
      {
        own.masters.push_back(this->nodeAt.at(at(low, NodePlaces[a], size, 2)));
        own.weights.push_back(weight);
      }
    }
    if (own.masters.size() > 1)
    {
      this->hanging.push_back(own);
    }
  }
}

double Octree::gap(const Points& points) const
{
  double most = 0;
  for (const Hanging& own : this->hanging)
  {
    Eigen::RowVector3d off = points.row(own.node);
    for (std::size_t k = 0; k < own.masters.size(); ++k)
    {
      off -= own.weights[k] * points.row(own.masters[k]);
    }
    most = std::max(most, off.norm());
  }
  return most;
}

Mesh dividedInThree()
{
  Mesh linear = hexes(3, 3, 1);
  linear.points.conservativeResize(36, 3);
  linear.points.bottomRows(4) << 0, 0, 4, 3, 0, 4, 3, 3, 4, 0, 3, 4;
  add(linear, morph::Hexahedron, { 16, 19, 31, 28, 32, 33, 34, 35 });
  return withNodesBetween(linear, { { morph::Hexahedron, { morph::QuadraticHexahedron, 20 } } });
}
}
