// SPDX-License-Identifier: BSD-3-Clause
// The stiffness of the cells, and the adjoint, of a mesh on several MPI ranks.
#include "Distributed/RankCommunicator.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "LinearMethods/RadialBasis.h"
#include "LinearMethods/SimplexLinear.h"
#include "LinearMethods/SimplexNaturalNeighbor.h"
#include "LinearMethods/WeightedResidual.h"
#include "Mesh/Topology.h"
#include "Meshes.h"
#include "Morpher/SiteMethod.h"
#include "Pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

namespace
{
using namespace morph;
using morph::distributed::DistributedMesh;
using morph::distributed::Ranks;

using Make = std::function<std::unique_ptr<morph::LinearMorpher>(const CellStiffness&)>;

std::unique_ptr<morph::LinearMorpher> stiff(const CellStiffness& stiffness)
{
  auto warp = std::make_unique<morph::FemWarp>();
  warp->setTolerance(1e-13);
  warp->setStiffness(stiffness);
  return warp;
}

std::unique_ptr<morph::LinearMorpher> lbwarp(const CellStiffness&)
{
  auto warp = std::make_unique<morph::LogBarrierWarp>();
  warp->setTolerance(1e-13);
  return warp;
}

template <typename Method>
std::unique_ptr<morph::LinearMorpher> plain(const CellStiffness&)
{
  return std::make_unique<Method>();
}

/// Stiffness of each kind; values of the cells by their ids.
std::vector<std::pair<std::string, CellStiffness>> kinds(const Mesh& whole)
{
  std::vector<std::pair<std::string, CellStiffness>> all(4);
  all[0].first = "inverse volume";
  all[0].second.kind = CellStiffness::Kind::InverseVolume;
  all[1].first = "wall distance";
  all[1].second.kind = CellStiffness::Kind::WallDistance;
  all[2].first = "distance of named walls, squared";
  all[2].second.kind = CellStiffness::Kind::WallDistance;
  all[2].second.exponent = 2;
  all[2].second.walls = { 0, 1, 2, whole.numberOfNodes() - 1 };
  all[3].first = "values";
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> some(0.1, 10);
  for (Index c = 0; c < whole.numberOfCells(); ++c)
  {
    all[3].second.values.push_back(some(random));
  }
  return all;
}

/// The same for this rank's piece.
CellStiffness ofPiece(const DistributedMesh& mesh, CellStiffness stiffness)
{
  std::vector<double> values;
  for (Index c = 0; c < mesh.pieceCells() && !stiffness.values.empty(); ++c)
  {
    values.push_back(stiffness.values[mesh.cellId(c)]);
  }
  stiffness.values = values;
  return stiffness;
}

Points bend(const Points& x)
{
  Points moved = x;
  moved.col(1).array() += 0.2 * (x.col(0).array()).sin();
  moved.col(2).array() += 0.1 * x.col(0).array() * x.col(1).array();
  return moved;
}

/// The largest differences of a method on ranks from the serial one: in positions over the mesh's
/// size, and in the adjoint over its largest value.
std::pair<double, double> differences(
  const Ranks& ranks, const Mesh& whole, const Make& make, const CellStiffness& stiffness)
{
  Monitor monitor;
  const std::vector<Index> outer = morph::boundaryFaces(whole, monitor).nodes;
  const Points target = bend(whole.points);
  const auto serial = make(stiffness);
  serial->prepare(whole, morph::partitionNodes(whole, outer), monitor);
  Points expected, expectedGradient;
  serial->evaluate(Points(target(outer, morph::allColumns)), expected, monitor);
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> some(-1, 1);
  Points gradient(whole.numberOfNodes(), 3);
  std::generate_n(gradient.data(), gradient.size(), [&] { return some(random); });
  serial->applyTranspose(gradient, expectedGradient, monitor);

  const DistributedMesh mesh = pieces::distribute(ranks, whole, 2, meshes::seed());
  const std::unique_ptr<morph::Morpher> method = morph::onProcesses(make(ofPiece(mesh, stiffness)));
  const std::vector<Index> prescribed = pieces::localNodes(mesh, outer);
  method->prepare(mesh.mesh(), morph::partitionNodes(mesh.mesh(), prescribed), monitor,
    std::make_shared<morph::distributed::RankCommunicator>(mesh));
  Points moved, result;
  method->evaluate(target(mesh.idsOfNodes(prescribed), morph::allColumns), moved, monitor);
  dynamic_cast<morph::LinearMorpher&>(*method).applyTranspose(
    gradient(std::vector<Index>(mesh.nodeIds().begin(), mesh.nodeIds().end()), morph::allColumns),
    result, monitor);
  Points sums = Points::Zero(expectedGradient.rows(), 3);
  for (std::size_t k = 0; k < prescribed.size(); ++k)
  {
    const Index row =
      std::lower_bound(outer.begin(), outer.end(), mesh.nodeId(prescribed[k])) - outer.begin();
    sums.row(row) += result.row(static_cast<Index>(k));
  }
  ranks.sum(sums.data(), static_cast<std::size_t>(sums.size()));
  const double slope = (sums - expectedGradient).cwiseAbs().maxCoeff();
  return { pieces::distance(mesh, moved, expected) / meshes::size(whole.points),
    slope / expectedGradient.cwiseAbs().maxCoeff() };
}
}

TEST(DistributedStiffness, AgreesWithTheSerialOne)
{
  const Ranks ranks = pieces::world();
  for (auto& [name, whole] : meshes::all(4, 3, 3))
  {
    meshes::jitterInterior(whole, 0.1, 7);
    for (const auto& [kind, stiffness] : kinds(whole))
    {
      const auto [place, slope] = differences(ranks, whole, stiff, stiffness);
      EXPECT_LT(place, 1e-9) << name << ", " << kind;
      EXPECT_LT(slope, 1e-9) << name << ", " << kind;
    }
  }
}

TEST(DistributedAdjoint, AgreesWithTheSerialOne)
{
  const Ranks ranks = pieces::world();
  const std::vector<std::pair<std::string, Make>> methods = { { "FEMWARP", stiff },
    { "LBWARP", lbwarp }, { "weighted residual", plain<morph::WeightedResidual> },
    { "simplex-linear", plain<morph::SimplexLinear> },
    { "natural neighbor", plain<morph::SimplexNaturalNeighbor> },
    { "radial basis", plain<morph::RadialBasis> } };
  for (auto& [name, whole] : meshes::all(4, 3, 3))
  {
    meshes::jitterInterior(whole, 0.1, 7);
    for (const auto& [method, make] : methods)
    {
      EXPECT_LT(differences(ranks, whole, make, {}).second, 1e-9) << name << ", " << method;
    }
  }
}
