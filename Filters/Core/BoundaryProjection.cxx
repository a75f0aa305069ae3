// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryProjection.h"

#include "FaceQuality.h"

#include <algorithm>

namespace morph
{
ProjectionTarget::~ProjectionTarget() = default;

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

/// Tries search(node, position, found) for each id; where it succeeds the node goes there.
template <typename Search>
ProjectionReport moveTo(
  const std::vector<Index>& ids, const Search& search, BoundaryMotion& motion, Monitor& monitor)
{
  const Points before = motion.moved();
  std::vector<std::uint8_t> found(ids.size(), 0);
  monitor.parallelFor(static_cast<Index>(ids.size()), 256,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        Eigen::RowVector3d to;
        if (search(ids[i], Eigen::RowVector3d(before.row(ids[i])), to) && to.allFinite())
        {
          motion.displacement.row(ids[i]) = to - motion.rest.row(ids[i]);
          found[i] = 1;
        }
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

/// Takes those of `nodes` that are projected back to `before`; returns whether any was.
bool takeBack(const std::vector<Index>& nodes, const Points& before, ProjectionReport& report,
  BoundaryMotion& motion)
{
  std::vector<Index> back;
  for (Index node : nodes)
  {
    if (std::binary_search(report.projected.begin(), report.projected.end(), node))
    {
      back.push_back(node);
    }
  }
  std::sort(back.begin(), back.end());
  back.erase(std::unique(back.begin(), back.end()), back.end());
  for (Index node : back)
  {
    motion.displacement.row(node) = before.row(node);
    report.projected.erase(
      std::lower_bound(report.projected.begin(), report.projected.end(), node));
  }
  report.kept.insert(report.kept.end(), back.begin(), back.end());
  std::sort(report.kept.begin(), report.kept.end());
  return !back.empty();
}
}

ProjectionReport projectCurves(const Classification& geometry, const ProjectionTarget& target,
  BoundaryMotion& motion, Monitor& monitor)
{
  const Points displacement = motion.displacement, moved = motion.moved();
  ProjectionReport report = moveTo(
    nodesIn(motion, BoundaryMotion::OnCurve),
    [&](Index, const Eigen::RowVector3d& x, Eigen::RowVector3d& y)
    { return target.closestOnFeatures(x, y); },
    motion, monitor);
  std::vector<Index> turned;
  do
  {
    turned.clear();
    const Points now = motion.moved();
    for (const GeometryCurve& curve : geometry.curves)
    {
      const std::size_t n = curve.nodes.size(), pieces = curve.loop ? n : n - 1;
      for (std::size_t i = 0; i < pieces; ++i)
      {
        const Index a = curve.nodes[i], b = curve.nodes[(i + 1) % n];
        const Eigen::RowVector3d was = moved.row(b) - moved.row(a), is = now.row(b) - now.row(a);
        if (!(was.dot(is) > 0) && !was.isZero(0))
        {
          turned.insert(turned.end(), { a, b });
        }
      }
    }
  } while (takeBack(turned, displacement, report, motion));
  return report;
}

ProjectionReport projectSurfaces(const BoundaryFaces& faces, const Classification& geometry,
  const ProjectionTarget& target, BoundaryMotion& motion, Monitor& monitor)
{
  const Points displacement = motion.displacement, moved = motion.moved();
  const std::vector<Index> foldedBefore = faceQuality(motion.rest, moved, faces, geometry).folded;
  const Points normals = surfaceNodeNormals(moved, faces, geometry);
  ProjectionReport report = moveTo(
    nodesIn(motion, BoundaryMotion::OnSurface),
    [&](Index node, const Eigen::RowVector3d& x, Eigen::RowVector3d& y)
    { return target.closestOnSurface(x, normals.row(node), y); },
    motion, monitor);
  std::vector<Index> nodes;
  do
  {
    monitor.check();
    nodes.clear();
    for (Index f : faceQuality(motion.rest, motion.moved(), faces, geometry).folded)
    {
      if (!std::binary_search(foldedBefore.begin(), foldedBefore.end(), f))
      {
        nodes.insert(nodes.end(), faces.connectivity.begin() + faces.offsets[f],
          faces.connectivity.begin() + faces.offsets[f + 1]);
      }
    }
  } while (takeBack(nodes, displacement, report, motion));
  return report;
}

Points surfaceNodeNormals(
  const ConstPoints& points, const BoundaryFaces& faces, const Classification& geometry)
{
  Points normal = Points::Zero(points.rows(), 3),
         area(static_cast<Index>(faces.offsets.size()) - 1, 3);
  for (Index f = 0; f < area.rows(); ++f)
  {
    const Index* nodes = faces.connectivity.data() + faces.offsets[f];
    const Index size = faces.offsets[f + 1] - faces.offsets[f];
    area.row(f) = vectorArea(points, nodes, size);
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
}
