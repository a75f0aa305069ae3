// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/CrossingFaces.h"
#include "BoundaryShapes.h"
#include "Meshes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>

namespace
{
using namespace morph;
using Row = Eigen::RowVector3d;
using Map = std::function<Row(const Row&)>;

Mesh mapped(Mesh mesh, const Map& map)
{
  meshes::transform(mesh, map);
  return mesh;
}

std::vector<std::array<Index, 2>> crossings(const Mesh& rest, const Points& moved, int threads = 1)
{
  meshes::ThreadedMonitor monitor(threads);
  const morph::BoundaryFaces faces = morph::boundaryFaces(rest, monitor);
  return morph::crossingFaces(
    rest.points, moved, faces, morph::cellSigns(rest, morph::connectedComponents(rest)), monitor);
}

/// The points with the first `count` of them moved.
Points moved(const Mesh& mesh, Index count, const Map& map)
{
  Points points = mesh.points;
  for (Index i = 0; i < count; ++i)
  {
    points.row(i) = map(points.row(i));
  }
  return points;
}

Map shift(double x, double y, double z)
{
  return [=](const Row& p) { return Row(p + Row(x, y, z)); };
}

TEST(CrossingFaces, OfTwoBodiesThatOverlapAndNotOfTwoThatTouch)
{
  // Both have one cross-section: their sides lie in one plane, and no edge passes through a face.
  for (const auto& [name, box] : meshes::all(2, 2, 2))
  {
    const Mesh both = shapes::together(box, mapped(box, shift(3, 0, 0)));
    for (const double way : { 0.5, 1., 1.25, 1.5, 2. })
    {
      const auto found = crossings(both, moved(both, box.numberOfNodes(), shift(way, 0, 0)));
      EXPECT_EQ(found.empty(), way <= 1) << name << ", " << way;
    }
  }
}

TEST(CrossingFaces, NotOfBodiesThatStayInContact)
{
  const Mesh box = meshes::hexes(3, 3, 3), finer = meshes::tets(4, 4, 4);
  const Mesh on = mapped(finer, [](const Row& p) { return Row(0.75 * p + Row(0, 0, 3)); });
  const Mesh both = shapes::together(shapes::together(box, on), mapped(box, shift(3, 0, 0)));
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> any(-1, 1);
  for (int i = 0; i < 20; ++i)
  {
    const Eigen::Vector4d q(any(random), any(random), any(random), any(random));
    const Eigen::Matrix3d turn = Eigen::Quaterniond(q.normalized()).matrix();
    const Row way = 100 * Row(any(random), any(random), any(random));
    const Mesh result = mapped(both, [&](const Row& p) { return Row(p * turn + way); });
    EXPECT_TRUE(crossings(both, result.points).empty());
  }
  // The one on top slides along the other two, from cell to cell.
  Points slid = both.points;
  slid.middleRows(box.numberOfNodes(), on.numberOfNodes()).rowwise() += Row(0.7, 0.3, 0);
  EXPECT_TRUE(crossings(both, slid).empty());
}

TEST(CrossingFaces, OfBodiesThatOverlapByLessThanACell)
{
  // They touch, or are a hundredth of a cell apart; one of them has other cells.
  for (const auto& [name, box] : meshes::all(2, 2, 2))
  {
    for (const double gap : { 0., 0.01 })
    {
      for (const double size : { 1., 0.6 })
      {
        const Mesh other = mapped(meshes::hexes(3, 3, 3),
          [&](const Row& p) { return Row(p * 2 * size / 3 + Row(2 + gap, 0.1, 0)); });
        const Mesh both = shapes::together(box, other);
        for (const double way : { -0.5, 0.5 * gap, gap + 0.06, gap + 0.1, gap + 0.5 })
        {
          const auto found = crossings(both, moved(both, box.numberOfNodes(), shift(way, 0, 0)));
          EXPECT_EQ(found.empty(), way <= gap) << name << ", " << gap << size << ", " << way;
        }
      }
    }
  }
}

TEST(CrossingFaces, NotOfAShaftThatTurnsInItsHole)
{
  // Of 32 and 20 facets, of one radius: they overlap by the height of the coarse ones.
  const auto ring = [](Index facets, double inner, double outer)
  {
    return mapped(meshes::hexes(facets, 2, 2),
      [=](const Row& p)
      {
        const double angle = 1.9 * M_PI * p[0] / static_cast<double>(facets);
        const double radius = inner + (outer - inner) * p[1] / 2;
        return Row(radius * std::cos(angle), radius * std::sin(angle), p[2]);
      });
  };
  for (const auto& [inside, outside] : { std::pair<Index, Index>(20, 32), { 32, 20 }, { 24, 24 } })
  {
    const Mesh shaft = ring(inside, 1, 2), both = shapes::together(shaft, ring(outside, 2, 3));
    const auto turn = [](double angle, double x)
    {
      return [=](const Row& p)
      {
        return Row(p[0] * std::cos(angle) - p[1] * std::sin(angle) + x,
          p[0] * std::sin(angle) + p[1] * std::cos(angle), p[2] + 0.1);
      };
    };
    for (const double angle : { 0.01, 0.1, 0.13, 1. })
    {
      EXPECT_TRUE(crossings(both, moved(both, shaft.numberOfNodes(), turn(angle, 0))).empty())
        << inside << ", " << outside << ", " << angle;
      EXPECT_FALSE(crossings(both, moved(both, shaft.numberOfNodes(), turn(angle, 0.3))).empty())
        << inside << ", " << outside << ", " << angle;
    }
  }
}

TEST(CrossingFaces, NotOfMatchingBodiesThatBendTogether)
{
  // Their faces have the same places, and other first corners.
  const Mesh box = meshes::hexes(4, 4, 2);
  const Mesh both =
    shapes::together(box, mapped(box, [](const Row& p) { return Row(p[1], 4 - p[0], p[2] + 2); }));
  const Mesh bent = mapped(both, [](const Row& p)
    { return Row(p + Row(0, 0, 0.3 * std::sin(p[0]) * std::cos(2 * p[1]) + 0.1 * p[0] * p[1])); });
  EXPECT_TRUE(crossings(both, bent.points).empty());
}

TEST(CrossingFaces, NotOfAnAffineMapOfBodiesInContact)
{
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> number(-1, 1);
  const Mesh box = meshes::hexes(1, 1, 1);
  const Mesh rest = shapes::together(box, mapped(box, shift(1, 0, 0)));
  for (int i = 0; i < 500; ++i)
  {
    Eigen::Matrix3d A;
    std::generate(A.data(), A.data() + 9, [&] { return number(engine); });
    A *= A.determinant() < 0 ? -1 : 1;
    const Points points =
      moved(rest, rest.numberOfNodes(), [&](const Row& x) { return Row(x * A + Row(3, -2, 1)); });
    EXPECT_TRUE(crossings(rest, points).empty()) << "seed 3, map " << i;
  }
}

TEST(CrossingFaces, NotOfPairsThatCrossedAtRest)
{
  const Mesh box = meshes::hexes(2, 2, 2);
  const Mesh both = shapes::together(box, mapped(box, shift(1.3, 0.2, 0.4)));
  const Mesh turned = mapped(both, [](const Row& p) { return Row(-p[1], p[0], p[2] + 7); });
  EXPECT_TRUE(crossings(both, both.points).empty());
  EXPECT_TRUE(crossings(both, turned.points).empty());
  EXPECT_FALSE(crossings(both, moved(both, box.numberOfNodes(), shift(0.5, 0.5, 0))).empty());
}

TEST(CrossingFaces, OfABodyWithItself)
{
  // A strip that is rolled up by a whole turn and more: its ends run through each other.
  const Mesh strip = meshes::hexes(40, 2, 1);
  const auto rolled = [&](double turns)
  {
    return mapped(strip,
      [&](const Row& p)
      {
        const double angle = 2 * M_PI * turns * p[0] / 40, radius = 20 / M_PI + p[2];
        return Row(radius * std::cos(angle), p[1], -radius * std::sin(angle));
      })
      .points;
  };
  EXPECT_TRUE(crossings(strip, rolled(0.95)).empty());
  EXPECT_FALSE(crossings(strip, rolled(1.06)).empty());
}

TEST(CrossingFaces, OfNeighborsAtANode)
{
  // A corner of a plate passes through a face that shares its other end.
  const Mesh plate = meshes::tets(2, 2, 1);
  const auto at = [&](const Row& place)
  {
    Index node = 0;
    (plate.points.rowwise() - place).rowwise().norm().minCoeff(&node);
    return node;
  };
  Points points = plate.points;
  points.row(at(Row(1, 1, 1))) = Row(1.1, 1.2, -0.5);
  EXPECT_FALSE(crossings(plate, points).empty());
}

struct OrientedBox
{
  Eigen::Matrix3d axes; ///< unit, in columns
  Eigen::Vector3d center, half;

  bool has(const Eigen::Vector3d& point) const
  {
    return ((this->axes.transpose() * (point - this->center)).cwiseAbs() - this->half).maxCoeff() <
           0;
  }
  Eigen::Vector3d corner(int i) const
  {
    return this->center + this->axes * this->half.cwiseProduct(Eigen::Vector3d(
                                         i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  }
};

/// How deep two boxes overlap; negative: how far apart they are at least.
double overlap(const OrientedBox& a, const OrientedBox& b)
{
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < 3; ++i)
  {
    directions.insert(directions.end(), { a.axes.col(i), b.axes.col(i) });
    for (int j = 0; j < 3; ++j)
    {
      const Eigen::Vector3d cross = a.axes.col(i).cross(b.axes.col(j));
      if (cross.norm() > 1e-6)
      {
        directions.push_back(cross.normalized());
      }
    }
  }
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& direction : directions)
  {
    const auto reach = [&](const OrientedBox& box)
    { return (box.axes.transpose() * direction).cwiseAbs().dot(box.half); };
    least = std::min(least, reach(a) + reach(b) - std::abs(direction.dot(a.center - b.center)));
  }
  return least;
}

bool isInside(const OrientedBox& a, const OrientedBox& b)
{
  bool all = true;
  for (int i = 0; i < 8; ++i)
  {
    all = all && b.has(a.corner(i));
  }
  return all;
}

TEST(CrossingFaces, AgreeWithSeparatingAxesForRandomBoxes)
{
  const auto kinds = meshes::all(2, 2, 2); // on [0, 2]^3
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> any(-1, 1);
  const auto randomBox = [&](double reach)
  {
    const Eigen::Vector4d q(any(random), any(random), any(random), any(random));
    OrientedBox box;
    box.axes = Eigen::Quaterniond(q.normalized()).matrix();
    box.center = reach * Eigen::Vector3d(any(random), any(random), any(random));
    box.half = Eigen::Vector3d(2 + any(random), 2 + any(random), 2 + any(random));
    return box;
  };
  int apart = 0, crossing = 0;
  for (int i = 0; i < 300; ++i)
  {
    const OrientedBox a = randomBox(3), b = randomBox(3);
    const double depth = overlap(a, b);
    if (std::abs(depth) < 0.02 || isInside(a, b) || isInside(b, a))
    {
      continue;
    }
    const Mesh &first = kinds[i % kinds.size()].second,
               &second = kinds[i / 3 % kinds.size()].second;
    const auto put = [](const Mesh& mesh, const OrientedBox& box)
    {
      return mapped(mesh,
        [&](const Row& p) -> Row
        {
          return (
            box.center + box.axes * box.half.cwiseProduct((p.array() - 1).matrix().transpose()))
            .transpose();
        });
    };
    const Mesh both = shapes::together(put(first, a), put(second, b));
    Mesh rest = both;
    rest.points.topRows(first.numberOfNodes()).rowwise() += Row(100, 0, 0);
    EXPECT_EQ(!crossings(rest, both.points).empty(), depth > 0)
      << "case " << i << ", overlap " << depth << ", " << kinds[i % kinds.size()].first;
    ++(depth > 0 ? crossing : apart);
  }
  EXPECT_GT(apart, 50);
  EXPECT_GT(crossing, 50);
}

TEST(CrossingFaces, DependNeitherOnThreadsNorOnNumbers)
{
  const Mesh box = meshes::hexes(6, 6, 6);
  const Mesh both = shapes::together(box, mapped(meshes::tets(5, 5, 5), shift(8, 0.3, 0.2)));
  const Points points = moved(both, box.numberOfNodes(), shift(4.1, 0, 0));
  const auto one = crossings(both, points, 1);
  EXPECT_FALSE(one.empty());
  EXPECT_EQ(crossings(both, points, 4), one);
  std::vector<Index> order(both.numberOfNodes());
  std::iota(order.begin(), order.end(), Index(0));
  std::shuffle(order.begin(), order.end(), std::mt19937(meshes::seed()));
  const Mesh other = meshes::renumbered(both, order);
  Points otherPoints = points;
  for (Index i = 0; i < points.rows(); ++i)
  {
    otherPoints.row(order[i]) = points.row(i);
  }
  EXPECT_EQ(crossings(other, otherPoints).size(), one.size());
}
}
