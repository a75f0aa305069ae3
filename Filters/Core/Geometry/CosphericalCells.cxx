// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/CosphericalCells.h"

#include "Support/UnionFind.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace morph
{
namespace
{
constexpr Index Grain = 4096;
constexpr double OnSphere = 1e-6; // power distance / (longest edge)^2
constexpr double Flat = 1e-6;     // 6 V / (longest edge)^3
constexpr double SameArea = 1e-6; // relative

using Row = Eigen::RowVector3d;
using Tetrahedron = Delaunay::Tetrahedron;
using Corners = std::array<int, 3>;

/// The face opposite corner k, ordered so that the face and corner k are positively oriented.
constexpr int Faces[4][3] = { { 1, 3, 2 }, { 0, 2, 3 }, { 0, 3, 1 }, { 0, 1, 2 } };

Corners cornersOf(const Tetrahedron& tetrahedron, int k)
{
  return { tetrahedron.sites[Faces[k][0]], tetrahedron.sites[Faces[k][1]],
    tetrahedron.sites[Faces[k][2]] };
}

Corners sorted(Corners corners)
{
  std::sort(corners.begin(), corners.end());
  return corners;
}

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

/// 6 V / (longest edge)^3, signed.
double thickness(const Points& sites, const std::array<int, 4>& corners)
{
  const double square = squaredLength(sites, corners);
  return Delaunay::sixVolumes({ corners, {} }, sites) / (square * std::sqrt(square));
}

/// The sphere through a tetrahedron's corners.
class Sphere
{
public:
  Sphere(const Points& sites, const Tetrahedron& tetrahedron)
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

/// A face of a cell's tetrahedron that belongs to no other of the cell's.
struct Outer
{
  int tetrahedron, k;
  Corners corners;
  int across; ///< cell, or one of the two below
};
constexpr int Hull = -1;
constexpr int NoCell = -2;

class Stars
{
public:
  Stars(Delaunay& delaunay, Monitor& monitor)
    : delaunay_(delaunay)
    , old_(delaunay.tetrahedra())
    , sites_(delaunay.sites())
    , cellOf_(old_.size(), NoCell)
    , isOnHull_(old_.size(), false)
  {
    this->findCells(monitor);
    this->findFlatHull();
  }

  bool empty() const { return this->members_.empty(); }

  Adjacency build()
  {
    this->means_.offsets = { 0 };
    this->copyOthers();
    for (std::size_t cell = 0; cell < this->members_.size(); ++cell)
    {
      this->divide(static_cast<int>(cell));
    }
    this->link();
    const Index count = static_cast<Index>(this->means_.offsets.size()) - 1;
    Points sites(this->sites_.rows() + count, 3);
    sites.topRows(this->sites_.rows()) = this->sites_;
    for (Index m = 0; m < count; ++m)
    {
      sites.row(this->sites_.rows() + m) =
        this->mean(std::vector<int>(this->means_.begin(m), this->means_.end(m)));
    }
    this->delaunay_.replace(std::move(sites), std::move(this->new_));
    return std::move(this->means_);
  }

private:
  void findCells(Monitor& monitor)
  {
    const Index n = static_cast<Index>(this->old_.size());
    this->thickness_.resize(n);
    monitor.parallelFor(n, Grain,
      [&](Index first, Index last)
      {
        for (Index t = first; t < last; ++t)
        {
          this->thickness_[t] = thickness(this->sites_, this->old_[t].sites);
        }
      });
    monitor.check();
    // The sphere of the thickest tetrahedron is the most accurate.
    std::vector<std::pair<double, int>> seeds;
    for (Index t = 0; t < n; ++t)
    {
      if (this->thickness_[t] > Flat && this->hasTie(static_cast<int>(t)))
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

  bool isFlatWithoutCell(int t) const
  {
    return t != Delaunay::Outside && this->cellOf_[t] == NoCell && this->thickness_[t] <= Flat;
  }

  /// Twice a face's area.
  double area(const Tetrahedron& tetrahedron, int k) const
  {
    const Corners c = cornersOf(tetrahedron, k);
    const Row a = this->sites_.row(c[0]);
    return (this->sites_.row(c[1]) - a).cross(this->sites_.row(c[2]) - a).norm();
  }

  /// Marks the layers of flat tetrahedra without a cell on the hull, where its sites are in one
  /// plane. All that a layer has on its inner side, it has outside. Flat tetrahedra inside keep
  /// their faces: they would part the cells on their two sides.
  void findFlatHull()
  {
    std::vector<bool> isDone(this->old_.size(), false);
    for (std::size_t seed = 0; seed < this->old_.size(); ++seed)
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
        const Tetrahedron& tetrahedron = this->old_[layer[i]];
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

  bool isOn(const Sphere& sphere, int t) const
  {
    const auto& corners = this->old_[t].sites;
    return std::all_of(corners.begin(), corners.end(),
      [&](int corner) { return sphere.has(this->sites_.row(corner)); });
  }

  bool hasTie(int t) const
  {
    const Sphere sphere(this->sites_, this->old_[t]);
    const auto& neighbors = this->old_[t].neighbors;
    return std::any_of(neighbors.begin(), neighbors.end(),
      [&](int next) { return next != Delaunay::Outside && this->isOn(sphere, next); });
  }

  /// Makes a cell of the tetrahedra around the seed that have all corners on its sphere.
  void grow(int seed)
  {
    const Sphere sphere(this->sites_, this->old_[seed]);
    const int cell = static_cast<int>(this->members_.size());
    std::vector<int> members = { seed };
    this->cellOf_[seed] = cell;
    for (std::size_t i = 0; i < members.size(); ++i)
    {
      for (const int next : this->old_[members[i]].neighbors)
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

  std::vector<int> cornersOfAll(const std::vector<int>& members) const
  {
    std::vector<int> corners;
    for (const int t : members)
    {
      corners.insert(corners.end(), this->old_[t].sites.begin(), this->old_[t].sites.end());
    }
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    return corners;
  }

  Row mean(const std::vector<int>& corners) const
  {
    const Row first = this->sites_.row(corners[0]);
    Row sum = Row::Zero();
    for (const int corner : corners)
    {
      sum += this->sites_.row(corner) - first;
    }
    return first + sum / static_cast<double>(corners.size());
  }

  std::vector<Outer> outerFaces(const std::vector<int>& members) const
  {
    const int cell = this->cellOf_[members[0]];
    std::vector<Outer> faces;
    for (const int t : members)
    {
      for (int k = 0; k < 4; ++k)
      {
        const int next = this->old_[t].neighbors[k];
        if (next == Delaunay::Outside || this->cellOf_[next] != cell)
        {
          const bool isHull = next == Delaunay::Outside || this->isOnHull_[next];
          faces.push_back(
            { t, k, cornersOf(this->old_[t], k), isHull ? Hull : this->cellOf_[next] });
        }
      }
    }
    return faces;
  }

  /// Whether the mean sees each outer face from inside.
  bool isStar(const std::vector<int>& members) const
  {
    const Row centre = this->mean(this->cornersOfAll(members));
    const std::vector<Outer> faces = this->outerFaces(members);
    return std::all_of(faces.begin(), faces.end(),
      [&](const Outer& face)
      {
        const Row a = this->sites_.row(face.corners[0]) - centre;
        const Row b = this->sites_.row(face.corners[1]) - centre;
        const Row c = this->sites_.row(face.corners[2]) - centre;
        return a.dot(b.cross(c)) < 0;
      });
  }

  int addMean(const std::vector<int>& corners)
  {
    this->means_.values.insert(this->means_.values.end(), corners.begin(), corners.end());
    this->means_.offsets.push_back(static_cast<Index>(this->means_.values.size()));
    return static_cast<int>(
      this->sites_.rows() + static_cast<Index>(this->means_.offsets.size()) - 2);
  }

  /// Keeps the tetrahedra without a cell, and the links between them.
  void copyOthers()
  {
    std::vector<int> place(this->old_.size(), Delaunay::Outside);
    for (std::size_t t = 0; t < this->old_.size(); ++t)
    {
      if (this->cellOf_[t] == NoCell)
      {
        place[t] = static_cast<int>(this->new_.size());
        this->new_.push_back(this->old_[t]);
      }
    }
    for (std::size_t t = 0; t < this->new_.size(); ++t)
    {
      for (int k = 0; k < 4; ++k)
      {
        int& next = this->new_[t].neighbors[k];
        if (next != Delaunay::Outside)
        {
          next = place[next];
          if (next == Delaunay::Outside)
          {
            this->open_.emplace_back(
              sorted(cornersOf(this->new_[t], k)), 4 * static_cast<Index>(t) + k);
          }
        }
      }
    }
  }

  void add(int a, int b, int c, int centre)
  {
    const Index t = static_cast<Index>(this->new_.size());
    this->new_.push_back({ { a, b, c, centre },
      { Delaunay::Outside, Delaunay::Outside, Delaunay::Outside, Delaunay::Outside } });
    for (int k = 0; k < 4; ++k)
    {
      this->open_.emplace_back(sorted(cornersOf(this->new_[t], k)), 4 * t + k);
    }
  }

  struct Edge
  {
    int low, high; ///< corners
    int face;      ///< index in the cell's outer faces
    int k;         ///< from its corner k to the next
    bool operator<(const Edge& other) const
    {
      return std::make_pair(this->low, this->high) < std::make_pair(other.low, other.high);
    }
  };

  static std::vector<Edge> edgesOf(const std::vector<Outer>& faces)
  {
    std::vector<Edge> edges;
    for (std::size_t f = 0; f < faces.size(); ++f)
    {
      for (int k = 0; k < 3; ++k)
      {
        const int a = faces[f].corners[k], b = faces[f].corners[(k + 1) % 3];
        edges.push_back({ std::min(a, b), std::max(a, b), static_cast<int>(f), k });
      }
    }
    std::stable_sort(edges.begin(), edges.end());
    return edges;
  }

  /// Whether two triangles with a common edge are parts of one face. Both cells at the face
  /// compute the same.
  bool areOneFace(const Outer& one, const Outer& other) const
  {
    if (one.across != other.across || one.across == NoCell)
    {
      return false;
    }
    std::array<int, 6> corners;
    std::copy(one.corners.begin(), one.corners.end(), corners.begin());
    std::copy(other.corners.begin(), other.corners.end(), corners.begin() + 3);
    std::sort(corners.begin(), corners.end());
    const auto last = std::unique(corners.begin(), corners.end());
    return last - corners.begin() == 4 &&
           std::abs(thickness(this->sites_, { corners[0], corners[1], corners[2], corners[3] })) <=
             Flat;
  }

  void divide(int cell)
  {
    const std::vector<Outer> faces = this->outerFaces(this->members_[cell]);
    const int centre = this->addMean(this->cornersOfAll(this->members_[cell]));
    const std::vector<Edge> edges = edgesOf(faces);
    UnionFind<int> groups(static_cast<int>(faces.size()));
    for (std::size_t e = 0; e + 1 < edges.size(); ++e)
    {
      const bool isPair = !(edges[e] < edges[e + 1]);
      if (isPair && this->areOneFace(faces[edges[e].face], faces[edges[e + 1].face]))
      {
        groups.join(edges[e].face, edges[e + 1].face);
      }
    }
    std::vector<std::vector<int>> parts(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
    {
      parts[groups.root(static_cast<int>(f))].push_back(static_cast<int>(f));
    }
    std::vector<int> middle(faces.size(), -1);
    for (const std::vector<int>& part : parts)
    {
      if (part.size() == 1)
      {
        const Corners& c = faces[part[0]].corners;
        this->add(c[0], c[1], c[2], centre);
      }
      else if (!part.empty())
      {
        const int mean = this->meanOf(faces, part);
        for (const int f : part)
        {
          middle[f] = mean;
        }
      }
    }
    for (std::size_t e = 0; e < edges.size(); ++e)
    {
      const int mean = middle[edges[e].face];
      const auto isTwin = [&](std::size_t other)
      {
        return other < edges.size() && edges[other].low == edges[e].low &&
               edges[other].high == edges[e].high && middle[edges[other].face] == mean;
      };
      if (mean >= 0 && !isTwin(e + 1) && !(e > 0 && isTwin(e - 1)))
      {
        const Corners& c = faces[edges[e].face].corners;
        this->add(c[edges[e].k], c[(edges[e].k + 1) % 3], mean, centre);
      }
    }
  }

  /// Returns the mean of a face's corners, which the cell across has too.
  int meanOf(const std::vector<Outer>& faces, const std::vector<int>& part)
  {
    std::vector<int> corners;
    for (const int f : part)
    {
      corners.insert(corners.end(), faces[f].corners.begin(), faces[f].corners.end());
    }
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    const auto known = this->meanOfFace_.find(corners);
    if (known != this->meanOfFace_.end())
    {
      return known->second;
    }
    const int mean = this->addMean(corners);
    this->meanOfFace_.emplace(std::move(corners), mean);
    return mean;
  }

  /// Links the tetrahedra on both sides of each open face.
  void link()
  {
    std::sort(this->open_.begin(), this->open_.end());
    for (std::size_t i = 0; i + 1 < this->open_.size(); ++i)
    {
      if (this->open_[i].first == this->open_[i + 1].first)
      {
        const Index one = this->open_[i].second, other = this->open_[i + 1].second;
        this->new_[one / 4].neighbors[one % 4] = static_cast<int>(other / 4);
        this->new_[other / 4].neighbors[other % 4] = static_cast<int>(one / 4);
        ++i;
      }
    }
  }

  Delaunay& delaunay_;
  const std::vector<Tetrahedron>& old_;
  const Points& sites_;
  std::vector<int> cellOf_;    ///< of each old tetrahedron
  std::vector<bool> isOnHull_; ///< of each old tetrahedron: findFlatHull()
  std::vector<double> thickness_;
  std::vector<std::vector<int>> members_;      ///< the old tetrahedra of each cell
  std::map<std::vector<int>, int> meanOfFace_; ///< by its corners
  Adjacency means_;
  std::vector<Tetrahedron> new_;
  std::vector<std::pair<Corners, Index>> open_; ///< faces, and 4 tetrahedron + k
};
}

Adjacency starCosphericalCells(Delaunay& delaunay, Monitor& monitor)
{
  Stars stars(delaunay, monitor);
  if (stars.empty())
  {
    return { { 0 }, {} };
  }
  monitor.check();
  return stars.build();
}
}
