// SPDX-License-Identifier: BSD-3-Clause
#include "Differences.h"
#include "Energies/FaceEnergy.h"

#include "Meshes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace morph;
using Matrix = Eigen::Matrix2d;
using Row = Eigen::RowVector3d;

namespace
{
struct Case
{
  double epsilon;
  int power;
};
constexpr Case Cases[] = { { 0, 1 }, { 0, 3 }, { 0.3, 1 }, { 0.3, 2 } };

class Numbers
{
public:
  explicit Numbers(unsigned seed)
    : random_(seed)
  {
  }
  double operator()() { return this->number_(this->random_); }
  /// A matrix, with a positive determinant where asked for.
  Matrix matrix(bool positive)
  {
    Matrix J;
    do
    {
      J = Matrix::NullaryExpr([this] { return (*this)(); });
    } while (std::abs(J.determinant()) < 0.1 || (positive && J.determinant() < 0));
    return J;
  }

private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> number_{ -1, 1 };
};

FaceDensity make(const Case& c)
{
  FaceDensity density;
  density.epsilon = c.epsilon;
  density.power = c.power;
  return density;
}

Eigen::Vector4d gradientOf(const FaceDensity& density, const Matrix& J)
{
  Matrix g;
  density.gradient(J, g);
  return Eigen::Map<const Eigen::Vector4d>(g.data());
}

/// The second derivative by differences of the first.
Eigen::Matrix4d difference(const FaceDensity& density, const Matrix& J)
{
  const double h = 1e-6;
  Eigen::Matrix4d H;
  for (int i = 0; i < 4; ++i)
  {
    Matrix plus = J, minus = J;
    plus.data()[i] += h;
    minus.data()[i] -= h;
    H.col(i) = (gradientOf(density, plus) - gradientOf(density, minus)) / (2 * h);
  }
  return (H + H.transpose()) / 2;
}

Eigen::Matrix4d withoutNegative(const Eigen::Matrix4d& H)
{
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(H);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.).asDiagonal() *
         eigen.eigenvectors().transpose();
}

/// A plane surface of quadrilaterals and, in every other square, of two triangles.
struct Surface
{
  Points points;
  std::vector<std::vector<Index>> faces;
  std::vector<Index> inner; ///< nodes that are not on the rim

  explicit Surface(int n, double jitter, unsigned seed)
  {
    Numbers number(seed);
    this->points = Points::Zero((n + 1) * (n + 1), 3);
    for (int j = 0; j <= n; ++j)
    {
      for (int i = 0; i <= n; ++i)
      {
        const bool isInner = i > 0 && j > 0 && i < n && j < n;
        const double by = isInner ? jitter : 0;
        const Index node = j * (n + 1) + i;
        this->points.row(node) = Row(i + by * number(), j + by * number(), 0);
        if (isInner)
        {
          this->inner.push_back(node);
        }
      }
    }
    for (int j = 0; j < n; ++j)
    {
      for (int i = 0; i < n; ++i)
      {
        const Index a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
        if ((i + j) % 2 == 0)
        {
          this->faces.push_back({ a, b, c, d });
        }
        else
        {
          this->faces.push_back({ a, b, c });
          this->faces.push_back({ a, c, d });
        }
      }
    }
  }

  /// The corners, with the faces at their present place for targets.
  std::vector<FaceCorner> corners() const
  {
    std::vector<FaceCorner> result;
    for (const std::vector<Index>& face : this->faces)
    {
      const std::size_t n = face.size();
      for (std::size_t k = 0; k < n; ++k)
      {
        FaceCorner corner{ { face[k], face[(k + 1) % n], face[(k + n - 1) % n] }, {}, 0 };
        Matrix edges;
        for (int e = 0; e < 2; ++e)
        {
          edges.col(e) = (this->points.row(corner.node[e + 1]) - this->points.row(corner.node[0]))
                           .head<2>()
                           .transpose();
        }
        corner.inverse = edges.inverse();
        corner.weight = edges.determinant() / (n == 3 ? 3. : 2.);
        result.push_back(corner);
      }
    }
    return result;
  }
};

Points rowsOf(std::size_t count, const Row& row)
{
  Points result(static_cast<Index>(count), 3);
  result.rowwise() = row;
  return result;
}
}

TEST(FaceDensity, OneForSimilaritiesAndMoreForAllElse)
{
  const FaceDensity density;
  Matrix R;
  R << std::cos(0.7), -std::sin(0.7), std::sin(0.7), std::cos(0.7);
  EXPECT_NEAR(density.value(R), 1, 1e-14);
  EXPECT_NEAR(density.value(5 * R), 1, 1e-14);
  Numbers number(meshes::seed());
  for (int i = 0; i < 100; ++i)
  {
    EXPECT_GT(density.value(number.matrix(true)), 1);
  }
  EXPECT_TRUE(std::isinf(density.value(Matrix::Zero())));
  EXPECT_TRUE(std::isinf(density.value(Eigen::Vector2d(1, -1).asDiagonal().toDenseMatrix())));
}

TEST(FaceDensity, IsTheConditionNumber)
{
  const FaceDensity density;
  Numbers number(meshes::seed());
  for (int i = 0; i < 100; ++i)
  {
    const Matrix J = number.matrix(true);
    EXPECT_NEAR(density.value(J), J.norm() * J.inverse().norm() / 2, 1e-12 * density.value(J));
  }
}

TEST(FaceDensity, DerivativesAgainstDifferences)
{
  Numbers number(meshes::seed() + 1);
  for (const Case& c : Cases)
  {
    const FaceDensity density = make(c);
    FaceDensity plain = density;
    plain.power = 1;
    for (int i = 0; i < 100; ++i)
    {
      const Matrix J = number.matrix(c.epsilon == 0);
      const Eigen::Vector4d g = gradientOf(density, J);
      const double h = 1e-6;
      for (int k = 0; k < 4; ++k)
      {
        Matrix plus = J, minus = J;
        plus.data()[k] += h;
        minus.data()[k] -= h;
        EXPECT_NEAR(g[k], (density.value(plus) - density.value(minus)) / (2 * h), 1e-6 * g.norm());
      }
      // The power adds a multiple of the gradient's square, which is positive already.
      const double p = c.power, phi = plain.value(J);
      const Eigen::Vector4d own = gradientOf(plain, J);
      const Eigen::Matrix4d expected =
        p * std::pow(phi, p - 1) * withoutNegative(difference(plain, J)) +
        p * (p - 1) * std::pow(phi, p - 2) * own * own.transpose();
      EXPECT_LE((density.hessian(J) - expected).norm(), 1e-5 * (1 + expected.norm()));
    }
  }
}

TEST(FaceEnergy, DerivativesAgainstDifferences)
{
  for (const Case& c : Cases)
  {
    const Surface surface(5, 0.3, meshes::seed());
    FaceEnergy energy(surface.corners(), surface.inner, surface.points.rows());
    energy.setPlanes(
      rowsOf(energy.corners().size(), Row(0, 0, 1)), rowsOf(surface.inner.size(), Row(0, 0, 1)));
    energy.setDensity(make(c));
    const Points x = Surface(5, 0.1, meshes::seed() + 7).points;
    const Points g = differences::expectGradient(energy, x, 1e-6, 0, 2);
    EXPECT_TRUE(g.col(2).isZero(0));
    differences::expectCurvature(energy, x, 2); // all corners are near their targets
  }
}

TEST(FaceEnergy, NewtonMatrixAtTheTargetIsTheSecondDerivative)
{
  Monitor monitor;
  const Surface surface(5, 0.3, meshes::seed());
  FaceEnergy energy(surface.corners(), surface.inner, surface.points.rows());
  energy.setPlanes(
    rowsOf(energy.corners().size(), Row(0, 0, 1)), rowsOf(surface.inner.size(), Row(0, 0, 1)));
  BlockCsr3f matrix;
  energy.hessian(surface.points, matrix, monitor);
  const double h = 1e-5;
  for (std::size_t i = 0; i < surface.inner.size(); ++i)
  {
    for (int j = 0; j < 2; ++j)
    {
      Points plus = surface.points, minus = plus, up, down, product;
      plus(surface.inner[i], j) += h;
      minus(surface.inner[i], j) -= h;
      energy.gradient(plus, up, monitor);
      energy.gradient(minus, down, monitor);
      Points unit = Points::Zero(up.rows(), 3);
      unit(static_cast<Index>(i), j) = 1;
      matrix.multiply(unit, product, monitor);
      const Points expected = (up - down) / (2 * h);
      EXPECT_LE((product - expected).norm(), 1e-5 * expected.norm());
    }
  }
}

TEST(FaceEnergy, AffineImagesAreStationary)
{
  Monitor monitor;
  Numbers number(meshes::seed());
  for (int round = 0; round < 5; ++round)
  {
    const Surface surface(6, 0.3, meshes::seed() + static_cast<unsigned>(round));
    for (const int power : { 1, 4 })
    {
      FaceEnergy energy(surface.corners(), surface.inner, surface.points.rows());
      energy.setPlanes(
        rowsOf(energy.corners().size(), Row(0, 0, 1)), rowsOf(surface.inner.size(), Row(0, 0, 1)));
      FaceDensity density;
      density.power = power;
      energy.setDensity(density);
      Matrix A = number.matrix(true);
      Points moved = surface.points;
      moved.leftCols<2>() = surface.points.leftCols<2>() * A.transpose();
      Points g;
      energy.gradient(moved, g, monitor);
      // A node's forces cancel: none of them is small.
      Matrix slope;
      density.gradient(A, slope);
      EXPECT_LE(g.cwiseAbs().maxCoeff(), 1e-12 * slope.norm() * 36);
    }
  }
}
