// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/BridgingTetrahedra.h"

#include "Mesh/CellShape.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/Topology.h"
#include "Support/ReproducibleSum.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace morph
{
namespace
{
constexpr Index Grain = 1024;
constexpr double LeavingSine = 0.01;
constexpr double SameDistance = 1e-9;
constexpr double StraightSine = 1e-3;
constexpr double SameVolume = 1e-9;

using Vector = Eigen::RowVector3d;

/// The corner of an outer face at a node: unit vectors along its two edges, and its outward unit
/// normal, 0 if it has none.
struct Sector
{
  Vector first, second, normal;
};

/// Returns the distance of the unit vector `d` from a sector: 1 minus the cosine of the angle to
/// its nearest direction.
double distance(const Sector& sector, const Vector& d)
{
  const Vector inPlane = d - d.dot(sector.normal) * sector.normal;
  const bool between = sector.normal.dot(sector.first.cross(inPlane)) >= 0 &&
                       sector.normal.dot(inPlane.cross(sector.second)) >= 0;
  return 1 - (between ? inPlane.norm() : std::max(d.dot(sector.first), d.dot(sector.second)));
}

/// Whether `d` leaves the mesh at a node with the outer faces `begin` to `end`.
bool leaves(const Sector* begin, const Sector* end, const Vector& d)
{
  if (std::all_of(begin, end, [&d](const Sector& s) { return d.dot(s.normal) <= LeavingSine; }))
  {
    return false; // inside all of its faces' planes
  }
  double nearest = std::numeric_limits<double>::infinity();
  Vector normal = Vector::Zero();
  for (const Sector* s = begin; s != end; ++s)
  {
    if (s->normal.isZero(0))
    {
      continue;
    }
    const double here = distance(*s, d);
    if (here < nearest - SameDistance)
    {
      nearest = here;
      normal = s->normal;
    }
    else if (here < nearest + SameDistance)
    {
      normal += s->normal;
    }
  }
  return d.dot(normal.normalized()) > LeavingSine;
}

/// Returns twice the area of a face times its normal.
Vector areaVector(const Points& points, const Index* corner, Index n)
{
  Vector sum = Vector::Zero();
  for (Index k = 2; k < n; ++k)
  {
    const Vector a = points.row(corner[k - 1]) - points.row(corner[0]);
    const Vector b = points.row(corner[k]) - points.row(corner[0]);
    sum += a.cross(b);
  }
  return sum;
}

/// Returns the sector at corner k of a face with n corners. `forward`: they are counter-clockwise,
/// seen from outside.
Sector sectorAt(const Points& points, const Index* corner, Index n, Index k, bool forward)
{
  const auto along = [&](Index to)
  { return (points.row(corner[to % n]) - points.row(corner[k])).normalized(); };
  Vector first = along(k + 1), second = along(k + n - 1);
  if (!forward)
  {
    first.swap(second);
  }
  Vector normal = first.cross(second);
  if (!(normal.norm() > StraightSine)) // a straight angle: its edges span no plane
  {
    normal = (forward ? 1 : -1) * areaVector(points, corner, n);
  }
  return { first, second, normal.normalized() };
}

/// The sectors at each node of `nodes`, in the order of the faces.
struct Sectors
{
  std::vector<Index> offsets; ///< #nodes + 1
  std::vector<Sector> values;
};

Sectors sectorsAt(const Mesh& mesh, const std::vector<Index>& nodes, Monitor& monitor)
{
  const BoundaryFaces faces = boundaryFaces(mesh, monitor);
  const std::vector<std::int8_t> sign =
    cellSigns(mesh, connectedComponents(mesh)); // signs allow mirrored meshes
  std::vector<Index> place(mesh.numberOfNodes(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    place[nodes[i]] = static_cast<Index>(i);
  }
  Sectors sectors;
  sectors.offsets.assign(nodes.size() + 1, 0);
  const auto visit = [&](const auto& onCorner)
  {
    for (std::size_t f = 0; f + 1 < faces.offsets.size(); ++f)
    {
      const Index* corner = faces.connectivity.data() + faces.offsets[f];
      const Index n = faces.offsets[f + 1] - faces.offsets[f];
      for (Index k = 0; k < n; ++k)
      {
        if (place[corner[k]] >= 0)
        {
          onCorner(place[corner[k]], f, k);
        }
      }
    }
  };
  visit([&](Index at, std::size_t, Index) { ++sectors.offsets[at + 1]; });
  std::partial_sum(sectors.offsets.begin(), sectors.offsets.end(), sectors.offsets.begin());
  sectors.values.resize(sectors.offsets.back());
  std::vector<Index> next(sectors.offsets.begin(), sectors.offsets.end() - 1);
  visit(
    [&](Index at, std::size_t f, Index k)
    {
      const Index first = faces.offsets[f], n = faces.offsets[f + 1] - first;
      sectors.values[next[at]++] =
        sectorAt(mesh.points, faces.connectivity.data() + first, n, k, sign[faces.cells[f]] > 0);
    });
  return sectors;
}

/// Whether the cells fill the tessellation, so that the mesh is convex. Much cheaper than finding
/// its outer faces.
bool fillsHull(const Mesh& mesh, const Delaunay& delaunay, Monitor& monitor)
{
  const double cells = reproducibleSum(mesh.numberOfCells(), monitor, 0.,
    [&](Index c)
    {
      const CellShape& shape = *cellShape(mesh.types[c]);
      double corners[8][3];
      copyCorners(mesh, c, shape, mesh.points, corners[0]);
      return numberOfCorners(shape.shape) == 0 ? 0. : std::abs(signedVolume(shape.shape, corners));
    });
  const auto& tetrahedra = delaunay.tetrahedra();
  const double hull = reproducibleSum(static_cast<Index>(tetrahedra.size()), monitor, 0.,
    [&](Index t) { return Delaunay::sixVolumes(tetrahedra[t], delaunay.sites()) / 6; });
  return std::abs(cells - hull) < SameVolume * hull;
}

bool leavesMesh(
  const InterpolationSites& sites, const Sectors& sectors, Index site, const Vector& d)
{
  if (site >= sites.size()) // the mean of a cell's or a face's corners has no faces
  {
    return false;
  }
  // Where bodies touch, an edge that leaves one may enter the other. An inner node has no faces.
  const Index* end = sites.prescribed().end(site);
  return std::all_of(sites.prescribed().begin(site), end,
    [&](Index node)
    {
      return leaves(sectors.values.data() + sectors.offsets[node],
        sectors.values.data() + sectors.offsets[node + 1], d);
    });
}
}

std::vector<int> bridgingTetrahedra(const Mesh& mesh, const std::vector<Index>& prescribed,
  const InterpolationSites& sites, const Delaunay& delaunay, const std::vector<int>& used,
  Monitor& monitor)
{
  if (fillsHull(mesh, delaunay, monitor))
  {
    return {};
  }
  const Sectors sectors = sectorsAt(mesh, prescribed, monitor);
  std::vector<std::uint8_t> bridges(used.size(), 0);
  monitor.parallelFor(static_cast<Index>(used.size()), Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        const auto& corners = delaunay.tetrahedra()[used[i]].sites;
        for (int a = 0; a < 4; ++a)
        {
          for (int b = a + 1; b < 4; ++b)
          {
            const Vector d =
              (delaunay.sites().row(corners[b]) - delaunay.sites().row(corners[a])).normalized();
            bridges[i] |= leavesMesh(sites, sectors, corners[a], d) ||
                          leavesMesh(sites, sectors, corners[b], -d);
          }
        }
      }
    });
  std::vector<int> result;
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    if (bridges[i])
    {
      result.push_back(used[i]);
    }
  }
  return result;
}
}
