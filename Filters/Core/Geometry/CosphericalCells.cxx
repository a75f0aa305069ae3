// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/CosphericalCells.h"

#include "Geometry/MeanOfRows.h"
#include "Support/Lists.h"
#include "Support/Parallel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

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
}

double thickness(const Points& sites, const std::array<int, 4>& corners)
{
  const double square = squaredLength(sites, corners);
  return Delaunay::sixVolumes({ corners, {} }, sites) / (square * std::sqrt(square));
}

/// The sphere through a tetrahedron's corners.
class CosphericalCells::Sphere
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

CosphericalCells::CosphericalCells(const Delaunay& delaunay, Monitor& monitor)
  : tetrahedra_(delaunay.tetrahedra())
  , sites_(delaunay.sites())
  , cellOf_(tetrahedra_.size(), NoCell)
  , isOnHull_(tetrahedra_.size(), false)
{
  this->measure(monitor);
  this->findCells(monitor);
  this->findFlatHull();
}

void CosphericalCells::measure(Monitor& monitor)
{
  const Index n = static_cast<Index>(this->tetrahedra_.size());
  this->thickness_.resize(n);
  parallel(n, monitor,
    [&](Index t) { this->thickness_[t] = thickness(this->sites_, this->tetrahedra_[t].sites); });
  monitor.check();
}

void CosphericalCells::findCells(Monitor& monitor)
{
  const Index n = static_cast<Index>(this->tetrahedra_.size());
  std::vector<std::uint8_t> isSeed(n);
  parallel(n, monitor,
    [&](Index t) { isSeed[t] = this->thickness_[t] > Flat && this->hasTie(static_cast<int>(t)); });
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

bool CosphericalCells::isFlatWithoutCell(int tetrahedron) const
{
  return tetrahedron != Delaunay::Outside && this->cellOf_[tetrahedron] == NoCell &&
         this->thickness_[tetrahedron] <= Flat;
}

/// Twice a face's area.
double CosphericalCells::area(const Delaunay::Tetrahedron& tetrahedron, int k) const
{
  const std::array<int, 3> c = tetrahedron.face(k);
  const Row a = this->sites_.row(c[0]);
  return (this->sites_.row(c[1]) - a).cross(this->sites_.row(c[2]) - a).norm();
}

/// Marks the layers of flat tetrahedra without a cell on the hull, where its sites are in one
/// plane. All that a layer has on its inner side, it has outside. Flat tetrahedra inside keep
/// their faces: they would part the cells on their two sides.
void CosphericalCells::findFlatHull()
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

bool CosphericalCells::isOn(const Sphere& sphere, int tetrahedron) const
{
  const auto& corners = this->tetrahedra_[tetrahedron].sites;
  return std::all_of(corners.begin(), corners.end(),
    [&](int corner) { return sphere.has(this->sites_.row(corner)); });
}

bool CosphericalCells::hasTie(int tetrahedron) const
{
  const Sphere sphere(this->sites_, this->tetrahedra_[tetrahedron]);
  const auto& neighbors = this->tetrahedra_[tetrahedron].neighbors;
  return std::any_of(neighbors.begin(), neighbors.end(),
    [&](int next) { return next != Delaunay::Outside && this->isOn(sphere, next); });
}

/// Makes a cell of the tetrahedra around the seed that have all corners on its sphere.
void CosphericalCells::grow(int seed)
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

std::vector<int> CosphericalCells::cornersOf(const Tetrahedra& members) const
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

std::vector<CosphericalCells::Face> CosphericalCells::facesOf(const Tetrahedra& members) const
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

/// Whether the mean sees each outer face from inside.
bool CosphericalCells::isStar(const Tetrahedra& members) const
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
}
