// SPDX-License-Identifier: BSD-3-Clause
#include "Interpolation/PointLocation.h"

#include "Geometry/PointOrders.h"
#include "Support/Error.h"
#include "Support/Parallel.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace morph
{
namespace
{
constexpr Index BlockLength = 256;
constexpr double FlatHeight = 1e-13; // of the longest edge
constexpr double InsideTolerance = PointLocation::InsideTolerance;
constexpr double LinearPrecision = 1e-10; // of the sites' size
constexpr std::size_t MostCandidates = 200;

using Row = Eigen::RowVector3d;

/// A tetrahedron as a barycentric coordinate system.
class Frame
{
public:
  Frame(const Delaunay& delaunay, int id)
  {
    const auto& sites = delaunay.tetrahedra()[id].sites;
    this->origin_ = delaunay.sites().row(sites[0]);
    for (int k = 0; k < 3; ++k)
    {
      this->edges_.col(k) = (delaunay.sites().row(sites[k + 1]) - this->origin_).transpose();
    }
    const Eigen::Vector3d a = this->edges_.col(0), b = this->edges_.col(1), c = this->edges_.col(2);
    const double longest = std::sqrt(std::max({ a.squaredNorm(), b.squaredNorm(), c.squaredNorm(),
      (b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm() }));
    const double largest = std::sqrt(std::max({ a.cross(b).squaredNorm(), b.cross(c).squaredNorm(),
      c.cross(a).squaredNorm(), (b - a).cross(c - a).squaredNorm() })); // twice a face's area
    // A height that rounding of the coordinates alone makes says nothing about x. That of the
    // largest face is one, too, if all corners are in one line.
    const double leastHeight = std::max(FlatHeight * longest, delaunay.rounding());
    this->flat_ = !(largest > leastHeight * longest &&
                    std::abs(this->edges_.determinant()) > leastHeight * largest);
    if (!this->flat_)
    {
      this->inverse_ = this->edges_.inverse();
    }
  }

  bool flat() const { return this->flat_; }

  Eigen::RowVector4d coordinates(const Row& x) const
  {
    const Eigen::Vector3d d = (x - this->origin_).transpose();
    Eigen::Vector3d b = this->inverse_ * d;
    b += this->inverse_ * (d - this->edges_ * b); // needles lose digits in the first product
    return Eigen::RowVector4d(1 - b[0] - b[1] - b[2], b[0], b[1], b[2]);
  }

private:
  Row origin_;
  Eigen::Matrix3d edges_, inverse_ = Eigen::Matrix3d::Zero();
  bool flat_;
};

struct Place
{
  int tetrahedron = Delaunay::Outside;
  Eigen::RowVector4d barycentric = Eigen::RowVector4d::Zero();
};

double residual(const Delaunay& delaunay, const Place& at, const Row& x)
{
  Row sum = Row::Zero();
  for (int k = 0; k < 4; ++k)
  {
    sum += at.barycentric[k] * delaunay.sites().row(delaunay.tetrahedra()[at.tetrahedron].sites[k]);
  }
  return (sum - x).norm();
}

/// Returns the best tetrahedron around `start` that is not flat, searching through flat ones and
/// two more rings.
Place bestAround(const Delaunay& delaunay, const Row& x, int start)
{
  Place best;
  std::vector<int> candidates{ start };
  std::vector<int> rings{ 0 };
  for (std::size_t i = 0; i < candidates.size() && candidates.size() < MostCandidates; ++i)
  {
    const Frame frame(delaunay, candidates[i]);
    if (!frame.flat())
    {
      const Eigen::RowVector4d b = frame.coordinates(x);
      if (b.allFinite() &&
          (best.tetrahedron == Delaunay::Outside || b.minCoeff() > best.barycentric.minCoeff()))
      {
        best = { candidates[i], b };
      }
    }
    const int ring = rings[i] + (frame.flat() ? 0 : 1);
    for (int next : delaunay.tetrahedra()[candidates[i]].neighbors)
    {
      if (next != Delaunay::Outside && ring <= 2 &&
          std::find(candidates.begin(), candidates.end(), next) == candidates.end())
      {
        candidates.push_back(next);
        rings.push_back(ring);
      }
    }
  }
  return best;
}

/// Tries the tetrahedron `found` with its `frame` first, then bestAround(). A walk may end too soon
/// in flat tetrahedra, which lie in one plane with x. Where x is outside the best, others go on
/// from there, through the face that x is farthest beyond, while they come closer.
Place place(const Delaunay& delaunay, const Row& x, int found, const Frame& frame)
{
  if (!frame.flat())
  {
    const Eigen::RowVector4d b = frame.coordinates(x);
    if (b.minCoeff() >= -InsideTolerance)
    {
      return { found, b };
    }
  }
  const Place best = bestAround(delaunay, x, found);
  Place here = best;
  while (here.tetrahedron != Delaunay::Outside)
  {
    Index face = 0;
    const double outside = here.barycentric.minCoeff(&face);
    if (outside >= -InsideTolerance)
    {
      return here;
    }
    const int beyond = delaunay.tetrahedra()[here.tetrahedron].neighbors[face];
    const Place next =
      bestAround(delaunay, x, delaunay.locate(x, beyond < 0 ? here.tetrahedron : beyond));
    if (next.tetrahedron == Delaunay::Outside || next.barycentric.minCoeff() <= outside)
    {
      break;
    }
    here = next;
  }
  return best;
}
}

PointLocation locatePoints(
  const Delaunay& delaunay, const Points& points, const std::vector<Index>& ids, Monitor& monitor)
{
  // Maps node ids, which spatialOrder() gives, to rows.
  std::vector<Index> rowOf(points.rows(), -1);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    rowOf[ids[i]] = static_cast<Index>(i);
  }
  const std::vector<Index> order = spatialOrder(points, ids);
  const Points& sites = delaunay.sites();
  const double size = (sites.colwise().maxCoeff() - sites.colwise().minCoeff()).norm();
  monitor.check();

  const Index n = static_cast<Index>(ids.size());
  PointLocation result;
  result.tetrahedron.resize(n);
  result.barycentric.resize(n, 4);
  std::vector<char> state(n, 0); // 1: outside, 2: not found
  parallel((n + BlockLength - 1) / BlockLength, 1, monitor,
    [&](Index block)
    {
      const Index first = block * BlockLength;
      const Row start = points.row(order[first]) - delaunay.origin();
      // A walk that begins in a flat tetrahedron may end there: if it lies in the same side of the
      // hull as x, x is certainly beyond none of its faces.
      int here = std::max(0, bestAround(delaunay, start, delaunay.startNear(start)).tetrahedron);
      int found = here;
      Frame frame(delaunay, here);
      for (Index i = first; i < std::min(n, first + BlockLength); ++i)
      {
        const Row x = points.row(order[i]) - delaunay.origin();
        const Index row = rowOf[order[i]];
        const int last = found;
        found = delaunay.locate(x, here);
        if (found != last) // several nodes lie in one tetrahedron
        {
          frame = Frame(delaunay, found);
        }
        const Place at = place(delaunay, x, found, frame);
        if (at.tetrahedron == Delaunay::Outside ||
            residual(delaunay, at, x) > LinearPrecision * size)
        {
          state[row] = 2;
          continue;
        }
        here = at.tetrahedron;
        state[row] = at.barycentric.minCoeff() < -InsideTolerance ? 1 : 0;
        result.tetrahedron[row] = at.tetrahedron;
        result.barycentric.row(row) = at.barycentric;
      }
    });
  monitor.check();

  std::vector<Index> lost;
  for (Index i = 0; i < n; ++i)
  {
    if (state[i] == 1)
    {
      result.extrapolated.push_back(ids[i]);
    }
    else if (state[i] == 2)
    {
      lost.push_back(ids[i]);
    }
  }
  if (!lost.empty())
  {
    throw Error(Error::Kind::Singular, "All tetrahedra between prescribed nodes near node ids " +
                                         listIds(lost) +
                                         " are flat, so they cannot say where the node goes. "
                                         "Prescribe nodes on all sides of it, or choose FEMWARP.");
  }
  return result;
}
}
