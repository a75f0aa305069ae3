// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/CellBatchKernel.h"
#include "Energies/FoldoverKernel.h"
#include "Meshes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{
using Matrix = Eigen::Matrix3d;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

/// The kernels' formulas for one matrix.
///@{
using Kernel = morph::foldover::Matrix3<double>;

Kernel toKernel(const Matrix& A)
{
  Kernel result;
  Eigen::Map<Matrix> view(&result[0][0]);
  view = A;
  return result;
}
Eigen::Map<const Matrix> toEigen(const Kernel& A)
{
  return Eigen::Map<const Matrix>(&A[0][0]);
}

struct Foldover
{
  morph::foldover::Parameters<double> parameters{ 0.1, 1e-10 };

  double value(const Matrix& J) const
  {
    double phi;
    morph::foldover::density(this->parameters, J.squaredNorm(), J.determinant(), phi);
    return phi;
  }
  double gradient(const Matrix& J, Matrix& derivative) const
  {
    Kernel cofactor;
    morph::foldover::cofactor(toKernel(J), cofactor);
    morph::foldover::Derivatives<double> d;
    morph::foldover::derivatives(this->parameters, J.squaredNorm(), J.determinant(), d);
    derivative = 2 * d.I * J + d.D * toEigen(cofactor);
    return d.value;
  }
  void hessian(const Kernel& J, const Kernel& g, Kernel (&block)[3][3]) const
  {
    morph::foldover::hessian(this->parameters, J, g, block);
  }
};

struct Condition
{
  double value(const Matrix& J) const
  {
    Kernel cofactor;
    morph::foldover::cofactor(toKernel(J), cofactor);
    double kappa;
    morph::condition::density(
      J.squaredNorm(), toEigen(cofactor).squaredNorm(), J.determinant(), kappa);
    return kappa;
  }
  double gradient(const Matrix& J, Matrix& derivative) const
  {
    Kernel result;
    double kappa;
    morph::condition::gradient(toKernel(J), kappa, result);
    derivative = toEigen(result);
    return kappa;
  }
  void hessian(const Kernel& J, const Kernel& g, Kernel (&block)[3][3]) const
  {
    morph::condition::hessian(J, g, block);
  }
};
///@}

struct Case
{
  const char* name;
  double theta, epsilon;
};
const Case Cases[] = { { "hex", 0.1, 1e-10 }, { "tet", 0.5, 1e-10 }, { "regularised", 0.1, 0.7 },
  { "shape alone", 0, 0.3 } };

Foldover densityOf(const Case& c)
{
  return { { c.theta, c.epsilon } };
}

/// Jacobians of all kinds: near the identity, sheared, nearly flat, and, where the density allows
/// it, inverted.
std::vector<Matrix> jacobians(bool inverted)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<Matrix> result{ Matrix::Identity(), 2 * Matrix::Identity() };
  while (result.size() < 40)
  {
    Matrix J = Matrix::Identity();
    for (int i = 0; i < 9; ++i)
    {
      J.data()[i] += 0.8 * number(random);
    }
    if (result.size() % 5 == 0)
    {
      J.col(2) = J.col(0) + 0.5 * J.col(1) + 0.05 * J.col(2);
    }
    if (inverted || J.determinant() > 0.02)
    {
      result.push_back(J);
    }
  }
  return result;
}

template <typename Density>
Matrix finiteDifference(const Density& density, const Matrix& J)
{
  const double h = 1e-6;
  Matrix result;
  for (int i = 0; i < 9; ++i)
  {
    Matrix plus = J, minus = J;
    plus.data()[i] += h;
    minus.data()[i] -= h;
    result.data()[i] = (density.value(plus) - density.value(minus)) / (2 * h);
  }
  return result;
}

/// The second derivatives by differences of the first, their negative eigenvalues left out.
template <typename Density>
Matrix9 projectedDifference(const Density& density, const Matrix& J)
{
  const double h = 1e-6;
  Matrix9 H;
  for (int i = 0; i < 9; ++i)
  {
    Matrix plus = J, minus = J, a, b;
    plus.data()[i] += h;
    minus.data()[i] -= h;
    density.gradient(plus, a);
    density.gradient(minus, b);
    const Matrix difference = (a - b) / (2 * h);
    H.col(i) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(difference.data());
  }
  const Eigen::SelfAdjointEigenSolver<Matrix9> eigen(Matrix9(H + H.transpose()) / 2);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.).asDiagonal() *
         eigen.eigenvectors().transpose();
}

/// With the unit matrix for shape functions block[a][b] is d2/(dJ_a dJ_b) by columns.
template <typename Density>
Matrix9 assembled(const Density& density, const Matrix& J)
{
  Kernel block[3][3];
  density.hessian(toKernel(J), toKernel(Matrix::Identity()), block);
  Matrix9 H;
  for (int a = 0; a < 3; ++a)
  {
    for (int b = 0; b < 3; ++b)
    {
      H.block<3, 3>(3 * a, 3 * b) =
        a <= b ? Matrix(toEigen(block[a][b])) : Matrix(toEigen(block[b][a]).transpose());
    }
  }
  return H;
}
}

TEST(FoldoverDensity, OneForRotationsAndMoreForAllElse)
{
  const Matrix R =
    Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  for (const Case& c : Cases)
  {
    SCOPED_TRACE(c.name);
    const Foldover density = densityOf({ c.name, c.theta, 1e-10 });
    EXPECT_NEAR(density.value(R), 1, 1e-14);
    for (const Matrix& J : jacobians(false))
    {
      EXPECT_GT(density.value(J), 1 - 1e-14);
      EXPECT_NEAR(density.value(R * J) / density.value(J), 1, 1e-12);
    }
  }
}

TEST(FoldoverDensity, GradientIsThatOfFiniteDifferences)
{
  for (const Case& c : Cases)
  {
    SCOPED_TRACE(c.name);
    const Foldover density = densityOf(c);
    for (const Matrix& J : jacobians(c.epsilon > 0.1))
    {
      Matrix derivative;
      EXPECT_NEAR(density.gradient(J, derivative) / density.value(J), 1, 1e-12);
      const double scale = std::max(1., derivative.norm());
      EXPECT_LT((derivative - finiteDifference(density, J)).norm(), 1e-5 * scale) << J;
    }
  }
}

TEST(FoldoverDensity, HessianIsTheProjectedOne)
{
  for (const Case& c : Cases)
  {
    SCOPED_TRACE(c.name);
    const Foldover density = densityOf(c);
    for (const Matrix& J : jacobians(c.epsilon > 0.1))
    {
      const Matrix9 expected = projectedDifference(density, J), H = assembled(density, J);
      EXPECT_LT((H - expected).norm(), 2e-5 * std::max(1., expected.norm())) << J;
    }
  }
}

TEST(FoldoverDensity, SignedSingularValues)
{
  std::vector<Matrix> all = jacobians(true);
  all.push_back(Matrix::Zero());
  all.push_back(Eigen::Vector3d(1, 2, 3) * Eigen::RowVector3d(1, -1, 2));
  all.push_back(Eigen::Vector3d(1, 1, -1).asDiagonal());
  for (const Matrix& J : all)
  {
    Kernel left, right;
    morph::foldover::Vector3<double> values;
    morph::foldover::signedSingularValues(toKernel(J), left, values, right);
    const Matrix U = toEigen(left), V = toEigen(right);
    const Eigen::Vector3d S(values.x);
    EXPECT_LT((U * S.asDiagonal() * V.transpose() - J).norm(), 1e-6 * (1 + J.norm())) << J;
    EXPECT_NEAR(U.determinant(), 1, 1e-10);
    EXPECT_NEAR(V.determinant(), 1, 1e-10);
    EXPECT_GE(S[0], S[1] - 1e-7);
    EXPECT_GE(S[1], std::abs(S[2]) - 1e-7);
  }
}

TEST(FoldoverDensity, IsInfiniteWhereItCannotBeComputed)
{
  const Foldover density;
  for (const double size : { 1e200, std::numeric_limits<double>::quiet_NaN() })
  {
    const Matrix J = Eigen::Vector3d(size, 1, -size).asDiagonal();
    Matrix derivative;
    EXPECT_EQ(density.value(J), std::numeric_limits<double>::infinity()) << size;
    EXPECT_EQ(density.gradient(J, derivative), std::numeric_limits<double>::infinity()) << size;
  }
}

TEST(ConditionDensity, IsTheConditionNumberAndABarrier)
{
  const Condition density;
  const Matrix R =
    Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  EXPECT_NEAR(density.value(R), 1, 1e-14);
  for (const Matrix& J : jacobians(false))
  {
    EXPECT_NEAR(density.value(J) / (J.norm() * J.inverse().norm() / 3), 1, 1e-11) << J;
    EXPECT_NEAR(density.value(1e5 * R * J) / density.value(J), 1, 1e-11);
  }
  const double infinity = std::numeric_limits<double>::infinity();
  Matrix derivative;
  for (const Eigen::Vector3d& stretch :
    { Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(1, 2, -1e-9), Eigen::Vector3d(0, 0, 0),
      Eigen::Vector3d(1, 1, std::numeric_limits<double>::quiet_NaN()) })
  {
    const Matrix J = stretch.asDiagonal();
    EXPECT_EQ(density.value(J), infinity) << stretch;
    EXPECT_EQ(density.gradient(J, derivative), infinity) << stretch;
  }
  // It grows with 1 / det, the mean ratio with det^(-2/3).
  const auto flat = [](double h) -> Matrix { return Eigen::Vector3d(1, 1, h).asDiagonal(); };
  EXPECT_NEAR(density.value(flat(1e-7)) / density.value(flat(1e-4)), 1e3, 1);
}

TEST(ConditionDensity, DerivativesAreThoseOfFiniteDifferences)
{
  const Condition density;
  for (const Matrix& J : jacobians(false))
  {
    Matrix derivative;
    EXPECT_NEAR(density.gradient(J, derivative) / density.value(J), 1, 1e-12);
    EXPECT_LT(
      (derivative - finiteDifference(density, J)).norm(), 1e-5 * std::max(1., derivative.norm()))
      << J;
    const Matrix9 expected = projectedDifference(density, J), H = assembled(density, J);
    EXPECT_LT((H - expected).norm(), 2e-5 * std::max(1., expected.norm())) << J;
  }
}
