// SPDX-License-Identifier: BSD-3-Clause
#include "Interpolation/RadialInterpolant.h"

#include "Geometry/NearestNodes.h"
#include "Solvers/ConjugateGradients.h"
#include "Solvers/DenseCholesky.h"
#include "Support/Error.h"
#include "Support/Monitor.h"
#include "Support/Parallel.h"
#include "Support/Simd.h"

#include <Eigen/Householder>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
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

namespace
{
constexpr Index BlockLength = 256;
constexpr double Reach = 2.5; // radius over the distance of a level's sites
// Of a level's distance to that of the level before: a half, and what rounding makes of it on a
// structured boundary.
constexpr double Ratio = 0.5 * (1 + 1e-5);

/// A target within a kernel's radius.
struct Entry
{
  std::int32_t target;
  double weight;
};

/// The targets in the kernels of one block of sites.
struct Block
{
  std::vector<Entry> entries;
  std::vector<Index> ends; ///< of each site's entries
};

/// #targets x #sites: the kernels of one radius around the sites, at the targets.
WeightMatrix kernelsAt(const Points& targets, const Points& sites, double radius, Monitor& monitor)
{
  WeightMatrix matrix;
  if (targets.rows() == 0 || sites.rows() == 0)
  {
    matrix.open(targets.rows(), sites.rows(), 0);
    return matrix;
  }
  const NearestNodes nodes(targets);
  const RadialKernel kernel{ RadialKernel::Kind::WendlandC2, radius };
  const Index n = sites.rows(), blocks = (n + BlockLength - 1) / BlockLength;
  std::vector<Block> found(blocks);
  monitor.check();
  monitor.parallelFor(blocks, 1,
    [&](Index firstBlock, Index lastBlock)
    {
      std::vector<std::int32_t> near;
      for (Index b = firstBlock; b < lastBlock; ++b)
      {
        for (Index i = b * BlockLength; i < std::min(n, (b + 1) * BlockLength); ++i)
        {
          nodes.within(sites.row(i), radius, near);
          for (std::int32_t target : near)
          {
            const double weight = kernel((targets.row(target) - sites.row(i)).squaredNorm());
            if (weight > 0)
            {
              found[b].entries.push_back({ target, weight });
            }
          }
          found[b].ends.push_back(static_cast<Index>(found[b].entries.size()));
        }
      }
    });
  monitor.check();

  std::vector<Index> offsets(targets.rows() + 1, 0);
  for (const Block& block : found)
  {
    for (const Entry& entry : block.entries)
    {
      ++offsets[entry.target + 1];
    }
  }
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  std::vector<Index> next(offsets.begin(), offsets.end() - 1);
  matrix.open(n, std::move(offsets));
  for (Index i = 0; i < n; ++i) // ascending columns in every row
  {
    const Block& block = found[i / BlockLength];
    const Index place = i % BlockLength;
    for (Index e = place > 0 ? block.ends[place - 1] : 0; e < block.ends[place]; ++e)
    {
      const Entry& entry = block.entries[e];
      const Index at = next[entry.target]++;
      matrix.column(0)[at] = static_cast<std::int32_t>(i);
      matrix.weight(0)[at] = entry.weight;
    }
  }
  return matrix;
}

/// Solves `matrix` x = `b`, #sites x 3, by conjugate gradients. The matrix is well conditioned: its
/// diagonal is 1, and each kernel reaches few sites. A factor would take longer than the solutions
/// of many motions, and could not be interrupted.
Points solved(const WeightMatrix& matrix, const Points& b, Monitor& monitor)
{
  constexpr double Tolerance = 1e-14;
  constexpr int MostIterations = 10000;
  Points x = Points::Zero(b.rows(), 3);
  PointsVectors work;
  PointsSystem system{ [&](const Points& from, Points& to) { matrix.multiply(from, to, monitor); },
    [](const Points& from, Points& to) { to = from; },
    [](const Points& p, const Points& q) { return p.cwiseProduct(q).sum(); }, b, x, monitor, work };
  Sums norm2 = system.residual();
  SolverGoal goal = solverGoal(norm2, norm2, Tolerance, MostIterations);
  goal.atStart = 0; // it is one solution of several
  try
  {
    conjugateGradients(system, norm2, goal, monitor);
  }
  catch (const Error& error)
  {
    if (error.kind() != Error::Kind::NoConvergence)
    {
      throw;
    }
    throw Error(error.kind(),
      "Compact kernels at " + std::to_string(b.rows()) +
        " prescribed places were not solved for: merge prescribed nodes that nearly coincide.");
  }
  return x;
}
}

/// The sites from 0 to `size`.
struct CompactCorrection::Level
{
  Index size = 0;
  WeightMatrix atOwn;   ///< the kernels at the sites
  WeightMatrix atLater; ///< at the other sites
  WeightMatrix atTargets;
};

CompactCorrection::CompactCorrection() = default;
CompactCorrection::~CompactCorrection() = default;
CompactCorrection::CompactCorrection(CompactCorrection&&) noexcept = default;
CompactCorrection& CompactCorrection::operator=(CompactCorrection&&) noexcept = default;

void CompactCorrection::prepare(const Points& sites, const std::vector<double>& distances,
  Index exact, const Points& targets, Monitor& monitor)
{
  this->sites_ = sites.rows();
  this->exact_ = exact;
  this->levels_.clear();
  for (Index begin = exact, end = begin; begin < this->sites_; begin = end)
  {
    while (end < this->sites_ && distances[end] > Ratio * distances[begin])
    {
      ++end;
    }
    monitor.check();
    auto level = std::make_unique<Level>();
    level->size = end;
    const double radius = Reach * distances[end - 1];
    const Points own = sites.topRows(end);
    level->atOwn = kernelsAt(own, own, radius, monitor);
    level->atLater = kernelsAt(sites.bottomRows(this->sites_ - end), own, radius, monitor);
    level->atTargets = kernelsAt(targets, own, radius, monitor);
    this->levels_.push_back(std::move(level));
    monitor.progress(static_cast<double>(end) / static_cast<double>(this->sites_));
  }
}

Index CompactCorrection::numberOfLevels() const
{
  return static_cast<Index>(this->levels_.size());
}

void CompactCorrection::addTo(Points& values, Points residuals, Monitor& monitor) const
{
  Points part;
  for (const auto& level : this->levels_)
  {
    monitor.check();
    const Points coefficients = solved(level->atOwn, residuals.topRows(level->size), monitor);
    level->atLater.multiply(coefficients, part, monitor);
    residuals.topRows(level->size).setZero();
    residuals.bottomRows(part.rows()) -= part;
    level->atTargets.multiply(coefficients, part, monitor);
    values += part;
  }
}

Points CompactCorrection::transposed(const Points& gradient, Monitor& monitor) const
{
  Points result = Points::Zero(this->sites_, 3);
  for (auto it = this->levels_.rbegin(); it != this->levels_.rend(); ++it)
  {
    monitor.check();
    const Level& level = **it;
    Points ofCoefficients, ofLater;
    level.atTargets.multiplyTranspose(gradient, ofCoefficients, monitor);
    level.atLater.multiplyTranspose(result.bottomRows(this->sites_ - level.size), ofLater, monitor);
    ofCoefficients -= ofLater;
    result.topRows(level.size) = solved(level.atOwn, ofCoefficients, monitor);
  }
  result.topRows(this->exact_).setZero();
  return result;
}
}
