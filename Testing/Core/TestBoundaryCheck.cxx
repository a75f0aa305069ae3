// SPDX-License-Identifier: BSD-3-Clause What boundaries forbid by themselves, and how soon the
// inversion-free morph and its sub-steps give up then.
#include "Geometry/ExactPredicates.h"
#include "LinearMethods/FemWarp.h"
#include "Mesh/Topology.h"
#include "Meshes.h"
#include "Motions.h"
#include "Quality/ScaledJacobian.h"
#include "Session/IncrementalMorph.h"
#include "Untangling/BoundaryCheck.h"
#include "Untangling/InversionFree.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace
{
using namespace morph;
using motions::Row;

/// The faces of a tetrahedron: the points inside have a common point with all of them, unless one
/// is turned round.
std::vector<HalfSpace> inside(const Row& a, const Row& b, const Row& c, const Row& d)
{
  std::vector<HalfSpace> faces = { { a, b, c }, { a, d, b }, { b, d, c }, { a, c, d } };
  const double volume = (b - a).dot((c - a).cross(d - a));
  for (HalfSpace& face : faces)
  {
    if (volume > 0)
    {
      std::swap(face[0], face[1]);
    }
  }
  return faces;
}

double room(const HalfSpace& h, const Row& v)
{
  return (h[0] - v).dot((h[1] - v).cross(h[2] - v));
}

std::vector<std::int8_t> orientationOf(const Mesh& mesh)
{
  return cellSigns(mesh, connectedComponents(mesh));
}

/// One hexahedron of 2 x 2 x 2 whose node at the center of the box alone is free.
struct Block
{
  Mesh mesh = meshes::hexes(2, 2, 2);
  NodePartition partition = motions::outerPartition(this->mesh);
  std::vector<std::int8_t> sides = orientationOf(this->mesh);
  BoundaryFaces faces;
  meshes::ThreadedMonitor monitor;

  Block() { this->faces = boundaryFaces(this->mesh, this->monitor); }
  ForbiddenCells at(const motions::Map& map)
  {
    return BoundaryCheck(this->mesh, this->partition, this->sides, this->faces, this->monitor)
      .at(motions::targets(this->mesh, this->partition, map));
  }
};

/// A box bent by half a turn round an axis inside it: its inner side is folded.
struct Bent
{
  Mesh mesh = meshes::hexes(16, 6, 6);
  NodePartition partition = motions::outerPartition(this->mesh);
  std::vector<std::int8_t> sides = orientationOf(this->mesh);
  Points target(double radius) const
  {
    return motions::targets(this->mesh, this->partition,
      [radius](const Row& x)
      {
        const double angle = M_PI * x[0] / 16, r = radius + x[1];
        return Row(r * std::sin(angle), r * std::cos(angle), x[2]);
      });
  }
};

}

TEST(CommonPoint, TheInsideOfATetrahedronIsFoundAndNothingBeyondIt)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto point = [&]
  { return Row(coordinate(random), coordinate(random), coordinate(random)); };
  for (int k = 0; k < 300; ++k)
  {
    const Row a = point(), b = point(), c = point();
    // Down to slivers.
    const Row d = k % 3 == 0 ? point() : Row((a + b + c) / 3 + std::pow(10., -k % 13) * point());
    std::vector<HalfSpace> faces = inside(a, b, c, d);
    for (const HalfSpace& face : faces)
    {
      ASSERT_GT(room(face, (a + b + c + d) / 4), 0) << k;
    }
    EXPECT_TRUE(haveCommonPoint(faces)) << k;
    // A half-space just beyond the corner that is opposite to a face leaves nothing.
    Row out = (c - b).cross(d - b).normalized();
    out *= out.dot(a - b) > 0 ? 1 : -1;
    const Row u = out.unitOrthogonal(), v = out.cross(u);
    HalfSpace beyond = { a + 1e-9 * out, a + 1e-9 * out + u, a + 1e-9 * out + v };
    const bool turn = room(beyond, a + out) <= 0;
    std::swap(beyond[0], beyond[turn ? 1 : 0]);
    faces.push_back(beyond);
    EXPECT_FALSE(haveCommonPoint(faces)) << k;
  }
}

TEST(CommonPoint, IsDecidedExactlyAtTheBorder)
{
  // Two half-spaces that share a plane have nothing in common; moved apart by one rounding they
  // have.
  const auto slab = [](double low, double high)
  {
    return std::vector<HalfSpace>{ { Row(0, 0, low), Row(0, 1, low), Row(1, 0, low) },
      { Row(0, 0, high), Row(1, 0, high), Row(0, 1, high) } };
  };
  ASSERT_GT(room(slab(1, 2)[0], Row(0, 0, 1.5)), 0);
  ASSERT_GT(room(slab(1, 2)[1], Row(0, 0, 1.5)), 0);
  EXPECT_TRUE(haveCommonPoint(slab(1, 2)));
  EXPECT_FALSE(haveCommonPoint(slab(1, 1)));
  EXPECT_TRUE(haveCommonPoint(slab(1, std::nextafter(1., 2.))));
  EXPECT_FALSE(haveCommonPoint(slab(std::nextafter(1., 2.), 1)));
  EXPECT_TRUE(haveCommonPoint({}));
  EXPECT_TRUE(haveCommonPoint(slab(1, std::nan(""))));
}

TEST(BoundaryCheck, ANodeWithoutAPlaceIsNamed)
{
  Block block;
  EXPECT_TRUE(block.at([](const Row& x) { return x; }).all().empty());
  EXPECT_TRUE(block.at(motions::affine).all().empty());

  // The middle of one side goes past the middle of the opposite one: each cell's own corners stay
  // right, and no place of the center is on the inner side of both.
  const ForbiddenCells sides = block.at(
    [](const Row& x) {
      return x == Row(0, 1, 1) ? Row(1.2, 1, 1) : x == Row(2, 1, 1) ? Row(0.8, 1, 1) : x;
    });
  ASSERT_FALSE(sides.all().empty());

  // One cell alone: its only free node is the center, and its corner goes so far that three sides
  // look away from each other.
  const ForbiddenCells corner =
    block.at([](const Row& x) { return x.norm() == 0 ? Row(1.5, 1.5, 1.5) : x; });
  EXPECT_EQ(corner.determined, std::vector<Index>{ 0 });
}

TEST(BoundaryCheck, AgreesWithASearchForThePlace)
{
  // The center's place is searched by brute force; where the check forbids there is none.
  std::mt19937 random(meshes::seed());
  int forbidden = 0, allowed = 0;
  for (int round = 0; round < 60; ++round)
  {
    Block block;
    const double amount = round % 2 == 0 ? 0.9 : 0.4;
    std::uniform_real_distribution<double> jitter(-amount, amount);
    Points points = block.mesh.points;
    Points boundary(static_cast<Index>(block.partition.prescribed.size()), 3);
    for (Index i = 0; i < boundary.rows(); ++i)
    {
      const Row x = block.mesh.points.row(block.partition.prescribed[i]);
      // The middles of sides move, so no corner that is all prescribed can.
      const bool middle = ((x.array() == 1).count() == 2);
      boundary.row(i) = middle ? Row(x + Row(jitter(random), jitter(random), jitter(random))) : x;
      points.row(block.partition.prescribed[i]) = boundary.row(i);
    }
    const ForbiddenCells found =
      BoundaryCheck(block.mesh, block.partition, block.sides, block.faces, block.monitor)
        .at(boundary);
    const bool isForbidden = !found.determined.empty() || !found.withoutPlace.empty();
    ASSERT_EQ(block.partition.free.size(), 1u);
    bool hasPlace = false;
    std::uniform_real_distribution<double> place(0, 2);
    for (int k = 0; k < 3000 && !hasPlace; ++k)
    {
      points.row(block.partition.free[0]) = Row(place(random), place(random), place(random));
      const Quality quality = measureQuality(block.mesh, points, block.sides, {}, block.monitor);
      hasPlace = quality.minimum > 0;
    }
    EXPECT_FALSE(isForbidden && hasPlace) << round;
    forbidden += isForbidden;
    allowed += hasPlace;
  }
  EXPECT_GT(forbidden, 5);
  EXPECT_GT(allowed, 5);
}

TEST(SubSteps, EndBeforeAFoldWithoutMorphsInVain)
{
  const Bent bent;
  meshes::ThreadedMonitor monitor;
  const BoundaryFaces faces = boundaryFaces(bent.mesh, monitor);
  const BoundaryCheck check(bent.mesh, bent.partition, bent.sides, faces, monitor);
  const Points target = bent.target(-1);
  const BoundaryPath path = straightPath(bent.mesh.points, bent.partition, target);
  SubStepLimits limits;
  limits.forbidden = [&](double time) { return check.at(path(time)).all(); };
  const auto make = [] { return std::make_unique<InversionFree>(); };
  const SubStepResult result = morphIncrementally(
    bent.mesh, bent.mesh.points, bent.partition, bent.sides, {}, path, make, limits, monitor);
  EXPECT_TRUE(result.isForbidden);
  EXPECT_LE(result.attempts, 2);
  EXPECT_GT(result.reached, 0.3);
  EXPECT_LT(result.reached, 1);
  EXPECT_EQ(result.inverted, limits.forbidden(result.reached + limits.least));
  EXPECT_FALSE(result.inverted.empty());
  EXPECT_TRUE(invertedCells(bent.mesh, result.moved, bent.sides, monitor).empty());

  limits.forbidden = nullptr;
  const SubStepResult blind = morphIncrementally(
    bent.mesh, bent.mesh.points, bent.partition, bent.sides, {}, path,
    [] { return std::make_unique<FemWarp>(); }, limits, monitor);
  EXPECT_LE(blind.reached, result.reached + limits.least);
  EXPECT_LE(blind.failures, limits.failures);
  EXPECT_FALSE(blind.isForbidden);
}

TEST(InversionFree, GivesUpOnAFoldedBoundaryAfterAFewTimesTheStepsOfAMorph)
{
  // Bounded by work, not by a clock: a morph that succeeds, and one that cannot, of the same mesh.
  const Bent bent;
  Index steps[2], evaluations[2];
  for (const int impossible : { 0, 1 })
  {
    meshes::ThreadedMonitor monitor;
    InversionFree method;
    method.prepare(bent.mesh, bent.partition, monitor);
    Points moved;
    const EvaluateReport report = method.evaluate(bent.target(impossible ? -1 : 1), moved, monitor);
    EXPECT_EQ(motions::count(report, "Untangled"), 1 - impossible);
    steps[impossible] = motions::count(report, "NewtonSteps");
    evaluations[impossible] = motions::count(report, "EnergyEvaluations");
  }
  EXPECT_LE(steps[1], 200) << "a morph that succeeds: " << steps[0];
  EXPECT_LE(evaluations[1], 400) << "a morph that succeeds: " << evaluations[0];
}
