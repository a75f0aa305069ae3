// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/LogBarrierWeights.h"

#include "Meshes.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace morph;
using Place = LogBarrierWeights::Place;

namespace
{
struct Outcome
{
  Place place;
  int iterations;
  Eigen::VectorXd w;
};

Outcome weightsOf(const Points& d)
{
  LogBarrierWeights solver;
  Outcome result;
  result.w = Eigen::VectorXd::Constant(d.rows(), -7);
  const auto* rows = reinterpret_cast<const double(*)[3]>(d.data());
  const LogBarrierWeights::Result found =
    solver.compute(rows, static_cast<int>(d.rows()), result.w.data());
  result.place = found.place;
  result.iterations = found.iterations;
  return result;
}

double residual(const Points& d, const Eigen::VectorXd& w)
{
  return (w.transpose() * d).norm() / d.rowwise().norm().maxCoeff();
}

/// Neighbors all round: the first four in four octants of a tetrahedron, the others anywhere.
Points neighborhood(int k, std::mt19937& random)
{
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> value(-1, 1);
  Points d(k, 3);
  d = d.unaryExpr([&](double) { return normal(random); });
  for (int c = 0; c < 4; ++c) // a tetrahedron around the node, so that it lies inside
  {
    d.row(c) = Eigen::RowVector3d(c & 1 ? 1 : -1, c & 2 ? 1 : -1, (c == 0 || c == 3) ? 1 : -1) +
               0.3 * Eigen::RowVector3d(value(random), value(random), value(random));
  }
  return d;
}

/// max sum log w_j by Newton's method on the weights themselves, with the constraints as equations:
/// another way to the same numbers.
Eigen::VectorXd primal(const Points& d)
{
  const Eigen::Index k = d.rows();
  Eigen::MatrixXd A(4, k);
  A.row(0).setOnes();
  A.bottomRows(3) = d.transpose();
  Eigen::Vector4d b(1, 0, 0, 0);
  Eigen::VectorXd w = Eigen::VectorXd::Constant(k, 1. / static_cast<double>(k));
  Eigen::Vector4d multiplier = Eigen::Vector4d::Zero();
  // Infeasible-start Newton with backtracking on the norm of all residuals.
  const auto norm = [&](const Eigen::VectorXd& x, const Eigen::Vector4d& l)
  { return std::hypot((A.transpose() * l - x.cwiseInverse()).norm(), (A * x - b).norm()); };
  for (int i = 0; i < 200 && norm(w, multiplier) > 1e-13; ++i)
  {
    const Eigen::VectorXd w2 = w.cwiseAbs2();
    const Eigen::VectorXd dual = A.transpose() * multiplier - w.cwiseInverse();
    const Eigen::Vector4d step =
      (A * w2.asDiagonal() * A.transpose()).ldlt().solve(A * w - b - A * w2.cwiseProduct(dual));
    const Eigen::VectorXd dw = -w2.cwiseProduct(dual + A.transpose() * step);
    double t = 1;
    while ((w + t * dw).minCoeff() <= 0 ||
           norm(w + t * dw, multiplier + t * step) > (1 - 0.1 * t) * norm(w, multiplier))
    {
      t /= 2;
      if (t < 1e-12)
      {
        return w;
      }
    }
    w += t * dw;
    multiplier += t * step;
  }
  return w;
}

Points lattice(bool lower)
{
  Points d(lower ? 26 : 17, 3);
  Eigen::Index row = 0;
  for (int z = lower ? -1 : 0; z <= 1; ++z)
  {
    for (int y = -1; y <= 1; ++y)
    {
      for (int x = -1; x <= 1; ++x)
      {
        if (x || y || z)
        {
          d.row(row++) = Eigen::RowVector3d(x, y, z);
        }
      }
    }
  }
  return d;
}
}

TEST(LogBarrierWeights, TakeFewStepsInMeshes)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> shift(-0.25, 0.25);
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (int trial = 0; trial < 200; ++trial)
  {
    const Eigen::RowVector3d edges(1, trial % 2 ? 1 : .03, trial % 2 ? 1 : 1e-4);
    const Points shifted = lattice(true).unaryExpr([&](double x) { return x + shift(random); });
    const Outcome found = weightsOf(shifted * edges.asDiagonal() * turn);
    ASSERT_EQ(found.place, Place::Inside) << trial;
    EXPECT_GE(found.iterations, 1) << trial;
    EXPECT_LE(found.iterations, 12) << trial;
  }
}

TEST(LogBarrierWeights, PlaceTheNodeExactly)
{
  std::mt19937 random(meshes::seed());
  for (int k = 4; k < 60; ++k)
  {
    const Points d = neighborhood(k, random);
    const Outcome found = weightsOf(d);
    ASSERT_EQ(found.place, Place::Inside) << k;
    EXPECT_NEAR(found.w.sum(), 1, 1e-14) << k;
    EXPECT_GT(found.w.minCoeff(), 0) << k;
    EXPECT_LT(residual(d, found.w), 1e-12) << k;
    EXPECT_LE(found.iterations, 30) << k;
  }
}

TEST(LogBarrierWeights, MaximizeTheBarrier)
{
  std::mt19937 random(meshes::seed());
  for (int k = 5; k < 40; ++k)
  {
    const Points d = neighborhood(k, random);
    const Eigen::VectorXd expected = primal(d);
    EXPECT_LT((weightsOf(d).w - expected).cwiseAbs().maxCoeff(), 1e-9) << k;
  }
  // And no other weights do better: any direction that keeps the constraints goes down.
  const Points d = neighborhood(12, random);
  const Eigen::VectorXd w = weightsOf(d).w;
  Eigen::MatrixXd A(4, 12);
  A << Eigen::RowVectorXd::Ones(12), d.transpose();
  const Eigen::MatrixXd kernel = A.fullPivLu().kernel();
  ASSERT_EQ(kernel.cols(), 8);
  for (Eigen::Index c = 0; c < kernel.cols(); ++c)
  {
    for (double t : { -1e-4, 1e-4 })
    {
      const Eigen::VectorXd other = w + t * kernel.col(c) / kernel.col(c).norm();
      EXPECT_LT(other.array().log().sum(), w.array().log().sum());
    }
  }
}

TEST(LogBarrierWeights, SymmetricNeighborsWeighTheSame)
{
  const Outcome all = weightsOf(lattice(true));
  EXPECT_EQ(all.place, Place::Inside);
  EXPECT_LT((all.w.array() - 1. / 26).abs().maxCoeff(), 1e-16);
  Points octahedron(6, 3);
  octahedron << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
  EXPECT_LT((weightsOf(octahedron).w.array() - 1. / 6).abs().maxCoeff(), 1e-16);
}

TEST(LogBarrierWeights, OneDimensionHasItsClosedForm)
{
  // Two neighbors on a line and pairs across: the line's weights balance the lever.
  Points d(2, 3);
  d << 3, 0, 0, -1, 0, 0;
  const Outcome found = weightsOf(d);
  EXPECT_EQ(found.place, Place::Inside);
  EXPECT_NEAR(found.w[0], .25, 1e-14);
  EXPECT_NEAR(found.w[1], .75, 1e-14);
}

TEST(LogBarrierWeights, AspectRatiosDoNotShow)
{
  std::mt19937 random(meshes::seed());
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (double thin : { 1., 1e-2, 1e-4, 1e-7, 1e-9 })
  {
    for (int k : { 6, 14, 26, 27 })
    {
      const Points round = neighborhood(k, random);
      const Eigen::VectorXd expected = weightsOf(round).w;
      const Points flat = round * Eigen::Vector3d(1, std::sqrt(thin), thin).asDiagonal() * turn;
      const Outcome found = weightsOf(flat);
      ASSERT_EQ(found.place, Place::Inside) << thin << ' ' << k;
      EXPECT_LT(residual(flat, found.w), 1e-12) << thin << ' ' << k;
      // The barrier is invariant to affine maps; what rounding took from the thin direction is
      // gone.
      EXPECT_LT((found.w - expected).cwiseAbs().maxCoeff(), 1e-10 + 1e-14 / thin)
        << thin << ' ' << k;
      EXPECT_LE(found.iterations, 30) << thin << ' ' << k;
    }
  }
}

TEST(LogBarrierWeights, TheUnitOfLengthDoesNotShow)
{
  std::mt19937 random(meshes::seed());
  const Points d = neighborhood(20, random);
  const Eigen::VectorXd expected = weightsOf(d).w;
  for (double unit : { 1e-150, 1e-30, 1e40, 1e150 })
  {
    EXPECT_LT((weightsOf(unit * d).w - expected).cwiseAbs().maxCoeff(), 1e-13) << unit;
  }
}

TEST(LogBarrierWeights, FlatAndStraightNeighborhoods)
{
  std::mt19937 random(meshes::seed());
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  Points d = neighborhood(12, random);
  d.col(2).setZero();
  for (const Points& flat : { d, Points(d * turn) })
  {
    const Outcome found = weightsOf(flat);
    ASSERT_EQ(found.place, Place::Inside);
    EXPECT_GT(found.w.minCoeff(), 0);
    EXPECT_LT(residual(flat, found.w), 1e-12);
  }
  d.col(1).setZero();
  EXPECT_LT(residual(d * turn, weightsOf(d * turn).w), 1e-12);
}

TEST(LogBarrierWeights, OnAFaceOfTheHullTheLimitHolds)
{
  const Outcome half = weightsOf(lattice(false));
  ASSERT_EQ(half.place, Place::OnHull);
  for (int j = 0; j < 17; ++j)
  {
    EXPECT_NEAR(half.w[j], j < 8 ? 1. / 8 : 0, 1e-14) << j; // the plane z = 0 comes first
  }

  // An edge: half of that again.
  Points quarter(11, 3);
  Eigen::Index row = 0;
  for (Eigen::Index j = 0; j < 17; ++j)
  {
    if (lattice(false)(j, 1) >= 0)
    {
      quarter.row(row++) = lattice(false).row(j);
    }
  }
  ASSERT_EQ(row, 11);
  const Outcome edge = weightsOf(quarter);
  ASSERT_EQ(edge.place, Place::OnHull);
  for (Eigen::Index j = 0; j < 11; ++j)
  {
    const bool along = quarter(j, 1) == 0 && quarter(j, 2) == 0;
    EXPECT_NEAR(edge.w[j], along ? .5 : 0, 1e-14) << j;
  }

  // Irregular, and turned: in-plane neighbors alone carry the node.
  std::mt19937 random(meshes::seed());
  Points d = neighborhood(16, random);
  d.topRows(10).col(2).setZero();
  d.bottomRows(6).col(2) = d.bottomRows(6).col(2).cwiseAbs().array() + .1;
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Points turned = d * turn;
  const Outcome found = weightsOf(turned);
  ASSERT_EQ(found.place, Place::OnHull);
  EXPECT_LT(residual(turned, found.w), 1e-10);
  EXPECT_LT(found.w.tail(6).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LT(
    (found.w.head(10) - primal(d.topRows(10).leftCols(2).eval().rowwise().homogeneous().eval() *
                               Eigen::DiagonalMatrix<double, 3>(1, 1, 0)))
      .cwiseAbs()
      .maxCoeff(),
    1e-9);
}

TEST(LogBarrierWeights, NearTheHullTheyStillPlaceTheNode)
{
  for (double height : { 1e-1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-9 })
  {
    Points d = lattice(false);
    d.col(2).array() -= height; // the face passes just under the node
    const Outcome found = weightsOf(d);
    ASSERT_EQ(found.place, Place::Inside) << height;
    EXPECT_GT(found.w.minCoeff(), 0) << height;
    EXPECT_LT(residual(d, found.w), 1e-10) << height;
  }
}

TEST(LogBarrierWeights, OutsideTheHullThereAreNone)
{
  for (double height : { 1e-8, 1e-4, 1e-2, 1., 1e3 })
  {
    Points d = lattice(false);
    d.col(2).array() += height;
    EXPECT_EQ(weightsOf(d).place, Place::Outside) << height;
  }
  Points octant = lattice(false).cwiseAbs();
  octant.array() += .5;
  EXPECT_EQ(weightsOf(octant).place, Place::Outside);
  Points single(1, 3);
  single << 1, 2, 3;
  EXPECT_EQ(weightsOf(single).place, Place::Outside);
  EXPECT_EQ(weightsOf(Points(0, 3)).place, Place::Outside);
}

TEST(LogBarrierWeights, CoincidentNeighborsAreFine)
{
  Points d = lattice(true);
  d.row(3).setZero();
  d.row(4) = d.row(5);
  const Outcome found = weightsOf(d);
  EXPECT_EQ(found.place, Place::Inside);
  EXPECT_LT(residual(d, found.w), 1e-12);
  const Outcome point = weightsOf(Points::Zero(5, 3));
  EXPECT_EQ(point.place, Place::Inside);
  EXPECT_EQ(point.w, Eigen::VectorXd::Constant(5, .2));
}

TEST(LogBarrierWeights, WhatCameBeforeDoesNotShow)
{
  std::mt19937 random(meshes::seed());
  const Points small = neighborhood(7, random), large = neighborhood(40, random);
  LogBarrierWeights solver;
  Eigen::VectorXd w(40), fresh = weightsOf(small).w;
  solver.compute(reinterpret_cast<const double(*)[3]>(large.data()), 40, w.data());
  solver.compute(reinterpret_cast<const double(*)[3]>(small.data()), 7, w.data());
  EXPECT_EQ(w.head(7), fresh);
}
