// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/SurfaceHarmonicExtension.h"

#include "BoundaryMorphing/MidNodes.h"
#include "Geometry/AffineFit.h"
#include "Solvers/SpdSolver.h"
#include "Support/Lists.h"
#include "Support/ProgressRange.h"

#include <algorithm>
#include <utility>

namespace morph
{
namespace
{
using Pair = std::pair<Index, Index>;

/// Returns the edges of the faces, lower node first, each once.
std::vector<Pair> edgesOf(const BoundaryFaces& faces, const std::vector<Index>& faceIds)
{
  std::vector<Pair> edges;
  for (Index f : faceIds)
  {
    const Index first = faces.offsets[f], size = faces.offsets[f + 1] - first;
    for (Index k = 0; k < size; ++k)
    {
      const Index a = faces.connectivity[first + k];
      const Index b = faces.connectivity[first + (k + 1) % size];
      edges.emplace_back(std::min(a, b), std::max(a, b));
    }
  }
  sortUnique(edges);
  return edges;
}

/// The number of a node in faces.nodes.
Index placeOf(const BoundaryFaces& faces, Index node)
{
  return std::lower_bound(faces.nodes.begin(), faces.nodes.end(), node) - faces.nodes.begin();
}

class Smoother
{
public:
  Smoother(const BoundaryFaces& faces, const std::vector<Index>& free, const AffineFit& fit,
    BoundaryMotion& motion)
    : faces_(faces)
    , fit_(fit)
    , motion_(motion)
  {
    for (Index node : free)
    {
      const Index k = placeOf(faces, node);
      const bool isCorner = faces.between.begin(k) == faces.between.end(k);
      (isCorner ? this->corners_ : this->middles_).push_back(node);
    }
  }

  void run(const std::vector<Index>& faceIds, Monitor& monitor)
  {
    if (!this->corners_.empty())
    {
      this->solve(edgesOf(this->faces_, faceIds), monitor);
    }
    for (Index node : this->middles_)
    {
      this->set(node, meanBetween(this->faces_, placeOf(this->faces_, node), this->motion_.rest,
                        [this](Index corner) { return this->residual(corner); }));
    }
  }

private:
  Eigen::RowVector3d field(Index node) const
  {
    return this->fit_.displacement(Eigen::RowVector3d(this->motion_.rest.row(node)));
  }
  Eigen::RowVector3d residual(Index node) const
  {
    return this->motion_.displacement.row(node) - this->field(node);
  }
  void set(Index node, const Eigen::RowVector3d& residual)
  {
    this->motion_.displacement.row(node) = this->field(node) + residual;
  }
  /// Returns the row of a free corner, or -1.
  int row(Index node) const
  {
    const auto place = std::lower_bound(this->corners_.begin(), this->corners_.end(), node);
    return place != this->corners_.end() && *place == node
             ? static_cast<int>(place - this->corners_.begin())
             : -1;
  }

  void solve(const std::vector<Pair>& edges, Monitor& monitor)
  {
    const auto length = [&](const Pair& e)
    { return (this->motion_.rest.row(e.first) - this->motion_.rest.row(e.second)).norm(); };
    double longest = 0;
    for (const Pair& e : edges)
    {
      longest = std::max(longest, length(e));
    }
    const Index n = static_cast<Index>(this->corners_.size());
    Points b = Points::Zero(n, 3), x = Points::Zero(n, 3);
    std::vector<Eigen::Triplet<double, int>> entries;
    double largestResidual = 0, largestMotion = 0;
    for (const Pair& e : edges)
    {
      // The weight of coincident nodes is large but bounded.
      const double weight = longest > 0 ? longest / std::max(length(e), 1e-6 * longest) : 1;
      const int i = this->row(e.first), j = this->row(e.second);
      for (const auto& [own, other, node] :
        { std::make_tuple(i, j, e.second), std::make_tuple(j, i, e.first) })
      {
        if (own < 0)
        {
          continue;
        }
        entries.emplace_back(own, own, weight);
        if (other >= 0)
        {
          entries.emplace_back(own, other, -weight);
        }
        else
        {
          const Eigen::RowVector3d r = this->residual(node);
          b.row(own) += weight * r;
          largestResidual = std::max(largestResidual, r.norm());
          largestMotion = std::max(largestMotion, this->motion_.displacement.row(node).norm());
        }
      }
    }
    if (largestResidual > 1e-13 * largestMotion) // otherwise it is rounding
    {
      LinearEquations equations = { CsrMatrix(n, n),
        this->motion_.rest(this->corners_, allColumns) };
      equations.matrix.setFromTriplets(entries.begin(), entries.end());
      SpdSolver solver;
      ProgressRange first(monitor, 0, 0.5), second(monitor, 0.5, 1);
      solver.prepare(std::move(equations), first);
      solver.solve(b, x, 1e-12, 2000, second);
    }
    for (Index i = 0; i < n; ++i)
    {
      this->set(this->corners_[i], x.row(i));
    }
  }

  const BoundaryFaces& faces_;
  const AffineFit& fit_;
  BoundaryMotion& motion_;
  std::vector<Index> corners_, middles_; ///< free, ascending
};
}

void extendHarmonically(const BoundaryFaces& faces, const std::vector<Index>& faceIds,
  const std::vector<Index>& fixed, const std::vector<Index>& free, BoundaryMotion& motion,
  Monitor& monitor)
{
  const AffineFit fit =
    AffineLeastSquares(motion.rest(fixed, allColumns), motion.rest(free, allColumns))
      .fit(motion.displacement(fixed, allColumns));
  Smoother(faces, free, fit, motion).run(faceIds, monitor);
}
}
