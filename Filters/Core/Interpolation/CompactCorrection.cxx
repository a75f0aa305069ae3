// SPDX-License-Identifier: BSD-3-Clause
#include "Interpolation/CompactCorrection.h"

#include "Geometry/NearestNodes.h"
#include "Interpolation/RadialKernel.h"
#include "Solvers/ConjugateGradients.h"
#include "Support/Error.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace morph
{
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
