// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/CurveChains.h"

#include <algorithm>
#include <tuple>

namespace morph
{
namespace
{
class Tracer
{
public:
  Tracer(const SurfaceEdges& all, const std::vector<Index>& edges,
    const std::vector<std::uint8_t>& isVertex, const std::vector<std::pair<Index, Index>>& middles)
    : isVertex_(isVertex)
    , middles_(middles)
    , used_(all.count(), 0)
  {
    for (Index e : edges)
    {
      this->at_.push_back({ all.nodes[e][0], all.nodes[e][1], e });
      this->at_.push_back({ all.nodes[e][1], all.nodes[e][0], e });
    }
    std::sort(this->at_.begin(), this->at_.end());
  }

  std::vector<CurveChain> trace()
  {
    std::vector<CurveChain> chains;
    // Sorted by node: the lower of two vertices starts first, towards its lower neighbor.
    for (const Step& step : this->at_)
    {
      if (this->isVertex_[step.from] && !this->used_[step.edge])
      {
        chains.push_back(this->follow(step));
      }
    }
    for (const Step& step : this->at_)
    {
      if (!this->used_[step.edge])
      {
        chains.push_back(this->follow(step));
        chains.back().loop = true;
        // Mid-side nodes of the closing edge remain after the last corner; the first corner is not
        // repeated.
        chains.back().nodes.pop_back();
      }
    }
    std::sort(chains.begin(), chains.end(),
      [](const CurveChain& a, const CurveChain& b)
      {
        const auto key = [](const CurveChain& c)
        {
          return std::make_tuple(*std::min_element(c.nodes.begin(), c.nodes.end()),
            *std::min_element(c.edges.begin(), c.edges.end()));
        };
        return key(a) < key(b);
      });
    return chains;
  }

private:
  struct Step
  {
    Index from, to, edge;
    bool operator<(const Step& other) const
    {
      return std::tie(this->from, this->to) < std::tie(other.from, other.to);
    }
  };

  CurveChain follow(Step step)
  {
    const Index start = step.from;
    CurveChain chain;
    chain.nodes.push_back(start);
    while (true)
    {
      this->used_[step.edge] = 1;
      chain.edges.push_back(step.edge);
      this->appendMiddles(step.edge, chain);
      chain.nodes.push_back(step.to);
      if (this->isVertex_[step.to] || step.to == start)
      {
        return chain;
      }
      auto next = std::lower_bound(this->at_.begin(), this->at_.end(), Step{ step.to, -1, -1 });
      next += next->edge == step.edge; // two edges meet here: take the other one
      step = *next;
    }
  }

  void appendMiddles(Index edge, CurveChain& chain) const
  {
    for (auto m = std::lower_bound(
           this->middles_.begin(), this->middles_.end(), std::pair<Index, Index>(edge, -1));
         m != this->middles_.end() && m->first == edge; ++m)
    {
      chain.nodes.push_back(m->second);
    }
  }

  const std::vector<std::uint8_t>& isVertex_;
  const std::vector<std::pair<Index, Index>>& middles_;
  std::vector<std::uint8_t> used_;
  std::vector<Step> at_; ///< each curve edge from both of its ends
};
}

std::vector<CurveChain> curveChains(const SurfaceEdges& all, const std::vector<Index>& edges,
  const std::vector<std::uint8_t>& isVertex, const std::vector<std::pair<Index, Index>>& middles)
{
  return Tracer(all, edges, isVertex, middles).trace();
}

std::vector<double> arcLengthParameters(const ConstPoints& points, const CurveChain& chain)
{
  const std::size_t n = chain.nodes.size();
  std::vector<double> t(n, 0);
  const auto step = [&](std::size_t i, std::size_t j)
  { return (points.row(chain.nodes[j]) - points.row(chain.nodes[i])).norm(); };
  for (std::size_t i = 1; i < n; ++i)
  {
    t[i] = t[i - 1] + step(i - 1, i);
  }
  const double length = t.back() + (chain.loop ? step(n - 1, 0) : 0);
  const double pieces = static_cast<double>(chain.loop ? n : n - 1);
  for (std::size_t i = 0; i < n; ++i)
  {
    t[i] = length > 0 ? t[i] / length : static_cast<double>(i) / pieces;
  }
  return t;
}
}
