// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/RankPolyhedra.h"

#include "Distributed/CutMesh.h"
#include "Distributed/SmoothMesh.h"
#include "Mesh/HigherOrderNodes.h"
#include "Private/Distributed/RankQuality.h"
#include "Session/AfterMotion.h"

#include <utility>

namespace morph::filters::RankPolyhedra
{
using morph::distributed::CutMesh;
using morph::distributed::DistributedMesh;
using morph::distributed::RepairReport;

namespace
{
/// Places what the pieces do not have where their nodes have gone, from `before` to `after`: nodes
/// between corners, and then those that hang.
void placeOthers(const DistributedMesh& mesh, const morph::NodePartition& partition,
  const morph::Points& before, morph::Points& after)
{
  if (!mesh.hasHanging())
  {
    return;
  }
  morph::HigherOrderNodes followers;
  mesh.ranks().together([&] { followers.prepare(mesh.mesh(), partition); });
  morph::Points change = after - before;
  followers.apply(change);
  for (const morph::Index node : partition.higherOrderNodes)
  {
    after.row(node) = before.row(node) + change.row(node);
  }
  mesh.halo().update(mesh.ranks(), after);
  mesh.hanging().place(mesh.mesh().points, after);
  mesh.halo().update(mesh.ranks(), after);
  mesh.copyToDoubles(after);
}
}

RepairReport Repair(const DistributedMesh& mesh, const morph::Points& reference,
  const morph::NodePartition& partition, bool needsPieces, const morph::InvertedBefore& before,
  morph::Points& moved, morph::Monitor& monitor)
{
  if (!needsPieces)
  {
    return morph::distributed::repairInverted(mesh, reference, partition, before, moved, monitor);
  }
  constexpr int Rounds = 4;
  const auto bad = [&](const morph::Points& points)
  { return RankQuality::Measure(mesh, points, before, monitor).AddedOfAll; };
  RepairReport result;
  result.bad = bad(moved);
  if (result.bad == 0)
  {
    return result;
  }
  const CutMesh cut(mesh, 1, monitor);
  const morph::Points shapes = cut.extend(reference);
  const morph::NodePartition ofPieces = cut.extend(partition);
  morph::Points points = moved;
  for (int round = 0; round < Rounds && result.bad > 0; ++round)
  {
    morph::Points all = cut.extend(points);
    const RepairReport ofRound =
      morph::distributed::repairInverted(cut.mesh(), shapes, ofPieces, {}, all, monitor);
    result.tooLarge = ofRound.tooLarge;
    result.cells = ofRound.cells;
    morph::Points repaired = cut.reduce(all, points);
    placeOthers(mesh, partition, points, repaired);
    if (mesh.ranks().sum(morph::Index(repaired != points)) == 0)
    {
      break;
    }
    points = std::move(repaired);
    const morph::Index now = bad(points);
    if (now < result.bad)
    {
      result.bad = now;
      moved = points;
    }
  }
  return result;
}

morph::Index Smooth(const DistributedMesh& mesh, const morph::Points& rest,
  const morph::NodePartition& partition, bool needsPieces, int iterationLimit, morph::Points& moved,
  morph::Monitor& monitor)
{
  const morph::SmoothingOptions options = morph::postSmoothing(iterationLimit);
  morph::SmoothingReport report;
  if (!needsPieces)
  {
    report = morph::distributed::smoothMesh(mesh, rest, partition, options, moved, monitor);
    return report.wasKept ? 0 : report.untangleSteps + report.newtonSteps;
  }
  const CutMesh cut(mesh, 1, monitor);
  morph::Points all = cut.extend(moved);
  report = morph::distributed::smoothMesh(
    cut.mesh(), cut.extend(rest), cut.extend(partition), options, all, monitor);
  morph::Points smoothed = cut.reduce(all, moved);
  placeOthers(mesh, partition, moved, smoothed);
  // What is better for the pieces may be worse for the polyhedra.
  const RankQuality::Measured before = RankQuality::Measure(mesh, moved, {}, monitor);
  const RankQuality::Measured after = RankQuality::Measure(mesh, smoothed, {}, monitor);
  if (after.Bad() > before.Bad() ||
      (after.Bad() == before.Bad() && !(after.Whole.minimum >= before.Whole.minimum)))
  {
    return 0;
  }
  moved = std::move(smoothed);
  return report.wasKept ? 0 : report.untangleSteps + report.newtonSteps;
}
}
