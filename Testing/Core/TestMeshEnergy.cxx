// SPDX-License-Identifier: BSD-3-Clause
// The energy of a mesh, and the minimizers, on every kind of cell.
#include "Differences.h"
#include "Energies/MeshEnergy.h"
#include "Meshes.h"
#include "Motions.h"
#include "Optimization/Minimizers.h"
#include "WatchingMonitor.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace
{
using namespace morph;

struct Setting
{
  Setting(const Mesh& mesh, morph::TargetConstruction target, double epsilon, int threads = 1)
    : monitor(threads)
    , partition(motions::outerPartition(mesh))
    , energy(mesh, this->partition.free)
  {
    const std::vector<std::int8_t> orientation =
      morph::cellSigns(mesh, morph::connectedComponents(mesh));
    this->energy.setTargets(morph::targetMatrices(
      mesh, orientation, mesh.points, target, morph::CellWeights::Volume, this->monitor));
    morph::FoldoverDensity density;
    density.epsilon = epsilon;
    this->energy.setDensity(density);
  }

  meshes::ThreadedMonitor monitor;
  morph::NodePartition partition;
  morph::MeshEnergy energy;
};

/// Free nodes off their places by up to `amount`; far enough for inverted cells if it is 1.
Points displaced(const Mesh& mesh, double amount)
{
  Mesh copy = mesh;
  meshes::jitterInterior(copy, amount, meshes::seed() + 1);
  return copy.points;
}

std::vector<std::pair<std::string, Mesh>> small()
{
  auto result = meshes::all(3, 3, 2);
  for (auto& [name, mesh] : result)
  {
    meshes::jitterInterior(mesh, 0.1, meshes::seed());
  }
  return result;
}

/// Compares first and second derivatives at `x` with differences.
void expectDifferences(const morph::MeshEnergy& energy, const Points& x)
{
  differences::expectGradient(energy, x, 1e-5);
  differences::expectCurvature(energy, x);
}
}

TEST(MeshEnergy, GradientAndHessianAreThoseOfFiniteDifferences)
{
  for (const auto& [name, mesh] : small())
  {
    for (double amount : { 0.2, 1. })
    {
      SCOPED_TRACE(name + ", moved by " + std::to_string(amount));
      Setting setting(mesh, morph::TargetConstruction::Initial, amount < 0.5 ? 1e-10 : 0.5);
      expectDifferences(setting.energy, displaced(mesh, amount));
    }
  }
}

TEST(MeshEnergy, TheConditionNumbersDerivativesAreThoseOfFiniteDifferences)
{
  for (const auto& [name, mesh] : small())
  {
    SCOPED_TRACE(name);
    Setting setting(mesh, morph::TargetConstruction::Initial, 0.5);
    setting.energy.setDensity(morph::ConditionDensity());
    const Points x = displaced(mesh, 0.05);
    ASSERT_TRUE(setting.energy.value(x, setting.monitor).allowed);
    expectDifferences(setting.energy, x);
  }
}

TEST(MeshEnergy, TheConditionNumberIsAMeanAndABarrier)
{
  for (const auto& [name, mesh] : small())
  {
    SCOPED_TRACE(name);
    Setting setting(mesh, morph::TargetConstruction::Initial, 1e-10);
    setting.energy.setDensity(morph::ConditionDensity());
    const Points x = motions::mapped(mesh.points, motions::affine);
    const double norm = setting.energy.evaluate(x, setting.monitor).energy;
    Eigen::Matrix3d A;
    for (int j = 0; j < 3; ++j)
    {
      A.col(j) =
        (motions::affine(Eigen::RowVector3d::Unit(j)) - motions::affine(Eigen::RowVector3d::Zero()))
          .transpose();
    }
    // All tetrahedra have the map's own number. Their weights sum to less than 1: some are fixed.
    const double weights = setting.energy.evaluate(mesh.points, setting.monitor).energy;
    EXPECT_NEAR(norm / weights, A.norm() * A.inverse().norm() / 3, 1e-11);
    EXPECT_FALSE(setting.energy.value(displaced(mesh, 3), setting.monitor).allowed);
    EXPECT_TRUE(std::isinf(setting.energy.evaluate(displaced(mesh, 3), setting.monitor).energy));
  }
}

TEST(MeshEnergy, HessianIsExactAtTheTarget)
{
  // All eigenvalues of the density's second derivative are positive or zero there: nothing is
  // projected away.
  for (const auto& [name, mesh] : small())
  {
    SCOPED_TRACE(name);
    Setting setting(mesh, morph::TargetConstruction::Initial, 1e-10);
    morph::BlockCsr3f matrix;
    setting.energy.hessian(mesh.points, matrix, setting.monitor);
    Points direction(matrix.rows(), 3), plus, minus, product;
    std::mt19937 random(meshes::seed());
    std::uniform_real_distribution<double> number(-1, 1);
    for (Index i = 0; i < direction.size(); ++i)
    {
      direction.data()[i] = number(random);
    }
    matrix.multiply(direction, product, setting.monitor);
    const double h = 1e-5;
    Points a = mesh.points, b = mesh.points;
    for (Index i = 0; i < direction.rows(); ++i)
    {
      a.row(setting.partition.free[i]) += h * direction.row(i);
      b.row(setting.partition.free[i]) -= h * direction.row(i);
    }
    setting.energy.gradient(a, plus, setting.monitor);
    setting.energy.gradient(b, minus, setting.monitor);
    EXPECT_LT(((plus - minus) / (2 * h) - product).norm(), 1e-5 * product.norm());
  }
}

TEST(MeshEnergy, AMatrixTellsEnergiesOfOneAddressApart)
{
  // Two energies after each other in the same place, with one matrix for both.
  const Mesh first = meshes::hexes(3, 3, 3), second = meshes::tets(4, 3, 3);
  std::optional<Setting> setting;
  morph::BlockCsr3f shared, fresh;
  setting.emplace(first, morph::TargetConstruction::Initial, 1e-10);
  setting->energy.hessian(first.points, shared, setting->monitor);
  const morph::Index rows = shared.rows();
  setting.emplace(second, morph::TargetConstruction::Initial, 1e-10);
  setting->energy.hessian(second.points, shared, setting->monitor);
  setting->energy.hessian(second.points, fresh, setting->monitor);
  ASSERT_NE(fresh.rows(), rows);
  ASSERT_EQ(shared.rows(), fresh.rows());
  for (Index row = 0; row < fresh.rows(); ++row)
  {
    ASSERT_EQ(shared.numberOfBlocks(row), fresh.numberOfBlocks(row));
    EXPECT_TRUE(std::equal(fresh.blocks(row), fresh.blocks(row + 1), shared.blocks(row))) << row;
  }

  const morph::PatternId id;
  const morph::PatternId copy = id; // NOLINT(performance-unnecessary-copy-initialization)
  EXPECT_NE(id.number(), copy.number());
}

TEST(MeshEnergy, AffineImagesOfTheTargetAreStationary)
{
  for (const auto& [name, mesh] : small())
  {
    SCOPED_TRACE(name);
    Setting setting(mesh, morph::TargetConstruction::Initial, 1e-10);
    const Points x = motions::mapped(mesh.points, motions::affine);
    Points gradient;
    for (const bool isCondition : { false, true })
    {
      if (isCondition)
      {
        setting.energy.setDensity(morph::ConditionDensity());
      }
      setting.energy.gradient(x, gradient, setting.monitor);
      // Against the forces of single tetrahedra, which cancel.
      const double scale = setting.energy.evaluate(x, setting.monitor).energy;
      EXPECT_LT(gradient.cwiseAbs().maxCoeff(), 1e-13 * scale);
    }
  }
}

TEST(MeshEnergy, ThreadsDoNotShow)
{
  const Mesh mesh = meshes::hexesAndPyramids(7, 7, 7);
  Setting one(mesh, morph::TargetConstruction::Stretched, 0.5),
    three(mesh, morph::TargetConstruction::Stretched, 0.5, 3);
  const Points x = displaced(mesh, 0.8);
  EXPECT_EQ(
    one.energy.evaluate(x, one.monitor).energy, three.energy.evaluate(x, three.monitor).energy);
  Points a, b;
  one.energy.gradient(x, a, one.monitor);
  three.energy.gradient(x, b, three.monitor);
  EXPECT_TRUE(motions::identical(a, b));
  morph::BlockCsr3f first, second;
  one.energy.hessian(x, first, one.monitor);
  three.energy.hessian(x, second, three.monitor);
  Points p, q;
  EXPECT_EQ(first.solve(a, p, 1e-3, 50, one.monitor), second.solve(b, q, 1e-3, 50, three.monitor));
  EXPECT_TRUE(motions::identical(p, q));
}

TEST(Minimizers, BothFindTheSameMinimum)
{
  const Mesh mesh = meshes::hexes(5, 5, 5);
  Setting setting(mesh, morph::TargetConstruction::Initial, 1e-10);
  const Points start = displaced(mesh, 0.25);
  morph::MinimizerLimits limits;
  limits.steps = 1000;
  limits.decrease = 1e-14;
  limits.slowDecrease = 0;
  morph::MinimizerEffort ofNewton, ofBfgs;
  morph::BlockCsr3f matrix;
  Points x = start, y = start;
  const double before = setting.energy.evaluate(start, setting.monitor).energy;
  const auto newton = morph::newton(setting.energy, x, limits, matrix, ofNewton, setting.monitor);
  const auto bfgs = morph::limitedMemoryBfgs(setting.energy, y, limits, ofBfgs, setting.monitor);
  EXPECT_LT(newton.energy, before);
  EXPECT_NEAR(newton.energy, bfgs.energy, 1e-10 * newton.energy);
  EXPECT_LT(motions::difference(x, mesh.points), 1e-5);
  EXPECT_LT(motions::difference(y, mesh.points), 1e-4);
  EXPECT_LT(ofNewton.steps, 15);
  EXPECT_GT(ofNewton.linearIterations, ofNewton.steps);
  EXPECT_GT(ofBfgs.evaluations, ofBfgs.steps);
  for (Index node : setting.partition.prescribed)
  {
    EXPECT_EQ(x.row(node), mesh.points.row(node));
  }
}

TEST(Minimizers, CancelAndLimits)
{
  const Mesh mesh = meshes::hexes(5, 5, 5);
  Setting setting(mesh, morph::TargetConstruction::Initial, 1e-10);
  Points x = displaced(mesh, 0.25);
  morph::MinimizerLimits limits;
  limits.steps = 2;
  morph::MinimizerEffort effort;
  morph::BlockCsr3f matrix;
  morph::newton(setting.energy, x, limits, matrix, effort, setting.monitor);
  EXPECT_EQ(effort.steps, 2);
  setting.monitor.cancelAt = 0.5;
  setting.monitor.progress(0.6);
  EXPECT_THROW(
    morph::newton(setting.energy, x, limits, matrix, effort, setting.monitor), morph::Error);
  EXPECT_THROW(
    morph::limitedMemoryBfgs(setting.energy, x, limits, effort, setting.monitor), morph::Error);
}

namespace
{
/// An energy that never falls, and derivatives that need not be numbers, whatever the points.
struct NeverFalls : morph::SecondOrderObjective
{
  explicit NeverFalls(double energy)
    : energy(energy)
  {
  }
  const std::vector<Index>& free() const override { return this->ids; }
  Value value(const Points&, morph::Monitor& monitor) const override
  {
    monitor.parallelFor(1, 1, [](Index, Index) {});
    return { this->energy + ++this->calls, true };
  }
  void gradient(const Points&, Points& result, morph::Monitor&) const override
  {
    result = Points::Constant(4, 3, this->slope);
  }
  void hessian(const Points&, morph::BlockCsr3f& matrix, morph::Monitor&) const override
  {
    morph::BlockPattern pattern;
    for (Index row = 0; row < 4; ++row)
    {
      pattern.columns.push_back(static_cast<std::int32_t>(row));
      pattern.offsets.push_back(row + 1);
      pattern.placeOffsets.push_back(0);
    }
    matrix.open(this->id, pattern);
    for (Index row = 0; row < 4; ++row)
    {
      std::fill(matrix.blocks(row), matrix.blocks(row + 1), static_cast<float>(this->curvature));
    }
  }

  double energy, slope = 1, curvature = 1;
  mutable int calls = 0;
  morph::PatternId id;
  std::vector<Index> ids = { 0, 1, 2, 3 };
};
}

TEST(Minimizers, EndAndLeaveThePointsWhereNumbersAreNone)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  for (double energy : { 1., nan, infinite })
  {
    for (double slope : { 1., nan, infinite })
    {
      for (double curvature : { 1., nan, infinite })
      {
        NeverFalls objective(energy);
        objective.slope = slope;
        objective.curvature = curvature;
        const Points start = Points::Random(4, 3);
        meshes::WatchingMonitor monitor;
        monitor.mostLoops = 300; // a system of 100 iterations, between two questions
        morph::BlockCsr3f matrix;
        morph::MinimizerEffort effort;
        Points points = start;
        morph::newton(objective, points, {}, matrix, effort, monitor);
        morph::limitedMemoryBfgs(objective, points, {}, effort, monitor);
        EXPECT_EQ(points, start) << energy << " " << slope << " " << curvature;
        EXPECT_GT(monitor.questions, 0);
      }
    }
  }
}

TEST(Minimizers, ALineSearchAsksWhetherToStop)
{
  NeverFalls objective(1); // all halvings are tried
  meshes::WatchingMonitor monitor;
  morph::MinimizerEffort effort;
  Points points = Points::Zero(4, 3);
  points(0, 0) = 1; // a size for the first step
  morph::limitedMemoryBfgs(objective, points, {}, effort, monitor);
  EXPECT_GT(monitor.questions, 40);
  monitor.questions = 0;
  monitor.cancelAfter = 5;
  std::string message;
  EXPECT_EQ(motions::kindOf(
              [&] { morph::limitedMemoryBfgs(objective, points, {}, effort, monitor); }, message),
    morph::Error::Kind::Cancelled);
  EXPECT_LT(monitor.questions, 8);
}
