// SPDX-License-Identifier: BSD-3-Clause
// Four numbers at once give what each gives alone.
#include "Energies/CellBatches.h"
#include "Energies/FoldoverKernel.h"
#include "Meshes.h"
#include "Motions.h"
#include "Support/Simd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace
{
using morph::Index;
using morph::SimdDouble4;
using morph::SimdWidth;
using namespace morph::foldover;

constexpr int Blocks = 6;

struct Case
{
  double J[9][SimdWidth], g[9][SimdWidth], epsilon;
  double hessian[Blocks][9][SimdWidth], phi[SimdWidth];
};

/// Jacobians of all kinds, every other one inverted, one of no rank.
std::vector<Case> cases()
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<Case> result(40);
  for (std::size_t n = 0; n < result.size(); ++n)
  {
    Case& c = result[n];
    c.epsilon = n % 2 == 0 ? 0.3 : 1e-10;
    for (int i = 0; i < 9; ++i)
    {
      for (int lane = 0; lane < SimdWidth; ++lane)
      {
        c.J[i][lane] = (i % 4 == 0) + number(random);
        c.g[i][lane] = (i % 4 == 0) + 0.3 * number(random);
      }
    }
  }
  std::memset(result[2].J, 0, sizeof(result[2].J));
  return result;
}

template <typename T>
MORPH_SIMD_INLINE void evaluate(const Parameters<T>& parameters, const Matrix3<T>& J,
  const Matrix3<T>& g, T& phi, Matrix3<T> (&block)[3][3])
{
  Vector3<T> normal;
  T determinant, square;
  cross(J[1], J[2], normal);
  dot(J[0], normal, determinant);
  squaredNorm(J, square);
  density(parameters, square, determinant, phi);
  hessian(parameters, J, g, block);
}

struct EvaluateCase
{
  static MORPH_SIMD_INLINE void run(Index n, std::vector<Case>& all)
  {
    Case& c = all[n];
    Matrix3<SimdDouble4> J, g, block[3][3];
    for (int i = 0; i < 9; ++i)
    {
      J[i / 3][i % 3] = morph::load(c.J[i]);
      g[i / 3][i % 3] = morph::load(c.g[i]);
    }
    Parameters<SimdDouble4> parameters;
    parameters.theta = SimdDouble4{} + 0.1;
    parameters.epsilon = c.epsilon;
    SimdDouble4 phi;
    evaluate(parameters, J, g, phi, block);
    for (int lane = 0; lane < SimdWidth; ++lane)
    {
      c.phi[lane] = phi[lane];
      for (int a = 0, k = 0; a < 3; ++a)
      {
        for (int b = a; b < 3; ++b, ++k)
        {
          for (int i = 0; i < 9; ++i)
          {
            c.hessian[k][i][lane] = block[a][b][i / 3][i % 3][lane];
          }
        }
      }
    }
  }
};
}

// What the twin of plain loops gives, too.
TEST(SimdDouble4, HasEachOperationOnEachNumber)
{
  using namespace morph;
  const double from[] = { 1, 2, -3, 4 };
  const float single[] = { 1, 2, -3, 4 };
  const SimdDouble4 a = load(from), b = 2. * a - 1., c = SimdDouble4{} + 7.;
  const SimdMask4 mask = (a > 1.) | (b == -7.);
  const long long bits[] = { 2, 0, 3, 1 };
  const SimdDouble4 chosen = select(mask, b, c), sums = sumsOf(a, b, c, -c);
  const SimdDouble4 marked = select(hasBit(bits, 1), a, c), wide = widened(single);
  const SimdFloat4 rows[] = { load(single), narrowed(b), 2.f * load(single), load(single) };
  SimdFloat4 columns[4];
  transpose(rows, columns);
  double stored[SimdWidth];
  store(a / 2., stored);
  for (int i = 0; i < SimdWidth; ++i)
  {
    EXPECT_EQ(b[i], 2 * from[i] - 1);
    EXPECT_EQ(chosen[i], i == 0 ? 7 : b[i]);
    EXPECT_EQ(marked[i], i == 0 || i == 2 ? from[i] : 7);
    EXPECT_EQ(wide[i], from[i]);
    EXPECT_EQ(stored[i], from[i] / 2);
    EXPECT_EQ(squareRoot(a * a)[i], std::abs(from[i]));
    EXPECT_EQ(columns[i][1], static_cast<float>(b[i]));
    EXPECT_EQ(columns[i][2], 2 * single[i]);
  }
  EXPECT_EQ(sums[0], 4);
  EXPECT_EQ(sums[1], 4);
  EXPECT_EQ(sums[2], 28);
  EXPECT_EQ(sums[3], -28);
  EXPECT_TRUE(any(mask));
  EXPECT_FALSE(any(a > 4.));
  EXPECT_TRUE(any(!mask));
}

TEST(SimdDouble4, TheDensityIsThatOfSingleNumbers)
{
  std::vector<Case> all = cases();
  morph::dispatchedFor<EvaluateCase>(0, static_cast<Index>(all.size()), all);
  for (const Case& c : all)
  {
    for (int lane = 0; lane < SimdWidth; ++lane)
    {
      Matrix3<double> J, g, block[3][3];
      for (int i = 0; i < 9; ++i)
      {
        J[i / 3][i % 3] = c.J[i][lane];
        g[i / 3][i % 3] = c.g[i][lane];
      }
      double phi;
      evaluate<double>({ 0.1, c.epsilon }, J, g, phi, block);
      EXPECT_NEAR(c.phi[lane] / phi, 1, 1e-13);
      double scale = 0, difference = 0;
      for (int a = 0, k = 0; a < 3; ++a)
      {
        for (int b = a; b < 3; ++b, ++k)
        {
          for (int i = 0; i < 9; ++i)
          {
            const double single = block[a][b][i / 3][i % 3];
            scale = std::max(scale, std::abs(single));
            difference = std::max(difference, std::abs(single - c.hessian[k][i][lane]));
          }
        }
      }
      EXPECT_LT(difference, 1e-7 * scale);
    }
  }
}

#if defined(MORPH_HAS_GNU_VECTORS) && defined(__x86_64__)
TEST(SimdDouble4, TheProcessorDoesNotShow)
{
  if (!__builtin_cpu_supports("avx2"))
  {
    GTEST_SKIP() << "This processor has no AVX2 to compare with.";
  }
  std::vector<Case> portable = cases(), wide = portable;
  const auto n = static_cast<Index>(portable.size());
  morph::detail::Loop<EvaluateCase>::run(0, n, portable);
  const morph::Index first = 0;
  morph::detail::runWithAvx2<morph::detail::Loop<EvaluateCase>>(first, n, wide);
  EXPECT_EQ(std::memcmp(portable.data(), wide.data(), n * sizeof(Case)), 0);
}
#endif

TEST(CellBatches, EachFreeCornerHasOnePlace)
{
  for (const auto& [name, mesh] : meshes::all(3, 3, 3))
  {
    SCOPED_TRACE(name);
    const std::vector<Index> free = motions::outerPartition(mesh).free;
    std::vector<std::int32_t> row(mesh.numberOfNodes(), -1);
    for (std::size_t i = 0; i < free.size(); ++i)
    {
      row[free[i]] = static_cast<std::int32_t>(i);
    }
    std::vector<int> expected(free.size()), found(free.size());
    for (Index node : mesh.connectivity)
    {
      if (row[node] >= 0)
      {
        ++expected[row[node]];
      }
    }
    const morph::CellBatches batches(mesh, free);
    for (Index place = 0; place < batches.places(); ++place)
    {
      const Index first = batches.firstPlace(batches.batchOf(place));
      EXPECT_GE(place, first);
      EXPECT_LT(place, first + SimdWidth * batches.corners(batches.batchOf(place)));
      if (batches.row(place) >= 0)
      {
        ++found[batches.row(place)];
      }
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(CellBatches, HoldEachCellWithAFreeNodeOnceOfThoseAskedFor)
{
  for (const auto& [name, mesh] : motions::jittered())
  {
    SCOPED_TRACE(name);
    std::vector<Index> free = motions::outerPartition(mesh).free, some, expected;
    std::reverse(free.begin(), free.end()); // rows in any order
    for (Index c = 0; c < mesh.numberOfCells(); c += 2)
    {
      some.push_back(c);
      const bool moves = std::any_of(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c),
        [&](Index node) { return std::find(free.begin(), free.end(), node) != free.end(); });
      if (moves && morph::cellShape(mesh.types[c])->dimension == 3)
      {
        expected.push_back(c);
      }
    }
    const morph::CellBatches batches(mesh, free, some);
    std::vector<Index> found;
    for (Index batch = 0; batch < batches.size(); ++batch)
    {
      for (int lane = 0; lane < batches.cells(batch); ++lane)
      {
        const Index c = batches.cell(batch, lane);
        found.push_back(c);
        EXPECT_EQ(batches.shape(batch), morph::cellShape(mesh.types[c])->shape);
        for (int a = 0; a < batches.corners(batch); ++a)
        {
          EXPECT_EQ(batches.nodes(batch)[a * SimdWidth + lane],
            mesh.cell(c)[morph::cellShape(mesh.types[c])->cornerNode[a]]);
        }
      }
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
  }
}
