// SPDX-License-Identifier: BSD-3-Clause
#include "DirectSolutions.h"
#include "Meshes.h"
#include "Motions.h"

#include "BoundaryMorphing/SurfaceResidual.h"
#include "Support/Error.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <limits>

using namespace morph;
using motions::difference;
using motions::identical;
using motions::mapped;

namespace
{
constexpr double Pi = 3.14159265358979323846;

using Motion = std::function<Eigen::RowVector3d(const Eigen::RowVector3d&)>;

/// A rotation, a scale and a shift.
Eigen::RowVector3d similar(const Eigen::RowVector3d& x)
{
  static const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(2.4, Eigen::Vector3d(1, .3, -2).normalized()).toRotationMatrix();
  return 1.7 * x * turn + Eigen::RowVector3d(3, -2, 5);
}

Eigen::RowVector3d bent(const Eigen::RowVector3d& x)
{
  return { x[0] + .2 * std::sin(x[1]), x[1] + .1 * x[0] * x[0], x[2] + .3 * std::cos(x[0]) };
}

struct Surface
{
  Points prescribed, points;
  SurfaceResidual::Loops loops;
};

/// A disc of radius 2 with a hole of radius 1; the points between the circles are raised to a dome
/// of height `rise`.
Surface annulus(double rise, bool withLoops)
{
  constexpr int Around = 24;
  Surface s;
  s.prescribed.resize(2 * Around, 3);
  s.loops.resize(2);
  s.points.resize(3 * Around, 3);
  for (int i = 0; i < Around; ++i)
  {
    const double a = 2 * Pi * i / Around;
    const Eigen::RowVector3d out(std::cos(a), std::sin(a), 0);
    s.prescribed.row(i) = 2 * out;
    s.prescribed.row(Around + i) = out;
    s.loops[0].push_back(i);
    s.loops[1].push_back(2 * Around - 1 - i); // the hole is clockwise
    for (int j = 0; j < 3; ++j)
    {
      s.points.row(3 * i + j) =
        (1.25 + .25 * j) * out + Eigen::RowVector3d(0, 0, rise * (1 + j % 2));
    }
  }
  if (!withLoops)
  {
    s.loops.clear();
  }
  return s;
}

/// A quarter of a cylinder's side: its four edges prescribed, which do not lie in a plane.
Surface shell()
{
  constexpr int N = 8;
  Surface s;
  std::vector<Eigen::RowVector3d> edges, inner;
  for (int i = 0; i <= N; ++i)
  {
    for (int j = 0; j <= N; ++j)
    {
      const double a = Pi / 2 * i / N;
      const bool edge = i == 0 || j == 0 || i == N || j == N;
      (edge ? edges : inner).push_back({ std::cos(a), std::sin(a), 2. * j / N });
    }
  }
  const auto pack = [](const std::vector<Eigen::RowVector3d>& from)
  {
    Points to(static_cast<Index>(from.size()), 3);
    for (Index i = 0; i < to.rows(); ++i)
    {
      to.row(i) = from[i];
    }
    return to;
  };
  s.prescribed = pack(edges);
  s.points = pack(inner);
  return s;
}

std::vector<Surface> surfaces()
{
  return { annulus(0, false), annulus(0, true), annulus(.3, false), annulus(.3, true), shell() };
}

struct Outcome
{
  Points moved;
  bool isReplaced;
};

Outcome morphed(const Surface& s, const Points& target, Index neighbors = 20, int threads = 1)
{
  meshes::ThreadedMonitor monitor(threads);
  SurfaceResidual method;
  method.setNumberOfNeighbors(neighbors);
  method.prepare(s.prescribed, s.points, s.loops, monitor);
  Outcome result;
  result.isReplaced = method.evaluate(target, result.moved, monitor);
  return result;
}

}

TEST(SurfaceResidual, NoMotionIsTheIdentityBitForBit)
{
  for (const Surface& s : surfaces())
  {
    const Outcome result = morphed(s, s.prescribed);
    EXPECT_TRUE(identical(result.moved, s.points));
    EXPECT_FALSE(result.isReplaced);
  }
}

TEST(SurfaceResidual, SimilarMotionsAreExactOffThePlaneToo)
{
  for (const Surface& s : surfaces())
  {
    const Outcome result = morphed(s, mapped(s.prescribed, similar));
    EXPECT_LT(difference(result.moved, mapped(s.points, similar)), 1e-12);
    EXPECT_FALSE(result.isReplaced);
  }
  // Half a turn about an axis in the plane turns the dome over, whatever shows the plane's side.
  for (bool loops : { false, true })
  {
    const Surface s = annulus(.3, loops);
    const auto over = [](const Eigen::RowVector3d& x) -> Eigen::RowVector3d {
      return { -x[0], x[1], -x[2] };
    };
    EXPECT_LT(
      difference(morphed(s, mapped(s.prescribed, over)).moved, mapped(s.points, over)), 1e-13);
  }
}

TEST(SurfaceResidual, AffineMotionsAreExactWhereTheyAreDetermined)
{
  for (bool loops : { false, true })
  {
    const Surface flat = annulus(0, loops);
    const Outcome result = morphed(flat, mapped(flat.prescribed, motions::affine));
    EXPECT_FALSE(result.isReplaced);
    EXPECT_LT(difference(result.moved, mapped(flat.points, motions::affine)), 1e-12);
  }
  const Surface s = shell();
  const Outcome result = morphed(s, mapped(s.prescribed, motions::affine));
  EXPECT_FALSE(result.isReplaced);
  EXPECT_LT(difference(result.moved, mapped(s.points, motions::affine)), 1e-12);
}

TEST(SurfaceResidual, DomesKeepTheirShapeAboveAStretchedPlane)
{
  const double rise = .3;
  const auto stretched = [](const Eigen::RowVector3d& x) -> Eigen::RowVector3d {
    return { 3 * x[0], 3 * x[1] + 1, 7 };
  };
  for (bool loops : { false, true })
  {
    const Surface s = annulus(rise, loops);
    const Points moved = morphed(s, mapped(s.prescribed, stretched)).moved;
    for (Index i = 0; i < moved.rows(); ++i)
    {
      EXPECT_NEAR(
        moved(i, 2), 7 + 3 * s.points(i, 2), 1e-12); // areas grow ninefold, lengths threefold
    }
  }
}

TEST(SurfaceResidual, AgreesWithTheEquationsWrittenOut)
{
  // Positions, prescribed points in space: nothing shared with the library.
  const Surface s = shell();
  const Points target = mapped(s.prescribed, bent);
  Eigen::MatrixXd columns(s.prescribed.rows(), 4);
  columns << s.prescribed, Eigen::VectorXd::Ones(s.prescribed.rows());
  const Eigen::MatrixXd gamma = direct::leastSquares(columns, target);
  const Eigen::MatrixXd residual = target - direct::product(columns, gamma);
  for (Index neighbors : { 20, 100 })
  {
    const Points moved = morphed(s, target, neighbors).moved;
    for (Index i = 0; i < s.points.rows(); ++i)
    {
      std::vector<std::pair<double, Index>> near;
      for (Index k = 0; k < s.prescribed.rows(); ++k)
      {
        near.emplace_back((s.prescribed.row(k) - s.points.row(i)).squaredNorm(), k);
      }
      std::sort(near.begin(), near.end());
      const Index last = std::min<Index>(neighbors, s.prescribed.rows());
      if (last < s.prescribed.rows() && near[last].first - near[last - 1].first < 1e-12)
      {
        continue; // a tie that rounding decides
      }
      near.resize(last);
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      double weights = 0;
      for (const auto& [square, k] : near)
      {
        sum += residual.row(k) / square;
        weights += 1 / square;
      }
      Eigen::RowVector4d extended;
      extended << s.points.row(i), 1;
      EXPECT_LT((moved.row(i) - extended * gamma - sum / weights).norm(), 1e-12) << i;
    }
  }
}

TEST(SurfaceResidual, RigidMotionAndScaleOfTheRestSurfaceDoNotMatter)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> shift(-.02, .02);
  for (Surface s : surfaces())
  {
    s.points = s.points.unaryExpr([&](double v) { return v + shift(random); }); // no ties
    const Points target = mapped(s.prescribed, bent);
    const Points expected = mapped(morphed(s, target).moved, similar);
    Surface elsewhere = s;
    elsewhere.prescribed = mapped(s.prescribed, similar);
    elsewhere.points = mapped(s.points, similar);
    EXPECT_LT(difference(morphed(elsewhere, mapped(target, similar)).moved, expected), 1e-11);
  }
}

TEST(SurfaceResidual, RenumberingAndThreadsDoNotShow)
{
  for (const Surface& s : surfaces())
  {
    const Points target = mapped(s.prescribed, bent);
    const Points reference = morphed(s, target).moved;
    EXPECT_TRUE(identical(morphed(s, target, 20, 3).moved, reference));
    Surface reversed = s;
    reversed.prescribed = s.prescribed.colwise().reverse();
    reversed.points = s.points.colwise().reverse();
    for (std::vector<Index>& loop : reversed.loops)
    {
      for (Index& row : loop)
      {
        row = s.prescribed.rows() - 1 - row;
      }
    }
    const Points back = morphed(reversed, target.colwise().reverse()).moved.colwise().reverse();
    EXPECT_LT(difference(back, reference), 1e-14);
  }
}

TEST(SurfaceResidual, ReflectedBoundariesGetASimilarity)
{
  const Surface s = shell();
  const auto mirrored = [](const Eigen::RowVector3d& x) -> Eigen::RowVector3d {
    return { 2 * x[0], 2 * x[1], -2 * x[2] };
  };
  const Points target = mapped(s.prescribed, mirrored);
  const Outcome result = morphed(s, target);
  EXPECT_TRUE(result.isReplaced);
  EXPECT_TRUE(result.moved.allFinite());
  // The residuals bring points near the edges back to them.
  EXPECT_LT(meshes::size(result.moved), 1.5 * meshes::size(target));

  // In a plane a mirror image is half a turn: nothing reflects, with loops or without.
  const Surface flat = annulus(.3, true);
  Points swapped = flat.prescribed;
  swapped.col(1) *= -1;
  EXPECT_FALSE(morphed(flat, swapped).isReplaced);
  EXPECT_FALSE(morphed(annulus(.3, false), swapped).isReplaced);
  // Only the rim is reversed, and it is the only loop: normal and affine map disagree.
  Surface partly = annulus(.3, true);
  partly.loops.resize(1);
  partly.prescribed.bottomRows(24) *= 1.9;
  Points rim = partly.prescribed;
  rim.topRows(24).col(1) *= -.5;
  const Outcome torn = morphed(partly, rim);
  EXPECT_TRUE(torn.isReplaced);

  // Everything onto a line, and into a point.
  for (int columns : { 2, 3 })
  {
    Points collapsed = flat.prescribed;
    collapsed.leftCols(columns).setZero();
    const Outcome outcome = morphed(flat, collapsed);
    EXPECT_TRUE(outcome.isReplaced);
    EXPECT_TRUE(outcome.moved.allFinite());
  }
}

TEST(SurfaceResidual, LinesAndSinglePlacesTranslate)
{
  Surface s = annulus(0, false);
  const auto shifted = [](const Eigen::RowVector3d& x) -> Eigen::RowVector3d {
    return { x[0] + 2, x[1] - 1, x[2] + 4 };
  };
  for (int kept : { 1, 0 })
  {
    s.prescribed.rightCols(3 - kept).setZero();
    const Outcome result = morphed(s, mapped(s.prescribed, shifted));
    EXPECT_FALSE(result.isReplaced);
    EXPECT_LT(difference(result.moved, mapped(s.points, shifted)), 1e-13);
  }
}

TEST(SurfaceResidual, PointsAtAPrescribedPlaceGoWithIt)
{
  Surface s = annulus(0, true);
  s.points.row(5) = s.prescribed.row(17);
  const Points target = mapped(s.prescribed, bent);
  const Points moved = morphed(s, target).moved;
  EXPECT_LT((moved.row(5) - target.row(17)).norm(), 1e-13);
  s.points.resize(0, 3);
  EXPECT_EQ(morphed(s, target).moved.rows(), 0);
}

TEST(SurfaceResidual, RefusesWhatItCannotUse)
{
  const Surface s = annulus(0, true);
  Monitor monitor;
  SurfaceResidual method;
  Points moved = Points::Constant(1, 3, 5);
  EXPECT_THROW(method.setNumberOfNeighbors(0), Error);
  EXPECT_THROW(method.evaluate(s.prescribed, moved, monitor), Error); // not prepared
  method.prepare(s.prescribed, s.points, s.loops, monitor);
  EXPECT_THROW(method.evaluate(s.prescribed.topRows(4), moved, monitor), Error);
  Points wrong = s.prescribed;
  wrong(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(method.evaluate(wrong, moved, monitor), Error);
  EXPECT_EQ(moved, Points::Constant(1, 3, 5));

  EXPECT_THROW(method.prepare(wrong, s.points, {}, monitor), Error);
  EXPECT_THROW(method.evaluate(s.prescribed, moved, monitor), Error); // the last prepare failed
  EXPECT_THROW(method.prepare(s.prescribed, wrong, {}, monitor), Error);
  EXPECT_THROW(method.prepare(Points(0, 3), s.points, {}, monitor), Error);
  EXPECT_THROW(method.prepare(s.prescribed, s.points, { { 0, 1 } }, monitor), Error);
  EXPECT_THROW(method.prepare(s.prescribed, s.points, { { 0, 1, 48 } }, monitor), Error);
  EXPECT_THROW(method.prepare(s.prescribed, s.points, { { 0, 1, -1 } }, monitor), Error);
}

TEST(SurfaceResidual, ItsLinearPartIsAllOfItOnPlanesAndShells)
{
  meshes::ThreadedMonitor monitor;
  const auto difference = [&](const Surface& surface, const Motion& motion)
  {
    SurfaceResidual method;
    method.prepare(surface.prescribed, surface.points, surface.loops, monitor);
    const Points target = mapped(surface.prescribed, motion);
    Points whole, linear;
    method.evaluate(target, whole, monitor);
    method.evaluateLinear(target - surface.prescribed, linear, monitor);
    return (surface.points + linear - whole).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(difference(annulus(0, true), bent), 1e-14);
  EXPECT_LT(difference(annulus(0, false), motions::affine), 1e-14);
  EXPECT_LT(difference(shell(), bent), 1e-14);
  // The normal of a dome turns with its rim, unless the rim is shifted alone.
  const auto shifted = [](const Eigen::RowVector3d& x) -> Eigen::RowVector3d
  { return x + Eigen::RowVector3d(1, -2, 3); };
  EXPECT_LT(difference(annulus(0.5, true), shifted), 1e-14);
  EXPECT_GT(difference(annulus(0.5, true), motions::affine), 0.01);

  SurfaceResidual method;
  Points moved;
  EXPECT_THROW(method.evaluateLinear(Points::Zero(3, 3), moved, monitor), Error);
  const Surface one = shell();
  method.prepare(one.prescribed, one.points, one.loops, monitor);
  const Points two = Points::Random(one.prescribed.rows(), 3);
  Points a, b, sum;
  method.evaluateLinear(two, a, monitor);
  method.evaluateLinear(one.prescribed, b, monitor);
  method.evaluateLinear(two - 3 * one.prescribed, sum, monitor);
  EXPECT_LT((sum - (a - 3 * b)).cwiseAbs().maxCoeff(), 1e-13);
}
