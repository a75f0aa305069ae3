// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/CrossingFaces.h"

#include "Boundary/SurfaceEdges.h"
#include "Geometry/MeanOfRows.h"
#include "Geometry/OrientationPredicate.h"
#include "Geometry/OverlappingBoxes.h"
#include "Support/Parallel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace morph
{
namespace
{
/// Of the shortest edge at a node: how far it is pushed. Rounding of coordinates is below it.
constexpr double Depth = 1e-3;
/// Faces whose boxes are nearer than this part of their size are in contact. Of curved bodies whose
/// faces do not match, facets in contact cross by their height, however small the motion.
constexpr double Contact = 0.125;

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
    std::sort(this->nodes.begin(), this->nodes.end());
    this->nodes.erase(std::unique(this->nodes.begin(), this->nodes.end()), this->nodes.end());
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

  Place(const Shell& shell, const ConstPoints& points)
    : at(points(shell.nodes, allColumns))
    , inside(at)
  {
    Points normals = Points::Zero(this->at.rows(), 3);
    Eigen::VectorXd shortest =
      Eigen::VectorXd::Constant(this->at.rows(), std::numeric_limits<double>::infinity());
    for (Index f = 0; f < shell.count(); ++f)
    {
      const Index* nodes = shell.begin(f);
      const Index size = shell.size(f);
      const Eigen::RowVector3d normal =
        shell.orientation[shell.cells[f]] * vectorArea(this->at, nodes, size).normalized();
      for (Index k = 0; k < size; ++k)
      {
        const Index a = nodes[k], b = nodes[(k + 1) % size];
        normals.row(a) += normal;
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
      if (std::isfinite(shortest[i]))
      {
        this->inside.row(i) -= Depth * shortest[i] * normals.row(i).normalized();
      }
    }
  }
};

struct Facet
{
  std::array<Eigen::Vector3d, 3> corners;
  Eigen::AlignedBox3d box;
};

/// Fills `triangles` with those of a face.
void makeFacets(const Shell& shell, Index face, const Points& points, std::vector<Facet>& triangles)
{
  const auto at = [&](Index corner) -> Eigen::Vector3d { return points.row(corner).transpose(); };
  const Index* nodes = shell.begin(face);
  const Index size = shell.size(face);
  triangles.clear();
  const auto add = [&](const Eigen::Vector3d& a, Index b, Index c)
  {
    Facet triangle;
    triangle.corners = { a, at(b), at(c) };
    for (const Eigen::Vector3d& corner : triangle.corners)
    {
      triangle.box.extend(corner);
    }
    triangles.push_back(triangle);
  };
  if (size == 3)
  {
    add(at(nodes[0]), nodes[1], nodes[2]);
    return;
  }
  const Eigen::Vector3d mean = meanOfRows(points, nodes, nodes + size).transpose();
  for (Index k = 0; k < size; ++k)
  {
    add(mean, nodes[k], nodes[(k + 1) % size]);
  }
}

/// Whether the line from p to q passes from one side of the triangle's plane to the other, through
/// the triangle or its rim. Lines that only reach the plane do not.
bool pierces(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Facet& triangle)
{
  const auto& [a, b, c] = triangle.corners;
  if (orientationSign(a, b, c, p) * orientationSign(a, b, c, q) >= 0)
  {
    return false;
  }
  const int sides[] = { orientationSign(p, q, a, b), orientationSign(p, q, b, c),
    orientationSign(p, q, c, a) };
  return std::find(sides, sides + 3, -1) == sides + 3 ||
         std::find(sides, sides + 3, 1) == sides + 3;
}

/// Whether an edge of a triangle passes through another one.
bool anyEdgePierces(const Facet& edges, const Facet& other)
{
  for (int k = 0; k < 3; ++k)
  {
    if (pierces(edges.corners[k], edges.corners[(k + 1) % 3], other))
    {
      return true;
    }
  }
  return false;
}

bool anyCross(const std::vector<Facet>& first, const std::vector<Facet>& second)
{
  for (const Facet& a : first)
  {
    for (const Facet& b : second)
    {
      if (a.box.intersects(b.box) && (anyEdgePierces(a, b) || anyEdgePierces(b, a)))
      {
        return true;
      }
    }
  }
  return false;
}

/// Whether two faces cross with one of them pushed.
bool facesCross(const Shell& shell, const Place& place, const std::array<Index, 2>& pair,
  std::vector<Facet>& first, std::vector<Facet>& second)
{
  for (const bool isFirstPushed : { true, false })
  {
    makeFacets(shell, pair[0], isFirstPushed ? place.inside : place.at, first);
    makeFacets(shell, pair[1], isFirstPushed ? place.at : place.inside, second);
    if (anyCross(first, second))
    {
      return true;
    }
  }
  return false;
}
}

std::vector<std::array<Index, 2>> crossingFaces(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const std::vector<std::int8_t>& orientation, Monitor& monitor)
{
  const Shell shell(faces, orientation);
  std::vector<Eigen::AlignedBox3d> boxes(static_cast<std::size_t>(shell.count()));
  std::vector<Eigen::AlignedBox3d> boxesAtRest(boxes.size());
  std::vector<std::uint8_t> isMoved(boxes.size());
  for (Index f = 0; f < shell.count(); ++f)
  {
    for (const Index* corner = shell.begin(f); corner != shell.end(f); ++corner)
    {
      const Index node = shell.nodes[*corner];
      boxes[f].extend(moved.row(node).transpose());
      boxesAtRest[f].extend(rest.row(node).transpose());
      isMoved[f] |= rest.row(node) != moved.row(node);
    }
  }
  monitor.check();
  // Faces that share a node are 0 apart, so they are in contact, too.
  const auto areApart = [&](Index f, Index g)
  {
    const Eigen::AlignedBox3d &first = boxesAtRest[f], &second = boxesAtRest[g];
    const double reach = Contact * (first.diagonal().norm() + second.diagonal().norm());
    return first.exteriorDistance(second) > reach;
  };
  std::vector<std::array<Index, 2>> pairs = overlappingBoxes(boxes, isMoved, areApart);
  if (pairs.empty())
  {
    return pairs;
  }
  const auto keepCrossing = [&](const Place& place, bool isKept)
  {
    constexpr Index Batch = 1 << 16, Grain = 256;
    std::vector<std::uint8_t> areKept(pairs.size());
    parallelBatches(monitor, static_cast<Index>(pairs.size()), Batch, Grain,
      [&](Index begin, Index end)
      {
        std::vector<Facet> first, second;
        for (Index i = begin; i < end; ++i)
        {
          areKept[i] = facesCross(shell, place, pairs[i], first, second) == isKept;
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
  keepCrossing(Place(shell, moved), true);
  if (!pairs.empty())
  {
    keepCrossing(Place(shell, rest), false);
  }
  return pairs;
}
}
