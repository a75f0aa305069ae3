// SPDX-License-Identifier: BSD-3-Clause
// A later step on random boxes of stretched, layered and shuffled cells against that on the cube of
// hexahedra, per node, on one thread. The answer's residual is the filters' default.
#include "Motions.h"
#include "PolyhedralMeshes.h"

#include "LinearMethods/FemWarp.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "Morpher/PolyhedralMorpher.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace
{
using morph::Index;
using Row = Eigen::RowVector3d;

constexpr double LargestAspect = 100;
constexpr double LargestGrowth = 1.3;
constexpr int Steps = 3; // of which the fastest counts

using Make = morph::Mesh (*)(int, int, int);
struct Kind
{
  const char* name;
  Make make;
  double nodesPerBox;
};
const std::array<Kind, 5> Kinds = { Kind{ "hexahedra", meshes::hexes, 1 },
  Kind{ "tetrahedra", meshes::tets, 1 }, Kind{ "wedges", meshes::wedges, 1 },
  Kind{ "pyramids", meshes::hexesAndPyramids, 1.5 },
  Kind{ "polyhedra",
    [](int x, int y, int z) { return meshes::asPolyhedra(meshes::hexes(x, y, z)); }, 1 } };

struct Box
{
  const Kind* kind = &Kinds[0];
  std::array<int, 3> cells;
  double aspect = 1, across = 1; ///< of the width along x by those along z and y
  double growth = 1;             ///< of the layers along z
  unsigned shuffle = 0;          ///< seed of the numbering; 0: as made
};

/// Layers start 1 / aspect high. They grow until they are as slender the other way as is allowed.
std::vector<double> heights(const Box& box)
{
  std::vector<double> places = { 0 };
  double height = 1 / box.aspect;
  for (int k = 0; k < box.cells[2]; ++k)
  {
    places.push_back(places.back() + height);
    height = std::min(height * box.growth, LargestAspect / box.across);
  }
  return places;
}

morph::Mesh meshOf(const Box& box)
{
  morph::Mesh mesh = box.kind->make(box.cells[0], box.cells[1], box.cells[2]);
  const std::vector<double> places = heights(box);
  meshes::transform(mesh,
    [&](const Row& x)
    {
      const auto below = static_cast<std::size_t>(x[2]); // pyramids meet between two layers
      const double part = x[2] - static_cast<double>(below);
      const double above = part > 0 ? places[below + 1] : places[below];
      return Row(x[0], x[1] / box.across, (1 - part) * places[below] + part * above);
    });
  if (box.shuffle == 0)
  {
    return mesh;
  }
  std::vector<Index> order(mesh.numberOfNodes());
  std::iota(order.begin(), order.end(), Index(0));
  std::shuffle(order.begin(), order.end(), std::mt19937(box.shuffle));
  return meshes::renumbered(mesh, order);
}

/// Its steps, with the boundary waving by a twentieth of the box.
class Problem
{
public:
  Problem(const Box& box, std::unique_ptr<morph::Morpher> method)
    : method_(std::move(method))
  {
    const morph::Mesh mesh = meshOf(box);
    const morph::NodePartition partition = motions::outerPartition(mesh);
    const Row low = mesh.points.colwise().minCoeff();
    const Row size = mesh.points.colwise().maxCoeff() - low;
    this->target_ = motions::targets(mesh, partition,
      [&](const Row& x)
      {
        const Row u = (x - low).cwiseQuotient(size);
        const Row wave(std::sin(3 * u[1]) * std::cos(2 * u[2]), std::sin(4 * u[0] + u[2]),
          std::sin(3 * u[0]) * std::sin(3 * u[1]));
        return Row(x + 0.05 * size.cwiseProduct(wave));
      });
    if (morph::needsPieces(mesh, {}))
    {
      this->method_ = morph::morpherForPolyhedra(std::move(this->method_));
    }
    this->nodes = static_cast<double>(mesh.numberOfNodes());
    const std::clock_t start = std::clock();
    this->method_->prepare(mesh, partition, this->monitor_);
    this->prepareSeconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    this->step();
  }

  /// Returns its processor seconds a node.
  double step()
  {
    const std::clock_t start = std::clock();
    this->iterations =
      this->method_->evaluate(this->target_, this->moved_, this->monitor_).iterations;
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / this->nodes;
  }

  double nodes = 0, prepareSeconds = 0;
  int iterations = 0;

private:
  std::unique_ptr<morph::Morpher> method_;
  morph::Monitor monitor_;
  morph::Points target_, moved_;
};

std::unique_ptr<morph::Morpher> makeMethod(bool isLbWarp)
{
  if (isLbWarp)
  {
    return std::make_unique<morph::LogBarrierWarp>();
  }
  return std::make_unique<morph::FemWarp>();
}

Box randomBox(int number, double nodes, std::mt19937& random)
{
  std::uniform_real_distribution<double> share(0, 1);
  Box box;
  box.kind = &Kinds[number % Kinds.size()];
  const double side = std::cbrt(nodes / box.kind->nodesPerBox);
  const double wide = std::exp2(share(random) - 0.5), deep = std::exp2(share(random) - 0.5);
  box.cells = { static_cast<int>(std::lround(side * wide)),
    static_cast<int>(std::lround(side * deep)), static_cast<int>(std::lround(side / wide / deep)) };
  box.aspect = std::pow(LargestAspect, share(random));
  box.across = std::pow(box.aspect, share(random));
  box.growth = 1 + (LargestGrowth - 1) * share(random);
  box.shuffle = 1 + static_cast<unsigned>(number);
  return box;
}

/// What boxes took beside the cube: ratios of seconds a node, and iterations.
struct Taken
{
  std::vector<double> ratios, iterations;

  void print(const char* cells) const
  {
    const auto median = [](std::vector<double> values)
    {
      std::sort(values.begin(), values.end());
      return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
    };
    const auto most = [](const std::vector<double>& values)
    { return *std::max_element(values.begin(), values.end()); };
    std::printf("%s,%zu,%.2f,%.2f,%.1f,%.0f\n", cells, this->ratios.size(), median(this->ratios),
      most(this->ratios), median(this->iterations), most(this->iterations));
  }
};

void compare(bool isLbWarp, int boxes, double nodes, unsigned seed)
{
  std::mt19937 random(seed);
  const int side = static_cast<int>(std::lround(std::cbrt(nodes))) - 1;
  Box cubic;
  cubic.cells = { side, side, side };
  Problem cube(cubic, makeMethod(isLbWarp));
  std::printf("%s, seed %u; the cube of hexahedra: %.0f nodes, %d iterations, %.3f us a node\n",
    isLbWarp ? "LBWARP" : "FEMWARP", seed, cube.nodes, cube.iterations, 1e6 * cube.step());
  std::printf("%-12s%8s%8s%8s%8s%12s%10s%10s%8s\n", "cells", "nodes", "aspect", "across", "growth",
    "iterations", "prepare/s", "us/node", "ratio");
  std::array<Taken, Kinds.size()> byKind;
  Taken all;
  for (int number = 0; number < boxes; ++number)
  {
    const Box box = randomBox(number, nodes, random);
    Problem problem(box, makeMethod(isLbWarp));
    double own = HUGE_VAL, cubes = HUGE_VAL;
    for (int k = 0; k < Steps; ++k) // by turns: the machine may change its speed
    {
      own = std::min(own, problem.step());
      cubes = std::min(cubes, cube.step());
    }
    for (Taken* taken : { &byKind[number % Kinds.size()], &all })
    {
      taken->ratios.push_back(own / cubes);
      taken->iterations.push_back(problem.iterations);
    }
    std::printf("%-12s%8.0f%8.1f%8.1f%8.2f%12d%10.3f%10.3f%8.2f\n", box.kind->name, problem.nodes,
      box.aspect, box.across, box.growth, problem.iterations, problem.prepareSeconds, 1e6 * own,
      own / cubes);
    std::fflush(stdout);
  }
  std::printf("cells,boxes,median_ratio,worst_ratio,median_iterations,most_iterations\n");
  for (std::size_t k = 0; k < Kinds.size() && static_cast<int>(k) < boxes; ++k)
  {
    byKind[k].print(Kinds[k].name);
  }
  all.print("all");
}
}

int main(int argc, char** argv)
{
  try
  {
    const std::string method = argc > 1 ? argv[1] : "FEMWARP";
    const int boxes = argc > 2 ? std::atoi(argv[2]) : 100;
    const double nodes = argc > 3 ? std::atof(argv[3]) : 1e5;
    const auto seed = argc > 4 ? std::strtoul(argv[4], nullptr, 10) : 1;
    if (argc > 5 || (method != "FEMWARP" && method != "LBWARP") || boxes < 1 || !(nodes >= 64))
    {
      std::fprintf(stderr, "Usage: benchmark-boxes [FEMWARP|LBWARP [BOXES [NODES [SEED]]]]\n"
                           "BOXES: 100. NODES: of each, about 100000, at least 64. SEED: 1.\n");
      return 2;
    }
    compare(method == "LBWARP", boxes, nodes, static_cast<unsigned>(seed));
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
