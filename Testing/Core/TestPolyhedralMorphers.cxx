// SPDX-License-Identifier: BSD-3-Clause
// Every method on meshes with polyhedra.
#include "LinearMethods.h"
#include "LinearMethods/FemWarp.h"
#include "Mesh/Topology.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Motions.h"
#include "PolyhedralMeshes.h"
#include "Quality/ScaledJacobian.h"
#include "Untangling/InversionFree.h"
#include "Untangling/Smoothing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

using namespace meshes;
using namespace morph;
using motions::affine;
using motions::difference;
using motions::outerPartition;
using motions::targets;

namespace
{
using Make = std::function<std::unique_ptr<Morpher>()>;

Points morphed(const Make& make, const Mesh& mesh, const NodePartition& partition,
  const Points& target, int threads = 1, bool cutsAll = false)
{
  ThreadedMonitor monitor(threads);
  auto method = make();
  if (!mesh.faceOffsets.empty())
  {
    method = morpherForPolyhedra(std::move(method), cutsAll);
  }
  return motions::morphed(*method, mesh, partition, target, monitor);
}

/// The linear methods, and those that are not, under options that keep affine motions exact.
std::vector<std::pair<std::string, Make>> allMethods()
{
  std::vector<std::pair<std::string, Make>> result;
  for (const LinearMethod& method : linearMethods())
  {
    result.emplace_back(
      method.name, [&method]() -> std::unique_ptr<Morpher> { return method.make(); });
  }
  result.emplace_back("InversionFree",
    []() -> std::unique_ptr<Morpher>
    {
      auto method = std::make_unique<InversionFree>();
      method->setSteps(InversionFree::NoSteps);
      method->setTolerance(1e-13);
      return method;
    });
  result.emplace_back("Smoothing",
    []() -> std::unique_ptr<Morpher>
    {
      auto method = std::make_unique<Smoothing>();
      SmoothingOptions options;
      options.target = SmoothingTarget::Initial;
      method->setOptions(options);
      return method;
    });
  return result;
}
}

TEST(PolyhedralMorphers, AffineMotionsAreExactAndTheIdentityIsTheIdentity)
{
  for (const auto& [name, mesh] : polyhedral())
  {
    const NodePartition partition = outerPartition(mesh);
    ASSERT_FALSE(partition.free.empty()) << name;
    for (const auto& [method, make] : allMethods())
    {
      const Points moved = morphed(make, mesh, partition, targets(mesh, partition, affine));
      EXPECT_LT(difference(moved, motions::mapped(mesh.points, affine)), 1e-10 * size(mesh.points))
        << method << " on " << name;
      const Points still = morphed(
        make, mesh, partition, targets(mesh, partition, [](const motions::Row& x) { return x; }));
      EXPECT_TRUE(motions::identical(still, mesh.points)) << method << " on " << name;
    }
  }
}

TEST(PolyhedralMorphers, ResultsDoNotDependOnThreadsOrNumbers)
{
  const auto twist = [](const motions::Row& x) { return motions::twist(x, 4, 4, 0.8); };
  for (const auto& [name, mesh] : polyhedral())
  {
    const NodePartition partition = outerPartition(mesh);
    const Points target = targets(mesh, partition, twist);
    const std::vector<Index> order = motions::shuffledNumbers(mesh.numberOfNodes());
    const Mesh other = renumbered(mesh, order);
    const NodePartition otherPartition = outerPartition(other);
    for (const auto& [method, make] : allMethods())
    {
      const Points moved = morphed(make, mesh, partition, target);
      EXPECT_TRUE(motions::identical(moved, morphed(make, mesh, partition, target, 4)))
        << method << " on " << name;
      // The tessellation of a lattice is not unique, nor where an iteration stops.
      if (method != "FemWarp" && method != "LogBarrierWarp" && method != "WeightedResidual")
      {
        continue;
      }
      const Points renamed =
        morphed(make, other, otherPartition, targets(other, otherPartition, twist));
      EXPECT_LT(difference(rows(renamed, order), moved), 1e-10 * size(mesh.points))
        << method << " on " << name;
    }
  }
}

TEST(PolyhedralMorphers, WhatIsMeasuredIsWhatIsMinimized)
{
  // Its cells have short edges, whose corners no method sees.
  const Mesh mesh = voronoi(5);
  validate(mesh);
  const NodePartition partition = outerPartition(mesh);
  const Points target = targets(
    mesh, partition, [](const motions::Row& x) { return motions::twist(x, 2.5, 2.5, 0.628); });
  const auto inverted = [&](const Points& points)
  {
    Monitor monitor;
    return invertedCells(mesh, points, {}, monitor).size();
  };
  ASSERT_EQ(inverted(mesh.points), 0);
  ASSERT_EQ(
    inverted(morphed([] { return std::make_unique<FemWarp>(); }, mesh, partition, target)), 0);
  const auto make = []
  {
    auto method = std::make_unique<InversionFree>();
    method->setSteps(0);
    return method;
  };
  EXPECT_EQ(inverted(morphed(make, mesh, partition, target)), 0);
}

TEST(PolyhedralMorphers, TheAdjointIsTheTranspose)
{
  Monitor monitor;
  for (const auto& [name, mesh] : polyhedral())
  {
    const NodePartition partition = outerPartition(mesh);
    for (const LinearMethod& make : linearMethods())
    {
      const auto method = morpherForPolyhedra(make.make());
      auto* linear = dynamic_cast<LinearMorpher*>(method.get());
      ASSERT_NE(linear, nullptr) << make.name;
      linear->prepare(mesh, partition, monitor);
      const Points by = Points::Random(static_cast<Index>(partition.prescribed.size()), 3);
      const Points gradient = Points::Random(mesh.numberOfNodes(), 3);
      const Points mode = linear->basis({ by }, monitor).front();
      Points adjoint;
      linear->applyTranspose(gradient, adjoint, monitor);
      EXPECT_NEAR((mode.array() * gradient.array()).sum(), (by.array() * adjoint.array()).sum(),
        1e-10 * gradient.norm() * by.norm())
        << make.name << " on " << name;
    }
  }
}

// The promise for hexahedra given as polyhedra, at 20 x 20 x 20.
TEST(PolyhedralMorphers, ATwistedBrickIsCloseToThatOfHexahedra)
{
  constexpr int N = 20;
  const Mesh hexahedra = hexes(N, N, N);
  const Mesh polyhedra = asPolyhedra(hexahedra);
  const NodePartition partition = outerPartition(hexahedra);
  const auto twist = [](const motions::Row& x)
  { return motions::twist(x, N, N, std::acos(-1.) / 4); };
  const Points target = targets(hexahedra, partition, twist);
  double largest = 0;
  for (std::size_t i = 0; i < partition.prescribed.size(); ++i)
  {
    largest = std::max(largest,
      (target.row(static_cast<Index>(i)) - hexahedra.points.row(partition.prescribed[i])).norm());
  }
  for (const auto& [method, make] : allMethods())
  {
    if (method == "SimplexNaturalNeighbor")
    {
      continue; // it sees the boundary alone, as SimplexLinear
    }
    const Points expected = morphed(make, hexahedra, partition, target, 2);
    // Smoothing stops early, and at another place for another order of a cell's corners.
    EXPECT_LT(difference(morphed(make, polyhedra, partition, target, 2), expected), 1e-5 * largest)
      << method << " on hexahedra that stay whole";
    const Points found = morphed(make, polyhedra, partition, target, 2, true);
    const double most = (found - expected).rowwise().norm().maxCoeff();
    EXPECT_LT(most, 0.05 * largest) << method;
  }
}

TEST(PolyhedralMorphers, InversionFreeKeepsPolyhedraValidWhereFemWarpInvertsThem)
{
  Monitor monitor;
  const auto bent = [](const motions::Row& x) { return motions::twist(x, 5.5, 4, 5); };
  const Mesh mesh = honeycomb(4);
  const NodePartition partition = outerPartition(mesh);
  const Points target = targets(mesh, partition, bent);
  const Make femWarp = [] { return std::make_unique<FemWarp>(); };
  const Make inversionFree = [] { return std::make_unique<InversionFree>(); };
  const auto bad = [&](const Make& make)
  {
    const Points moved = morphed(make, mesh, partition, target);
    const Quality quality = measureQuality(mesh, moved, {}, {}, monitor);
    return quality.inverted + quality.degenerate;
  };
  EXPECT_GT(bad(femWarp), 0) << "the motion tests nothing";
  EXPECT_EQ(bad(inversionFree), 0);
}

TEST(PolyhedralMorphers, WarningsNameCellsAndNotTheirPieces)
{
  Mesh mesh = asPolyhedra(hexes(3, 3, 3));
  mesh.points.row(21).array() += 1.2; // the node of 8 cells, of which it inverts some
  auto method = morpherForPolyhedra(std::make_unique<FemWarp>(), true);
  ThreadedMonitor monitor;

  method->prepare(mesh, outerPartition(mesh), monitor);

  ASSERT_EQ(monitor.warnings.size(), 1u);
  const std::string& text = monitor.warnings[0];
  const std::size_t from = text.find("ids ") + 4;
  std::istringstream ids(text.substr(from, text.find('.', from) - from));
  std::vector<Index> named;
  for (std::string id; std::getline(ids, id, ',');)
  {
    named.push_back(std::stol(id));
  }
  EXPECT_LT(named.back(), mesh.numberOfCells()) << text;
  EXPECT_EQ(std::adjacent_find(named.begin(), named.end()), named.end()) << text;
}
