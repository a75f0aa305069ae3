// SPDX-License-Identifier: BSD-3-Clause
// Nodes that hang on faces of other ranks' cells, against the serial methods on the whole mesh.
#include "Distributed/DistributedMesh.h"
#include "Distributed/RankCommunicator.h"
#include "LinearMethods.h"
#include "Mesh/HangingNodes.h"
#include "Mesh/Topology.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Morpher/SiteMethod.h"
#include "Motions.h"
#include "Octree.h"
#include "Pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

namespace
{
using namespace morph;
using morph::distributed::DistributedMesh;
using morph::distributed::Ranks;
using motions::Row;

Row twisted(const Row& x)
{
  return motions::twist(x, meshes::Octree::Width, meshes::Octree::Height, 0.5);
}

/// A linear method on the whole octree, and on this rank's random part of it.
class RankHangingNodes : public testing::TestWithParam<int>
{
protected:
  const Ranks Processes = pieces::world();
  Monitor Quiet;
  const meshes::Octree Octree{ meshes::seed(), this->GetParam() };
  const double Size = meshes::size(this->Octree.mesh.points);
  HangingNodes Hanging;
  NodePartition Partition; ///< of the whole mesh
  std::unique_ptr<morph::LinearMorpher> Serial;
  std::unique_ptr<DistributedMesh> Mesh;
  std::vector<Index> Prescribed; ///< local nodes
  std::unique_ptr<morph::Morpher> Mine;

  void Prepare(const meshes::LinearMethod& method, unsigned seed)
  {
    const morph::Mesh& whole = this->Octree.mesh;
    const std::vector<Index> outer = morph::boundaryFaces(whole, this->Hanging, this->Quiet).nodes;
    this->Partition = morph::partitionNodes(whole, this->Hanging, this->Hanging.without(outer));
    this->Serial.reset(dynamic_cast<morph::LinearMorpher*>(
      morph::morpherForPolyhedra(method.make(), false, this->Hanging).release()));
    this->Serial->prepare(whole, this->Partition, this->Quiet);
    this->Mesh =
      std::make_unique<DistributedMesh>(pieces::distribute(this->Processes, whole, 1, seed));
    this->Mine =
      morph::morpherForPolyhedra(morph::onProcesses(method.make()), false, this->Mesh->hanging());
    this->Prescribed = pieces::localNodes(*this->Mesh, this->Partition.prescribed);
    this->Mine->prepare(this->Mesh->mesh(),
      morph::partitionNodes(this->Mesh->mesh(), this->Mesh->hanging(), this->Prescribed),
      this->Quiet, std::make_shared<morph::distributed::RankCommunicator>(*this->Mesh));
  }
};
}

TEST_P(RankHangingNodes, AreThoseOfOneRank)
{
  for (unsigned seed = 0; seed < 5; ++seed)
  {
    const meshes::Octree octree(meshes::seed() + seed, this->GetParam());
    HangingNodes whole;
    const morph::BoundaryFaces outer = morph::boundaryFaces(octree.mesh, whole, this->Quiet);

    const DistributedMesh mesh = pieces::distribute(this->Processes, octree.mesh, 1, seed);

    std::vector<Index> own;
    for (const Index node : mesh.hanging().nodes())
    {
      if (mesh.owns(node))
      {
        own.push_back(mesh.nodeId(node));
      }
    }
    own = this->Processes.gather(own);
    std::sort(own.begin(), own.end());
    EXPECT_EQ(own, whole.nodes());
    const auto rest = pieces::undeformed(mesh);
    EXPECT_EQ(this->Processes.sum(static_cast<Index>(rest->outerFaces().cells.size())),
      static_cast<Index>(outer.cells.size()));
    EXPECT_TRUE(rest->touchingNodes().empty());
  }
}

TEST_P(RankHangingNodes, MoveAsOnOneRank)
{
  unsigned seed = meshes::seed();
  for (const meshes::LinearMethod& method : meshes::linearMethods())
  {
    SCOPED_TRACE(method.name);
    this->Prepare(method, ++seed);
    for (const bool isAffine : { false, true })
    {
      const Points target =
        motions::mapped(this->Octree.mesh.points, isAffine ? motions::affine : twisted);
      Points expected = target, moved;
      if (!isAffine)
      {
        this->Serial->evaluate(
          Points(target(this->Partition.prescribed, morph::allColumns)), expected, this->Quiet);
      }

      this->Mine->evaluate(
        meshes::rows(target, this->Mesh->idsOfNodes(this->Prescribed)), moved, this->Quiet);

      EXPECT_LT(
        pieces::distance(*this->Mesh, moved, expected), (isAffine ? 1e-10 : 1e-9) * this->Size);
      EXPECT_LT(this->Octree.gap(pieces::gathered(*this->Mesh, moved)), 1e-12 * this->Size);
    }
  }
}

TEST_P(RankHangingNodes, HaveTheAdjointOfOneRank)
{
  unsigned seed = meshes::seed() + 100;
  const Points gradient = (3 * this->Octree.mesh.points.array()).sin();
  for (const meshes::LinearMethod& method : meshes::linearMethods())
  {
    SCOPED_TRACE(method.name);
    this->Prepare(method, ++seed);
    const std::vector<Index>& outer = this->Partition.prescribed;
    Points expected, found;
    this->Serial->applyTranspose(gradient, expected, this->Quiet);

    dynamic_cast<morph::LinearMorpher&>(*this->Mine)
      .applyTranspose(gradient(this->Mesh->nodeIds(), morph::allColumns), found, this->Quiet);

    for (std::size_t k = 0; k < this->Prescribed.size(); ++k)
    {
      if (this->Mesh->owns(this->Prescribed[k]))
      {
        const Index id = this->Mesh->nodeId(this->Prescribed[k]);
        const Index row = std::lower_bound(outer.begin(), outer.end(), id) - outer.begin();
        EXPECT_LT(
          (found.row(static_cast<Index>(k)) - expected.row(row)).norm(), 1e-9 * expected.norm());
      }
    }
  }
}

// Middle nodes of the large cell are no corners of the small ones: they follow, and nodes hang on
// them.
TEST(RankHangingNodesOfFollowers, MoveAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh whole = meshes::dividedInThree();
  Monitor monitor;
  const std::vector<Index> outer = { 0, 3, 12, 15, 32, 33, 34, 35 };
  HangingNodes hanging;
  morph::boundaryFaces(whole, hanging, monitor);
  const NodePartition partition = morph::partitionNodes(whole, hanging, outer);
  const Points target = motions::mapped(whole.points, twisted);
  const auto serial =
    morph::morpherForPolyhedra(meshes::linearMethods().front().make(), false, hanging);
  serial->prepare(whole, partition, monitor);
  Points expected, moved;
  serial->evaluate(meshes::rows(target, partition.prescribed), expected, monitor);
  const DistributedMesh mesh = pieces::distribute(ranks, whole, 1, meshes::seed());
  const auto mine = morph::morpherForPolyhedra(
    morph::onProcesses(meshes::linearMethods().front().make()), false, mesh.hanging());
  const std::vector<Index> prescribed = pieces::localNodes(mesh, outer);

  mine->prepare(mesh.mesh(), morph::partitionNodes(mesh.mesh(), mesh.hanging(), prescribed),
    monitor, std::make_shared<morph::distributed::RankCommunicator>(mesh));
  mine->evaluate(meshes::rows(target, mesh.idsOfNodes(prescribed)), moved, monitor);

  EXPECT_LT(pieces::distance(mesh, moved, expected), 1e-9 * meshes::size(whole.points));
}

INSTANTIATE_TEST_SUITE_P(Orders, RankHangingNodes, testing::Values(0, 1, 2));
