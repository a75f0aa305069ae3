// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/ExactPredicates.h"
#include "Mesh/CellShape.h"
#include "Meshes.h"
#include "Quality/Certificate.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace
{
using namespace morph;
using Vector = Eigen::Vector3d;
using Cell = std::vector<Vector>;

const Cell RightTet = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
const Cell Cube = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
  { 1, 1, 1 }, { 0, 1, 1 } };
const Cell RightWedge = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
  { 0, 1, 1 } };
const Cell SquarePyramid = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { .5, .5, .7 } };

struct Volume
{
  std::uint8_t type;
  const Cell* cell;
};
const Volume Volumes[] = { { Tetra, &RightTet }, { Hexahedron, &Cube }, { Wedge, &RightWedge },
  { Pyramid, &SquarePyramid } };

Certificate certified(std::uint8_t type, const Cell& cell)
{
  Mesh mesh;
  mesh.points = Eigen::Map<const Points>(cell[0].data(), static_cast<Index>(cell.size()), 3);
  meshes::add(mesh, type, consecutive(cellShape(type)->numberOfNodes));
  Monitor monitor;
  return certify(mesh, mesh.points, {}, {}, monitor).cells[0];
}

double scaledJacobianOf(std::uint8_t type, const Cell& cell)
{
  return scaledJacobian(*cellShape(type), reinterpret_cast<const double(*)[3]>(cell.data()));
}

Cell jittered(Cell cell, double amount, std::mt19937& random)
{
  std::uniform_real_distribution<double> jitter(-amount, amount);
  for (Vector& x : cell)
  {
    x += Vector(jitter(random), jitter(random), jitter(random));
  }
  return cell;
}

/// The Jacobian determinant at a parametric point, by the shape functions; a pyramid's without the
/// factor (1 - t)^2 that vanishes at the apex.
double determinant(std::uint8_t type, const Cell& cell, const Vector& at)
{
  double N[8], dN[8][3];
  const double xi[3] = { at[0], at[1], type == Pyramid ? 0 : at[2] };
  shapeFunctions(cellShape(type)->shape, xi, N, dN);
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
  for (std::size_t a = 0; a < cell.size(); ++a)
  {
    jacobian += cell[a] * Eigen::RowVector3d(dN[a][0], dN[a][1], dN[a][2]);
  }
  return jacobian.determinant();
}

bool isInside(std::uint8_t type, const Vector& at)
{
  return at.minCoeff() >= 0 && at.maxCoeff() <= 1 && (type != Wedge || at[0] + at[1] <= 1);
}

/// The minimum determinant on a lattice, then by a search from the best of its points with ever
/// shorter steps.
double sampledMinimum(std::uint8_t type, const Cell& cell, int lattice, bool search)
{
  double least = std::numeric_limits<double>::infinity();
  Vector best = Vector::Zero();
  const auto probe = [&](const Vector& at)
  {
    if (!isInside(type, at))
    {
      return false;
    }
    const double value = determinant(type, cell, at);
    if (value >= least)
    {
      return false;
    }
    least = value;
    best = at;
    return true;
  };
  for (int i = 0; i <= lattice; ++i)
  {
    for (int j = 0; j <= lattice; ++j)
    {
      for (int k = 0; k <= (type == Pyramid ? 0 : lattice); ++k)
      {
        probe(Vector(i, j, k) / lattice);
      }
    }
  }
  for (double step = .5 / lattice; search && step > 1e-7;)
  {
    bool isBetter = false;
    const Vector from = best;
    for (int code = 0; code < 27; ++code)
    {
      isBetter |= probe(from + step * Vector(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1));
    }
    step *= isBetter ? 1 : .5;
  }
  return least;
}

Mesh meshOf(const std::vector<std::pair<std::uint8_t, Cell>>& cells)
{
  Mesh mesh;
  std::vector<Vector> points;
  for (const auto& [type, cell] : cells)
  {
    std::vector<Index> nodes;
    for (const Vector& x : cell)
    {
      nodes.push_back(static_cast<Index>(points.size()));
      points.push_back(x);
    }
    meshes::add(mesh, type, nodes);
  }
  mesh.points.resize(static_cast<Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    mesh.points.row(static_cast<Index>(i)) = points[i].transpose();
  }
  return mesh;
}

CertificateReport certifyAll(const Mesh& mesh, const std::vector<std::int8_t>& orientation = {},
  const std::vector<std::uint8_t>& skip = {})
{
  Monitor monitor;
  return certify(mesh, mesh.points, orientation, skip, monitor);
}
}

TEST(OrientationPredicate, IsExactForNearlyFlatTetrahedra)
{
  // Edges that are long sums of one another, so that the determinant is the small number of the
  // start, about 2^-50 of its six products.
  std::mt19937 random(meshes::seed());
  std::uniform_int_distribution<int> pick(0, 2), factor(-3, 3), coordinate(-(1 << 17), 1 << 17);
  for (int trial = 0; trial < 20000; ++trial)
  {
    const int sign = trial % 3 - 1;
    Eigen::Matrix<std::int64_t, 3, 3> edges =
      Eigen::Vector3i(1, 1, sign).cast<std::int64_t>().asDiagonal();
    for (int step = 0; step < 200; ++step)
    {
      const int i = pick(random), j = pick(random);
      const Eigen::Matrix<std::int64_t, 3, 1> sum = edges.col(i) + factor(random) * edges.col(j);
      if (i != j && sum.cwiseAbs().maxCoeff() < (1 << 17))
      {
        edges.col(i) = sum;
      }
    }
    const double scale = std::ldexp(1., trial % 1600 - 900);
    const Vector corner(coordinate(random), coordinate(random), coordinate(random));
    const Vector a = scale * corner;
    const Vector b = scale * (corner + edges.col(0).cast<double>());
    const Vector c = scale * (corner + edges.col(1).cast<double>());
    const Vector d = scale * (corner + edges.col(2).cast<double>());
    ASSERT_EQ(orientationSign(a, b, c, d), sign) << "trial " << trial;
    ASSERT_EQ(orientationSign(b, a, c, d), -sign) << "trial " << trial;
    ASSERT_EQ(orientationSign(d, b, a, c), sign) << "trial " << trial;
  }
}

TEST(OrientationPredicate, SeesTheLastBitOfACoordinate)
{
  // The plane x + y + z = 3/2 cut by a point one unit in the last place off it.
  const double eps = std::numeric_limits<double>::epsilon() / 4;
  const Vector a(1.5, 0, 0), b(0, 1.5, 0), c(0, 0, 1.5);
  EXPECT_EQ(orientationSign(a, b, c, Vector(.5, .5, .5)), 0);
  EXPECT_EQ(orientationSign(a, b, c, Vector(.5, .5, .5 + 2 * eps)), 1);
  EXPECT_EQ(orientationSign(a, b, c, Vector(.5, .5, .5 - eps)), -1);
}

TEST(OrientationPredicate, ExtremeCoordinates)
{
  const double huge = 1e300, tiny = 1e-300, least = std::numeric_limits<double>::denorm_min();
  const Vector o(0, 0, 0);
  EXPECT_EQ(orientationSign(o, { huge, 0, 0 }, { 0, huge, 0 }, { 0, 0, huge }), 1);
  EXPECT_EQ(orientationSign(o, { tiny, 0, 0 }, { 0, tiny, 0 }, { 0, 0, tiny }), 1);
  EXPECT_EQ(orientationSign(o, { least, 0, 0 }, { 0, least, 0 }, { 0, 0, least }), 1);
  EXPECT_EQ(orientationSign(o, o, o, o), 0);
  EXPECT_EQ(orientationSign(o, { huge, 0, 0 }, { 0, huge, 0 }, { 0, 0, -tiny }), -1);
  EXPECT_EQ(orientationSign(o, { huge, 0, 0 }, { 0, huge, 0 }, { tiny, tiny, least }), 1);
}

TEST(Certificate, IdealCellsAreCertified)
{
  for (const Volume& v : Volumes)
  {
    EXPECT_EQ(certified(v.type, *v.cell), Certificate::Certified) << cellShape(v.type)->name;
    Cell mirrored = *v.cell;
    for (Vector& x : mirrored)
    {
      x[0] = -x[0];
    }
    EXPECT_EQ(certified(v.type, mirrored), Certificate::Inverted) << cellShape(v.type)->name;
  }
}

TEST(Certificate, AgreesWithDenseSampling)
{
  std::mt19937 random(meshes::seed());
  for (const Volume& v : Volumes)
  {
    int counts[3] = { 0, 0, 0 };
    for (int trial = 0; trial < 1200; ++trial)
    {
      const Cell cell = jittered(*v.cell, .1 + .05 * (trial % 10), random);
      const Certificate found = certified(v.type, cell);
      ++counts[static_cast<int>(found) + 1];
      if (found == Certificate::Certified)
      {
        ASSERT_GT(sampledMinimum(v.type, cell, 8, trial % 8 == 0), 0)
          << cellShape(v.type)->name << " trial " << trial;
      }
      else
      {
        ASSERT_LE(sampledMinimum(v.type, cell, 8, true), 1e-12)
          << cellShape(v.type)->name << " trial " << trial;
      }
    }
    EXPECT_GT(counts[2], 200) << cellShape(v.type)->name;
    EXPECT_GT(counts[0], 15) << cellShape(v.type)->name;
    EXPECT_EQ(counts[1], 0) << cellShape(v.type)->name;
  }
}

TEST(Certificate, FindsWhatTheScaledJacobianMisses)
{
  // Every corner, and a hexahedron's center, positive; the inside not. Wedges like that are twisted
  // by nearly half a turn.
  Cell twisted = RightWedge;
  for (int k = 3; k < 6; ++k)
  {
    twisted[k] = Vector(.6 - twisted[k][0], .6 - twisted[k][1], 1);
  }
  std::mt19937 random(meshes::seed());
  for (const Volume& v : { Volumes[1], Volume{ Wedge, &twisted } })
  {
    int missed = 0;
    for (int trial = 0; trial < 40000 && missed < 5; ++trial)
    {
      const Cell cell = jittered(*v.cell, .6, random);
      if (scaledJacobianOf(v.type, cell) > 0 && certified(v.type, cell) == Certificate::Inverted)
      {
        ++missed;
        EXPECT_LT(sampledMinimum(v.type, cell, 8, true), 0) << cellShape(v.type)->name;
      }
    }
    EXPECT_EQ(missed, 5) << cellShape(v.type)->name;
  }
}

TEST(Certificate, PyramidsAreDecidedByTheirBase)
{
  std::mt19937 random(meshes::seed());
  for (int trial = 0; trial < 2000; ++trial)
  {
    const Cell cell = jittered(SquarePyramid, .4, random);
    EXPECT_EQ(
      certified(Pyramid, cell) == Certificate::Certified, scaledJacobianOf(Pyramid, cell) > 0);
    // The determinant without its factor does not depend on the height, as the header derives.
    double N[5], dN[5][3];
    const double xi[3] = { .3, .8, .6 };
    shapeFunctions(Shape::Pyramid, xi, N, dN);
    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
    for (int a = 0; a < 5; ++a)
    {
      jacobian += cell[a] * Eigen::RowVector3d(dN[a][0], dN[a][1], dN[a][2]);
    }
    EXPECT_NEAR(
      jacobian.determinant(), .4 * .4 * determinant(Pyramid, cell, Vector(.3, .8, 0)), 1e-14);
  }
}

TEST(Certificate, DecidesNextToTheLimit)
{
  // On the line from a valid cell to an inverted one only a short stretch stays undecided.
  std::mt19937 random(meshes::seed());
  for (const Volume& v : Volumes)
  {
    for (int trial = 0; trial < 20; ++trial)
    {
      Cell bad = jittered(*v.cell, .6, random);
      while (certified(v.type, bad) != Certificate::Inverted)
      {
        bad = jittered(*v.cell, .6, random);
      }
      const auto at = [&](double t)
      {
        Cell cell = *v.cell;
        for (std::size_t k = 0; k < cell.size(); ++k)
        {
          cell[k] += t * (bad[k] - cell[k]);
        }
        return certified(v.type, cell);
      };
      // Each bisection keeps one end that is certified and one that is not, or one that is inverted
      // and one that is not: the ends close in on the undecided stretch from either side.
      double valid = 0, notValid = 1, notInverted = 0, inverted = 1;
      for (int i = 0; i < 50; ++i)
      {
        const double a = (valid + notValid) / 2, b = (notInverted + inverted) / 2;
        (at(a) == Certificate::Certified ? valid : notValid) = a;
        (at(b) == Certificate::Inverted ? inverted : notInverted) = b;
      }
      if (at(notValid) == Certificate::Undecided)
      {
        EXPECT_LT(inverted - valid, 1e-5) << cellShape(v.type)->name << " trial " << trial;
      }
    }
  }
}

TEST(Certificate, DegenerateCellsAreNotCertified)
{
  for (const Volume& v : Volumes)
  {
    EXPECT_EQ(certified(v.type, Cell(8, Vector(1, 2, 3))), Certificate::Inverted);
    Cell flat = *v.cell, collapsed = *v.cell;
    for (Vector& x : flat)
    {
      x = Vector(x[0], x[1], .1 * x[0] + .7 * x[1]); // flat but for rounding
    }
    EXPECT_NE(certified(v.type, flat), Certificate::Certified) << cellShape(v.type)->name;
    collapsed[1] = collapsed[0];
    EXPECT_EQ(certified(v.type, collapsed), Certificate::Inverted) << cellShape(v.type)->name;
  }
}

TEST(Certificate, AZeroInsideIsNotCertified)
{
  // The wedge's upper triangle turned by 180 degrees: flat in the middle.
  Cell wedge = RightWedge;
  for (int k = 3; k < 6; ++k)
  {
    wedge[k] = Vector(-wedge[k][0], -wedge[k][1], 1);
  }
  EXPECT_NE(certified(Wedge, wedge), Certificate::Certified);
  // The cube's top rotated in the same way: the middle section is a point.
  Cell hex = Cube;
  for (int k = 4; k < 8; ++k)
  {
    hex[k] = Vector(1 - hex[k][0], 1 - hex[k][1], 1);
  }
  EXPECT_NE(certified(Hexahedron, hex), Certificate::Certified);
}

TEST(Certificate, ThinAndDistantCells)
{
  // Boundary layers of aspect 1e8, turned, and cells far from the origin.
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(.7, Vector(1, 2, 3).normalized()).toRotationMatrix();
  for (const Volume& v : Volumes)
  {
    Cell thin = *v.cell, distant = *v.cell;
    for (Vector& x : thin)
    {
      x = turn * Vector(x[0], x[1], 1e-8 * x[2]);
    }
    for (Vector& x : distant)
    {
      x += Vector(1e9, -1e9, 1e9);
    }
    EXPECT_EQ(certified(v.type, thin), Certificate::Certified) << cellShape(v.type)->name;
    EXPECT_EQ(certified(v.type, distant), Certificate::Certified) << cellShape(v.type)->name;
  }
}

TEST(Certificate, ScaleAndMirrorImageDoNotShow)
{
  std::mt19937 random(meshes::seed());
  std::vector<std::pair<std::uint8_t, Cell>> cells;
  for (int trial = 0; trial < 400; ++trial)
  {
    for (const Volume& v : Volumes)
    {
      cells.emplace_back(v.type, jittered(*v.cell, .35, random));
    }
  }
  Mesh mesh = meshOf(cells);
  const CertificateReport expected = certifyAll(mesh);
  for (const double scale : { 1e-200, 1e-6, 1e6, 1e200 })
  {
    Mesh scaled = mesh;
    scaled.points *= scale;
    EXPECT_EQ(certifyAll(scaled).cells, expected.cells) << scale;
  }
  Mesh image = mesh;
  image.points.col(1) *= -1;
  EXPECT_EQ(certifyAll(image, std::vector<std::int8_t>(cells.size(), -1)).cells, expected.cells);
}

TEST(Certificate, CountsVolumeCellsOnly)
{
  Cell quadratic = RightTet;
  for (const auto& [a, b] : { std::pair(0, 1), { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } })
  {
    quadratic.push_back((RightTet[a] + RightTet[b]) / 2);
  }
  Cell inverted = RightTet;
  std::swap(inverted[0], inverted[1]);
  Cell notFinite = Cube;
  notFinite[3][1] = std::numeric_limits<double>::quiet_NaN();
  const Cell voxel = { Cube[0], Cube[1], Cube[3], Cube[2], Cube[4], Cube[5], Cube[7], Cube[6] };
  const Mesh mesh = meshOf({ { Triangle, Cell(RightTet.begin(), RightTet.begin() + 3) },
    { Tetra, inverted }, { QuadraticTetra, quadratic }, { Hexahedron, notFinite }, { Voxel, voxel },
    { 72, RightTet }, { Tetra, RightTet } });
  const CertificateReport report = certifyAll(mesh);
  const auto U = Certificate::Undecided, C = Certificate::Certified;
  EXPECT_EQ(report.cells, (std::vector<Certificate>{ U, Certificate::Inverted, C, U, C, U, C }));
  EXPECT_EQ(report.certified, 3);
  EXPECT_EQ(report.inverted, 1);
  EXPECT_EQ(report.undecided, 2);

  const CertificateReport some = certifyAll(mesh, {}, { 0, 1, 1, 1, 0, 1, 1 });
  EXPECT_EQ(some.cells, (std::vector<Certificate>{ U, U, U, U, C, U, U }));
  EXPECT_EQ(some.certified, 1);
  EXPECT_EQ(some.inverted + some.undecided, 0);
}

TEST(Certificate, ThreadsDoNotShow)
{
  std::mt19937 random(meshes::seed());
  std::vector<std::pair<std::uint8_t, Cell>> cells;
  for (int trial = 0; trial < 6000; ++trial)
  {
    const Volume& v = Volumes[trial % 4];
    cells.emplace_back(v.type, jittered(*v.cell, .4, random));
  }
  const Mesh mesh = meshOf(cells);
  const CertificateReport one = certifyAll(mesh);
  meshes::ThreadedMonitor threads(3);
  const CertificateReport many = certify(mesh, mesh.points, {}, {}, threads);
  EXPECT_EQ(one.cells, many.cells);
  EXPECT_EQ(one.inverted, many.inverted);
  EXPECT_EQ(one.certified + one.inverted + one.undecided, 6000);
}

TEST(Certificate, CancelThrowsAndAnEmptyMeshHasNothing)
{
  EXPECT_TRUE(certifyAll(meshOf({})).cells.empty());
  meshes::ThreadedMonitor monitor;
  monitor.cancelAt = -1;
  const Mesh mesh = meshOf({ { Tetra, RightTet } });
  EXPECT_THROW(certify(mesh, mesh.points, {}, {}, monitor), Error);
}
