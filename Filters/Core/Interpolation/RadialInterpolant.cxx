// SPDX-License-Identifier: BSD-3-Clause
#include "Interpolation/RadialInterpolant.h"

#include "Solvers/DenseCholesky.h"
#include "Support/Parallel.h"
#include "Support/ProgressRange.h"

#include <Eigen/Householder>

#include <utility>

namespace morph
{
namespace
{
constexpr Index ColumnGrain = 16;
constexpr int Terms = 4; // 1, x, y, z

void fillLower(
  const RadialKernel& kernel, const Points& centers, Eigen::MatrixXd& matrix, Monitor& monitor)
{
  const Index n = centers.rows();
  matrix.resize(n, n);
  parallel(n, ColumnGrain, monitor,
    [&](Index j)
    {
      for (Index i = j; i < n; ++i)
      {
        matrix(i, j) = kernel((centers.row(i) - centers.row(j)).squaredNorm());
      }
    });
}
}

bool RadialInterpolant::prepare(const RadialKernel& kernel, const Points& centers, Monitor& monitor)
{
  this->kernel_ = kernel;
  this->centers_ = centers;
  const Index n = centers.rows();
  Reflector polynomial(n, Terms);
  polynomial.col(0).setOnes();
  polynomial.rightCols<3>() = centers;
  this->reflectors_.setZero(n, Terms);
  fillLower(kernel, centers, this->matrix_, monitor);
  for (int k = 0; k < Terms; ++k)
  {
    monitor.check();
    double tail = 0;
    Eigen::VectorXd essential(n - k - 1);
    polynomial.col(k).tail(n - k).makeHouseholder(essential, this->scales_[k], tail);
    auto v = this->reflectors_.col(k);
    v[k] = 1;
    v.tail(n - k - 1) = essential;
    for (int j = k; j < Terms; ++j)
    {
      polynomial.col(j) -= (this->scales_[k] * v.dot(polynomial.col(j))) * v;
    }
    auto symmetric = this->matrix_.selfadjointView<Eigen::Lower>();
    Eigen::VectorXd w = this->scales_[k] * (symmetric * v);
    w -= (this->scales_[k] / 2 * v.dot(w)) * v;
    symmetric.rankUpdate(v, w, -1);
  }
  this->triangle_ = polynomial.topRows<Terms>().triangularView<Eigen::Upper>();
  const Index rest = n - Terms;
  return factorizeCholesky(this->matrix_.bottomRightCorner(rest, rest), monitor);
}

Eigen::MatrixXd RadialInterpolant::reflect(const Points& values) const
{
  Eigen::MatrixXd result = values;
  for (int k = 0; k < Terms; ++k)
  {
    const auto v = this->reflectors_.col(k);
    result -= this->scales_[k] * v * (v.transpose() * result);
  }
  return result;
}

Points RadialInterpolant::reflectBack(Eigen::MatrixXd values) const
{
  for (int k = Terms - 1; k >= 0; --k)
  {
    const auto v = this->reflectors_.col(k);
    values -= this->scales_[k] * v * (v.transpose() * values);
  }
  return values;
}

RadialInterpolant::Coefficients RadialInterpolant::solve(const Points& values) const
{
  const Index rest = this->centers_.rows() - Terms;
  Eigen::MatrixXd x = this->reflect(values);
  solveCholesky(this->matrix_.bottomRightCorner(rest, rest), x.bottomRows(rest));
  Eigen::Matrix<double, Terms, 3> top =
    x.topRows<Terms>() -
    this->matrix_.bottomLeftCorner(rest, Terms).transpose() * x.bottomRows(rest);
  this->triangle_.triangularView<Eigen::Upper>().solveInPlace(top);
  x.topRows<Terms>().setZero();
  return { this->reflectBack(std::move(x)), top };
}

Points RadialInterpolant::solveTranspose(const Coefficients& gradient) const
{
  const Index rest = this->centers_.rows() - Terms;
  Eigen::Matrix<double, Terms, 3> top = gradient.ofPolynomial;
  this->triangle_.transpose().triangularView<Eigen::Lower>().solveInPlace(top);
  Eigen::MatrixXd x = this->reflect(gradient.ofKernels);
  x.bottomRows(rest) -= this->matrix_.bottomLeftCorner(rest, Terms) * top;
  solveCholesky(this->matrix_.bottomRightCorner(rest, rest), x.bottomRows(rest));
  x.topRows<Terms>() = top;
  return this->reflectBack(std::move(x));
}

void RadialInterpolant::evaluate(
  const Coefficients& coefficients, const Points& targets, Points& values, Monitor& monitor) const
{
  kernelSums(this->kernel_, targets, this->centers_, coefficients.ofKernels, values, monitor);
  const auto& p = coefficients.ofPolynomial;
  parallel(targets.rows(), monitor,
    [&](Index i)
    {
      values.row(i) +=
        p.row(0) + targets(i, 0) * p.row(1) + targets(i, 1) * p.row(2) + targets(i, 2) * p.row(3);
    });
}

RadialInterpolant::Coefficients RadialInterpolant::evaluateTranspose(
  const Points& targets, const Points& gradient, Monitor& monitor) const
{
  Coefficients result;
  kernelSums(this->kernel_, this->centers_, targets, gradient, result.ofKernels, monitor);
  result.ofPolynomial.row(0) = gradient.colwise().sum();
  result.ofPolynomial.bottomRows<3>() = targets.transpose() * gradient;
  return result;
}
}
