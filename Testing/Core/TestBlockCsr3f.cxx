// SPDX-License-Identifier: BSD-3-Clause
// The symmetric matrix of Newton's method, against products with all of its blocks.
#include "Meshes.h"
#include "Motions.h"
#include "Optimization/BlockCsr3f.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace
{
using morph::Index;
using morph::Points;

/// A matrix, and all blocks of its upper part one by one.
struct Sample
{
  struct Block
  {
    Index row, column;
    Eigen::Matrix3d entries;
  };
  morph::BlockCsr3f matrix;
  std::vector<Block> upper;
};

/// Rows with about `degree` blocks after the diagonal, at most `reach` rows farther. The diagonal
/// dominates, so that the matrix is positive definite.
Sample sample(Index rows, int degree, Index reach)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> number(-1, 1);
  Sample result;
  morph::BlockPattern pattern;
  for (Index row = 0; row < rows; ++row)
  {
    std::set<Index> columns;
    std::uniform_int_distribution<Index> after(row, std::min(rows - 1, row + reach));
    for (int k = 0; k < degree; ++k)
    {
      columns.insert(after(random));
    }
    columns.insert(row);
    for (const Index column : columns)
    {
      Eigen::Matrix3d entries = Eigen::Matrix3d::NullaryExpr([&] { return number(random); });
      if (column == row)
      {
        entries = (entries + entries.transpose()).eval() / 2;
        entries.diagonal().array() += 20 * degree;
      }
      entries = entries.cast<float>().cast<double>().eval();
      pattern.columns.push_back(static_cast<std::int32_t>(column));
      result.upper.push_back({ row, column, entries });
    }
    pattern.offsets.push_back(static_cast<Index>(pattern.columns.size()));
    pattern.placeOffsets.push_back(0);
  }
  result.matrix.open(morph::PatternId(), pattern);
  float* to = result.matrix.blocks(0);
  for (const Sample::Block& block : result.upper)
  {
    Eigen::Map<Eigen::Matrix3f> own(to);
    own = block.entries.cast<float>();
    to += 9;
  }
  return result;
}

Points productOf(const Sample& matrix, const Points& x)
{
  Points y = Points::Zero(x.rows(), 3);
  for (const Sample::Block& block : matrix.upper)
  {
    y.row(block.row) += (block.entries * x.row(block.column).transpose()).transpose();
    if (block.column != block.row)
    {
      y.row(block.column) += x.row(block.row) * block.entries;
    }
  }
  return y;
}

/// A multiple of the identity.
struct Scaling : morph::NodePreconditioner
{
  Scaling(Index rows, double factor)
    : count(rows)
    , factor(factor)
  {
  }
  void apply(const Points& from, Points& to, morph::Monitor&) const override
  {
    to = this->factor * from;
  }
  double diagonal(Index) const override { return 1; }
  Index rows() const override { return this->count; }
  Index count;
  double factor;
};

Points randomRows(Index rows)
{
  std::mt19937 random(meshes::seed() + 1);
  std::uniform_real_distribution<double> number(-1, 1);
  return Points::NullaryExpr(rows, 3, [&] { return number(random); });
}
}

TEST(BlockCsr3f, ProductsHaveBothTriangles)
{
  for (const Index rows : { 0, 1, 5, 1024, 1025, 5000 })
  {
    for (const Index reach : { 3, 200, 5000 })
    {
      SCOPED_TRACE(std::to_string(rows) + " rows, reach " + std::to_string(reach));
      const Sample own = sample(rows, 6, reach);
      const Points x = randomRows(rows), expected = productOf(own, x);
      meshes::ThreadedMonitor one(1), three(3);
      Points y, again;
      own.matrix.multiply(x, y, one);
      own.matrix.multiply(x, again, three);
      ASSERT_EQ(y.rows(), rows);
      EXPECT_TRUE(motions::identical(y, again));
      EXPECT_LE((y - expected).norm(), 1e-13 * (1 + expected.norm()));
    }
  }
}

TEST(BlockCsr3f, ConjugateGradientsReachTheirTolerance)
{
  const Sample own = sample(3000, 6, 500);
  const Points b = randomRows(3000);
  meshes::ThreadedMonitor monitor(2);
  Points x, product;
  const int iterations = own.matrix.solve(b, x, 1e-8, 100, monitor);
  EXPECT_GT(iterations, 1);
  EXPECT_LT(iterations, 50);
  EXPECT_LE((b - productOf(own, x)).norm(), 2e-8 * b.norm());
  EXPECT_EQ(own.matrix.solve(b, x, 1e-8, 1, monitor), 1);
}

TEST(BlockCsr3f, APreconditionerOfTheWholeMeshChangesTheWayNotTheSolution)
{
  const Sample own = sample(3000, 6, 500);
  const Points b = randomRows(3000);
  meshes::ThreadedMonitor one(1), three(3);
  Points plain, x, again;
  const int alone = own.matrix.solve(b, plain, 1e-10, 100, one);
  const auto solve =
    [&](double factor, double tolerance, Points& result, meshes::ThreadedMonitor& monitor)
  {
    const Scaling whole(3000, factor);
    return own.matrix.solve(
      b, result, 1e-10, 100, monitor, morph::CopiedRows::alone(), &whole, tolerance);
  };
  EXPECT_LT(solve(0.3, 1e-10, x, one), alone);
  EXPECT_LE((x - plain).norm(), 1e-9 * plain.norm());
  solve(0.3, 1e-10, again, three);
  EXPECT_TRUE(motions::identical(x, again));
  // A loose tolerance is for it alone.
  solve(0.3, 0.3, again, one);
  EXPECT_GT((again - plain).norm(), 1e-4 * plain.norm());
  // One that is not positive definite: the diagonal blocks alone find the solution.
  EXPECT_GE(solve(-10, 0.3, x, one), alone);
  EXPECT_LE((x - plain).norm(), 1e-9 * plain.norm());
}
