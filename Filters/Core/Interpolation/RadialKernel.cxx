// SPDX-License-Identifier: BSD-3-Clause
#include "Interpolation/RadialKernel.h"

#include "Support/Parallel.h"
#include "Support/Simd.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace morph
{
namespace
{
constexpr Index Lanes = 2 * SimdWidth;     // targets a block: two registers hide the root's latency
constexpr double PairsBetweenChecks = 2e7; // about 20 ms

struct Triharmonic
{
  template <typename Real>
  MORPH_SIMD_INLINE Real operator()(const Real& square) const
  {
    return square * squareRoot(square);
  }
};

struct ThinPlate
{
  template <typename Real>
  MORPH_SIMD_INLINE Real operator()(const Real& square) const
  {
    // At r = 0 the logarithm stays finite, and the product is 0.
    return 0.5 * square * logarithm(square + std::numeric_limits<double>::min());
  }
};

struct WendlandC2
{
  double inverseRadius;

  template <typename Real>
  MORPH_SIMD_INLINE Real operator()(const Real& square) const
  {
    const Real q = squareRoot(square) * this->inverseRadius;
    const Real left = 1. - q, inside = select(left > 0., left, Real{}),
               fourth = inside * inside * inside * inside;
    return fourth * (4. * q + 1.);
  }
};

struct Source
{
  double x, y, z, a, b, c;
};

template <typename Kernel>
struct BlockSums
{
  static MORPH_SIMD_INLINE void run(Index block, const Kernel& kernel,
    const std::vector<double>& targets, const std::vector<Source>& sources, Points& sums)
  {
    const double* from = targets.data() + 3 * Lanes * block;
    SimdDouble4 x[2], y[2], z[2], a[2] = {}, b[2] = {}, c[2] = {};
    for (int v = 0; v < 2; ++v)
    {
      for (int lane = 0; lane < SimdWidth; ++lane)
      {
        x[v][lane] = from[v * SimdWidth + lane];
        y[v][lane] = from[v * SimdWidth + lane + Lanes];
        z[v][lane] = from[v * SimdWidth + lane + 2 * Lanes];
      }
    }
    for (const Source& source : sources)
    {
      for (int v = 0; v < 2; ++v)
      {
        const SimdDouble4 dx = x[v] - source.x, dy = y[v] - source.y, dz = z[v] - source.z;
        const SimdDouble4 value = kernel(dx * dx + dy * dy + dz * dz);
        a[v] += value * source.a;
        b[v] += value * source.b;
        c[v] += value * source.c;
      }
    }
    const Index first = block * Lanes;
    const Index count = std::min<Index>(Lanes, sums.rows() - first);
    for (Index i = 0; i < count; ++i)
    {
      const Index v = i / SimdWidth, lane = i % SimdWidth;
      double* to = sums.data() + 3 * (first + i);
      to[0] = a[v][lane];
      to[1] = b[v][lane];
      to[2] = c[v][lane];
    }
  }
};

/// Returns the x of each block's targets, then their y and z. Lanes without a target repeat the
/// last one.
std::vector<double> inBlocks(const Points& targets, Index blocks)
{
  std::vector<double> result(3 * Lanes * blocks);
  for (Index i = 0; i < blocks * Lanes; ++i)
  {
    const Index target = std::min<Index>(i, targets.rows() - 1);
    for (int j = 0; j < 3; ++j)
    {
      result[3 * Lanes * (i / Lanes) + Lanes * j + i % Lanes] = targets(target, j);
    }
  }
  return result;
}

template <typename Kernel>
void sumOver(const Kernel& kernel, const Points& targets, const std::vector<Source>& sources,
  Points& sums, Monitor& monitor)
{
  const Index blocks = (targets.rows() + Lanes - 1) / Lanes;
  const std::vector<double> places = inBlocks(targets, blocks);
  const double pairs = static_cast<double>(Lanes * sources.size());
  const Index stretch = std::max<Index>(64, static_cast<Index>(PairsBetweenChecks / pairs));
  parallelBatches(monitor, blocks, stretch, 4,
    [&](Index first, Index last)
    { dispatchedFor<BlockSums<Kernel>>(first, last, kernel, places, sources, sums); });
}
}

double RadialKernel::operator()(double squaredDistance) const
{
  switch (this->kind)
  {
    case Kind::ThinPlate:
      return ThinPlate{}(squaredDistance);
    case Kind::WendlandC2:
      return WendlandC2{ 1 / this->radius }(squaredDistance);
    case Kind::Triharmonic:
      break;
  }
  return Triharmonic{}(squaredDistance);
}

void kernelSums(const RadialKernel& kernel, const Points& targets, const Points& sources,
  const Points& strengths, Points& sums, Monitor& monitor)
{
  sums.setZero(targets.rows(), 3);
  if (targets.rows() == 0 || sources.rows() == 0)
  {
    return;
  }
  std::vector<Source> given(sources.rows());
  for (Index j = 0; j < sources.rows(); ++j)
  {
    given[j] = { sources(j, 0), sources(j, 1), sources(j, 2), strengths(j, 0), strengths(j, 1),
      strengths(j, 2) };
  }
  switch (kernel.kind)
  {
    case RadialKernel::Kind::Triharmonic:
      sumOver(Triharmonic{}, targets, given, sums, monitor);
      break;
    case RadialKernel::Kind::ThinPlate:
      sumOver(ThinPlate{}, targets, given, sums, monitor);
      break;
    case RadialKernel::Kind::WendlandC2:
      sumOver(WendlandC2{ 1 / kernel.radius }, targets, given, sums, monitor);
      break;
  }
}
}
