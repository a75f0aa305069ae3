// SPDX-License-Identifier: BSD-3-Clause
// The parts of radial basis functions: kernels, their sums, order of the centers, factorisation.
#include "Meshes.h"
#include "Motions.h"

#include "Geometry/PointOrders.h"
#include "Interpolation/RadialInterpolant.h"
#include "Solvers/DenseCholesky.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace morph;

namespace
{
double kernelOf(const RadialKernel& kernel, double r)
{
  const double q = r / kernel.radius;
  switch (kernel.kind)
  {
    case RadialKernel::Kind::ThinPlate:
      return r > 0 ? r * r * std::log(r) : 0;
    case RadialKernel::Kind::WendlandC2:
      return q < 1 ? std::pow(1 - q, 4) * (4 * q + 1) : 0;
    default:
      return r * r * r;
  }
}

const RadialKernel Kernels[] = { { RadialKernel::Kind::Triharmonic },
  { RadialKernel::Kind::ThinPlate }, { RadialKernel::Kind::WendlandC2, 0.7 } };
}

TEST(RadialKernel, HasTheFormulasValues)
{
  for (const RadialKernel& kernel : Kernels)
  {
    for (const double r : { 0., 1e-200, 1e-8, 0.01, 0.3, 0.6999, 0.7, 1., 1.3, 3. })
    {
      const double expected = kernelOf(kernel, r);
      EXPECT_NEAR(kernel(r * r), expected, 1e-15 * (1 + std::abs(expected))) << r;
    }
  }
}

TEST(RadialKernel, SumsAreThoseOfPairs)
{
  std::mt19937 random(meshes::seed());
  // More than one block, and lanes without a target.
  const Points targets = meshes::randomPoints(133, random),
               strengths = meshes::randomPoints(57, random);
  Points sources = meshes::randomPoints(57, random);
  sources.row(3) = targets.row(9); // r = 0
  for (const RadialKernel& kernel : Kernels)
  {
    Points expected = Points::Zero(targets.rows(), 3), found;
    for (Index i = 0; i < targets.rows(); ++i)
    {
      for (Index j = 0; j < sources.rows(); ++j)
      {
        expected.row(i) +=
          kernelOf(kernel, (targets.row(i) - sources.row(j)).norm()) * strengths.row(j);
      }
    }
    meshes::ThreadedMonitor serial(1), parallel(3);
    kernelSums(kernel, targets, sources, strengths, found, serial);
    EXPECT_LT(motions::difference(found, expected), 1e-13);
    Points again;
    kernelSums(kernel, targets, sources, strengths, again, parallel);
    EXPECT_TRUE(motions::identical(found, again));
    // A target's sum does not depend on the others.
    kernelSums(kernel, targets.middleRows(17, 1), sources, strengths, again, serial);
    EXPECT_TRUE(motions::identical(found.middleRows(17, 1), again));
    kernelSums(kernel, targets, sources.topRows(0), strengths.topRows(0), again, serial);
    EXPECT_TRUE(again.isZero(0));
    EXPECT_EQ(again.rows(), targets.rows());
  }
}

TEST(FarthestPoints, EachIsTheFarthestFromThoseBefore)
{
  std::mt19937 random(meshes::seed());
  Points points = meshes::randomPoints(400, random);
  points.topRows(50) = points.row(60).replicate(50, 1); // at one place
  Monitor monitor;
  const FarthestPoints far = farthestPoints(points, monitor);
  ASSERT_EQ(far.order.size(), 400u);
  std::vector<Index> sorted = far.order;
  std::sort(sorted.begin(), sorted.end());
  for (Index i = 0; i < 400; ++i)
  {
    ASSERT_EQ(sorted[i], i);
  }
  Eigen::VectorXd distance =
    Eigen::VectorXd::Constant(400, std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < far.order.size(); ++k)
  {
    if (k > 0)
    {
      EXPECT_NEAR(far.distances[k], distance[far.order[k]], 1e-5); // of a tie the order is free
    }
    if (k >= 4)
    {
      EXPECT_LE(far.distances[k], distance.maxCoeff() + 1e-14);
      EXPECT_GE(far.distances[k], (1 - 2e-5) * distance.maxCoeff());
      EXPECT_TRUE(k == 4 || far.distances[k] <= far.distances[k - 1]);
    }
    distance =
      distance.cwiseMin((points.rowwise() - points.row(far.order[k])).rowwise().norm()).eval();
    distance[far.order[k]] = 0;
  }
}

TEST(FarthestPoints, TheFirstFourSpanSpaceIfAnyDo)
{
  Points points(1001, 3);
  for (Index i = 0; i < 1000; ++i) // a line, and one point beside it
  {
    points.row(i) << static_cast<double>(i), 0, 0;
  }
  points.row(1000) << 500, 1e-3, 0;
  points.conservativeResize(1002, 3);
  points.row(1001) << 300, 0, 1e-4;
  Monitor monitor;
  const FarthestPoints far = farthestPoints(points, monitor);
  EXPECT_EQ(far.order[2], 1000);
  EXPECT_EQ(far.order[3], 1001);
  EXPECT_TRUE(farthestPoints(Points(0, 3), monitor).order.empty());
  EXPECT_EQ(farthestPoints(points.topRows(1), monitor).order.size(), 1u);
  EXPECT_EQ(farthestPoints(points.topRows(3), monitor).order.size(), 3u);
}

TEST(DenseCholesky, IsTheFactorOfEigen)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> value(-1, 1);
  for (const Index n : { 0, 1, 95, 96, 97, 500 })
  {
    const Eigen::MatrixXd B =
      Eigen::MatrixXd(n, n).unaryExpr([&](double) { return value(random); });
    const Eigen::MatrixXd A = B * B.transpose() + Eigen::MatrixXd::Identity(n, n);
    Eigen::MatrixXd serial = A, parallel = A;
    serial.triangularView<Eigen::StrictlyUpper>().setConstant(std::nan("")); // not read
    meshes::ThreadedMonitor one(1), three(3);
    ASSERT_TRUE(factorizeCholesky(serial, one));
    ASSERT_TRUE(factorizeCholesky(parallel, three));
    const Eigen::MatrixXd L = serial.triangularView<Eigen::Lower>();
    const Eigen::MatrixXd other = parallel.triangularView<Eigen::Lower>();
    EXPECT_TRUE(L == other);
    EXPECT_LE((L * L.transpose() - A).norm(), 1e-13 * A.norm());
    Eigen::MatrixXd x = B.leftCols(std::min<Index>(3, n));
    const Eigen::MatrixXd b = x;
    solveCholesky(serial, x);
    EXPECT_LE((A * x - b).norm(), 1e-11 * b.norm());
  }
  Eigen::MatrixXd indefinite = Eigen::MatrixXd::Identity(300, 300);
  indefinite(250, 250) = -1e-9;
  Monitor monitor;
  EXPECT_FALSE(factorizeCholesky(indefinite, monitor));
}

TEST(CompactCorrection, MeetsTheResidualsAtItsSitesAndVanishesAtOthers)
{
  std::mt19937 random(meshes::seed());
  const Points points = meshes::randomPoints(300, random);
  meshes::ThreadedMonitor monitor(2);
  const FarthestPoints far = farthestPoints(points, monitor);
  const Points sites = meshes::rows(points, far.order);
  Points residuals = meshes::randomPoints(300, random), values = Points::Zero(300, 3);
  residuals.topRows(50).setZero();
  CompactCorrection correction;
  correction.prepare(sites, far.distances, 50, sites, monitor);
  EXPECT_GE(correction.numberOfLevels(), 2);
  correction.addTo(values, residuals, monitor);
  EXPECT_LT(motions::difference(values, residuals), 1e-12);

  const Points targets = meshes::randomPoints(200, random),
               gradient = meshes::randomPoints(200, random);
  correction.prepare(sites, far.distances, 50, targets, monitor);
  Points moved = Points::Zero(200, 3);
  correction.addTo(moved, residuals, monitor);
  const Points transposed = correction.transposed(gradient, monitor);
  EXPECT_TRUE(transposed.topRows(50).isZero(0));
  EXPECT_NEAR((gradient.array() * moved.array()).sum(),
    (transposed.array() * residuals.array()).sum(), 1e-11);

  correction.prepare(sites, far.distances, 300, targets, monitor);
  EXPECT_EQ(correction.numberOfLevels(), 0);
  moved.setOnes();
  correction.addTo(moved, Points::Zero(300, 3), monitor);
  EXPECT_TRUE(moved.isOnes(0));
}
