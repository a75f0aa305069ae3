// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/NodePartition.h"
#include "Mesh/Topology.h"
#include "Meshes.h"
#include "QuadraticCells.h"
#include "Quality/CellMap.h"
#include "Quality/Certificate.h"
#include "Quality/ScaledJacobian.h"
#include "Untangling/InversionFree.h"
#include "Untangling/Smoothing.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace
{
using namespace morph;
using quadratic::Cell;
using quadratic::Point;
using quadratic::Vector;

JacobianProof proof(std::uint8_t type, const Cell& cell)
{
  return proveJacobian(type, cell.data());
}

Mesh meshOf(std::uint8_t type, const std::vector<Cell>& cells)
{
  Mesh mesh;
  std::vector<Vector> points;
  for (const Cell& cell : cells)
  {
    std::vector<Index> nodes;
    for (const Vector& x : cell)
    {
      nodes.push_back(static_cast<Index>(points.size()));
      points.push_back(x);
    }
    meshes::add(mesh, type, nodes);
  }
  mesh.points = Eigen::Map<const Points>(points[0].data(), static_cast<Index>(points.size()), 3);
  return mesh;
}

Certificate certificate(std::uint8_t type, const Cell& cell)
{
  const Mesh mesh = meshOf(type, { cell });
  Monitor monitor;
  return certify(mesh, mesh.points, {}, {}, monitor).cells[0];
}

Point pointOf(const JacobianProof& proof)
{
  return Eigen::Map<const Vector>(proof.at).cast<long double>();
}

std::vector<Cell> randomCells(const quadratic::Type& type, int count)
{
  std::mt19937 random(meshes::seed());
  std::vector<Cell> cells;
  for (int i = 0; i < count; ++i)
  {
    cells.push_back(quadratic::random(type.type, type.amount, random));
  }
  return cells;
}

const char* nameOf(std::uint8_t type)
{
  return cellShape(type)->name;
}
}

TEST(QuadraticJacobian, TheMapIsThatOfTheShapeFunctions)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const quadratic::Type& type : quadratic::Types)
  {
    const CellMap& map = *CellMap::find(type.type);
    const Cell nodes = quadratic::parametric(type.type);
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      const auto values = quadratic::functions(type.type, nodes[i].cast<long double>());
      for (Eigen::Index j = 0; j < values.size(); ++j)
      {
        EXPECT_EQ(values[j], j == static_cast<Eigen::Index>(i)) << nameOf(type.type);
      }
    }
    for (int trial = 0; trial < 50; ++trial)
    {
      const Cell cell = quadratic::random(type.type, type.amount, random);
      const double r = uniform(random), s = uniform(random) * (1 - r), t = uniform(random);
      const double at[3] = { r, s, type.type == QuadraticTetra ? t * (1 - r - s) : t };
      const Eigen::Matrix3d expected =
        quadratic::jacobian(cell, quadratic::gradients(type.type, Point(at[0], at[1], at[2])))
          .cast<double>();
      const Eigen::Matrix3d found = map.jacobian(map.derivatives(cell.data()), at);
      EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-13) << nameOf(type.type);
    }
  }
  for (const std::uint8_t type : { Tetra, Pyramid, QuadraticTriangle, BiquadraticTriangle })
  {
    EXPECT_EQ(CellMap::find(type), nullptr);
  }
  EXPECT_EQ(CellMap::find(255), nullptr);
}

TEST(QuadraticJacobian, CertificatesHoldAgainstDenseSampling)
{
  // TestQuadraticCells.cxx of the filters does the same with 10,000 cells of each type and VTK's
  // own functions.
  for (const quadratic::Type& type : quadratic::Types)
  {
    const int count = 1000;
    const quadratic::Sampler sampler(
      type.type, 6, [&type](const Point& at) { return quadratic::gradients(type.type, at); });
    int inverted = 0, undecided = 0;
    const std::vector<Cell> cells = randomCells(type, count);
    for (int i = 0; i < count; ++i)
    {
      const JacobianProof found = proof(type.type, cells[i]);
      inverted += found.certificate == Certificate::Inverted;
      undecided += found.certificate == Certificate::Undecided;
      Point least;
      if (found.certificate == Certificate::Inverted)
      {
        ASSERT_LT(quadratic::determinant(type.type, cells[i], pointOf(found)), 0)
          << nameOf(type.type) << " cell " << i;
      }
      else
      {
        ASSERT_GT(sampler.minimum(cells[i], least), 0) << nameOf(type.type) << " cell " << i;
        if (i % 50 == 0)
        {
          ASSERT_GT(quadratic::searchedMinimum(type.type, cells[i], least), 0)
            << nameOf(type.type) << " cell " << i;
        }
      }
    }
    EXPECT_GE(inverted, .3 * count) << nameOf(type.type);
    EXPECT_LE(inverted, .7 * count) << nameOf(type.type);
    EXPECT_LE(undecided, .01 * count) << nameOf(type.type);
  }
}

TEST(QuadraticJacobian, IdealCellsAreCertifiedAndMirroredOnesInverted)
{
  for (const quadratic::Type& type : quadratic::Types)
  {
    Cell cell = quadratic::ideal(type.type);
    EXPECT_EQ(proof(type.type, cell).certificate, Certificate::Certified) << nameOf(type.type);
    EXPECT_EQ(certificate(type.type, cell), Certificate::Certified) << nameOf(type.type);
    for (Vector& x : cell)
    {
      x[1] = -x[1];
    }
    EXPECT_EQ(proof(type.type, cell).certificate, Certificate::Inverted) << nameOf(type.type);
    EXPECT_EQ(certificate(type.type, cell), Certificate::Inverted) << nameOf(type.type);
  }
}

TEST(QuadraticJacobian, CoefficientsAreWithinTheirBound)
{
  // Compared where the coefficients are values: at the domain's corners. Thin, turned and distant
  // cells, too.
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(.7, Vector(1, 2, 3).normalized()).toRotationMatrix();
  for (const quadratic::Type& type : quadratic::Types)
  {
    const CellMap& map = *CellMap::find(type.type);
    int i = 0;
    for (Cell cell : randomCells(type, 60))
    {
      const double thickness = i % 3 == 0 ? 1 : i % 3 == 1 ? 1e-5 : 1e5;
      for (Vector& x : cell)
      {
        x = turn * Vector(x[0], x[1], thickness * x[2]);
        x += i % 2 == 0 ? Vector(0, 0, 0) : Vector(1e6, -2e6, 3e6);
      }
      ++i;
      const double scale = exactScale(cell.data(), static_cast<int>(cell.size()));
      Cell scaled = cell;
      for (Vector& x : scaled)
      {
        x *= scale;
      }
      BernsteinHalving::Part part = map.halving().whole();
      const CellMap::Derivatives derivatives = map.derivatives(scaled.data());
      const double error = map.determinant(derivatives, 0, part.c);
      double at[3];
      const double found = map.halving().minimumCorner(part, at);
      const double unit = scale * scale * scale;
      const double expected =
        static_cast<double>(quadratic::determinant(type.type, cell, Point(at[0], at[1], at[2])));
      EXPECT_LE(std::abs(found / unit - expected), error / unit) << nameOf(type.type);
      const double* largest = derivatives.largest;
      EXPECT_LT(error, 1e-11 * largest[0] * largest[1] * largest[2]) << nameOf(type.type);
    }
  }
}

TEST(QuadraticJacobian, GradientsOfCoefficientsAgreeWithDifferences)
{
  std::mt19937 generator(meshes::seed());
  std::uniform_real_distribution<double> one(-1, 1);
  for (const quadratic::Type& type : quadratic::Types)
  {
    const CellMap& map = *CellMap::find(type.type);
    Cell cell = quadratic::random(type.type, type.amount, generator);
    BernsteinHalving::Coefficients weights{};
    std::generate(weights.begin(), weights.begin() + map.terms(), [&] { return one(generator); });
    const auto weighted = [&](const Cell& x)
    {
      BernsteinHalving::Coefficients c{};
      map.determinant(map.derivatives(x.data()), 0, c);
      return std::inner_product(c.begin(), c.begin() + map.terms(), weights.begin(), 0.);
    };
    Vector gradient[CellMap::MostNodes];
    map.gradient(map.derivatives(cell.data()), weights, gradient);
    for (std::size_t i = 0; i < cell.size(); ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        // A coordinate alone is in one row of the matrix, so the determinant is affine in it.
        Cell moved = cell;
        moved[i][j] += 1;
        EXPECT_NEAR(gradient[i][j], weighted(moved) - weighted(cell), 1e-10) << int(type.type);
      }
    }
  }
}

TEST(QuadraticJacobian, ScalePlaceAndMirrorImageDoNotShow)
{
  for (const quadratic::Type& type : quadratic::Types)
  {
    for (const Cell& cell : randomCells(type, 100))
    {
      const Certificate expected = certificate(type.type, cell);
      for (const double scale : { 1e-200, 1e-30, 1e30, 1e200 })
      {
        Cell scaled = cell;
        for (Vector& x : scaled)
        {
          x *= scale;
        }
        EXPECT_EQ(certificate(type.type, scaled), expected) << nameOf(type.type) << scale;
      }
      Cell distant = cell;
      for (Vector& x : distant)
      {
        // Without rounding, so that it is the same cell: the random coordinates have few bits.
        x = (x * 0x1p20).array().round() * 0x1p-20;
      }
      const JacobianProof near = proof(type.type, distant);
      for (Vector& x : distant)
      {
        x += Vector(0x1p30, -0x1p30, 0x1p29);
      }
      const JacobianProof far = proof(type.type, distant);
      EXPECT_EQ(far.certificate, near.certificate) << nameOf(type.type);
      EXPECT_EQ(pointOf(far), pointOf(near)) << nameOf(type.type);

      Mesh image = meshOf(type.type, { cell });
      image.points.col(0) *= -1;
      Monitor monitor;
      EXPECT_EQ(certify(image, image.points, { -1 }, {}, monitor).cells[0], expected);
      const Quality direct = measureQuality(
        meshOf(type.type, { cell }), meshOf(type.type, { cell }).points, {}, {}, monitor);
      const Quality mirrored = measureQuality(image, image.points, { -1 }, {}, monitor);
      EXPECT_NEAR(mirrored.minimum, direct.minimum, 1e-12) << nameOf(type.type);
    }
  }
}

TEST(QuadraticJacobian, StraightSidedCellsAreProvedAsLinearOnes)
{
  std::mt19937 random(meshes::seed());
  std::uniform_int_distribution<int> jitter(-75, 75);
  const std::uint8_t linear[] = { Tetra, Hexahedron, Wedge, Pyramid };
  for (const quadratic::Type& type : quadratic::Types)
  {
    const CellShape& shape = *cellShape(type.type);
    const int kind = shape.shape == Shape::Tet     ? 0
                     : shape.shape == Shape::Hex   ? 1
                     : shape.shape == Shape::Wedge ? 2
                                                   : 3;
    int counts[2] = { 0, 0 };
    for (int trial = 0; trial < 300; ++trial)
    {
      Cell cell = quadratic::ideal(type.type);
      for (int i = 0; i < shape.numberOfCorners; ++i)
      {
        cell[i] += Vector(jitter(random), jitter(random), jitter(random)) / 128;
        cell[i] = (cell[i] * 1024).array().round() / 1024;
      }
      for (int i = shape.numberOfCorners; i < shape.numberOfNodes; ++i)
      {
        double N[8];
        shapeFunctions(shape.shape, shape.extraNodes[i - shape.numberOfCorners], N, nullptr);
        cell[i].setZero();
        for (int a = 0; a < shape.numberOfCorners; ++a)
        {
          cell[i] += N[a] * cell[a];
        }
      }
      ASSERT_TRUE(isStraightSided(type.type, cell.data())) << nameOf(type.type);
      const Certificate expected = certificate(linear[kind], cell);
      ++counts[expected == Certificate::Certified];
      EXPECT_EQ(certificate(type.type, cell), expected) << nameOf(type.type);
      // The curved path agrees where it decides.
      const Certificate curved = proof(type.type, cell).certificate;
      EXPECT_TRUE(curved == expected || curved == Certificate::Undecided) << nameOf(type.type);
      cell.back()[1] = std::nextafter(cell.back()[1], 2.);
      EXPECT_FALSE(isStraightSided(type.type, cell.data())) << nameOf(type.type);
    }
    EXPECT_GT(counts[0], 10) << nameOf(type.type);
    EXPECT_GT(counts[1], 10) << nameOf(type.type);
  }
}

TEST(QuadraticJacobian, WhatIsNotDecidedKeepsTheValueOfItsCorners)
{
  // The middle of an edge at a quarter of it: the determinant is 0 at the nearer corner, and
  // positive elsewhere.
  Cell cell = quadratic::ideal(QuadraticTetra);
  cell[4] = Vector(.25, 0, 0);
  EXPECT_EQ(certificate(QuadraticTetra, cell), Certificate::Undecided);
  const Mesh mesh = meshOf(QuadraticTetra, { cell });
  Monitor monitor;
  const Quality quality = measureQuality(mesh, mesh.points, {}, {}, monitor);
  EXPECT_GT(quality.minimum, .5);
  EXPECT_EQ(quality.inverted, 0);
  EXPECT_EQ(certify(mesh, mesh.points, {}, {}, monitor).undecided, 1);
  // A little farther it is inverted there, a little nearer it is not.
  cell[4] = Vector(.25 - 1e-9, 0, 0);
  EXPECT_EQ(certificate(QuadraticTetra, cell), Certificate::Inverted);
  cell[4] = Vector(.25 + 1e-9, 0, 0);
  EXPECT_EQ(certificate(QuadraticTetra, cell), Certificate::Certified);
  cell[4][2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(certificate(QuadraticTetra, cell), Certificate::Undecided);
}

TEST(QuadraticJacobian, StretchedCellsAreDecidedLikeTheCellsTheyComeFrom)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> power(-9, 9);
  for (const quadratic::Type& type : quadratic::Types)
  {
    const int count = 100;
    int undecided = 0;
    for (Cell& cell : randomCells(type, count))
    {
      const Certificate expected = proof(type.type, cell).certificate;
      const Vector factor(
        std::pow(10, power(random)), std::pow(10, power(random)), std::pow(10, power(random)));
      for (Vector& x : cell)
      {
        x = x.cwiseProduct(factor);
      }
      const JacobianProof found = proof(type.type, cell);
      undecided += found.certificate == Certificate::Undecided;
      if (found.certificate != Certificate::Undecided && expected != Certificate::Undecided)
      {
        ASSERT_EQ(found.certificate, expected) << nameOf(type.type);
      }
      if (found.certificate == Certificate::Inverted)
      {
        EXPECT_LT(quadratic::determinant(type.type, cell, pointOf(found)), 0) << nameOf(type.type);
        EXPECT_LE(quadraticScaledJacobian(type.type, cell.data(), 1), 0) << nameOf(type.type);
      }
    }
    EXPECT_LE(undecided, .01 * count) << nameOf(type.type);
  }
}

TEST(QuadraticJacobian, ExtentsWithoutAFiniteInverseAreDecided)
{
  for (const quadratic::Type& type : quadratic::Types)
  {
    Cell cell = quadratic::ideal(type.type);
    for (Vector& x : cell)
    {
      x[2] *= 1e-222; // 2^-737: a power of two that takes it to 2^299 is no double
    }
    EXPECT_EQ(proof(type.type, cell).certificate, Certificate::Certified) << nameOf(type.type);
    for (Vector& x : cell)
    {
      x[1] = -x[1];
    }
    EXPECT_EQ(proof(type.type, cell).certificate, Certificate::Inverted) << nameOf(type.type);
  }
}

TEST(QuadraticJacobian, ANodeFarAwayDoesNotHideInvertedPoints)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> unit(-1, 1), power(3, 9);
  for (const quadratic::Type& type : quadratic::Types)
  {
    const quadratic::Sampler sampler(
      type.type, 6, [&type](const Point& at) { return quadratic::gradients(type.type, at); });
    int inverted = 0;
    for (Cell& cell : randomCells(type, 100))
    {
      cell[random() % cell.size()] +=
        std::pow(10, power(random)) * Vector(unit(random), unit(random), unit(random));
      Point worst;
      if (!(sampler.minimum(cell, worst) < 0))
      {
        continue;
      }
      auto jacobian = quadratic::jacobian(cell, quadratic::gradients(type.type, worst));
      if (jacobian.determinant() < -1e-3L * jacobian.colwise().norm().prod())
      {
        ++inverted;
        EXPECT_EQ(certificate(type.type, cell), Certificate::Inverted) << nameOf(type.type);
        EXPECT_LE(quadraticScaledJacobian(type.type, cell.data(), 1), 0) << nameOf(type.type);
      }
    }
    EXPECT_GT(inverted, 10) << nameOf(type.type);
  }
}

TEST(QuadraticJacobian, DegenerateCellsAreNotCertified)
{
  Monitor monitor;
  for (const quadratic::Type& type : quadratic::Types)
  {
    const Cell ideal = quadratic::ideal(type.type);
    EXPECT_EQ(certificate(type.type, Cell(ideal.size(), Vector(1, 2, 3))), Certificate::Inverted)
      << nameOf(type.type);
    Cell collapsed = ideal, flat = ideal;
    collapsed[1] = collapsed[0];
    const JacobianProof found = proof(type.type, collapsed);
    EXPECT_EQ(found.certificate, Certificate::Inverted) << nameOf(type.type);
    EXPECT_LE(quadratic::determinant(type.type, collapsed, pointOf(found)), 0);
    const Mesh mesh = meshOf(type.type, { collapsed });
    const Quality quality = measureQuality(mesh, mesh.points, {}, {}, monitor);
    EXPECT_EQ(quality.minimum, 0) << nameOf(type.type);
    EXPECT_EQ(quality.degenerate, 1) << nameOf(type.type);
    for (Vector& x : flat)
    {
      x = Vector(x[0], x[1], .1 * x[0] + .7 * x[1]); // flat but for rounding
    }
    EXPECT_NE(certificate(type.type, flat), Certificate::Certified) << nameOf(type.type);
  }
}

TEST(QuadraticJacobian, APointInvertedInsideIsFoundThoughTheDeterminantVanishesAtACorner)
{
  // Coordinates rounded to whole numbers: mid-side nodes lie on corners, where the determinant
  // is 0.
  const Cell first = { { -6, 3, -1 }, { -7, 3, 0 }, { -6, 2, 0 }, { -6, 4, 0 }, { -7, 3, 0 },
    { -6, 3, 0 }, { -6, 3, 0 }, { -6, 4, 0 }, { -6, 3, 0 }, { -6, 3, 0 } };
  const Cell second = { { 148, -102, 44 }, { 149, -101, 44 }, { 148, -101, 45 }, { 149, -102, 45 },
    { 149, -102, 44 }, { 149, -101, 44 }, { 149, -102, 44 }, { 149, -102, 44 }, { 149, -102, 44 },
    { 149, -102, 45 } };
  for (const Cell& cell : { first, second })
  {
    EXPECT_EQ(certificate(QuadraticTetra, cell), Certificate::Inverted);
    const double corners[4][3] = { { cell[0][0], cell[0][1], cell[0][2] },
      { cell[1][0], cell[1][1], cell[1][2] }, { cell[2][0], cell[2][1], cell[2][2] },
      { cell[3][0], cell[3][1], cell[3][2] } };
    const double ofCorners = scaledJacobian(*cellShape(Tetra), corners);
    EXPECT_GT(ofCorners, 0);
    EXPECT_LT(quadraticScaledJacobian(QuadraticTetra, cell.data(), ofCorners), 0);
  }
}

TEST(QuadraticJacobian, DecidesNextToTheLimit)
{
  for (const quadratic::Type& type : quadratic::Types)
  {
    int trials = 0;
    for (const Cell& bad : randomCells(type, 40))
    {
      if (certificate(type.type, bad) != Certificate::Inverted)
      {
        continue;
      }
      ++trials;
      const Cell good = quadratic::ideal(type.type);
      const auto at = [&](double t)
      {
        Cell cell = good;
        for (std::size_t k = 0; k < cell.size(); ++k)
        {
          cell[k] += t * (bad[k] - cell[k]);
        }
        return certificate(type.type, cell);
      };
      double valid = 0, notValid = 1, notInverted = 0, inverted = 1;
      for (int i = 0; i < 40; ++i)
      {
        const double a = (valid + notValid) / 2, b = (notInverted + inverted) / 2;
        (at(a) == Certificate::Certified ? valid : notValid) = a;
        (at(b) == Certificate::Inverted ? inverted : notInverted) = b;
      }
      EXPECT_LT(inverted - valid, 1e-4) << nameOf(type.type);
    }
    EXPECT_GT(trials, 5) << nameOf(type.type);
  }
}

TEST(QuadraticJacobian, CellsInvertedInsideAreMeasuredAsInverted)
{
  Monitor monitor;
  for (const quadratic::Type& type : quadratic::Types)
  {
    const std::vector<Cell> cells = randomCells(type, 200);
    const Mesh mesh = meshOf(type.type, cells);
    const CertificateReport report = certify(mesh, mesh.points, {}, {}, monitor);
    const Quality quality = measureQuality(mesh, mesh.points, {}, {}, monitor);
    const Quality corners = measureCorners(mesh, mesh.points, {}, {}, monitor);
    EXPECT_EQ(corners.inverted, 0) << nameOf(type.type);
    EXPECT_EQ(quality.inverted, report.inverted) << nameOf(type.type);
    EXPECT_GT(quality.inverted, 0) << nameOf(type.type);
    EXPECT_EQ(static_cast<Index>(invertedCells(quality).size()), report.inverted);
    for (std::size_t c = 0; c < cells.size(); ++c)
    {
      if (report.cells[c] == Certificate::Inverted)
      {
        EXPECT_LT(quality.scaledJacobian[c], 0) << nameOf(type.type) << " cell " << c;
        EXPECT_GE(quality.scaledJacobian[c], -1.5) << nameOf(type.type) << " cell " << c;
      }
      else
      {
        EXPECT_EQ(quality.scaledJacobian[c], corners.scaledJacobian[c]) << nameOf(type.type);
      }
    }
  }
}

TEST(QuadraticJacobian, ACellThatIsPositiveEverywhereIsNotInvertedByItsCorners)
{
  // Corners that are pushed in, with middle nodes that do not follow: the corner cell is inverted,
  // the curved one is not.
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> uniform(-1, 1);
  Monitor monitor;
  int found = 0;
  for (int trial = 0; trial < 20000 && found < 5; ++trial)
  {
    Cell cell = quadratic::ideal(QuadraticHexahedron);
    for (std::size_t i = 0; i < cell.size(); ++i)
    {
      cell[i] += .08 * Vector(uniform(random), uniform(random), uniform(random));
    }
    // The edges at corner 6 bend away from it, and back to it along its diagonal.
    const double push = .6 + .4 * uniform(random), lag = .25 + .25 * uniform(random);
    cell[6] -= push * Vector(.5, .5, 1);
    for (const int middle : { 13, 14, 18 })
    {
      cell[middle] -= lag * push * Vector(.5, .5, 1);
    }
    const Mesh mesh = meshOf(QuadraticHexahedron, { cell });
    if (measureCorners(mesh, mesh.points, {}, {}, monitor).inverted == 1 &&
        certificate(QuadraticHexahedron, cell) == Certificate::Certified)
    {
      ++found;
      const Quality quality = measureQuality(mesh, mesh.points, {}, {}, monitor);
      EXPECT_EQ(quality.inverted, 0);
      EXPECT_GT(quality.minimum, 0);
      EXPECT_LE(quality.minimum, 1);
    }
  }
  EXPECT_EQ(found, 5);
}
