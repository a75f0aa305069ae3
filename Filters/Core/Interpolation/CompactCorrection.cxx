// SPDX-License-Identifier: BSD-3-Clause
#include "Interpolation/CompactCorrection.h"

#include "Geometry/NearestNodes.h"
#include "Interpolation/RadialKernel.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace morph
{
namespace
{
constexpr Index BlockLength = 256;
constexpr double Negligible = 1e-40; // at the radius, and up to rounding within

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

/// #targets x #sites: the kernels at the targets with numbers above `above` of each site.
template <typename Above>
WeightMatrix kernelsAt(const Points& targets, const Points& sites, const std::vector<double>& radii,
  const Above& above, Monitor& monitor)
{
  WeightMatrix matrix;
  if (targets.rows() == 0 || sites.rows() == 0)
  {
    matrix.open(targets.rows(), sites.rows(), 0);
    return matrix;
  }
  const NearestNodes nodes(targets);
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
          const RadialKernel kernel{ RadialKernel::Kind::WendlandC2, radii[i] };
          nodes.within(sites.row(i), radii[i], near);
          for (std::int32_t target : near)
          {
            const double weight =
              target > above(i) ? kernel((targets.row(target) - sites.row(i)).squaredNorm()) : 0;
            if (weight > Negligible)
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
}

void CompactCorrection::prepare(
  const Points& sites, const std::vector<double>& radii, const Points& targets, Monitor& monitor)
{
  this->atSites_ = kernelsAt(
    sites, sites, radii, [](Index i) { return i; }, monitor);
  this->atTargets_ = kernelsAt(
    targets, sites, radii, [](Index) { return Index(-1); }, monitor);
}

void CompactCorrection::solve(Points& residuals) const
{
  for (Index i = 0; i < residuals.rows(); ++i)
  {
    const std::int32_t* column = this->atSites_.column(i);
    const double* weight = this->atSites_.weight(i);
    for (Index e = 0; e < this->atSites_.entries(i); ++e)
    {
      residuals.row(i) -= weight[e] * residuals.row(column[e]);
    }
  }
}

void CompactCorrection::solveTranspose(Points& coefficients) const
{
  for (Index i = coefficients.rows() - 1; i >= 0; --i)
  {
    const std::int32_t* column = this->atSites_.column(i);
    const double* weight = this->atSites_.weight(i);
    for (Index e = 0; e < this->atSites_.entries(i); ++e)
    {
      coefficients.row(column[e]) -= weight[e] * coefficients.row(i);
    }
  }
}
}
