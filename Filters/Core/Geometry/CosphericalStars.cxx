// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/CosphericalStars.h"

#include "Geometry/Delaunay.h"
#include "Geometry/MeanOfRows.h"
#include "Support/Lists.h"
#include "Support/Monitor.h"
#include "Support/Parallel.h"
#include "Support/UnionFind.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

namespace morph
{
namespace
{
constexpr double OnSphere = 1e-6; // power distance / (longest edge)^2
constexpr double SameArea = 1e-6; // relative

using Row = Eigen::RowVector3d;

double squaredLength(const Points& sites, const std::array<int, 4>& corners)
{
  double most = 0;
  for (int a = 0; a < 4; ++a)
  {
    for (int b = a + 1; b < 4; ++b)
    {
      most = std::max(most, (sites.row(corners[a]) - sites.row(corners[b])).squaredNorm());
    }
  }
  return most;
}

/// 6 V / (longest edge)^3, signed. `corners`: four of the sites.
double thickness(const Points& sites, const std::array<int, 4>& corners)
{
  const double square = squaredLength(sites, corners);
  return Delaunay::sixVolumes({ corners, {} }, sites) / (square * std::sqrt(square));
}

/// The sphere through a tetrahedron's corners.
class Sphere
{
public:
  Sphere(const Points& sites, const Delaunay::Tetrahedron& tetrahedron)
    : corner_(sites.row(tetrahedron.sites[0]))
    , tolerance_(OnSphere * squaredLength(sites, tetrahedron.sites))
  {
    const Row a = sites.row(tetrahedron.sites[1]) - this->corner_;
    const Row b = sites.row(tetrahedron.sites[2]) - this->corner_;
    const Row c = sites.row(tetrahedron.sites[3]) - this->corner_;
    this->diameter_ =
      (a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) + c.squaredNorm() * a.cross(b)) /
      a.dot(b.cross(c));
  }

  bool has(const Row& x) const
  {
    const Row d = x - this->corner_;
    return std::abs(d.squaredNorm() - d.dot(this->diameter_)) <= this->tolerance_;
  }

private:
  Row corner_, diameter_;
  double tolerance_;
};

/// The convex cells of a Delaunay tessellation with more than four corners on one empty sphere.
///
/// A site is on the sphere of a tetrahedron with longest edge L if its power distance is at most
/// 1e-6 L^2. Tetrahedra with 6 V below 1e-6 L^3 have no sphere of their own; they belong to the
/// cell of a neighbor, or to none.
class CosphericalCells
{
public:
  static constexpr int Hull = -1, NoCell = -2;
  static constexpr double Flat = 1e-6; ///< 6 V / (longest edge)^3

  /// A face of a cell's tetrahedron that belongs to no other of the cell's.
  struct Face
  {
    std::array<int, 3> corners; ///< in the order of Delaunay::Tetrahedron::face()
    int across;                 ///< the cell on its other side, Hull or NoCell
  };

  /// `delaunay` must outlive this object. Cost: 0.5 microseconds a tetrahedron.
  CosphericalCells(const Delaunay& delaunay, Monitor& monitor)
    : tetrahedra_(delaunay.tetrahedra())
    , sites_(delaunay.sites())
    , cellOf_(tetrahedra_.size(), NoCell)
    , isOnHull_(tetrahedra_.size(), false)
  {
    this->measure(monitor);
    this->findCells(monitor);
    this->findFlatHull();
  }

  Index size() const { return static_cast<Index>(this->members_.size()); }
  /// Returns the cell of a tetrahedron, or NoCell.
  int cellOf(Index tetrahedron) const { return this->cellOf_[tetrahedron]; }
  /// Returns a cell's sites, ascending.
  std::vector<int> corners(Index cell) const { return this->cornersOf(this->members_[cell]); }
  std::vector<Face> faces(Index cell) const { return this->facesOf(this->members_[cell]); }

private:
  using Tetrahedra = std::vector<int>;

  void measure(Monitor& monitor)
  {
    const Index n = static_cast<Index>(this->tetrahedra_.size());
    this->thickness_.resize(n);
    parallel(n, monitor,
      [&](Index t) { this->thickness_[t] = thickness(this->sites_, this->tetrahedra_[t].sites); });
    monitor.check();
  }

  void findCells(Monitor& monitor)
  {
    const Index n = static_cast<Index>(this->tetrahedra_.size());
    std::vector<std::uint8_t> isSeed(n);
    parallel(n, monitor,
      [&](Index t)
      { isSeed[t] = this->thickness_[t] > Flat && this->hasTie(static_cast<int>(t)); });
    // The sphere of the thickest tetrahedron is the most accurate.
    std::vector<std::pair<double, int>> seeds;
    for (Index t = 0; t < n; ++t)
    {
      if (isSeed[t])
      {
        seeds.emplace_back(-this->thickness_[t], static_cast<int>(t));
      }
    }
    std::sort(seeds.begin(), seeds.end());
    monitor.check();
    for (const auto& [negative, seed] : seeds)
    {
      if (this->cellOf_[seed] == NoCell)
      {
        this->grow(seed);
      }
    }
  }

  /// Marks the layers of flat tetrahedra without a cell on the hull, where its sites are in one
  /// plane. All that a layer has on its inner side, it has outside. Flat tetrahedra inside keep
  /// their faces: they would part the cells on their two sides.
  void findFlatHull()
  {
    std::vector<bool> isDone(this->tetrahedra_.size(), false);
    for (std::size_t seed = 0; seed < this->tetrahedra_.size(); ++seed)
    {
      if (isDone[seed] || !this->isFlatWithoutCell(static_cast<int>(seed)))
      {
        continue;
      }
      std::vector<int> layer = { static_cast<int>(seed) };
      isDone[seed] = true;
      double outside = 0, inside = 0;
      for (std::size_t i = 0; i < layer.size(); ++i)
      {
        const Delaunay::Tetrahedron& tetrahedron = this->tetrahedra_[layer[i]];
        for (int k = 0; k < 4; ++k)
        {
          const int next = tetrahedron.neighbors[k];
          if (next == Delaunay::Outside)
          {
            outside += this->area(tetrahedron, k);
          }
          else if (!this->isFlatWithoutCell(next))
          {
            inside += this->area(tetrahedron, k);
          }
          else if (!isDone[next])
          {
            isDone[next] = true;
            layer.push_back(next);
          }
        }
      }
      if (outside >= (1 - SameArea) * inside)
      {
        for (const int t : layer)
        {
          this->isOnHull_[t] = true;
        }
      }
    }
  }

  bool isFlatWithoutCell(int tetrahedron) const
  {
    return tetrahedron != Delaunay::Outside && this->cellOf_[tetrahedron] == NoCell &&
           this->thickness_[tetrahedron] <= Flat;
  }

  bool isOn(const Sphere& sphere, int tetrahedron) const
  {
    const auto& corners = this->tetrahedra_[tetrahedron].sites;
    return std::all_of(corners.begin(), corners.end(),
      [&](int corner) { return sphere.has(this->sites_.row(corner)); });
  }

  bool hasTie(int tetrahedron) const
  {
    const Sphere sphere(this->sites_, this->tetrahedra_[tetrahedron]);
    const auto& neighbors = this->tetrahedra_[tetrahedron].neighbors;
    return std::any_of(neighbors.begin(), neighbors.end(),
      [&](int next) { return next != Delaunay::Outside && this->isOn(sphere, next); });
  }

  /// Makes a cell of the tetrahedra around the seed that have all corners on its sphere.
  void grow(int seed)
  {
    const Sphere sphere(this->sites_, this->tetrahedra_[seed]);
    const int cell = static_cast<int>(this->members_.size());
    Tetrahedra members = { seed };
    this->cellOf_[seed] = cell;
    for (std::size_t i = 0; i < members.size(); ++i)
    {
      for (const int next : this->tetrahedra_[members[i]].neighbors)
      {
        if (next != Delaunay::Outside && this->cellOf_[next] == NoCell && this->isOn(sphere, next))
        {
          this->cellOf_[next] = cell;
          members.push_back(next);
        }
      }
    }
    if (members.size() == 1 || !this->isStar(members))
    {
      for (const int t : members)
      {
        this->cellOf_[t] = NoCell;
      }
      return;
    }
    this->members_.push_back(std::move(members));
  }

  /// Whether the mean sees each outer face from inside.
  bool isStar(const Tetrahedra& members) const
  {
    const std::vector<int> corners = this->cornersOf(members);
    const Row center = meanOfRows(this->sites_, corners.begin(), corners.end());
    const std::vector<Face> faces = this->facesOf(members);
    return std::all_of(faces.begin(), faces.end(),
      [&](const Face& face)
      {
        const Row a = this->sites_.row(face.corners[0]) - center;
        const Row b = this->sites_.row(face.corners[1]) - center;
        const Row c = this->sites_.row(face.corners[2]) - center;
        return a.dot(b.cross(c)) < 0;
      });
  }

  std::vector<int> cornersOf(const Tetrahedra& members) const
  {
    std::vector<int> corners;
    corners.reserve(4 * members.size());
    for (const int t : members)
    {
      const auto& sites = this->tetrahedra_[t].sites;
      corners.insert(corners.end(), sites.begin(), sites.end());
    }
    sortUnique(corners);
    return corners;
  }

  std::vector<Face> facesOf(const Tetrahedra& members) const
  {
    const int cell = this->cellOf_[members[0]];
    std::vector<Face> faces;
    for (const int t : members)
    {
      for (int k = 0; k < 4; ++k)
      {
        const int next = this->tetrahedra_[t].neighbors[k];
        if (next == Delaunay::Outside || this->cellOf_[next] != cell)
        {
          const bool isHull = next == Delaunay::Outside || this->isOnHull_[next];
          faces.push_back({ this->tetrahedra_[t].face(k), isHull ? Hull : this->cellOf_[next] });
        }
      }
    }
    return faces;
  }

  /// Twice a face's area.
  double area(const Delaunay::Tetrahedron& tetrahedron, int k) const
  {
    const std::array<int, 3> c = tetrahedron.face(k);
    const Row a = this->sites_.row(c[0]);
    return (this->sites_.row(c[1]) - a).cross(this->sites_.row(c[2]) - a).norm();
  }

  const std::vector<Delaunay::Tetrahedron>& tetrahedra_;
  const Points& sites_;
  std::vector<double> thickness_; ///< of each tetrahedron
  std::vector<int> cellOf_;
  std::vector<bool> isOnHull_; ///< of each tetrahedron: findFlatHull()
  std::vector<Tetrahedra> members_;
};

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
