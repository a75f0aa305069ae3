// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/BoundaryProjection.h"

#include "Boundary/FaceQuality.h"
#include "Support/Lists.h"
#include "Support/Parallel.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace morph
{
ProjectionTarget::~ProjectionTarget() = default;

bool ProjectionTarget::holds(Index) const
{
  return true;
}

namespace
{
std::vector<Index> nodesIn(const BoundaryMotion& motion, BoundaryMotion::State state)
{
  std::vector<Index> ids;
  for (std::size_t n = 0; n < motion.state.size(); ++n)
  {
    if (motion.state[n] == state)
    {
      ids.push_back(static_cast<Index>(n));
    }
  }
  return ids;
}

/// Calls search(node, position, found) for each id, and moves the node if it succeeds.
template <typename Search>
ProjectionReport moveTo(
  const std::vector<Index>& ids, const Search& search, BoundaryMotion& motion, Monitor& monitor)
{
  const Points before = motion.moved();
  std::vector<std::uint8_t> found(ids.size(), 0);
  parallel(static_cast<Index>(ids.size()), 256, monitor,
    [&](Index i)
    {
      Eigen::RowVector3d to;
      if (search(ids[i], Eigen::RowVector3d(before.row(ids[i])), to) && to.allFinite())
      {
        motion.displacement.row(ids[i]) = to - motion.rest.row(ids[i]);
        found[i] = 1;
      }
    });
  monitor.check();
  ProjectionReport report;
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    (found[i] ? report.projected : report.missed).push_back(ids[i]);
  }
  return report;
}

/// Returns projected nodes to their position before the projection.
class TakingBack
{
public:
  TakingBack(const Points& displacement, const Points& moved, const std::vector<Index>& projected,
    BoundaryMotion& motion)
    : displacement_(displacement)
    , moved_(moved)
    , motion_(motion)
    , isProjected_(motion.state.size(), 0)
  {
    for (Index node : projected)
    {
      this->isProjected_[node] = 1;
    }
  }

  /// Returns the node if it is projected, also in `now` (#nodes x 3, the moved positions). The
  /// result tells whether it is.
  bool take(Index node, Points& now)
  {
    if (!this->isProjected_[node])
    {
      return false;
    }
    this->isProjected_[node] = 0;
    this->motion_.displacement.row(node) = this->displacement_.row(node);
    now.row(node) = this->moved_.row(node);
    return true;
  }

  /// Moves the returned nodes from `projected` to `kept`.
  void finish(ProjectionReport& report) const
  {
    const auto kept = std::stable_partition(report.projected.begin(), report.projected.end(),
      [this](Index node) { return this->isProjected_[node] != 0; });
    report.kept.assign(kept, report.projected.end());
    report.projected.erase(kept, report.projected.end());
  }

private:
  const Points &displacement_, &moved_; ///< before the projection
  BoundaryMotion& motion_;
  std::vector<std::uint8_t> isProjected_; ///< #nodes
};

/// Opens folds some tens of faces across; a round costs little compared with the projection.
constexpr int RelaxationRounds = 100;

/// Spreads projected nodes where faces fold.
class Relaxation
{
public:
  /// `now`: #nodes x 3, the moved positions, updated.
  Relaxation(const BoundaryFaces& faces, const Classification& geometry,
    const ProjectionTarget& target, const Points& normals, BoundaryMotion& motion, Points& now,
    Monitor& monitor)
    : faces_(faces)
    , geometry_(geometry)
    , target_(target)
    , normals_(normals)
    , motion_(motion)
    , now_(now)
    , monitor_(monitor)
    , wasMoved_(motion.state.size(), 0)
  {
    for (const auto& [a, b] : geometry.edges.nodes)
    {
      this->pairs_.emplace_back(a, b);
      this->pairs_.emplace_back(b, a);
    }
    std::sort(this->pairs_.begin(), this->pairs_.end());
  }

  /// Moves projected ones of `nodes` and their neighbors simultaneously: to the target's point
  /// nearest to the mean of their neighbors.
  void round(const std::vector<Index>& nodes, const std::vector<Index>& projected)
  {
    std::vector<Index> around = nodes;
    for (Index node : nodes)
    {
      this->eachNeighbor(node, [&](Index other) { around.push_back(other); });
    }
    sortUnique(around);
    std::vector<Index> moving;
    std::set_intersection(
      around.begin(), around.end(), projected.begin(), projected.end(), std::back_inserter(moving));
    this->place(moving,
      [&](Index node)
      {
        Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
        Index count = 0;
        this->eachNeighbor(node,
          [&](Index other)
          {
            sum += this->now_.row(other);
            ++count;
          });
        return Eigen::RowVector3d(sum / static_cast<double>(count));
      });
  }

  /// Moves projected mid-side and face nodes between their corners if these moved.
  void finish(const std::vector<Index>& projected)
  {
    std::vector<Index> moving;
    for (Index node : projected)
    {
      const Index k = this->placeOf(node);
      if (std::any_of(this->faces_.between.begin(k), this->faces_.between.end(k),
            [&](Index corner) { return this->wasMoved_[corner]; }))
      {
        moving.push_back(node);
      }
    }
    this->place(moving,
      [&](Index node)
      {
        return meanBetween(this->faces_, this->placeOf(node), this->motion_.rest,
          [this](Index corner) { return Eigen::RowVector3d(this->now_.row(corner)); });
      });
  }

private:
  template <typename Visit>
  void eachNeighbor(Index node, const Visit& visit) const
  {
    for (auto p = std::lower_bound(
           this->pairs_.begin(), this->pairs_.end(), std::pair<Index, Index>(node, -1));
         p != this->pairs_.end() && p->first == node; ++p)
    {
      visit(p->second);
    }
  }

  Index placeOf(Index node) const
  {
    return std::lower_bound(this->faces_.nodes.begin(), this->faces_.nodes.end(), node) -
           this->faces_.nodes.begin();
  }

  /// Moves all nodes simultaneously: `wanted` sees the previous positions.
  template <typename Wanted>
  void place(const std::vector<Index>& nodes, const Wanted& wanted)
  {
    std::vector<std::uint8_t> found(nodes.size(), 0);
    parallel(static_cast<Index>(nodes.size()), 64, this->monitor_,
      [&](Index i)
      {
        const Index node = nodes[i];
        Eigen::RowVector3d to;
        if (this->target_.closestOnSurface(
              this->geometry_.entity[node], wanted(node), this->normals_.row(node), to) &&
            to.allFinite())
        {
          this->motion_.displacement.row(node) = to - this->motion_.rest.row(node);
          this->wasMoved_[node] = 1;
          found[i] = 1;
        }
      });
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      if (found[i])
      {
        this->now_.row(nodes[i]) =
          this->motion_.rest.row(nodes[i]) + this->motion_.displacement.row(nodes[i]);
      }
    }
  }

  const BoundaryFaces& faces_;
  const Classification& geometry_;
  const ProjectionTarget& target_;
  const Points& normals_;
  BoundaryMotion& motion_;
  Points& now_;
  Monitor& monitor_;
  std::vector<std::uint8_t> wasMoved_;
  std::vector<std::pair<Index, Index>> pairs_; ///< corners that share an edge, in both directions
};
}

ProjectionReport projectCurves(const Classification& geometry, const ProjectionTarget& target,
  BoundaryMotion& motion, Monitor& monitor)
{
  const Points displacement = motion.displacement, moved = motion.moved();
  ProjectionReport report = moveTo(
    nodesIn(motion, BoundaryMotion::OnCurve),
    [&](Index node, const Eigen::RowVector3d& x, Eigen::RowVector3d& y)
    { return target.closestOnFeatures(node, x, y); },
    motion, monitor);
  // After the first round, only pieces next to a node that went back can have turned.
  Points now = motion.moved();
  TakingBack takingBack(displacement, moved, report.projected, motion);
  for (const GeometryCurve& curve : geometry.curves)
  {
    const std::size_t n = curve.nodes.size(), pieces = curve.loop ? n : n - 1;
    std::vector<std::size_t> waiting = consecutive<std::size_t>(pieces);
    report.checkedPieces += static_cast<Index>(pieces);
    monitor.check();
    while (!waiting.empty())
    {
      std::vector<std::size_t> turned;
      for (std::size_t i : waiting)
      {
        const Index a = curve.nodes[i], b = curve.nodes[(i + 1) % n];
        const Eigen::RowVector3d was = moved.row(b) - moved.row(a), is = now.row(b) - now.row(a);
        if (!(was.dot(is) > 0) && !was.isZero(0))
        {
          turned.insert(turned.end(), { i, (i + 1) % n });
        }
      }
      waiting.clear();
      for (std::size_t i : turned)
      {
        if (takingBack.take(curve.nodes[i], now))
        {
          waiting.insert(waiting.end(), { (i + n - 1) % n, i });
        }
      }
      waiting.erase(std::remove_if(waiting.begin(), waiting.end(),
                      [pieces](std::size_t piece) { return piece >= pieces; }),
        waiting.end());
      report.checkedPieces += static_cast<Index>(waiting.size());
    }
  }
  takingBack.finish(report);
  return report;
}

ProjectionReport projectSurfaces(const BoundaryFaces& faces, const Classification& geometry,
  const ProjectionTarget& target, BoundaryMotion& motion, Monitor& monitor)
{
  const Points displacement = motion.displacement, moved = motion.moved();
  const std::vector<Index> foldedBefore = faceQuality(motion.rest, moved, faces, geometry).folded;
  const Points normals = surfaceNodeNormals(motion.rest, moved, faces, geometry);
  ProjectionReport report = moveTo(
    nodesIn(motion, BoundaryMotion::OnSurface),
    [&](Index node, const Eigen::RowVector3d& x, Eigen::RowVector3d& y)
    { return target.closestOnSurface(geometry.entity[node], x, normals.row(node), y); },
    motion, monitor);
  Points now = motion.moved();
  const auto folding = [&](const std::vector<Index>& except)
  {
    std::vector<Index> nodes;
    for (Index f : faceQuality(motion.rest, now, faces, geometry).folded)
    {
      if (!std::binary_search(except.begin(), except.end(), f))
      {
        nodes.insert(nodes.end(), faces.connectivity.begin() + faces.offsets[f],
          faces.connectivity.begin() + faces.offsets[f + 1]);
      }
    }
    sortUnique(nodes);
    monitor.check();
    return nodes;
  };
  std::vector<Index> nodes = folding({});
  if (!nodes.empty())
  {
    Relaxation relaxation(faces, geometry, target, normals, motion, now, monitor);
    for (int round = 0; round < RelaxationRounds && !nodes.empty(); ++round)
    {
      relaxation.round(nodes, report.projected);
      // Nodes that no longer fold keep moving: they make room for the others.
      const std::vector<Index> folded = folding({});
      std::vector<Index> moving;
      if (!folded.empty())
      {
        std::set_union(
          nodes.begin(), nodes.end(), folded.begin(), folded.end(), std::back_inserter(moving));
      }
      nodes = std::move(moving);
    }
    relaxation.finish(report.projected);
  }
  TakingBack takingBack(displacement, moved, report.projected, motion);
  for (bool any = true; any;)
  {
    any = false;
    for (Index node : folding(foldedBefore))
    {
      any = takingBack.take(node, now) || any;
    }
  }
  takingBack.finish(report);
  return report;
}

Points surfaceNodeNormals(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const Classification& geometry)
{
  const Points carried = faceQuality(rest, moved, faces, geometry).normal;
  Points normal = Points::Zero(moved.rows(), 3), area(carried.rows(), 3);
  for (Index f = 0; f < area.rows(); ++f)
  {
    const Index* nodes = faces.connectivity.data() + faces.offsets[f];
    const Index size = faces.offsets[f + 1] - faces.offsets[f];
    area.row(f) = vectorArea(moved, nodes, size);
    if (area.row(f).dot(carried.row(f)) < 0)
    {
      area.row(f) *= -1;
    }
    for (Index k = 0; k < size; ++k)
    {
      if (geometry.dimension[nodes[k]] == 2)
      {
        normal.row(nodes[k]) += area.row(f);
      }
    }
  }
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    const Index k = static_cast<Index>(i), node = faces.nodes[i];
    if (geometry.dimension[node] != 2)
    {
      continue;
    }
    const Index* corners = faces.between.begin(k);
    for (const Index* corner = corners; corner != faces.between.end(k); ++corner)
    {
      const Index e = geometry.edges.find(corners[0], *corner);
      const Adjacency& at = geometry.edges.faces;
      for (const Index* f = e < 0 ? nullptr : at.begin(e); f && f != at.end(e); ++f)
      {
        if (geometry.surfaceOfFace[*f] == geometry.entity[node])
        {
          normal.row(node) += area.row(*f);
        }
      }
    }
    normal.row(node).normalize();
  }
  return normal;
}

void carryMidNodes(const BoundaryFaces& faces, const Classification& geometry,
  const ProjectionTarget* target, const Points& normals, const Points& before,
  BoundaryMotion& motion)
{
  using Row = ProjectionTarget::Row;
  const Points shift = motion.moved() - before;
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    const Index k = static_cast<Index>(i), node = faces.nodes[i];
    if (motion.state[node] != BoundaryMotion::OnSurface)
    {
      continue;
    }
    const Row mean =
      meanBetween(faces, k, motion.rest, [&](Index corner) { return Row(shift.row(corner)); });
    if (mean.isZero(0))
    {
      continue;
    }
    const Index surface = geometry.entity[node];
    Row to = before.row(node) + mean;
    if (!target || !target->holds(surface) ||
        target->closestOnSurface(surface, Row(to), normals.row(node), to))
    {
      motion.displacement.row(node) = to - motion.rest.row(node);
    }
  }
}
}
