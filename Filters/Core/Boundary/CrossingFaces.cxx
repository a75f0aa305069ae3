// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/CrossingFaces.h"

#include "Boundary/Classification.h"
#include "Boundary/SurfaceEdges.h"
#include "Geometry/ExactPredicates.h"
#include "Support/Lists.h"
#include "Support/Parallel.h"

#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace morph
{
namespace
{
/// Of the shortest edge at a node: how far it is pushed. Rounding of coordinates is below it.
constexpr double Depth = 1e-3;
/// Faces whose boxes are nearer than this part of their size are near each other.
constexpr double Near = 0.125;
/// Degrees: by how much faces in contact may turn where no neighbor shows it.
constexpr double Slight = 5;
/// Corners move back by no more than this times the way of their faces.
constexpr double Steep = 4;
constexpr double Degree = 3.14159265358979323846 / 180;
/// The boundary faces by numbers of their own corners: its arrays do not grow with the mesh.
struct Shell
{
  std::vector<Index> nodes;          ///< the mesh's, ascending
  std::vector<Index> corners;        ///< of all faces, numbers in `nodes`
  const std::vector<Index>& offsets; ///< #faces + 1, into `corners`
  const std::vector<Index>& cells;   ///< #faces
  const std::vector<std::int8_t>& orientation;

  Shell(const BoundaryFaces& faces, const std::vector<std::int8_t>& orientationOfCells)
    : nodes(faces.connectivity)
    , offsets(faces.offsets)
    , cells(faces.cells)
    , orientation(orientationOfCells)
  {
    sortUnique(this->nodes);
    std::vector<Index> number(this->nodes.empty() ? 0 : this->nodes.back() + 1);
    for (std::size_t i = 0; i < this->nodes.size(); ++i)
    {
      number[this->nodes[i]] = static_cast<Index>(i);
    }
    this->corners.reserve(faces.connectivity.size());
    for (const Index node : faces.connectivity)
    {
      this->corners.push_back(number[node]);
    }
  }

  Index count() const { return static_cast<Index>(this->cells.size()); }
  const Index* begin(Index face) const { return this->corners.data() + this->offsets[face]; }
  const Index* end(Index face) const { return this->corners.data() + this->offsets[face + 1]; }
  Index size(Index face) const { return this->offsets[face + 1] - this->offsets[face]; }
};

/// The corners at one time, and where they are once they are pushed into their body.
struct Place
{
  Points at, inside;
  Points normals; ///< #faces x 3, outwards, of unit length
  /// The way outwards at a corner along which all of its faces move by 1 at least, unless they are
  /// steeper than Steep.
  Points outwards;

  Place(const Shell& shell, const ConstPoints& points)
    : at(points(shell.nodes, allColumns))
    , inside(at)
    , normals(shell.count(), 3)
    , outwards(Points::Zero(this->at.rows(), 3))
  {
    Eigen::VectorXd shortest =
      Eigen::VectorXd::Constant(this->at.rows(), std::numeric_limits<double>::infinity());
    for (Index f = 0; f < shell.count(); ++f)
    {
      const Index* nodes = shell.begin(f);
      const Index size = shell.size(f);
      this->normals.row(f) =
        shell.orientation[shell.cells[f]] * vectorArea(this->at, nodes, size).normalized();
      for (Index k = 0; k < size; ++k)
      {
        const Index a = nodes[k], b = nodes[(k + 1) % size];
        this->outwards.row(a) += this->normals.row(f);
        const double length = (this->at.row(a) - this->at.row(b)).norm();
        if (length > 0)
        {
          shortest[a] = std::min(shortest[a], length);
          shortest[b] = std::min(shortest[b], length);
        }
      }
    }
    for (Index i = 0; i < this->at.rows(); ++i)
    {
      // Where faces are folded onto one another their normals may cancel, and nothing is outwards.
      this->outwards.row(i) = this->outwards.row(i).normalized().eval();
      if (std::isfinite(shortest[i]))
      {
        this->inside.row(i) -= Depth * shortest[i] * this->outwards.row(i);
      }
    }
    Eigen::VectorXd least = Eigen::VectorXd::Ones(this->at.rows());
    for (Index f = 0; f < shell.count(); ++f)
    {
      for (const Index* corner = shell.begin(f); corner != shell.end(f); ++corner)
      {
        const double along = this->normals.row(f).dot(this->outwards.row(*corner));
        least[*corner] = std::min(least[*corner], std::max(along, 1 / Steep));
      }
    }
    this->outwards.array().colwise() /= least.array();
  }
};

Eigen::AlignedBox3d boxOf(const Shell& shell, const Place& place, Index face)
{
  Eigen::AlignedBox3d box;
  std::for_each(shell.begin(face), shell.end(face),
    [&](Index corner) { box.extend(place.at.row(corner).transpose()); });
  return box;
}

/// The height of an arc over a chord, turning by an angle in radians.
double arcHeight(double chord, double turn)
{
  return chord / 2 * std::tan(turn / 4);
}

/// For each face how far the faces at its corners are at most from a smooth surface that turns as
/// they do: the height of an arc over its chord.
Eigen::VectorXd heights(const Shell& shell, const Place& place, Monitor& monitor)
{
  const double feature = ClassificationOptions().featureAngle * Degree;
  const Points& at = place.at;
  Eigen::VectorXd size(shell.count());
  for (Index f = 0; f < shell.count(); ++f)
  {
    size[f] = boxOf(shell, place, f).diagonal().norm();
  }
  const Adjacency facesAt = sortIntoBuckets(shell.count(), at.rows(), monitor,
    [&](Index first, Index last, const auto& add)
    {
      for (Index f = first; f < last; ++f)
      {
        std::for_each(shell.begin(f), shell.end(f), [&](Index corner) { add(corner, f); });
      }
    });
  Eigen::VectorXd atCorner = Eigen::VectorXd::Zero(at.rows());
  for (Index corner = 0; corner < at.rows(); ++corner)
  {
    for (const Index* f = facesAt.begin(corner); f != facesAt.end(corner); ++f)
    {
      for (const Index* g = facesAt.begin(corner); g != f; ++g)
      {
        const Eigen::RowVector3d a = place.normals.row(*f), b = place.normals.row(*g);
        const double turn = std::atan2(a.cross(b).norm(), a.dot(b));
        if (turn <= feature)
        {
          const double height = arcHeight(std::max(size[*f], size[*g]), turn);
          atCorner[corner] = std::max(atCorner[corner], height);
        }
      }
    }
  }
  Eigen::VectorXd result = Eigen::VectorXd::Zero(shell.count());
  for (Index f = 0; f < shell.count(); ++f)
  {
    for (const Index* corner = shell.begin(f); corner != shell.end(f); ++corner)
    {
      result[f] = std::max(result[f], atCorner[*corner]);
    }
  }
  return result;
}

/// A face as triangles: itself, or those around the mean of its corners.
struct Facets
{
  std::vector<Eigen::Vector3d> points; ///< the corners, and then their mean
  std::vector<std::array<std::size_t, 3>> triangles;
  std::vector<Eigen::AlignedBox3d> boxes; ///< #triangles

  /// `at`: the place of a corner.
  template <typename At>
  void take(const Shell& shell, Index face, const At& at)
  {
    this->points.clear();
    this->triangles.clear();
    this->boxes.clear();
    std::transform(shell.begin(face), shell.end(face), std::back_inserter(this->points), at);
    const std::size_t size = this->points.size();
    if (size == 3)
    {
      this->add({ 0, 1, 2 });
      return;
    }
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& corner : this->points)
    {
      mean += corner / static_cast<double>(size);
    }
    this->points.push_back(mean);
    for (std::size_t k = 0; k < size; ++k)
    {
      this->add({ size, k, (k + 1) % size });
    }
  }

private:
  void add(const std::array<std::size_t, 3>& triangle)
  {
    this->triangles.push_back(triangle);
    this->boxes.emplace_back();
    for (const std::size_t corner : triangle)
    {
      this->boxes.back().extend(this->points[corner]);
    }
  }
};

/// Whether the line from p to q passes through a triangle or its rim.
bool passes(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
  const std::array<const Eigen::Vector3d*, 3>& triangle)
{
  int sum = 0, sides = 0;
  for (int k = 0; k < 3; ++k)
  {
    const int side = orientationSign(p, q, *triangle[k], *triangle[(k + 1) % 3]);
    sum += side;
    sides += std::abs(side);
    if (std::abs(sum) < sides)
    {
      return false; // on one side here, and on the other there
    }
  }
  return true;
}

/// Whether an edge of a triangle of `edges` passes from one side of the plane of one of `others` to
/// the other side, and through this triangle. Edges that only reach the plane do not.
bool anyEdgePierces(const Facets& edges, const Facets& others)
{
  std::vector<int> side; // of the plane, on which the points are
  for (std::size_t t = 0; t < others.triangles.size(); ++t)
  {
    const auto& [a, b, c] = others.triangles[t];
    const std::array<const Eigen::Vector3d*, 3> triangle = { &others.points[a], &others.points[b],
      &others.points[c] };
    side.clear();
    for (std::size_t s = 0; s < edges.triangles.size(); ++s)
    {
      if (!edges.boxes[s].intersects(others.boxes[t]))
      {
        continue;
      }
      if (side.empty())
      {
        std::transform(edges.points.begin(), edges.points.end(), std::back_inserter(side),
          [&](const Eigen::Vector3d& x)
          { return orientationSign(*triangle[0], *triangle[1], *triangle[2], x); });
      }
      for (int k = 0; k < 3; ++k)
      {
        const std::size_t p = edges.triangles[s][k], q = edges.triangles[s][(k + 1) % 3];
        if (side[p] * side[q] < 0 && passes(edges.points[p], edges.points[q], triangle))
        {
          return true;
        }
      }
    }
  }
  return false;
}

/// Whether two faces cross with one of them pushed, and one moved back by `length`: as a whole, and
/// also with the faces at its corners.
bool crossPushed(const Shell& shell, const Place& place, const std::array<Index, 2>& pair,
  double length, std::array<Facets, 2>& facets)
{
  const auto cross = [&](int pushed, int movedBack, bool asAWhole)
  {
    for (const int side : { 0, 1 })
    {
      const Index face = pair[side];
      const Points& corners = side == pushed ? place.inside : place.at;
      const auto at = [&](Index corner) -> Eigen::Vector3d
      {
        const Eigen::RowVector3d x = corners.row(corner);
        const Eigen::RowVector3d way =
          asAWhole ? place.normals.row(face) : place.outwards.row(corner);
        return (side == movedBack ? Eigen::RowVector3d(x - length * way) : x).transpose();
      };
      facets[side].take(shell, face, at);
    }
    return anyEdgePierces(facets[0], facets[1]) || anyEdgePierces(facets[1], facets[0]);
  };
  const auto crossIf = [&](int movedBack, bool asAWhole)
  { return cross(0, movedBack, asAWhole) || cross(1, movedBack, asAWhole); };
  return (crossIf(0, true) && (length == 0 || crossIf(0, false))) ||
         (length > 0 && crossIf(1, true) && crossIf(1, false));
}

/// Whether one affine map moves the corners of both faces. It lets none cross that did not, but
/// sharp corners of sheared faces in contact look as if it did.
bool moveAffinely(const Shell& shell, const ConstPoints& rest, const ConstPoints& moved,
  const std::array<Index, 2>& pair)
{
  std::vector<Index> nodes;
  for (const Index face : pair)
  {
    std::for_each(shell.begin(face), shell.end(face),
      [&](Index corner) { nodes.push_back(shell.nodes[corner]); });
  }
  const Points from = rest(nodes, allColumns), to = moved(nodes, allColumns);
  const Eigen::MatrixXd x = from.rowwise() - from.row(0), y = to.rowwise() - to.row(0);
  constexpr double Rounding = 1e-9;
  const Eigen::MatrixXd map = x.completeOrthogonalDecomposition().solve(y);
  return (x * map - y).cwiseAbs().maxCoeff() <= Rounding * y.cwiseAbs().maxCoeff();
}
}

std::vector<std::array<Index, 2>> crossingFaces(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const std::vector<std::int8_t>& orientation, Monitor& monitor)
{
  const Shell shell(faces, orientation);
  std::vector<Eigen::AlignedBox3d> boxes(static_cast<std::size_t>(shell.count()));
  std::vector<std::uint8_t> isMoved(boxes.size());
  for (Index f = 0; f < shell.count(); ++f)
  {
    for (const Index* corner = shell.begin(f); corner != shell.end(f); ++corner)
    {
      const Index node = shell.nodes[*corner];
      boxes[f].extend(moved.row(node).transpose());
      isMoved[f] |= rest.row(node) != moved.row(node);
    }
  }
  monitor.check();
  const auto areApart = [&](Index f, Index g)
  {
    return std::none_of(shell.begin(f), shell.end(f),
      [&](Index corner)
      { return std::find(shell.begin(g), shell.end(g), corner) != shell.end(g); });
  };
  std::vector<std::array<Index, 2>> pairs = overlappingBoxes(boxes, isMoved, areApart);
  if (pairs.empty())
  {
    return pairs;
  }
  const auto keep = [&](const auto& isKept)
  {
    constexpr Index Batch = 1 << 16, Grain = 256;
    std::vector<std::uint8_t> areKept(pairs.size());
    parallelBatches(monitor, static_cast<Index>(pairs.size()), Batch, Grain,
      [&](Index begin, Index end)
      {
        std::array<Facets, 2> facets;
        const auto crossAt = [&](const Place& place, const auto& pair, double length)
        { return crossPushed(shell, place, pair, length, facets); };
        for (Index i = begin; i < end; ++i)
        {
          areKept[i] = isKept(pairs[i], crossAt);
        }
      });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i)
    {
      if (areKept[i])
      {
        pairs[kept++] = pairs[i];
      }
    }
    pairs.resize(kept);
  };
  const Place now(shell, moved);
  keep([&](const auto& pair, const auto& crossAt)
    { return crossAt(now, pair, 0) && !moveAffinely(shell, rest, moved, pair); });
  if (pairs.empty())
  {
    return pairs;
  }
  const Place before(shell, rest);
  const Eigen::VectorXd height =
    heights(shell, before, monitor).cwiseMax(heights(shell, now, monitor));
  // Of faces in contact before the motion, the height is at least that of a slight turn.
  const auto heightOf = [&](const std::array<Index, 2>& pair)
  {
    const auto size = [](const Eigen::AlignedBox3d& box) { return box.diagonal().norm(); };
    const Eigen::AlignedBox3d first = boxOf(shell, before, pair[0]),
                              second = boxOf(shell, before, pair[1]);
    const bool isNear = first.exteriorDistance(second) <= Near * (size(first) + size(second));
    double sum = 0;
    for (const Index f : pair)
    {
      const double least = isNear ? arcHeight(size(boxes[f]), Slight * Degree) : 0;
      sum += std::max(height[f], least);
    }
    return sum;
  };
  keep(
    [&](const auto& pair, const auto& crossAt)
    {
      const double length = heightOf(pair);
      return crossAt(now, pair, length) &&
             !(crossAt(before, pair, 0) && crossAt(before, pair, length));
    });
  return pairs;
}
}
