// SPDX-License-Identifier: BSD-3-Clause
#include "Morpher/Blend.h"

#include "Support/Error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace morph
{
namespace
{
constexpr Index Grain = 4096;
constexpr Index Block = 1024; // coordinates: their sums stay in the first cache

struct Term
{
  const double* values;
  double weight;
};

/// Adds the terms to `rest` at the coordinates [first, last), a block at most.
void addTerms(
  const std::vector<Term>& terms, const double* rest, Index first, Index last, double* moved)
{
  std::array<double, Block> sum;
  const Index n = last - first;
  std::fill_n(sum.begin(), n, 0.);
  for (const Term& term : terms)
  {
    const double* values = term.values + first;
    for (Index i = 0; i < n; ++i)
    {
      sum[i] += term.weight * values[i];
    }
  }
  for (Index i = 0; i < n; ++i)
  {
    // x + -0.0 has the bits of x for every x; -0.0 + 0.0 would be 0.0.
    moved[first + i] = rest[first + i] + (sum[i] != 0 ? sum[i] : -0.);
  }
}

/// Returns the modes of weights other than 0.
std::vector<Term> terms(const std::vector<WeightedMode>& modes, Index nodes)
{
  std::vector<Term> result;
  for (std::size_t i = 0; i < modes.size(); ++i)
  {
    if (!std::isfinite(modes[i].weight))
    {
      throw Error("The weight of mode " + std::to_string(i) + " is not finite.");
    }
    if (modes[i].mode->rows() != nodes)
    {
      throw Error("Mode " + std::to_string(i) + " has " + std::to_string(modes[i].mode->rows()) +
                  " rows where the mesh has " + std::to_string(nodes) + " nodes.");
    }
    if (modes[i].weight != 0)
    {
      result.push_back({ modes[i].mode->data(), modes[i].weight });
    }
  }
  return result;
}
}

void blend(
  const ConstPoints& rest, const std::vector<WeightedMode>& modes, Points& moved, Monitor& monitor)
{
  const std::vector<Term> list = terms(modes, rest.rows());
  if (moved.rows() != rest.rows())
  {
    moved.resize(rest.rows(), 3);
  }
  monitor.parallelFor(rest.rows(), Grain,
    [&](Index first, Index last)
    {
      for (Index i = 3 * first; i < 3 * last; i += Block)
      {
        addTerms(list, rest.data(), i, std::min(i + Block, 3 * last), moved.data());
      }
    });
}
}
