// SPDX-License-Identifier: BSD-3-Clause
#include "DirectSolutions.h"
#include "Meshes.h"

#include "Geometry/AffineFit.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

using namespace morph;

namespace
{
/// Random points squeezed into a space of the given dimension, turned in space.
Points flatPoints(Index n, int dimension, std::mt19937& random)
{
  Points points = meshes::randomPoints(n, random);
  points.rightCols(3 - dimension).setZero();
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(1.1, Eigen::Vector3d(3, -1, 2).normalized()).toRotationMatrix();
  return (points * turn).rowwise() + Eigen::RowVector3d(4, 5, -6);
}
}

TEST(AffineFit, IsTheLeastSquaresSolutionOfMinimumNorm)
{
  std::mt19937 random(meshes::seed());
  for (int dimension : { 0, 1, 2, 3 })
  {
    const Points rest = flatPoints(40, dimension, random), u = meshes::randomPoints(40, random);
    const AffineLeastSquares leastSquares(rest);
    EXPECT_EQ(leastSquares.directions().rank(), dimension);
    const AffineFit fit = leastSquares.fit(u);
    // Without the means, the gradient is a least-squares problem of its own.
    const Eigen::MatrixXd arms = rest.rowwise() - rest.colwise().mean();
    const Eigen::MatrixXd right = u.rowwise() - u.colwise().mean();
    const Eigen::MatrixXd gradient =
      dimension == 0 ? Eigen::MatrixXd::Zero(3, 3) : direct::leastSquares(arms, right, 1e-8);
    EXPECT_LT((fit.gradient() - gradient).norm(), 1e-12) << dimension;
    EXPECT_LT((fit.displacement(rest.colwise().mean()) - u.colwise().mean()).norm(), 1e-13);
  }
}

// Squares of an unevenness of 3e-6 have four digits beside those of the extent.
TEST(AffineFit, OfNearlyFlatPointsTurnsWithThem)
{
  std::mt19937 random(meshes::seed());
  Eigen::Matrix3d turn;
  turn << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  for (int trial = 0; trial < 20; ++trial)
  {
    Points rest = meshes::randomPoints(40, random);
    rest.col(0) *= 3e-6;
    const Points u = meshes::randomPoints(40, random), turned = rest * turn;
    const AffineFit fit = AffineLeastSquares(rest).fit(u);
    const AffineFit other = AffineLeastSquares(turned).fit(u * turn);
    for (Index i = 0; i < rest.rows(); ++i)
    {
      const Eigen::RowVector3d expected = fit.displacement(rest.row(i)) * turn;
      EXPECT_LT((other.displacement(turned.row(i)) - expected).norm(), 1e-9)
        << "seed " << meshes::seed() << ", trial " << trial;
    }
  }
}

TEST(AffineFit, TransposeIsTheAdjoint)
{
  std::mt19937 random(meshes::seed());
  for (int dimension : { 0, 1, 2, 3 })
  {
    const Points rest = flatPoints(40, dimension, random), u = meshes::randomPoints(40, random);
    const Points x = meshes::randomPoints(25, random), gradient = meshes::randomPoints(25, random);
    const AffineLeastSquares leastSquares(rest);
    const AffineFit fit = leastSquares.fit(u);
    double value = 0;
    for (Index i = 0; i < x.rows(); ++i)
    {
      value += gradient.row(i).dot(fit.displacement(x.row(i)));
    }
    Points adjoint = Points::Ones(40, 3); // added to
    leastSquares.fitTranspose(x, gradient, adjoint);
    EXPECT_NEAR((adjoint.array() - 1).matrix().cwiseProduct(u).sum(), value, 1e-11) << dimension;
  }
}
