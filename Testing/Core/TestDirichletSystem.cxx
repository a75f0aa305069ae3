// SPDX-License-Identifier: BSD-3-Clause
// What both methods that solve equations have to do: their solutions, and their first guesses.
#include "BoundaryShapes.h"
#include "DirectSolutions.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "Mesh/Mesh.h"
#include "Meshes.h"
#include "Motions.h"
#include "Solvers/CsrMatrix.h"
#include "Solvers/MultigridSolver.h"
#include "Solvers/RowComponents.h"
#include "Untangling/InversionFree.h"
#include "WatchingMonitor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace morph;
using motions::identical;
using motions::outerPartition;

namespace
{
struct Method
{
  const char* name;
  std::unique_ptr<DirichletMethod> (*make)();
};

class DirichletMethods : public testing::TestWithParam<Method>
{
protected:
  const std::unique_ptr<DirichletMethod> method = GetParam().make();
};
/// That of a body of its own, far from others.
Mesh apart(const Mesh& mesh)
{
  return meshes::shifted(mesh, { 40, 1, 2 });
}

/// A block of 6 x 6 x 6 hexahedra with a fin, one cell thick and five long, on its side x = 6.
/// `tip`: becomes the four nodes at the fin's end.
Mesh blockWithFin(std::vector<Index>& tip)
{
  Mesh mesh = meshes::hexes(6, 6, 6);
  const auto at = [](int i, int j, int k) { return Index(i) + 7 * (j + 7 * Index(k)); };
  tip = { at(6, 3, 3), at(6, 4, 3), at(6, 4, 4), at(6, 3, 4) };
  for (int cell = 0; cell < 5; ++cell)
  {
    const Index first = mesh.numberOfNodes();
    const std::vector<Index> next = { first, first + 1, first + 2, first + 3 };
    mesh.points.conservativeResize(first + 4, 3);
    for (int k = 0; k < 4; ++k)
    {
      mesh.points.row(next[k]) = mesh.points.row(tip[k]) + Eigen::RowVector3d(1, 0, 0);
    }
    meshes::add(
      mesh, Hexahedron, { tip[0], tip[1], tip[2], tip[3], next[0], next[1], next[2], next[3] });
    tip = next;
  }
  return mesh;
}

/// Where the prescribed nodes go: `map` for those with `moves`, the others stay.
Points targetsWhere(const Mesh& mesh, const NodePartition& partition,
  const std::function<bool(Index)>& moves, const motions::Map& map)
{
  Points target = meshes::rows(mesh.points, partition.prescribed);
  for (Index i = 0; i < target.rows(); ++i)
  {
    if (moves(partition.prescribed[i]))
    {
      target.row(i) = map(mesh.points.row(partition.prescribed[i]));
    }
  }
  return target;
}

/// A symmetric positive definite matrix of two blocks, and right-hand sides.
struct TwoBlocks
{
  CsrMatrix A;
  Points places, b;
  static constexpr int Size = 700; // of a block: more than the multigrid factorises

  TwoBlocks()
    : A(2 * Size, 2 * Size)
    , places(2 * Size, 3)
    , b(2 * Size, 3)
  {
    std::mt19937 random(meshes::seed());
    std::uniform_real_distribution<double> value(-1, 1);
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < 2 * Size; ++i)
    {
      this->places.row(i) = Eigen::RowVector3d(i % Size, i / Size, 0);
      entries.emplace_back(i, i, 2.1);
      for (int j : { i - 1, i + 1 })
      {
        if (j >= 0 && j < 2 * Size && j / Size == i / Size)
        {
          entries.emplace_back(i, j, -1);
        }
      }
    }
    this->A.setFromTriplets(entries.begin(), entries.end());
    this->b = this->b.unaryExpr([&](double) { return value(random); });
  }
};
}

TEST_P(DirichletMethods, AgreeWithADirectSolution)
{
  for (const auto& [name, mesh] : motions::jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    const Points target = motions::targets(mesh, partition, motions::twistOf(4));
    Monitor monitor;
    method->setTolerance(1e-13);
    method->prepare(mesh, partition, monitor);
    Points moved, adjoint;
    const EvaluateReport report = method->evaluate(target, moved, monitor);
    EXPECT_GT(report.iterations, 0) << name;
    EXPECT_LE(report.relativeResidual, 1e-13) << name;
    EXPECT_LE(method->applyTranspose(mesh.points, adjoint, monitor).relativeResidual, 1e-13);

    const Eigen::MatrixXd A = method->solver().matrix();
    const Points displacement = target - meshes::rows(mesh.points, partition.prescribed);
    const Points expected = direct::solve(A, -(method->coupling() * displacement));
    const Points found =
      meshes::rows(moved, method->rows()) - meshes::rows(mesh.points, method->rows());
    EXPECT_LT(motions::difference(found, expected), 1e-11) << name;
  }
}

TEST_P(DirichletMethods, RandomNumbersChangeTheRowsNotTheResult)
{
  const Mesh mesh = meshes::hexes(26, 25, 24);
  const std::vector<Index> order = motions::shuffledNumbers(mesh.numberOfNodes());
  const Mesh shuffled = meshes::renumbered(mesh, order);
  const auto move = [](const motions::Row& x) { return motions::twist(x, 26, 24, 1); };
  const NodePartition partition = outerPartition(mesh), renamed = outerPartition(shuffled);
  Monitor monitor;
  method->setTolerance(1e-12);
  method->prepare(mesh, partition, monitor);
  Points reference, moved;
  method->evaluate(motions::targets(mesh, partition, move), reference, monitor);
  method->prepare(shuffled, renamed, monitor);
  const std::vector<Index>& rows = method->rows();
  EXPECT_NE(rows, renamed.free);
  EXPECT_TRUE(std::is_permutation(rows.begin(), rows.end(), renamed.free.begin()));
  const Points at = motions::targets(shuffled, renamed, move);
  method->evaluate(at, moved, monitor);
  EXPECT_LT(
    motions::difference(meshes::rows(moved, order), reference), 1e-10 * meshes::size(mesh.points));

  // The adjoint goes through the same order.
  Points gradient = Points::Zero(mesh.numberOfNodes(), 3), step, plus, minus;
  gradient(rows[1234], 2) = 1;
  method->applyTranspose(gradient, step, monitor);
  method->evaluate(at + step, plus, monitor);
  method->evaluate(at - step, minus, monitor);
  EXPECT_NEAR((plus - minus)(rows[1234], 2) / 2, step.squaredNorm(), 1e-9 * step.squaredNorm());
}

TEST_P(DirichletMethods, TheUnitOfLengthDoesNotShow)
{
  Mesh mesh = meshes::hexes(12, 12, 12);
  meshes::jitterInterior(mesh, .2, meshes::seed());
  const NodePartition partition = outerPartition(mesh);
  const Points target = motions::targets(mesh, partition, motions::twistOf(12, 1));
  Monitor monitor;
  method->setTolerance(1e-12);
  method->prepare(mesh, partition, monitor);
  Points reference, moved;
  method->evaluate(target, reference, monitor);
  for (double unit : { 1e-30, 1e40 })
  {
    Mesh scaled = mesh;
    scaled.points *= unit;
    method->prepare(scaled, partition, monitor);
    method->evaluate(unit * target, moved, monitor);
    EXPECT_LT(motions::difference(moved / unit, reference), 1e-9) << unit;
  }
}

TEST_P(DirichletMethods, ABodyWithoutPrescribedNodesIsNamed)
{
  const Mesh body = meshes::hexes(2, 2, 2), mesh = shapes::together(body, apart(body));
  const NodePartition partition = partitionNodes(mesh, outerPartition(body).prescribed);
  Monitor monitor;
  motions::expectError(
    Error::Kind::Singular, [&] { method->prepare(mesh, partition, monitor); },
    "Body 1 (8 cells, the first is cell 8");
}

TEST_P(DirichletMethods, RefuseTolerancesAndMotionsThatAreNone)
{
  for (double wrong : { 0., -1., 1., std::numeric_limits<double>::quiet_NaN() })
  {
    EXPECT_THROW(method->setTolerance(wrong), Error);
  }
  const Mesh mesh = meshes::hexes(3, 3, 3);
  const NodePartition partition = outerPartition(mesh);
  Monitor monitor;
  method->prepare(mesh, partition, monitor);
  Points moved = Points::Constant(1, 3, 5),
         target = meshes::rows(mesh.points, partition.prescribed);
  target(7, 2) = 1e300;
  motions::expectError([&] { method->evaluate(target, moved, monitor); }, "too large");
  EXPECT_EQ(moved, Points::Constant(1, 3, 5)); // untouched
}

TEST_P(DirichletMethods, AFinsTipMovesNoNodeOfTheBlock)
{
  std::vector<Index> tip;
  const Mesh mesh = blockWithFin(tip);
  const NodePartition partition = outerPartition(mesh);
  ASSERT_EQ(partition.free.size(), 125u);
  const Points target = targetsWhere(
    mesh, partition, [&](Index node) { return node >= tip[0]; },
    [](const motions::Row& x) { return motions::Row(x + motions::Row(.3, .2, -.1)); });
  meshes::ThreadedMonitor monitor;
  method->prepare(mesh, partition, monitor);
  Points moved;
  const EvaluateReport report = method->evaluate(target, moved, monitor);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(report.relativeResidual, 0);
  EXPECT_TRUE(monitor.warnings.empty()) << monitor.warnings[0];
  EXPECT_TRUE(
    identical(meshes::rows(moved, partition.free), meshes::rows(mesh.points, partition.free)));
  EXPECT_TRUE(identical(meshes::rows(moved, partition.prescribed), target));
}

TEST_P(DirichletMethods, ABodyWithoutFreeNodesMovesNoOther)
{
  const Mesh block = meshes::hexes(5, 5, 5);
  const Mesh mesh = shapes::together(block, apart(meshes::hexes(1, 4, 4)));
  const NodePartition partition = outerPartition(mesh);
  ASSERT_EQ(partition.free.size(), 64u);
  const Points target = targetsWhere(
    mesh, partition, [&](Index node) { return node >= block.numberOfNodes(); },
    [](const motions::Row& x) { return motions::twist(x, 4, 4, .4); });
  meshes::ThreadedMonitor monitor;
  method->prepare(mesh, partition, monitor);
  Points moved;
  EXPECT_EQ(method->evaluate(target, moved, monitor).iterations, 0);
  EXPECT_TRUE(identical(moved.topRows(block.numberOfNodes()), block.points));
}

TEST_P(DirichletMethods, EachBodyTakesItsOwnAffineMotion)
{
  const Mesh block = meshes::hexes(5, 5, 5);
  Mesh mesh = shapes::together(block, apart(meshes::tets(5, 4, 5)));
  mesh = shapes::together(mesh, meshes::shifted(meshes::hexes(5, 4, 4), { 80, 2, 4 }));
  const Index second = block.numberOfNodes();
  const Index third = mesh.numberOfNodes() - meshes::hexes(5, 4, 4).numberOfNodes();
  const NodePartition partition = outerPartition(mesh);
  const auto turn = [](const motions::Row& x)
  { return motions::Row(x[0] - .4 * x[1], .5 * x[0] + x[1], x[2] + 3); };
  const auto turned = [&](Index node) { return node >= second && node < third; };
  const Points target = targetsWhere(mesh, partition, turned, turn);
  meshes::ThreadedMonitor monitor;
  method->prepare(mesh, partition, monitor);
  Points moved;
  const EvaluateReport report = method->evaluate(target, moved, monitor);
  EXPECT_LE(report.iterations, 2);
  for (Index node = 0; node < mesh.numberOfNodes(); ++node)
  {
    const motions::Row rest = mesh.points.row(node), now = moved.row(node);
    if (turned(node))
    {
      EXPECT_LT((now - turn(rest)).norm(), 1e-11) << node;
    }
    else
    {
      EXPECT_EQ(now, rest) << node;
    }
  }
}

TEST_P(DirichletMethods, ABodyThatMovesByLittleHasAsManyDigits)
{
  const Mesh body = meshes::layered(meshes::hexes, 8, 0.05, 1.2),
             mesh = shapes::together(body, apart(body));
  const Index first = body.numberOfNodes();
  const NodePartition ofBoth = outerPartition(mesh), ofOne = outerPartition(body);
  const auto wave = [](double factor, const Eigen::RowVector3d& x) -> Eigen::RowVector3d
  { return factor * Eigen::RowVector3d(std::sin(5 * x[1]), std::cos(3 * x[0]), x[0] * x[2]); };
  Monitor monitor;
  const auto both = GetParam().make(), one = GetParam().make();
  both->prepare(mesh, ofBoth, monitor);
  one->prepare(body, ofOne, monitor);
  for (const double small : { 1e-3, 1e-6, 1e-9 })
  {
    // Displacements, as rounded positions give them.
    Points given(static_cast<Index>(ofBoth.prescribed.size()), 3);
    for (Index i = 0; i < given.rows(); ++i)
    {
      const Index node = ofBoth.prescribed[i];
      given.row(i) =
        node < first ? wave(1, mesh.points.row(node)) : wave(small, body.points.row(node - first));
    }
    const Points alone = one->basis({ given.bottomRows(given.rows() / 2) }, monitor)[0];
    const Points beside = both->basis({ given }, monitor)[0].bottomRows(first);
    EXPECT_LT((beside - alone).cwiseAbs().maxCoeff(), 1e-9 * small) << small;
  }
}

TEST_P(DirichletMethods, TheirFirstGuessAnswersAnAffineMotionOfTheWholeBoundary)
{
  for (const auto& [name, mesh] : motions::jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    Points target = motions::targets(mesh, partition, motions::affine);
    meshes::ThreadedMonitor monitor(2);
    method->prepare(mesh, partition, monitor);
    Points moved;
    EXPECT_EQ(method->evaluate(target, moved, monitor).iterations, 0) << name;
    EXPECT_LT(motions::difference(moved, motions::mapped(mesh.points, motions::affine)), 1e-12)
      << name;
    // Nodes of a side that are off make it a motion like others.
    for (Index i = 0; i < target.rows(); ++i)
    {
      const motions::Row x = mesh.points.row(partition.prescribed[i]);
      if (x[0] == 0 && x[1] > 0 && x[1] < 4 && x[2] > 0 && x[2] < 4)
      {
        target(i, 1) += 1e-6 * std::sin(static_cast<double>(i));
      }
    }
    EXPECT_GT(method->evaluate(target, moved, monitor).iterations, 0) << name;
  }
}

TEST_P(DirichletMethods, TheirFirstGuessIsNoAnswerWhereAffineMotionsDoNotSolveTheEquations)
{
  // The sides are free: stretched along x at both ends, they do not follow linearly.
  const Mesh mesh = meshes::hexes(4, 4, 12);
  std::vector<Index> ends;
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    if (mesh.points(n, 2) == 0 || mesh.points(n, 2) == 12)
    {
      ends.push_back(n);
    }
  }
  const NodePartition partition = partitionNodes(mesh, ends);
  const auto stretch = [](const motions::Row& x) { return motions::Row(1.5 * x[0], x[1], x[2]); };
  meshes::ThreadedMonitor monitor;
  if (std::string(GetParam().name) == "LogBarrierWarp")
  {
    return; // has weights for nodes inside alone
  }
  method->prepare(mesh, partition, monitor);
  Points moved;
  EXPECT_GT(
    method->evaluate(motions::targets(mesh, partition, stretch), moved, monitor).iterations, 0);
  // The Laplace equation without flux forgets what varies across the bar: the middle goes with the
  // mean, 2 to 3, but for the slowest mode, exp(-6 pi / 4).
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    if (mesh.points(n, 2) == 6)
    {
      EXPECT_NEAR(moved(n, 0) - mesh.points(n, 0), 1, 0.05) << n;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, DirichletMethods,
  testing::Values(
    Method{
      "FemWarp", []() -> std::unique_ptr<DirichletMethod> { return std::make_unique<FemWarp>(); } },
    Method{ "LogBarrierWarp",
      []() -> std::unique_ptr<DirichletMethod> { return std::make_unique<LogBarrierWarp>(); } }),
  [](const auto& info) { return std::string(info.param.name); });

TEST(InversionFree, AFinsTipMoves)
{
  std::vector<Index> tip;
  const Mesh mesh = blockWithFin(tip);
  const NodePartition partition = outerPartition(mesh);
  const Points target = targetsWhere(
    mesh, partition, [&](Index node) { return node >= tip[0]; },
    [](const motions::Row& x) { return motions::Row(x + motions::Row(.3, .2, -.1)); });
  meshes::ThreadedMonitor monitor;
  InversionFree method;
  Points moved = motions::morphed(method, mesh, partition, target, monitor);
  EXPECT_TRUE(identical(meshes::rows(moved, partition.prescribed), target));
  EXPECT_LT((meshes::rows(moved, partition.free) - meshes::rows(mesh.points, partition.free))
              .cwiseAbs()
              .maxCoeff(),
    .1);
}

TEST(RowComponents, AreTheBlocksOfTheMatrix)
{
  // 0 and 3 by an entry of row 0 alone, 2 and 4 by one of row 4; 1 by itself.
  CsrMatrix A(5, 5);
  for (int i = 0; i < 5; ++i)
  {
    A.insert(i, i) = 1;
  }
  A.insert(0, 3) = -1;
  A.insert(4, 2) = -1;
  A.makeCompressed();
  Monitor monitor;
  const RowComponents components = rowComponents(A, monitor);
  EXPECT_EQ(components.count, 3);
  EXPECT_EQ(components.ofRow, (std::vector<int>{ 0, 1, 2, 0, 2 }));
  const auto count = [&](const CsrMatrix& matrix) { return rowComponents(matrix, monitor).count; };
  EXPECT_EQ(count(TwoBlocks().A), 2);
  EXPECT_EQ(count(CsrMatrix(0, 0)), 0);
}

template <typename Solver>
class GuessOf : public testing::Test
{
};
using Solvers = testing::Types<SpdSolver, GeneralSolver>;
TYPED_TEST_SUITE(GuessOf, Solvers);

TYPED_TEST(GuessOf, TheSolverIsUsedOnlyWhereItIsBetterThanZero)
{
  TwoBlocks problem;
  constexpr int n = TwoBlocks::Size;
  const CsrMatrix A = problem.A;
  Monitor monitor;
  TypeParam solver;
  solver.prepare({ problem.A, problem.places }, monitor);
  Points exact = Points::Zero(2 * n, 3), fromZero = exact;
  solver.solve(problem.b, exact, 1e-14, 500, monitor);
  solver.solve(problem.b, fromZero, 1e-6, 500, monitor);

  Points far = Points::Constant(2 * n, 3, 1e6);
  solver.solve(problem.b, far, 1e-6, 500, monitor);
  EXPECT_TRUE(identical(far, fromZero));
  for (double bad : { std::numeric_limits<double>::infinity(), 1e200 })
  {
    far.setConstant(bad);
    solver.solve(problem.b, far, 1e-6, 500, monitor);
    EXPECT_TRUE(identical(far, fromZero)) << bad;
  }

  // One column of one block is far off, all the rest is right already.
  Points mixed = exact;
  mixed.topRows(n).col(1).setConstant(1e3);
  const int iterations = solver.solve(problem.b, mixed, 1e-10, 500, monitor).iterations;
  EXPECT_GT(iterations, 0);
  Points expected = exact;
  expected.topRows(n).col(1).setZero();
  EXPECT_EQ(solver.solve(problem.b, expected, 1e-10, 500, monitor).iterations, iterations);
  EXPECT_TRUE(identical(mixed, expected));

  // Without a right-hand side in one block nothing moves there.
  Points b = problem.b, x = Points::Constant(2 * n, 3, .1);
  b.bottomRows(n).setZero();
  solver.solve(b, x, 1e-10, 500, monitor);
  EXPECT_TRUE((x.bottomRows(n).array() == 0).all());
  EXPECT_LT((A * x - b).norm(), 2e-10 * b.norm());
  x.setConstant(.1);
  EXPECT_EQ(solver.solve(Points::Zero(2 * n, 3), x, 1e-10, 500, monitor).iterations, 0);
  EXPECT_TRUE((x.array() == 0).all());
}

// A line whose unknowns are numbered at random.
TYPED_TEST(GuessOf, TheSolverMayBeOfRowsInAnyOrder)
{
  constexpr int n = 100000;
  std::mt19937 random(meshes::seed());
  std::vector<int> number(n);
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), random);
  std::vector<Eigen::Triplet<double>> entries;
  Points places = Points::Zero(n, 3), expected(n, 3);
  for (int i = 0; i < n; ++i)
  {
    places(number[i], 0) = i;
    expected.row(number[i]) << std::sin(1e-3 * i), 1, i % 3;
    entries.emplace_back(number[i], number[i], 2.5);
    if (i > 0)
    {
      entries.emplace_back(number[i], number[i - 1], -1);
      entries.emplace_back(number[i - 1], number[i], -1);
    }
  }
  CsrMatrix A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  meshes::ThreadedMonitor monitor(2);
  TypeParam solver;
  solver.prepare({ A, places }, monitor);
  Points x = Points::Zero(n, 3);
  solver.solve(Points(A * expected), x, 1e-12, 100, monitor);
  EXPECT_LT((x - expected).cwiseAbs().maxCoeff(), 1e-9);
}

// Single precision has room for factors up to 1e38.
TYPED_TEST(GuessOf, TheSolverSaysWhereEntriesAreTooDifferent)
{
  constexpr int n = 1000; // more than the multigrid factorises
  for (const double small : { 1e-30, 1e-45 })
  {
    CsrMatrix A(n, n);
    for (int i = 0; i < n; ++i)
    {
      A.insert(i, i) = i % 2 == 0 ? 1 : small;
    }
    meshes::ThreadedMonitor monitor(2);
    const Points places = Points::Random(n, 3), b = Points::Constant(n, 3, 1);
    Points x = Points::Zero(n, 3);
    TypeParam solver;
    const auto solve = [&]
    {
      solver.prepare({ A, places }, monitor);
      solver.solve(b, x, 1e-10, 100, monitor);
    };
    if (small < 1e-38)
    {
      motions::expectError(Error::Kind::Singular, solve, "1e38");
      continue;
    }
    solve();
    EXPECT_LE((A * x - b).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TYPED_TEST(GuessOf, TheSolverIsOfAnySize)
{
  TwoBlocks problem;
  Monitor monitor;
  TypeParam solver;
  solver.prepare({ problem.A, problem.places }, monitor);
  Points reference = Points::Zero(problem.b.rows(), 3);
  const int iterations = solver.solve(problem.b, reference, 1e-10, 500, monitor).iterations;
  for (int exponent : { -300, -150, 300, 480 }) // of 2: without rounding
  {
    meshes::WatchingMonitor watching;
    const double factor = std::ldexp(1., exponent);
    Points x = Points::Zero(problem.b.rows(), 3);
    EXPECT_EQ(
      solver.solve(Points(factor * problem.b), x, 1e-10, 500, watching).iterations, iterations)
      << exponent;
    EXPECT_TRUE(identical(Points(x / factor), reference)) << exponent;
  }
}

TEST(IndexLimits, SayWhatIsTooLarge)
{
  const Index large = Index(1) << 31;
  requireIndexable(large - (1 << 20) - 1, 5, 5);
  motions::expectError([&] { requireIndexable(large, 5, 5); }, "2147483648 nodes");
  motions::expectError([&] { requireIndexable(5, 3 * large, 5); }, "6442450944 cells");
  motions::expectError([&] { requireIndexable(5, 5, large - 1); }, "2147483647 corners of cells");
  requireEntries(large - 1);
  EXPECT_THROW(requireEntries(large), Error);
}
