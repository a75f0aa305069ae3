// SPDX-License-Identifier: BSD-3-Clause
// What every method tells of its progress.
#include "LinearMethods.h"
#include "Meshes.h"
#include "Motions.h"

#include "Mesh/Topology.h"
#include "Quality/MovableQuality.h"
#include "Session/IncrementalMorph.h"
#include "Support/Monitor.h"
#include "Untangling/InversionFree.h"
#include "Untangling/QualityRaising.h"
#include "Untangling/Smoothing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{
using namespace morph;

/// Keeps all that it is told.
struct Recorder : meshes::ThreadedMonitor
{
  using ThreadedMonitor::ThreadedMonitor;
  void progress(double fraction) override { this->told.push_back(fraction); }
  std::vector<double> told;

  /// What was told since the last call rises from 0 to 1.
  void expectRise(const std::string& what)
  {
    double last = 0;
    ASSERT_FALSE(this->told.empty()) << what;
    for (double fraction : this->told)
    {
      EXPECT_GE(fraction, last) << what;
      EXPECT_LE(fraction, 1) << what;
      last = fraction;
    }
    EXPECT_EQ(last, 1) << what;
    this->told.clear();
  }
};

struct Method
{
  std::string name;
  std::function<std::unique_ptr<Morpher>()> make;
};

std::vector<Method> methods()
{
  std::vector<Method> list = {
    { "InversionFree", [] { return std::make_unique<InversionFree>(); } },
    { "Smoothing", [] { return std::make_unique<Smoothing>(); } },
  };
  for (const meshes::LinearMethod& method : meshes::linearMethods())
  {
    list.push_back({ method.name, method.make });
  }
  return list;
}

/// Steep enough to turn cells over by the linear methods.
motions::Row waves(const motions::Row& x)
{
  return { x[0], x[1], x[2] + 1.6 * std::sin(M_PI / 2 * x[0]) };
}

/// A corner goes through its cell, and a node of the top past its neighbor.
motions::Row impossible(const motions::Row& x)
{
  return x.norm() == 0                ? motions::Row(1.5, 1.5, 1.5)
         : x == motions::Row(2, 2, 4) ? motions::Row(2, 3.4, 4)
                                      : waves(x);
}
}

TEST(Progress, RisesFromZeroToOneForEveryMethod)
{
  const Mesh mesh = meshes::hexes(4, 4, 4);
  const NodePartition partition = motions::outerPartition(mesh);
  for (const Method& method : methods())
  {
    for (const motions::Map& map :
      { motions::Map(motions::affine), motions::Map(waves), motions::Map(impossible) })
    {
      Recorder monitor;
      const auto morpher = method.make();
      morpher->prepare(mesh, partition, monitor);
      monitor.expectRise(method.name + " prepare");
      const Points moved =
        motions::moved(*morpher, motions::targets(mesh, partition, map), monitor);
      monitor.expectRise(method.name + " evaluate");
      if (auto* linear = dynamic_cast<LinearMorpher*>(morpher.get()))
      {
        Points prescribed;
        linear->applyTranspose(moved, prescribed, monitor);
        monitor.expectRise(method.name + " adjoint");
      }
    }
  }
}

TEST(Progress, OfTheInversionFreeMorphIsSpreadOut)
{
  // The part that takes the time, from 0.1 to 0.95, is told in steps.
  const Mesh mesh = meshes::hexes(4, 4, 4);
  const NodePartition partition = motions::outerPartition(mesh);
  Recorder monitor;
  InversionFree method;
  method.prepare(mesh, partition, monitor);
  monitor.told.clear();
  Points moved = motions::moved(method, motions::targets(mesh, partition, waves), monitor);
  const auto within = std::count_if(monitor.told.begin(), monitor.told.end(),
    [](double fraction) { return fraction > 0.1 && fraction < 0.95; });
  EXPECT_GE(within, 4);
  monitor.told.clear();
  method.repair(moved, monitor);
  monitor.expectRise("repair");
}

TEST(Progress, OfRaisingTheMinimumIsTold)
{
  Mesh mesh = meshes::hexes(8, 8, 8);
  // Sheared, so that no mesh reaches the goal and round follows round.
  for (Index node = 0; node < mesh.numberOfNodes(); ++node)
  {
    mesh.points(node, 2) += 0.5 * mesh.points(node, 0);
  }
  meshes::jitterInterior(mesh, 0.2, 7);
  const auto orientation = cellSigns(mesh, connectedComponents(mesh));
  const NodePartition partition = motions::outerPartition(mesh);
  const MovableQuality quality(mesh, orientation, partition.free);
  Recorder monitor;
  Points points = mesh.points;
  ASSERT_GE(raiseQuality(quality, 1, 12, points, monitor).steps, 3);
  ASSERT_GE(monitor.told.size(), 3u);
  EXPECT_TRUE(std::is_sorted(monitor.told.begin(), monitor.told.end()));
  EXPECT_GT(monitor.told.back(), monitor.told.front());
  EXPECT_LE(monitor.told.back(), 1);
}

TEST(Progress, OfSubStepsRises)
{
  const Mesh mesh = meshes::hexes(4, 4, 4);
  const NodePartition partition = motions::outerPartition(mesh);
  Recorder monitor;
  morphIncrementally(
    mesh, mesh.points, partition, cellSigns(mesh, connectedComponents(mesh)), {},
    straightPath(mesh.points, partition, motions::targets(mesh, partition, impossible)),
    [] { return std::make_unique<FemWarp>(); }, {}, monitor);
  EXPECT_TRUE(std::is_sorted(monitor.told.begin(), monitor.told.end()));
  EXPECT_LE(monitor.told.back(), 1);
}

TEST(ProgressRange, NeverRunsBackwardsAndStaysInItsPart)
{
  Recorder recorder;
  morph::ProgressRange part(recorder, 0.5, 0.75);
  for (double fraction : { 0.2, 0.1, 0.4, -3., 7., 0.5 })
  {
    part.progress(fraction);
  }
  EXPECT_EQ(recorder.told, (std::vector<double>{ 0.55, 0.6, 0.75 }));
}
