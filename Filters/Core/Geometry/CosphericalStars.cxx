// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/CosphericalStars.h"

#include "Geometry/CosphericalCells.h"
#include "Geometry/MeanOfRows.h"
#include "Support/Buckets.h"
#include "Support/Lists.h"
#include "Support/Parallel.h"
#include "Support/UnionFind.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

namespace morph
{
namespace
{
constexpr Index CellGrain = 256, Grain = 4096;

using Tetrahedron = Delaunay::Tetrahedron;
using Corners = std::array<int, 3>;
using Face = CosphericalCells::Face;

/// The pyramids from one cell's mean, before the means have numbers.
struct Star
{
  /// A face with more than three corners.
  struct Polygon
  {
    std::vector<int> corners; ///< ascending
    int across;               ///< the cell on its other side, or Hull
    int mean = -1;            ///< its number among the sites
  };
  /// A pyramid's base: three sites, or two and the mean of a polygon.
  struct Triangle
  {
    Corners corners;
    int polygon = -1; ///< whose mean is the third corner, unless negative
  };

  std::vector<int> corners; ///< ascending
  int mean = -1;
  std::vector<Polygon> polygons;
  std::vector<int> byCorners; ///< the polygons' numbers, sorted by their corners
  std::vector<Triangle> triangles;

  /// Returns the polygon with these corners, or null.
  const Polygon* find(const std::vector<int>& polygonCorners) const
  {
    const auto place =
      std::lower_bound(this->byCorners.begin(), this->byCorners.end(), polygonCorners,
        [this](int number, const std::vector<int>& value)
        { return this->polygons[number].corners < value; });
    const bool isThere =
      place != this->byCorners.end() && this->polygons[*place].corners == polygonCorners;
    return isThere ? &this->polygons[*place] : nullptr;
  }
};

/// An edge of an outer face of a cell.
struct Edge
{
  int low, high; ///< sites
  int face, k;   ///< from the face's corner k to the next

  bool isSame(const Edge& other) const
  {
    return this->low == other.low && this->high == other.high;
  }
  bool operator<(const Edge& other) const
  {
    return std::tie(this->low, this->high, this->face) <
           std::tie(other.low, other.high, other.face);
  }
};

/// Returns the edges of all faces, sorted: equal ones follow each other.
std::vector<Edge> edgesOf(const std::vector<Face>& faces)
{
  std::vector<Edge> edges;
  edges.reserve(3 * faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    for (int k = 0; k < 3; ++k)
    {
      const int a = faces[f].corners[k], b = faces[f].corners[(k + 1) % 3];
      edges.push_back({ std::min(a, b), std::max(a, b), static_cast<int>(f), k });
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Whether two triangles with a common edge are parts of one polygon. Both cells at it compute the
/// same.
bool areOnePolygon(const Points& sites, const Face& one, const Face& other)
{
  if (one.across != other.across || one.across == CosphericalCells::NoCell)
  {
    return false;
  }
  std::array<int, 6> corners;
  std::copy(one.corners.begin(), one.corners.end(), corners.begin());
  std::copy(other.corners.begin(), other.corners.end(), corners.begin() + 3);
  std::sort(corners.begin(), corners.end());
  const auto last = std::unique(corners.begin(), corners.end());
  return last - corners.begin() == 4 &&
         std::abs(thickness(sites, { corners[0], corners[1], corners[2], corners[3] })) <=
           CosphericalCells::Flat;
}

Star::Polygon polygonOf(const std::vector<Face>& faces, const std::vector<int>& part)
{
  Star::Polygon polygon;
  polygon.across = faces[part[0]].across;
  for (const int f : part)
  {
    const Corners& corners = faces[f].corners;
    polygon.corners.insert(polygon.corners.end(), corners.begin(), corners.end());
  }
  sortUnique(polygon.corners);
  return polygon;
}

/// Returns the faces that make one polygon or are a triangle by themselves, at the place of the
/// first of them. Lists at other places are empty.
std::vector<std::vector<int>> partsOf(
  const Points& sites, const std::vector<Face>& faces, const std::vector<Edge>& edges)
{
  UnionFind<int> groups(static_cast<int>(faces.size()));
  for (std::size_t e = 0; e + 1 < edges.size(); ++e)
  {
    const Face &one = faces[edges[e].face], &next = faces[edges[e + 1].face];
    if (edges[e].isSame(edges[e + 1]) && areOnePolygon(sites, one, next))
    {
      groups.join(edges[e].face, edges[e + 1].face);
    }
  }
  std::vector<std::vector<int>> parts(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    parts[groups.root(static_cast<int>(f))].push_back(static_cast<int>(f));
  }
  return parts;
}

Star starOf(const Points& sites, const CosphericalCells& cells, Index cell)
{
  const std::vector<Face> faces = cells.faces(cell);
  const std::vector<Edge> edges = edgesOf(faces);
  Star star;
  star.corners = cells.corners(cell);
  std::vector<int> polygon(faces.size(), -1);
  for (const std::vector<int>& part : partsOf(sites, faces, edges))
  {
    if (part.size() == 1)
    {
      star.triangles.push_back({ faces[part[0]].corners, -1 });
    }
    else if (!part.empty())
    {
      std::for_each(part.begin(), part.end(),
        [&](int f) { polygon[f] = static_cast<int>(star.polygons.size()); });
      star.polygons.push_back(polygonOf(faces, part));
    }
  }
  star.byCorners = consecutive<int>(star.polygons.size());
  std::sort(star.byCorners.begin(), star.byCorners.end(),
    [&](int a, int b) { return star.polygons[a].corners < star.polygons[b].corners; });
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    const int own = polygon[edges[e].face];
    const auto isTwin = [&](std::size_t other)
    { return edges[other].isSame(edges[e]) && polygon[edges[other].face] == own; };
    if (own >= 0 && !(e + 1 < edges.size() && isTwin(e + 1)) && !(e > 0 && isTwin(e - 1)))
    {
      const Corners& c = faces[edges[e].face].corners;
      star.triangles.push_back({ { c[edges[e].k], c[(edges[e].k + 1) % 3], -1 }, own });
    }
  }
  return star;
}

std::vector<Star> starsOf(const Points& sites, const CosphericalCells& cells, Monitor& monitor)
{
  std::vector<Star> stars(cells.size());
  parallel(cells.size(), CellGrain, monitor,
    [&](Index cell) { stars[cell] = starOf(sites, cells, cell); });
  monitor.check();
  return stars;
}

/// Numbers the means after the sites. A polygon between two cells has one: the cell before has it.
Adjacency numberMeans(Index sites, std::vector<Star>& stars)
{
  Adjacency means;
  const auto add = [&](const std::vector<int>& corners)
  {
    means.add(corners.begin(), corners.end());
    return static_cast<int>(sites + static_cast<Index>(means.offsets.size()) - 2);
  };
  for (std::size_t cell = 0; cell < stars.size(); ++cell)
  {
    Star& star = stars[cell];
    star.mean = add(star.corners);
    for (Star::Polygon& polygon : star.polygons)
    {
      if (polygon.across >= 0 && polygon.across < static_cast<int>(cell))
      {
        const Star::Polygon* same = stars[polygon.across].find(polygon.corners);
        polygon.mean = same ? same->mean : -1;
      }
      if (polygon.mean < 0)
      {
        polygon.mean = add(polygon.corners);
      }
    }
  }
  return means;
}

/// Returns the tetrahedra without a cell and then the pyramids. Faces beside a pyramid are not
/// linked: they have no neighbor.
std::vector<Tetrahedron> assemble(const std::vector<Tetrahedron>& old,
  const CosphericalCells& cells, const std::vector<Star>& stars, Monitor& monitor)
{
  constexpr int None = Delaunay::Outside;
  std::vector<int> place(old.size(), None);
  int others = 0;
  for (std::size_t t = 0; t < old.size(); ++t)
  {
    if (cells.cellOf(static_cast<Index>(t)) == CosphericalCells::NoCell)
    {
      place[t] = others++;
    }
  }
  std::vector<Index> first = { others };
  for (const Star& star : stars)
  {
    first.push_back(first.back() + static_cast<Index>(star.triangles.size()));
  }
  std::vector<Tetrahedron> all;
  all.resize(first.back());
  for (std::size_t t = 0; t < old.size(); ++t)
  {
    if (place[t] != None)
    {
      Tetrahedron& tetrahedron = all[place[t]];
      tetrahedron = old[t];
      for (int& next : tetrahedron.neighbors)
      {
        next = next == None ? None : place[next];
      }
    }
  }
  parallel(static_cast<Index>(stars.size()), CellGrain, monitor,
    [&](Index cell)
    {
      const Star& star = stars[cell];
      Index at = first[cell];
      for (const Star::Triangle& triangle : star.triangles)
      {
        const Corners& c = triangle.corners;
        const int third = triangle.polygon < 0 ? c[2] : star.polygons[triangle.polygon].mean;
        all[at++] = { { c[0], c[1], third, star.mean }, { None, None, None, None } };
      }
    });
  return all;
}

Corners sortedFace(const Tetrahedron& tetrahedron, int k)
{
  Corners corners = tetrahedron.face(k);
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// Links the tetrahedra on both sides of each face without a neighbor. `sites`: without the means.
void link(std::vector<Tetrahedron>& tetrahedra, Index sites, Monitor& monitor)
{
  // Faces by their first site. Each has one that is no mean, and a mean may have very many faces.
  const Adjacency open = sortIntoBuckets(static_cast<Index>(tetrahedra.size()), sites, monitor,
    [&](Index first, Index last, const auto& add)
    {
      for (Index t = first; t < last; ++t)
      {
        for (int k = 0; k < 4; ++k)
        {
          if (tetrahedra[t].neighbors[k] == Delaunay::Outside)
          {
            add(sortedFace(tetrahedra[t], k).front(), 4 * t + k);
          }
        }
      }
    });
  monitor.parallelFor(sites, Grain,
    [&](Index first, Index last)
    {
      std::vector<std::pair<Corners, Index>> faces;
      for (Index site = first; site < last; ++site)
      {
        faces.clear();
        std::for_each(open.begin(site), open.end(site),
          [&](Index face)
          { faces.emplace_back(sortedFace(tetrahedra[face / 4], face % 4), face); });
        std::sort(faces.begin(), faces.end());
        for (std::size_t i = 0; i + 1 < faces.size(); ++i)
        {
          if (faces[i].first == faces[i + 1].first)
          {
            const Index one = faces[i].second, other = faces[i + 1].second;
            tetrahedra[one / 4].neighbors[one % 4] = static_cast<int>(other / 4);
            tetrahedra[other / 4].neighbors[other % 4] = static_cast<int>(one / 4);
            ++i;
          }
        }
      }
    });
}
}

Adjacency starCosphericalCells(Delaunay& delaunay, Monitor& monitor)
{
  const CosphericalCells cells(delaunay, monitor);
  if (cells.size() == 0)
  {
    return { { 0 }, {} };
  }
  monitor.check();
  std::vector<Star> stars = starsOf(delaunay.sites(), cells, monitor);
  Adjacency means = numberMeans(delaunay.sites().rows(), stars);
  Points sites = withMeans(delaunay.sites(), means, monitor);
  std::vector<Tetrahedron> tetrahedra = assemble(delaunay.tetrahedra(), cells, stars, monitor);
  monitor.check();
  link(tetrahedra, delaunay.sites().rows(), monitor);
  delaunay.replace(std::move(sites), std::move(tetrahedra));
  return means;
}

Points withMeans(const Points& values, const Adjacency& means, Monitor& monitor)
{
  const Index count = static_cast<Index>(means.offsets.size()) - 1;
  Points all(values.rows() + count, 3);
  parallel(values.rows(), monitor, [&](Index i) { all.row(i) = values.row(i); });
  parallel(count, monitor,
    [&](Index m)
    { all.row(values.rows() + m) = meanOfRows(values, means.begin(m), means.end(m)); });
  return all;
}
}
