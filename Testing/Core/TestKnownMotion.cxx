// SPDX-License-Identifier: BSD-3-Clause
#include "ClassifiedShape.h"

#include "BoundaryMorphing/KnownMotion.h"
#include "BoundaryMorphing/SurfaceMorph.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace morph;
using shapes::Row;

namespace
{
/// A plate of n x n square holes, two cells wide and deep.
Mesh plateWithHoles(int n)
{
  return shapes::cut(meshes::hexes(4 * n + 2, 4 * n + 2, 2),
    [](const Row& x)
    {
      const auto isHole = [](double at) { return static_cast<int>(at - 2 + 4) % 4 < 2 && at > 2; };
      return !(isHole(x[0]) && isHole(x[1]));
    });
}

/// The vertices, and one node of `every` where that is above 0, moved at random.
struct Case : shapes::ClassifiedShape
{
  BoundaryMotion motion;

  explicit Case(const Mesh& m, std::size_t every = 7)
    : ClassifiedShape(m)
  {
    std::vector<Index> ids;
    for (std::size_t i = 0; i < this->faces.nodes.size(); ++i)
    {
      if ((every > 0 && i % every == every / 2) ||
          this->geometry.dimension[this->faces.nodes[i]] == 0)
      {
        ids.push_back(this->faces.nodes[i]);
      }
    }
    std::mt19937 random(meshes::seed());
    std::uniform_real_distribution<double> shift(-.3, .3);
    const Points targets =
      meshes::rows(this->mesh.points, ids).unaryExpr([&](double x) { return x + shift(random); });
    this->motion = beginMotion(this->mesh, this->faces, this->geometry, ids, targets);
  }

  /// The sets of KnownMotion::around(), node by node.
  std::vector<std::vector<Index>> setsAround(const GeometryCurve& curve) const
  {
    std::vector<std::vector<Index>> sets(3);
    const Index body = this->motion.bodyOfNode[curve.nodes[0]];
    for (Index node : this->motion.known())
    {
      const auto has = [node](const std::vector<Index>& nodes)
      { return std::find(nodes.begin(), nodes.end(), node) != nodes.end(); };
      const bool isBeside = std::any_of(curve.surfaces.begin(), curve.surfaces.end(),
        [&](Index s) { return has(this->geometry.surfaces[s].nodes); });
      const bool isIn[] = { has(curve.nodes), isBeside, this->motion.bodyOfNode[node] == body };
      for (int k = 0; k < 3; ++k)
      {
        if (isIn[k])
        {
          sets[k].push_back(node);
        }
      }
    }
    return sets;
  }
};

/// The fits' largest difference at the places `at`.
double difference(const MotionAround& a, const MotionAround& b, const Points& at)
{
  const auto fa = a.affineFit(), fb = b.affineFit();
  const auto ra = a.rigidFit(), rb = b.rigidFit();
  double worst = 0;
  for (Index i = 0; i < at.rows(); ++i)
  {
    const Row x = at.row(i);
    worst = std::max({ worst, (fa.displacement(x) - fb.displacement(x)).norm(),
      (ra.displacement(x) - rb.displacement(x)).norm() });
  }
  return worst;
}

/// The motion of one set, to move the places `at`.
MotionAround of(const MotionSums& sums, const Points& at)
{
  MotionAround around;
  if (!sums.empty())
  {
    around.add(sums, sums.directions(at), 1);
  }
  return around;
}

double difference(const MotionSums& a, const MotionSums& b, const Points& at)
{
  return difference(of(a, at), of(b, at), at);
}

/// Whether places lie in the affine span of some nodes.
bool holds(const Points& nodes, const Points& places)
{
  const Row center = nodes.colwise().mean();
  const Points arms = nodes.rowwise() - center;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(arms.transpose() * arms, Eigen::ComputeFullU);
  Points off = places.rowwise() - center;
  for (int j = 0; j < 3; ++j)
  {
    if (svd.singularValues()[j] > 1e-10 * svd.singularValues()[0])
    {
      off -= (off * svd.matrixU().col(j) * svd.matrixU().col(j).transpose()).eval();
    }
  }
  return off.rowwise().norm().maxCoeff() <= 1e-9;
}
}

TEST(KnownMotion, SumsOfPartsAreThoseOfTheWhole)
{
  const Case c(plateWithHoles(2));
  const std::vector<Index> ids = c.motion.known();
  std::vector<Index> first, second;
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    (i % 3 == 0 ? first : second).push_back(ids[i]);
  }
  MotionSums parts(c.motion, first);
  parts.add(MotionSums());
  parts.add(MotionSums(c.motion, second));
  MotionSums fromNothing;
  fromNothing.add(parts);
  const MotionSums whole(c.motion, ids);
  EXPECT_LE(difference(parts, whole, c.mesh.points), 1e-13);
  EXPECT_LE(difference(fromNothing, parts, c.mesh.points), 0);
  EXPECT_GT(difference(MotionSums(c.motion, first), whole, c.mesh.points), 1e-3);
}

TEST(KnownMotion, CurvesFollowTheFirstSetThatHoldsThem)
{
  Mesh arcs = meshes::hexes(4, 6, 3);
  meshes::transform(arcs,
    [](const Row& x)
    {
      const double a = x[1] * std::acos(0.) / 6, r = 1 + 0.25 * x[0];
      return Row(r * std::cos(a), r * std::sin(a), 0.3 * x[2]);
    });
  int second = 0;
  const std::vector<std::pair<Mesh, std::size_t>> cases = { { plateWithHoles(2), 7 },
    { plateWithHoles(2), 0 }, { arcs, 0 }, { shapes::boxWithHole(32, 4, 3), 40 },
    { shapes::together(shapes::cylinder(8, 4), meshes::tets(2, 2, 2)), 7 },
    { shapes::together(shapes::cylinder(8, 4), meshes::tets(2, 2, 2)), 0 },
    { shapes::creasedPlate(), 7 } };
  for (const auto& [mesh, every] : cases)
  {
    const Case c(mesh, every);
    KnownMotion known(c.geometry, c.motion);
    for (const GeometryCurve& curve : c.geometry.curves)
    {
      const std::vector<std::vector<Index>> sets = c.setsAround(curve);
      const Points places = meshes::rows(c.mesh.points, curve.nodes);
      MotionSums expected;
      for (std::size_t k = 0; k < sets.size(); ++k)
      {
        if (sets[k].empty())
        {
          continue;
        }
        expected = MotionSums(c.motion, sets[k]);
        if (holds(meshes::rows(c.mesh.points, sets[k]), places))
        {
          second += k == 1;
          break;
        }
      }
      EXPECT_LE(difference(known.around(curve), of(expected, places), places), 1e-11);
    }
  }
  EXPECT_GT(second, 0);
}

TEST(KnownMotion, CurvesCostWhatTheBoundaryDoesHoweverManyThereAre)
{
  std::vector<double> perNode;
  for (const int n : { 2, 4, 8 })
  {
    Case c(plateWithHoles(n));
    ASSERT_GE(c.geometry.curves.size(), 12u * n * n);
    Monitor monitor;
    const Index summed =
      morphCurves(c.geometry, UnattachedMotion::FollowAffinely, c.motion, monitor);
    perNode.push_back(static_cast<double>(summed) / static_cast<double>(c.faces.nodes.size()));
  }
  // Sets made for each curve would take four times as much for each node at every step.
  EXPECT_LE(perNode.back(), 1.5 * perNode.front());
  EXPECT_LE(perNode.back(), 2);
}
