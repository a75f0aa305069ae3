// SPDX-License-Identifier: BSD-3-Clause
// The answer of the linear methods to an affine motion with fixed weights.
#include "LinearMethods.h"
#include "Meshes.h"
#include "Morpher/AffineModes.h"
#include "Motions.h"

#include <gtest/gtest.h>

#include <random>

using namespace morph;
using motions::difference;
using motions::identical;
using motions::outerPartition;

namespace
{
class AffineModesOf : public testing::TestWithParam<meshes::LinearMethod>
{
};

double number(std::mt19937& random)
{
  return std::uniform_real_distribution<double>(-1, 1)(random);
}

AffineMotion randomMotion(std::mt19937& random)
{
  return AffineMotion().unaryExpr([&](double) { return .1 * number(random); });
}

/// Fields of a weight that falls along x, about the origin.
AffineFields fading(const Mesh& mesh, const NodePartition& partition)
{
  AffineFields fields(static_cast<Index>(partition.prescribed.size()), 4);
  for (Index i = 0; i < fields.rows(); ++i)
  {
    const Eigen::RowVector3d x = mesh.points.row(partition.prescribed[i]);
    const double weight = 1 / (1 + x[0] * x[0]);
    fields.row(i) << weight, weight * x[0], weight * x[1], weight * x[2];
  }
  return fields;
}

Points weightedTargets(const Mesh& mesh, const NodePartition& partition, const AffineFields& fields,
  const AffineMotion& motion)
{
  return meshes::rows(mesh.points, partition.prescribed) + fields * motion.transpose();
}
}

TEST_P(AffineModesOf, GiveWhatEvaluateGives)
{
  std::mt19937 random(meshes::seed());
  for (const auto& [name, mesh] : motions::jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    meshes::ThreadedMonitor monitor(2);
    const auto method = GetParam().make();
    method->prepare(mesh, partition, monitor);
    const AffineFields fields = fading(mesh, partition);
    AffineModes modes;
    EXPECT_FALSE(modes.isPreparedFor(*method, fields));
    modes.prepare(*method, fields, monitor);
    EXPECT_TRUE(modes.isPreparedFor(*method, fields));
    EXPECT_FALSE(modes.isPreparedFor(*method, 2 * fields));
    for (int i = 0; i < 3; ++i)
    {
      const AffineMotion motion = randomMotion(random);
      const Points to = weightedTargets(mesh, partition, fields, motion);
      Points direct, moved, again;
      method->evaluate(to, direct, monitor);
      modes.evaluate(*method, motion, to, moved, monitor);
      EXPECT_LT(difference(moved, direct), 1e-8) << name;
      EXPECT_TRUE(identical(meshes::rows(moved, partition.prescribed), to)) << name;
      meshes::ThreadedMonitor three(3);
      modes.evaluate(*method, motion, to, again, three);
      EXPECT_TRUE(identical(moved, again)) << name;
    }
  }
}

TEST_P(AffineModesOf, AreTheAnswersToEachFieldInAnyUnit)
{
  for (const auto& [name, unscaled] : motions::jittered())
  {
    for (const double unit : { 1e-6, 1., 1e6 })
    {
      Mesh mesh = unscaled;
      mesh.points *= unit;
      const NodePartition partition = outerPartition(mesh);
      meshes::ThreadedMonitor monitor(2);
      const auto method = GetParam().make();
      method->prepare(mesh, partition, monitor);
      AffineFields fields = fading(unscaled, partition);
      fields.rightCols<3>() *= unit;
      Points weight = Points::Zero(fields.rows(), 3);
      weight.col(0) = fields.col(0);
      const std::vector<Points> expected =
        method->basis({ fields.rightCols<3>(), weight }, monitor);
      AffineFields scaled = fields;
      scaled.col(0) *= unit;
      EvaluateReport report;
      const FourFields found = method->fields(scaled, monitor, &report);
      EXPECT_LT(difference(found.rightCols<3>(), expected[0]), 1e-8 * unit) << name << unit;
      EXPECT_LT((found.col(0) / unit - expected[1].col(0)).cwiseAbs().maxCoeff(), 1e-8)
        << name << unit;
      meshes::ThreadedMonitor three(3);
      EXPECT_EQ(method->fields(scaled, three), found) << name << unit;

      AffineModes modes;
      modes.prepare(*method, fields, monitor);
      AffineMotion shift = AffineMotion::Zero();
      shift.col(0) << unit, -unit, unit; // the weight's answer alone
      const Points to = weightedTargets(mesh, partition, fields, shift);
      Points direct, moved;
      method->evaluate(to, direct, monitor);
      modes.evaluate(*method, shift, to, moved, monitor);
      EXPECT_LT(difference(moved, direct), 1e-8 * unit) << name << unit;
    }
  }
}

TEST_P(AffineModesOf, WithoutMotionKeepEveryBit)
{
  for (const auto& [name, mesh] : motions::jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    Monitor monitor;
    const auto method = GetParam().make();
    method->prepare(mesh, partition, monitor);
    const AffineFields fields = fading(mesh, partition);
    AffineModes modes;
    modes.prepare(*method, fields, monitor);
    Points moved;
    modes.evaluate(*method, AffineMotion::Zero(), meshes::rows(mesh.points, partition.prescribed),
      moved, monitor);
    EXPECT_TRUE(identical(moved, mesh.points)) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(AllMethods, AffineModesOf, testing::ValuesIn(meshes::linearMethods()),
  [](const auto& info) { return info.param.name; });

TEST(AffineModes, RefuseFieldsAndPositionsOfAnotherBoundary)
{
  const auto method = meshes::linearMethods().front().make();
  const Mesh mesh = motions::jittered().front().second;
  const NodePartition partition = outerPartition(mesh);
  Monitor monitor;
  method->prepare(mesh, partition, monitor);
  AffineModes modes;
  AffineFields fields = fading(mesh, partition);
  const AffineMotion motion = AffineMotion::Ones();
  const Points to = weightedTargets(mesh, partition, fields, motion);
  Points moved;
  std::string message;
  motions::expectError(
    [&] { modes.evaluate(*method, motion, to, moved, monitor); }, "prepare them");
  modes.prepare(*method, fields, monitor);
  motions::kindOf([&] { modes.evaluate(*method, motion, to.topRows(3), moved, monitor); }, message);
  motions::kindOf([&] { modes.prepare(*method, fields.topRows(3), monitor); }, message);
  EXPECT_FALSE(modes.isPreparedFor(*method, fields)); // and nothing is half prepared
  fields(0, 2) = std::nan("");
  motions::expectError([&] { modes.prepare(*method, fields, monitor); }, "not finite");
}
