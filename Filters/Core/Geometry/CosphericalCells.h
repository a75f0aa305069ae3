// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/Delaunay.h"
#include "Support/Monitor.h"

#include <array>
#include <vector>

namespace morph
{
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
  CosphericalCells(const Delaunay& delaunay, Monitor& monitor);

  Index size() const { return static_cast<Index>(this->members_.size()); }
  /// Returns the cell of a tetrahedron, or NoCell.
  int cellOf(Index tetrahedron) const { return this->cellOf_[tetrahedron]; }
  /// Returns a cell's sites, ascending.
  std::vector<int> corners(Index cell) const { return this->cornersOf(this->members_[cell]); }
  std::vector<Face> faces(Index cell) const { return this->facesOf(this->members_[cell]); }

private:
  class Sphere;
  using Tetrahedra = std::vector<int>;

  void measure(Monitor& monitor);
  void findCells(Monitor& monitor);
  void findFlatHull();
  bool isFlatWithoutCell(int tetrahedron) const;
  bool isOn(const Sphere& sphere, int tetrahedron) const;
  bool hasTie(int tetrahedron) const;
  void grow(int seed);
  bool isStar(const Tetrahedra& members) const;
  std::vector<int> cornersOf(const Tetrahedra& members) const;
  std::vector<Face> facesOf(const Tetrahedra& members) const;
  double area(const Delaunay::Tetrahedron& tetrahedron, int k) const;

  const std::vector<Delaunay::Tetrahedron>& tetrahedra_;
  const Points& sites_;
  std::vector<double> thickness_; ///< of each tetrahedron
  std::vector<int> cellOf_;
  std::vector<bool> isOnHull_; ///< of each tetrahedron: findFlatHull()
  std::vector<Tetrahedra> members_;
};

/// 6 V / (longest edge)^3, signed. `corners`: four of the sites.
double thickness(const Points& sites, const std::array<int, 4>& corners);
}
