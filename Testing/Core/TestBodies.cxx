// SPDX-License-Identifier: BSD-3-Clause
// Meshes of several bodies: what is asked of one does not move another.
#include "BoundaryMover/BoundaryMover.h"
#include "BoundaryShapes.h"
#include "LinearMethods.h"
#include "LinearMethods/FemWarp.h"
#include "Meshes.h"
#include "Motions.h"
#include "Session/Session.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

namespace
{
using namespace morph;
using motions::Row;

constexpr double Gap = 0.01;

/// Two cubes of 4 x 4 x 4 hexahedra, one above the other, with a gap between.
struct TwoCubes
{
  meshes::ThreadedMonitor monitor;
  morph::Mesh mesh = meshes::hexes(4, 4, 4);
  Index half = mesh.numberOfNodes(); ///< the first node of the upper one
  Session session;
  Session::Options options;
  std::vector<Index> ids;

  TwoCubes()
  {
    meshes::jitterInterior(this->mesh, 0.2, meshes::seed());
    morph::Mesh upper = this->mesh;
    meshes::transform(upper, [](const Row& x) { return Row(x + Row(0, 0, 4 + Gap)); });
    this->mesh = shapes::together(this->mesh, upper);
    this->ids = motions::outerPartition(this->mesh).prescribed;
    this->session.setMesh(this->mesh, this->monitor);
    this->options.createMorpher = [] { return std::make_unique<morph::FemWarp>(); };
  }
  Row motionOf(Index node, const Row& x) const
  {
    return node < this->half ? motions::affine(x) : Row(x[0], 2 * x[1], x[2] + x[0]);
  }
  Points places(const std::vector<Index>& nodes) const
  {
    Points result(static_cast<Index>(nodes.size()), 3);
    for (Index i = 0; i < result.rows(); ++i)
    {
      result.row(i) = this->motionOf(nodes[i], this->mesh.points.row(nodes[i]));
    }
    return result;
  }
  std::vector<Index> all() const
  {
    std::vector<Index> nodes(this->mesh.numberOfNodes());
    std::iota(nodes.begin(), nodes.end(), Index(0));
    return nodes;
  }
};

class Bodies : public testing::TestWithParam<meshes::LinearMethod>
{
};

TEST_P(Bodies, EachFollowsItsOwnAffineMotion)
{
  TwoCubes cubes;
  cubes.options.createMorpher = GetParam().make;
  const auto step =
    cubes.session.morph({ cubes.ids, cubes.places(cubes.ids) }, cubes.options, cubes.monitor);
  EXPECT_LT(motions::difference(step->moved, cubes.places(cubes.all())), 1e-8);
}

TEST_P(Bodies, TheAdjointOfOneDoesNotReachTheOther)
{
  TwoCubes cubes;
  cubes.options.createMorpher = GetParam().make;
  Points gradient = Points::Random(cubes.mesh.numberOfNodes(), 3);
  gradient.bottomRows(cubes.half).setZero();

  const Points derivative =
    cubes.session.transpose(cubes.ids, gradient, cubes.options, cubes.monitor);

  const Points targets = cubes.places(cubes.ids);
  const auto step = cubes.session.morph({ cubes.ids, targets }, cubes.options, cubes.monitor);
  const Points motion = targets - cubes.mesh.points(cubes.ids, morph::allColumns);
  const double change = gradient.cwiseProduct(step->moved - cubes.mesh.points).sum();
  EXPECT_NEAR(derivative.cwiseProduct(motion).sum(), change, 1e-7 * (1 + std::abs(change)));
  for (std::size_t i = 0; i < cubes.ids.size(); ++i)
  {
    EXPECT_TRUE(cubes.ids[i] < cubes.half || derivative.row(static_cast<Index>(i)).isZero(0));
  }
}

INSTANTIATE_TEST_SUITE_P(All, Bodies, testing::ValuesIn(meshes::linearMethods()),
  [](const auto& method) { return method.param.name; });

TEST(Bodies, OneOfWhichNothingIsAskedStays)
{
  TwoCubes cubes;
  std::vector<Index> ids = cubes.ids;
  ids.erase(std::lower_bound(ids.begin(), ids.end(), cubes.half), ids.end());

  const auto step = cubes.session.morph({ ids, cubes.places(ids) }, cubes.options, cubes.monitor);

  const Points upper = cubes.mesh.points.bottomRows(cubes.half);
  EXPECT_TRUE(motions::identical(step->moved.bottomRows(cubes.half), upper));
  ASSERT_EQ(cubes.monitor.warnings.size(), 1U);
  EXPECT_NE(cubes.monitor.warnings[0].find("125 nodes: node ids 125, 126"), std::string::npos)
    << cubes.monitor.warnings[0];
}

TEST(Bodies, IdsThatDoNotExistAreNamed)
{
  TwoCubes cubes;
  const Points target = Points::Zero(1, 3);
  motions::expectError(
    [&] {
      cubes.session.morph({ { 9999 }, target }, cubes.options, cubes.monitor);
    },
    "9999");
}

/// The boundary of bodies, of which the nodes that `isMoving` tells are moved by `map`.
struct MovedBoundary
{
  meshes::ThreadedMonitor monitor;
  morph::BoundaryModel model;
  morph::Choice choice;
  morph::BoundaryMover mover;
  morph::BoundaryMover::Options options;

  MovedBoundary(morph::Mesh mesh, const std::function<bool(Index node)>& isMoving)
  {
    this->model.mesh = std::move(mesh);
    this->model.findFaces(
      std::vector<std::uint8_t>(this->model.mesh.numberOfCells(), 0), this->monitor);
    this->model.geometry = morph::classify(this->model.mesh, this->model.faces, {}, this->monitor);
    this->model.takeSets({});
    std::vector<std::uint8_t> chosen(this->model.mesh.numberOfNodes(), 0);
    for (const Index node : this->model.faces.nodes)
    {
      chosen[node] = isMoving(node);
    }
    this->choice = morph::chooseNodes(this->model, chosen, {});
  }
  Points move(const motions::Map& map)
  {
    const Points targets =
      motions::mapped(this->model.points()(this->choice.moving, morph::allColumns), map);
    return this->mover
      .move(this->model, this->choice, targets, this->options, nullptr, this->monitor)
      .moved;
  }
};

TEST(Bodies, AMotionFadesWithinItsBody)
{
  const TwoCubes cubes;
  MovedBoundary boundary(cubes.mesh, [&](Index node) { return cubes.mesh.points(node, 2) == 4; });
  boundary.options.rest.how = morph::Surroundings::Kind::Fade;
  boundary.options.rest.radius = 3;

  const Points moved = boundary.move([](const Row& x) { return Row(x[0], x[1], x[2] + 0.3); });

  const Points upper = cubes.mesh.points.bottomRows(cubes.half);
  EXPECT_TRUE(motions::identical(moved.bottomRows(cubes.half), upper));
  EXPECT_GT(
    motions::difference(moved.topRows(cubes.half), cubes.mesh.points.topRows(cubes.half)), 0.29);
}

/// A box of hexahedra, 125 nodes, and a wider one of tetrahedra above it.
morph::Mesh tower(double gap)
{
  morph::Mesh upper = meshes::tets(3, 3, 3);
  meshes::transform(upper, [&](const Row& x) { return Row(x * 1.6 + Row(-0.4, -0.4, 4 + gap)); });
  return shapes::together(meshes::hexes(4, 4, 4), upper);
}

TEST(Bodies, ContactKeepsItsGapWhicheverSideTurns)
{
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const auto turned = [&](const Row& x) { return Row(x * turn.transpose()); };
  for (const double gap : { 0., Gap, -Gap })
  {
    for (const bool isLower : { true, false })
    {
      SCOPED_TRACE(testing::Message() << "gap " << gap << (isLower ? ", lower" : ", upper"));
      const morph::Mesh mesh = tower(gap);
      const auto isAsked = [&](Index node) { return (node < 125) == isLower; };
      MovedBoundary boundary(mesh, isAsked);
      boundary.options.contact.distance = 2 * Gap;

      const Points moved = boundary.move(turned);

      int followers = 0;
      for (const Index node : boundary.model.faces.nodes)
      {
        const Row x = mesh.points.row(node);
        if (!isAsked(node) && std::abs(x[2] - (isLower ? 4 + gap : 4)) < 1e-12 && x[0] >= 0 &&
            x[0] <= 4 && x[1] >= 0 && x[1] <= 4)
        {
          EXPECT_LT((moved.row(node) - turned(x)).norm(), 1e-12);
          ++followers;
        }
      }
      EXPECT_EQ(followers, isLower ? 4 : 25);
      if (!isLower) // else nodes below the sides of the wider box follow its other nodes
      {
        const morph::Contact::Gaps after = boundary.mover.contact().gaps(boundary.model, moved);
        EXPECT_NEAR(after.least, gap, 1e-12);
        EXPECT_NEAR(after.most, gap, 1e-12);
      }
    }
  }
}

TEST(Bodies, WithoutContactThatIsToldAndDistancesAreGiven)
{
  MovedBoundary boundary(tower(1), [](Index node) { return node < 125; });
  boundary.options.contact.distance = 0.5;
  motions::expectError(
    morph::Error::Kind::InvalidInput, [&] { boundary.move([](const Row& x) { return x; }); },
    "`ContactDistance` 0.5 of another body");
}
}
