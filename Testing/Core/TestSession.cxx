// SPDX-License-Identifier: BSD-3-Clause
// What a program does that has a mesh and its boundary's new places, and no VTK.
#include "LinearMethods/FemWarp.h"
#include "Meshes.h"
#include "Motions.h"
#include "PolyhedralMeshes.h"
#include "Quality/ScaledJacobian.h"
#include "Session/AfterMotion.h"
#include "Session/Session.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

namespace
{
using namespace morph;

constexpr double Deep = 4;

/// A box whose top is dented. FEMWARP inverts cells below a deep dent.
struct DentedBox
{
  meshes::ThreadedMonitor monitor;
  morph::Mesh mesh = meshes::hexes(6, 6, 6);
  std::vector<Index> ids = motions::outerPartition(mesh).prescribed;
  Session session;
  Session::Options options;

  DentedBox()
  {
    this->session.setMesh(this->mesh, this->monitor);
    this->options.createMorpher = [] { return std::make_unique<morph::FemWarp>(); };
  }
  Points targets(double depth) const
  {
    return motions::targets(this->mesh, motions::outerPartition(this->mesh),
      [&](const motions::Row& x)
      {
        const double dent = std::sin(EIGEN_PI * x[0] / 6) * std::sin(EIGEN_PI * x[1] / 6);
        return motions::Row(x[0], x[1], x[2] < 6 ? x[2] : x[2] - depth * dent);
      });
  }
  Index inverted(const Points& points)
  {
    return static_cast<Index>(
      morph::invertedCells(this->mesh, points, this->session.mesh().orientation(), this->monitor)
        .size());
  }
};

TEST(Session, RepairsWhatAMethodInverts)
{
  DentedBox box;
  const Points targets = box.targets(Deep);
  const auto without = box.session.morph({ box.ids, targets }, box.options, box.monitor);
  ASSERT_GT(box.inverted(without->moved), 0);
  EXPECT_EQ(without->valid.status, "Inverted");

  box.options.validity = Validity::Mode::Repair;
  const auto step = box.session.morph({ box.ids, targets }, box.options, box.monitor);

  EXPECT_EQ(step->valid.status, "Repaired");
  EXPECT_EQ(box.inverted(step->moved), 0);
  EXPECT_EQ(Points(step->moved(box.ids, morph::allColumns)), targets);
  EXPECT_EQ(step->prescribed, static_cast<Index>(box.ids.size()));
  EXPECT_EQ(box.session.effort.preparations, 1) << "for both";
}

TEST(Session, SubStepsEndAtTheLastValidMesh)
{
  DentedBox box;
  box.options.validity = Validity::Mode::SubStep;
  const auto step = box.session.morph({ box.ids, box.targets(Deep) }, box.options, box.monitor);
  EXPECT_EQ(step->valid.status, "Partial");
  EXPECT_GT(step->valid.largestValidStep, 0.5);
  EXPECT_LT(step->valid.largestValidStep, 1);
  EXPECT_NE(step->valid.error.find("`Validity` set to Repair"), std::string::npos);
  EXPECT_EQ(box.inverted(step->moved), 0);
}

TEST(Session, TheAdjointIsThatOfTheMotion)
{
  DentedBox box;
  const Points still = box.targets(0), dented = box.targets(0.1);
  const Points gradient = Points::Random(box.mesh.numberOfNodes(), 3);

  const Points derivative = box.session.transpose(box.ids, gradient, box.options, box.monitor);

  const auto step = box.session.morph({ box.ids, dented }, box.options, box.monitor);
  const double change = gradient.cwiseProduct(step->moved - box.mesh.points).sum();
  EXPECT_NEAR(derivative.cwiseProduct(dented - still).sum(), change, 1e-6 * std::abs(change));
}

TEST(Session, AStepOfASeriesStartsFromTheStepBefore)
{
  DentedBox box;
  const auto boundaryOf = [&](int step) {
    return morph::BoundaryTargets{ box.ids, box.targets(0.2 * step) };
  };
  const morph::BoundaryTargets whole = boundaryOf(5);

  const auto last = box.session.morphSeries(5, boundaryOf, &whole, box.options, box.monitor);
  EXPECT_EQ(box.session.steps().lastUntil(4).first, 4);

  Points from = box.mesh.points;
  for (int step = 0; step <= 5; ++step)
  {
    morph::Mesh mesh = box.mesh;
    mesh.points = from;
    morph::FemWarp method;
    method.prepare(mesh, motions::outerPartition(box.mesh), box.monitor);
    method.evaluate(box.targets(0.2 * step), from, box.monitor);
  }
  EXPECT_LT(motions::difference(last->moved, from), 1e-9);
}

TEST(Session, WrongBoundariesAreNamed)
{
  DentedBox box;
  Points targets = box.targets(0.1);
  const auto errorOf = [&](const std::vector<Index>& ids, const Points& places)
  {
    std::string message;
    motions::kindOf([&] { box.session.morph({ ids, places }, box.options, box.monitor); }, message);
    return message;
  };
  EXPECT_EQ(errorOf(box.ids, targets.topRows(3)),
    "The array of targets has 3 rows where " + std::to_string(box.ids.size()) + " are expected.");
  EXPECT_EQ(errorOf({ 5, 2 }, targets.topRows(2)),
    "The ids of prescribed nodes do not ascend. Sort them, and their targets alike.");
  targets(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(errorOf(box.ids, targets),
    "The targets are not finite or beyond 1e50, at node ids " + std::to_string(box.ids[1]) + ".");
}

TEST(Session, WhereTheBoundaryInvertsAllThatIsLeftNothingStartsAgain)
{
  const morph::Mesh mesh = meshes::asPolyhedra(meshes::hexes(3, 3, 3));
  const std::vector<std::int8_t> signs(mesh.numberOfCells(), 1);
  morph::Points moved = mesh.points;
  moved.row(0).setConstant(1.5);
  const morph::Points start = moved;
  morph::Monitor monitor;
  int asked = 0;
  const auto bad = [&](const morph::Points& points)
  {
    ++asked;
    return morph::invertedCells(mesh, points, signs, monitor);
  };
  EXPECT_FALSE(morph::repairPolyhedra(
    mesh, {}, mesh.points, motions::outerPartition(mesh), bad, moved, monitor));
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(moved, start);
  EXPECT_EQ(bad(moved), std::vector<morph::Index>{ 0 });
}

TEST(MorphSeries, AMillionStepsAreKeptInTimeLinearInTheirNumber)
{
  // A walk over all that is kept, for each step, takes hours.
  constexpr int Steps = 1000000;
  const auto step = std::make_shared<const morph::StepResult>();
  for (const double megabytes : { 1000., 1e-3, 0. })
  {
    morph::Series series;
    for (int i = 0; i <= Steps; ++i)
    {
      series.keep(i, step, megabytes);
    }
    EXPECT_EQ(series.lastUntil(Steps).first, Steps);
    const int kept = series.lastUntil(Steps / 2 + 1).first;
    EXPECT_GE(kept, megabytes > 1   ? Steps / 2 + 1
                    : megabytes > 0 ? Steps / 2 - 2 * Steps / 1000
                                    : -1);
  }
}

TEST(MorphSeries, WhatIsBetweenStridesIsKeptOnlyWhileItIsTheLast)
{
  auto step = std::make_shared<morph::StepResult>();
  step->moved.resize(1000, 3); // 24,000 bytes
  morph::Series series;
  for (int i = 0; i <= 9; ++i)
  {
    series.keep(i, step, 0.072); // three of them
  }
  EXPECT_EQ(series.lastUntil(9).first, 9);
  EXPECT_EQ(series.lastUntil(8).first, 8);
  EXPECT_EQ(series.lastUntil(7).first, 4);
  EXPECT_EQ(series.lastUntil(3).first, 0);
  series.keep(5, step, 0.072);
  EXPECT_EQ(series.lastUntil(9).first, 8);
  EXPECT_EQ(series.lastUntil(7).first, 5);
  series.keep(6, step, 0.072);
  EXPECT_EQ(series.lastUntil(5).first, 4);
}
}
