// SPDX-License-Identifier: BSD-3-Clause
// What is particular to radial basis functions; TestLinearMorphers.cxx has what they share with the
// other linear methods.
#include "BoundaryShapes.h"
#include "DirectSolutions.h"
#include "Meshes.h"
#include "Motions.h"

#include "LinearMethods/RadialBasis.h"
#include "Support/Error.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

using namespace morph;
using motions::bend;
using motions::difference;
using motions::Row;

namespace
{
using Kind = RadialKernel::Kind;

struct Options
{
  Kind kernel = Kind::Triharmonic;
  double radius = 1;
  Index centers = 0;
};

void configure(RadialBasis& method, const Options& options)
{
  method.setKernel(options.kernel);
  method.setSupportRadius(options.radius);
  method.setNumberOfCenters(options.centers);
}

Points morphed(const Mesh& mesh, const NodePartition& partition, const Options& options = {},
  double* residual = nullptr)
{
  meshes::ThreadedMonitor monitor(2);
  RadialBasis method;
  configure(method, options);
  Points result =
    motions::morphed(method, mesh, partition, motions::targets(mesh, partition, bend), monitor);
  if (residual)
  {
    *residual = method.largestResidual();
  }
  return result;
}

double kernelOf(Kind kind, double r, double radius)
{
  const double q = r / radius;
  switch (kind)
  {
    case Kind::ThinPlate:
      return r > 0 ? r * r * std::log(r) : 0;
    case Kind::WendlandC2:
      return q < 1 ? std::pow(1 - q, 4) * (4 * q + 1) : 0;
    default:
      return r * r * r;
  }
}

/// The interpolant at `x` by the indefinite system with the polynomial's rows, in the mesh's unit.
Points bySaddlePoint(
  Kind kind, double radius, const Points& sites, const Points& values, const Points& x)
{
  const Index n = sites.rows();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n + 4, n + 4), b = Eigen::MatrixXd::Zero(n + 4, 3);
  for (Index i = 0; i < n; ++i)
  {
    for (Index j = 0; j < n; ++j)
    {
      A(i, j) = kernelOf(kind, (sites.row(i) - sites.row(j)).norm(), radius);
    }
    A.row(i).tail<4>() << 1, sites.row(i);
    A.col(i).tail<4>() = A.row(i).tail<4>().transpose();
  }
  b.topRows(n) = values;
  const Eigen::MatrixXd c = direct::solve(A, b);
  Points result(x.rows(), 3);
  for (Index i = 0; i < x.rows(); ++i)
  {
    result.row(i) = c.row(n) + x.row(i) * c.bottomRows(3);
    for (Index j = 0; j < n; ++j)
    {
      result.row(i) += kernelOf(kind, (x.row(i) - sites.row(j)).norm(), radius) * c.row(j);
    }
  }
  return result;
}

/// The mesh with nodes of no cell added at `places`; they are free.
Mesh withNodes(const Mesh& mesh, NodePartition& partition, const Points& places)
{
  Mesh result = mesh;
  const Index n = mesh.points.rows();
  result.points.conservativeResize(n + places.rows(), 3);
  result.points.bottomRows(places.rows()) = places;
  for (Index i = 0; i < places.rows(); ++i)
  {
    partition.free.push_back(n + i);
  }
  return result;
}
}

TEST(RadialBasis, SolvesTheSaddlePointSystem)
{
  Mesh mesh = shapes::ball(6);
  meshes::transform(mesh, [](const Row& x) { return Row(5 * x[0] + 7, 5 * x[1], 4 * x[2] - 3); });
  const NodePartition partition = motions::outerPartition(mesh);
  const Points sites = meshes::rows(mesh.points, partition.prescribed);
  const Points free = meshes::rows(mesh.points, partition.free);
  const Points values = motions::mapped(sites, bend) - sites;
  const Row mean = sites.colwise().mean();
  const double extent = 2 * (sites.rowwise() - mean).rowwise().norm().maxCoeff();
  for (const Options& options : { Options{}, Options{ Kind::ThinPlate },
         Options{ Kind::WendlandC2, 1 }, Options{ Kind::WendlandC2, 0.3 } })
  {
    const Points expected =
      free + bySaddlePoint(options.kernel, options.radius * extent, sites, values, free);
    const Points found = meshes::rows(morphed(mesh, partition, options), partition.free);
    EXPECT_LT(difference(found, expected), 1e-9 * extent)
      << static_cast<int>(options.kernel) << " " << options.radius;
  }
}

TEST(RadialBasis, IsExactAtAllSites)
{
  const Mesh ball = shapes::ball(8);
  NodePartition partition = motions::outerPartition(ball);
  // Free nodes where prescribed ones are: they meet the interpolant itself.
  const Points places = meshes::rows(ball.points, partition.prescribed);
  const Mesh mesh = withNodes(ball, partition, places);
  for (const Kind kernel : { Kind::Triharmonic, Kind::ThinPlate, Kind::WendlandC2 })
  {
    for (const Index centers : { 0, 4, 40, 300 })
    {
      const Points moved = morphed(mesh, partition, { kernel, 1, centers });
      EXPECT_LT(difference(moved.bottomRows(places.rows()), motions::mapped(places, bend)), 1e-10)
        << static_cast<int>(kernel) << " " << centers;
    }
  }
}

TEST(RadialBasis, IsExactAtStronglyGradedSites)
{
  // Edges from 4e-6 to 0.5 of the size.
  Mesh mesh = meshes::hexes(8, 8, 8);
  meshes::transform(mesh, [](const Row& x)
    { return Row(std::pow(x[0] / 8, 6), std::pow(x[1] / 8, 6), std::pow(x[2] / 8, 6)); });
  NodePartition partition = motions::outerPartition(mesh);
  const Points places = meshes::rows(mesh.points, partition.prescribed);
  mesh = withNodes(mesh, partition, places);
  for (const Kind kernel : { Kind::Triharmonic, Kind::ThinPlate, Kind::WendlandC2 })
  {
    const Points moved = morphed(mesh, partition, { kernel });
    EXPECT_LT(difference(moved.bottomRows(places.rows()), motions::mapped(places, bend)), 1e-9)
      << static_cast<int>(kernel);
  }
  meshes::ThreadedMonitor monitor;
  RadialBasis method;
  Points moved = motions::morphed(
    method, mesh, partition, motions::targets(mesh, partition, motions::affine), monitor);
  const Points expected = motions::mapped(mesh.points, motions::affine);
  EXPECT_LT(difference(moved, expected), 1e-10 * meshes::size(expected));
}

TEST(RadialBasis, FewerCentersLeaveResidualsThatAreReported)
{
  const Mesh mesh = shapes::boxWithHole(24, 4, 6);
  const NodePartition partition = motions::outerPartition(mesh);
  const Points all = morphed(mesh, partition);
  double last = std::numeric_limits<double>::max();
  std::vector<double> differences;
  for (const Index centers : { 10, 40, 160 })
  {
    double residual = 0;
    const Points moved = morphed(mesh, partition, { Kind::Triharmonic, 1, centers }, &residual);
    differences.push_back(difference(moved, all));
    EXPECT_GT(residual, 0);
    EXPECT_LT(residual, last);
    last = residual;
  }
  EXPECT_LT(last, 0.02 * meshes::size(mesh.points));
  EXPECT_LT(differences.back(), 0.5 * differences.front());
  double residual = 1;
  morphed(mesh, partition, {}, &residual);
  EXPECT_EQ(residual, 0);
}

TEST(RadialBasis, TheResidualIsThatOfTheCentersAlone)
{
  const Mesh mesh = shapes::cylinder(4, 6);
  const NodePartition partition = motions::outerPartition(mesh);
  const Points sites = meshes::rows(mesh.points, partition.prescribed);
  meshes::ThreadedMonitor monitor;
  RadialBasis method;
  method.setNumberOfCenters(30);
  method.prepare(mesh, partition, monitor);
  EXPECT_EQ(method.centers(), 30);
  EXPECT_EQ(method.correctedSites(), sites.rows() - 30);
  const Points moved = motions::moved(method, motions::targets(mesh, partition, bend), monitor);

  // Only the centers prescribed: no correction.
  RadialBasis coarse;
  NodePartition few;
  for (const Index i : method.centerNodes())
  {
    few.prescribed.push_back(i);
  }
  std::sort(few.prescribed.begin(), few.prescribed.end());
  for (Index i = 0; i < mesh.points.rows(); ++i)
  {
    if (!std::binary_search(few.prescribed.begin(), few.prescribed.end(), i))
    {
      few.free.push_back(i);
    }
  }
  Points followed = motions::morphed(coarse, mesh, few, motions::targets(mesh, few, bend), monitor);
  const double expected =
    (followed - motions::mapped(mesh.points, bend))(partition.prescribed, allColumns)
      .rowwise()
      .norm()
      .maxCoeff();
  EXPECT_NEAR(method.largestResidual(), expected, 1e-10);
}

TEST(RadialBasis, ManySitesAreMultiscaleNearTheDenseResult)
{
  Mesh mesh = shapes::cylinder(16, 60); // 4,000 sites and some
  const NodePartition partition = motions::outerPartition(mesh);
  const auto n = static_cast<Index>(partition.prescribed.size());
  ASSERT_GT(n, RadialBasis::MostCenters);
  meshes::ThreadedMonitor monitor(2);
  RadialBasis method;
  method.prepare(mesh, partition, monitor);
  EXPECT_EQ(method.centers(), RadialBasis::CentersOfMany);
  EXPECT_EQ(method.correctedSites(), n - RadialBasis::CentersOfMany);
  Points moved, affine;
  method.evaluate(motions::targets(mesh, partition, bend), moved, monitor);
  method.evaluate(motions::targets(mesh, partition, motions::affine), affine, monitor);
  const Points expected = motions::mapped(mesh.points, motions::affine);
  EXPECT_LT(difference(affine, expected), 1e-10 * meshes::size(expected));
  method.setNumberOfCenters(RadialBasis::MostCenters);
  Points nearlyDense;
  method.prepare(mesh, partition, monitor);
  method.evaluate(motions::targets(mesh, partition, bend), nearlyDense, monitor);
  EXPECT_LT(difference(moved, nearlyDense), 1e-3 * meshes::size(mesh.points));
}

TEST(RadialBasis, NeitherRoundingNorNumbersChooseTheCentersOfASymmetricBody)
{
  const Mesh mesh = shapes::cylinder(16, 60);
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> noise(-1e-14, 1e-14);
  std::vector<Index> order(static_cast<std::size_t>(mesh.points.rows()));
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  Mesh other = meshes::renumbered(mesh, order);
  other.points = other.points.unaryExpr([&](double x) { return x + noise(random); });
  const Points one = morphed(mesh, motions::outerPartition(mesh));
  const Points two = morphed(other, motions::outerPartition(other));
  EXPECT_LT(difference(one, meshes::rows(two, order)), 1e-8 * meshes::size(mesh.points));
}

TEST(RadialBasis, SitesThatNearlyCoincideAreCorrected)
{
  Mesh mesh = shapes::ball(4);
  NodePartition partition = motions::outerPartition(mesh);
  const auto n = static_cast<Index>(partition.prescribed.size());
  // A twin of each prescribed node, 1e-9 beside it, that moves alike.
  Points twins = meshes::rows(mesh.points, partition.prescribed);
  twins.array() += 1e-9;
  mesh = withNodes(mesh, partition, twins);
  for (Index i = 0; i < n; ++i)
  {
    partition.free.pop_back();
    partition.prescribed.push_back(mesh.points.rows() - n + i);
  }
  meshes::ThreadedMonitor monitor;
  RadialBasis method;
  method.prepare(mesh, partition, monitor);
  EXPECT_EQ(method.centers(), n);
  EXPECT_EQ(method.correctedSites(), n);
  const Points moved = motions::moved(method, motions::targets(mesh, partition, bend), monitor);
  const Mesh alone = shapes::ball(4);
  const Points expected = morphed(alone, motions::outerPartition(alone));
  EXPECT_LT(difference(moved.topRows(expected.rows()), expected), 1e-6);
}

TEST(RadialBasis, SitesAtOnePlaceAreOne)
{
  Mesh mesh = shapes::ball(4);
  NodePartition partition = motions::outerPartition(mesh);
  const Index first = partition.prescribed.front();
  mesh = withNodes(mesh, partition, mesh.points.row(first));
  partition.prescribed.push_back(partition.free.back());
  partition.free.pop_back();
  meshes::ThreadedMonitor monitor;
  RadialBasis method;
  method.prepare(mesh, partition, monitor);
  EXPECT_EQ(method.centers(), static_cast<Index>(partition.prescribed.size()) - 1);
  // Both keep their own positions; the nodes inside follow their mean.
  Points target = motions::targets(mesh, partition, bend), moved, ofMean;
  target.row(0) += Row(.2, 0, 0);
  method.evaluate(target, moved, monitor);
  EXPECT_TRUE(meshes::rows(moved, partition.prescribed) == target);
  target.row(0) -= Row(.1, 0, 0);
  target.row(target.rows() - 1) = target.row(0);
  method.evaluate(target, ofMean, monitor);
  EXPECT_LT(
    difference(meshes::rows(moved, partition.free), meshes::rows(ofMean, partition.free)), 1e-12);
}

TEST(RadialBasis, SitesWithoutExtentAreOneError)
{
  const Mesh mesh = meshes::hexes(3, 3, 3);
  const auto messageOf = [&](std::vector<Index> prescribed)
  {
    NodePartition partition;
    partition.prescribed = std::move(prescribed);
    for (Index i = 0; i < mesh.points.rows(); ++i)
    {
      if (!std::count(partition.prescribed.begin(), partition.prescribed.end(), i))
      {
        partition.free.push_back(i);
      }
    }
    meshes::ThreadedMonitor monitor;
    RadialBasis method;
    try
    {
      method.prepare(mesh, partition, monitor);
    }
    catch (const Error& error)
    {
      EXPECT_EQ(error.kind(), Error::Kind::Singular);
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(messageOf({ 5 }).find("coincide"), std::string::npos);
  EXPECT_NE(messageOf({ 0, 1, 2, 3 }).find("lie on one line"), std::string::npos);
  std::vector<Index> bottom(16);
  std::iota(bottom.begin(), bottom.end(), 0);
  EXPECT_NE(messageOf(bottom).find("16 distinct places"), std::string::npos);
  EXPECT_NE(messageOf(bottom).find("lie in one plane"), std::string::npos);
  bottom.push_back(16);
  EXPECT_EQ(messageOf(bottom), "");
}

TEST(RadialBasis, OptionsHaveRanges)
{
  RadialBasis method;
  for (const double radius : { 0., -1., std::nan(""), std::numeric_limits<double>::infinity() })
  {
    EXPECT_THROW(method.setSupportRadius(radius), Error) << radius;
  }
  for (const Index centers : { -1, 1, 3, 4001 })
  {
    EXPECT_THROW(method.setNumberOfCenters(centers), Error) << centers;
  }
  EXPECT_EQ(method.supportRadius(), 1);
  EXPECT_EQ(method.numberOfCenters(), 0);
  EXPECT_EQ(method.kernel(), Kind::Triharmonic);
}

TEST(RadialBasis, HugeSupportRadiiAreAnErrorRatherThanNoise)
{
  const Mesh mesh = shapes::ball(12);
  const NodePartition partition = motions::outerPartition(mesh);
  meshes::ThreadedMonitor monitor;
  RadialBasis method;
  configure(method, { Kind::WendlandC2, 1e6 });
  try
  {
    method.prepare(mesh, partition, monitor);
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("singular to rounding"), std::string::npos);
  }
}
