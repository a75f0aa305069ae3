// SPDX-License-Identifier: BSD-3-Clause
// Smoothing of a mesh on ranks against that of one process.
#include "Distributed/RankCommunicator.h"
#include "Mesh/OwnCells.h"
#include "Mesh/Topology.h"
#include "Meshes.h"
#include "Motions.h"
#include "Pieces.h"
#include "Quality/ScaledJacobian.h"
#include "Untangling/SmoothMesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <string>
#include <utility>

namespace
{
using namespace morph;
using morph::distributed::DistributedMesh;
using morph::distributed::Ranks;

/// The minimum of the mesh at these points. `bad`: becomes its inverted or degenerate cells.
double minimumOf(const Mesh& mesh, const Points& points, Index& bad)
{
  morph::Monitor monitor;
  const morph::Quality quality = morph::measureQuality(
    mesh, points, morph::cellSigns(mesh, morph::connectedComponents(mesh)), {}, monitor);
  bad = quality.inverted + quality.degenerate;
  return quality.minimum;
}

/// Smooths `moved` on one process and on ranks, and compares.
void compare(const Ranks& ranks, const std::string& name, const Mesh& whole, const Points& moved,
  const morph::SmoothingOptions& options)
{
  SCOPED_TRACE(name);
  morph::Monitor monitor;
  const morph::NodePartition outer = motions::outerPartition(whole);
  Points expected = moved;
  const morph::SmoothingReport serial = morph::smoothMesh(whole,
    morph::cellSigns(whole, morph::connectedComponents(whole)), outer, options, expected, monitor);

  const DistributedMesh mesh = pieces::distribute(ranks, whole, 1, meshes::seed());
  const morph::distributed::RankCommunicator processes(mesh);
  const morph::OwnCells part(mesh.mesh(),
    morph::partitionNodes(mesh.mesh(), pieces::localNodes(mesh, outer.prescribed)),
    mesh.orientation(), processes);
  Points mine = moved(mesh.nodeIds(), morph::allColumns), ofCells = part.take(mine);
  const morph::SmoothingReport report = morph::smoothMesh(part.mesh(), part.orientation(),
    part.partition(), options, ofCells, monitor, part.communicator());
  mine(part.nodes(), morph::allColumns) = ofCells;
  processes.rows()->update(mine);
  const Points all = pieces::gathered(mesh, mine);
  Index bad = 0, expectedBad = 0;
  const double least = minimumOf(whole, expected, expectedBad), own = minimumOf(whole, all, bad);
  EXPECT_EQ(bad, expectedBad);
  EXPECT_EQ(report.isValid, serial.isValid);
  EXPECT_EQ(report.wasKept, serial.wasKept);
  EXPECT_GT(own, least - 0.01 * std::abs(least));
  if (ranks.rank() == 0)
  {
    std::cout << name << ": minimum " << own << ", on one rank " << least << "; steps "
              << report.untangleSteps << " + " << report.newtonSteps << ", " << serial.untangleSteps
              << " + " << serial.newtonSteps << "\n";
  }
}
}

TEST(RankSmoothMesh, IsAsGoodAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  const std::pair<std::string, Mesh> all[] = { { "hexahedra", meshes::hexes(4, 3, 3) },
    { "tetrahedra", meshes::tets(4, 3, 3) },
    { "hexahedra and pyramids", meshes::hexesAndPyramids(4, 3, 3) },
    { "quadratic tetrahedra", meshes::quadraticTets(3, 3, 3) } };
  for (const auto& [name, mesh] : all)
  {
    for (const double jitter : { 0.2, 0.6 }) // the latter inverts cells
    {
      Mesh moved = mesh;
      meshes::jitterInterior(moved, jitter, meshes::seed());
      const std::string both = name + ", jitter " + std::to_string(jitter);
      morph::SmoothingOptions options;
      compare(ranks, both + ", ideal", mesh, moved.points, options);
      options.target = morph::SmoothingTarget::Initial;
      options.neverWorse = true;
      compare(ranks, both + ", initial", mesh, moved.points, options);
    }
  }
}
