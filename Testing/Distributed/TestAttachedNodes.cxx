// SPDX-License-Identifier: BSD-3-Clause
// Shells on a volume that several ranks have parts of.
#include "Distributed/RankCommunicator.h"
#include "LinearMethods/AttachedNodes.h"
#include "Meshes.h"
#include "Pieces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace
{
using morph::AttachedNodes;
using morph::Index;
using morph::Mesh;
using morph::Points;
using Row = Eigen::RowVector3d;

constexpr Index Volume = 7 * 6 * 5;

/// A block with a row of quads from end to end on its top, so that all ranks have some.
Mesh blockWithFin()
{
  Mesh mesh = meshes::hexes(6, 5, 4);
  const Index foot = 7 * (2 + 6 * 4);
  mesh.points.conservativeResize(Volume + 7, 3);
  for (Index i = 0; i < 7; ++i)
  {
    mesh.points.row(Volume + i) << static_cast<double>(i), 2, 5;
  }
  for (Index i = 0; i < 6; ++i)
  {
    meshes::add(mesh, morph::Quad, { foot + i, foot + i + 1, Volume + i + 1, Volume + i });
  }
  return mesh;
}

Row bent(const Row& x)
{
  return { x[0] + 0.3 * std::sin(x[2]), x[1] + 0.1 * x[0] * x[2], x[2] + 0.2 * std::cos(x[0]) };
}
}

TEST(AttachedNodes, AreThoseOfOneRank)
{
  const morph::distributed::Ranks ranks = pieces::world();
  const Mesh whole = blockWithFin();
  const auto mesh = pieces::distribute(ranks, whole, 1, meshes::seed());
  const auto partition = morph::partitionNodes(mesh.mesh(), pieces::localNodes(mesh, { 0 }));
  const morph::distributed::RankCommunicator processes(mesh);
  const AttachedNodes attached(mesh.mesh(), partition, processes);
  const AttachedNodes expected(whole, morph::partitionNodes(whole, { 0 }));
  EXPECT_EQ(attached.nodes(), expected.nodes());
  EXPECT_EQ(attached.nodes().size(), 7u);

  Points moved = mesh.mesh().points, all = whole.points;
  for (Index n = 0; n < moved.rows(); ++n)
  {
    moved.row(n) = mesh.nodeId(n) < Volume ? bent(moved.row(n)) : Row(moved.row(n));
  }
  for (Index n = 0; n < Volume; ++n)
  {
    all.row(n) = bent(all.row(n));
  }
  attached.apply(moved);
  expected.apply(all);
  EXPECT_LT(pieces::distance(mesh, moved, all), 1e-12);

  std::srand(meshes::seed());
  Points ofAll = Points::Random(whole.numberOfNodes(), 3), ofPiece = Points::Zero(moved.rows(), 3);
  for (Index n = 0; n < moved.rows(); ++n)
  {
    ofPiece.row(n) = mesh.owns(n) ? Row(ofAll.row(mesh.nodeId(n))) : Row(Row::Zero());
  }
  attached.applyTranspose(ofPiece);
  mesh.halo().add(ranks, ofPiece);
  expected.applyTranspose(ofAll);
  for (Index n = 0; n < moved.rows(); ++n)
  {
    const double off = (ofPiece.row(n) - ofAll.row(mesh.nodeId(n))).norm();
    EXPECT_LT(mesh.owns(n) ? off : 0, 1e-12);
  }
}
