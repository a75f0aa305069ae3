// SPDX-License-Identifier: BSD-3-Clause
// FEMWARP's first step on polyhedra against the same on hexahedra of as many nodes, on one thread.
#include "PolyhedralMeshes.h"

#include "LinearMethods/FemWarp.h"
#include "Mesh/PolyhedronPieces.h"
#include "Mesh/Topology.h"
#include "Morpher/PolyhedralMorpher.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <memory>
#include <string>
#include <vector>

namespace
{
using morph::Index;

double processorSeconds()
{
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Of several runs the one that other work on the machine has slowed least.
double least(const std::vector<double>& values)
{
  return *std::min_element(values.begin(), values.end());
}

struct Case
{
  std::string name;
  morph::Mesh mesh;
  enum class Cells
  {
    Standard,
    Polyhedra,
    Cut ///< polyhedra, hexahedra among them cut as well
  } cells;
  std::vector<double> first, later; ///< seconds of prepare and evaluate, and of evaluate alone
};

/// The boundary turned about z by up to 45 degrees, growing with the height.
morph::Points twisted(const morph::Points& rest, const std::vector<Index>& nodes)
{
  const Eigen::RowVector3d low = rest.colwise().minCoeff(), high = rest.colwise().maxCoeff();
  morph::Points moved = rest(nodes, morph::allColumns);
  for (Index i = 0; i < moved.rows(); ++i)
  {
    const double angle = std::acos(-1.) / 4 * (moved(i, 2) - low[2]) / (high[2] - low[2]);
    const Eigen::RowVector2d x = (moved.row(i) - (low + high) / 2).head<2>();
    moved.row(i).head<2>() += Eigen::RowVector2d(std::cos(angle) * x[0] - std::sin(angle) * x[1],
                                std::sin(angle) * x[0] + std::cos(angle) * x[1]) -
                              x;
  }
  return moved;
}

void measure(Case& what)
{
  morph::Monitor monitor; // one thread
  const morph::NodePartition partition =
    morph::partitionNodes(what.mesh, morph::boundaryFaces(what.mesh, monitor).nodes);
  const morph::Points target = twisted(what.mesh.points, partition.prescribed);
  morph::Points moved;
  const double start = processorSeconds();
  std::unique_ptr<morph::Morpher> method = std::make_unique<morph::FemWarp>();
  if (what.cells != Case::Cells::Standard)
  {
    method = morph::morpherForPolyhedra(std::move(method), what.cells == Case::Cells::Cut);
  }
  method->prepare(what.mesh, partition, monitor);
  const double prepared = processorSeconds();
  method->evaluate(target, moved, monitor);
  what.first.push_back(processorSeconds() - start);
  what.later.push_back(processorSeconds() - prepared);
}
}

int main(int argc, char** argv)
{
  try
  {
    const int cells = argc > 1 ? std::atoi(argv[1]) : 40;
    const int rounds = argc > 2 ? std::atoi(argv[2]) : 5;
    if (argc > 3 || cells < 2 || rounds < 1)
    {
      std::fprintf(stderr, "Usage: benchmark-polyhedra [CELLS [ROUNDS]]\nCELLS: hexahedra along "
                           "an edge of the brick, 40. ROUNDS: of which the fastest counts, 5.\n");
      return 2;
    }
    const morph::Mesh brick = meshes::hexes(cells, cells, cells);
    // A layer of n x n prisms has about 2 n^2 + 4 n nodes.
    int n = 1;
    while (2. * n * (n + 2) * (n + 1) < static_cast<double>(brick.numberOfNodes()))
    {
      ++n;
    }
    std::vector<Case> cases = { { "hexahedra", brick, Case::Cells::Standard, {}, {} },
      { "the same as polyhedra", meshes::asPolyhedra(brick), Case::Cells::Polyhedra, {}, {} },
      { "the same, cut", meshes::asPolyhedra(brick), Case::Cells::Cut, {}, {} },
      { "hexagonal prisms", meshes::honeycomb(n), Case::Cells::Polyhedra, {}, {} } };
    for (int round = 0; round < rounds; ++round)
    {
      for (Case& what : cases) // by turns: the machine may change its speed
      {
        measure(what);
      }
    }
    std::printf("FEMWARP on one thread, processor seconds, the least of %d\n", rounds);
    std::printf("%-24s%10s%10s%14s%10s%14s\n", "", "nodes", "first", "per node: x", "later", "x");
    const auto nodes = [](const Case& what)
    { return static_cast<double>(what.mesh.numberOfNodes()); };
    const Case& base = cases.front();
    for (const Case& what : cases)
    {
      const auto ratio = [&](const std::vector<double>& of, const std::vector<double>& to)
      { return least(of) / nodes(what) / (least(to) / nodes(base)); };
      std::printf("%-24s%10.0f%10.3f%14.2f%10.3f%14.2f\n", what.name.c_str(), nodes(what),
        least(what.first), ratio(what.first, base.first), least(what.later),
        ratio(what.later, base.later));
    }
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
