// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

#include <array>
#include <vector>

namespace morph
{
/// The Delaunay tessellation of sites in space, built by CGAL with exact predicates. It is stored
/// in plain arrays that any number of threads may read.
///
/// The tessellation is not unique where more than four sites lie on one empty sphere, as on every
/// structured boundary. CGAL then decides by a symbolic perturbation in lexicographic order of the
/// coordinates. So the same set of sites gives the same tetrahedra in any order; rotated sites may
/// give others (CosphericalStars.h).
///
/// All coordinates here are relative to origin(), which lies near sites that are far from 0. This
/// shift is exact, so the tessellation does not change, and rounding is relative to the sites'
/// extent.
class Delaunay
{
public:
  static constexpr int Outside = -1; ///< neighbor beyond the convex hull

  struct Tetrahedron
  {
    std::array<int, 4> sites;     ///< positively oriented, as VTK orders them
    std::array<int, 4> neighbors; ///< neighbors[k] shares the face opposite sites[k]

    /// The face opposite corner k, ordered so that the face and corner k are positively oriented.
    static constexpr int Faces[4][3] = { { 1, 3, 2 }, { 0, 2, 3 }, { 0, 3, 1 }, { 0, 1, 2 } };
    /// Returns that face's sites.
    std::array<int, 3> face(int k) const
    {
      return { this->sites[Faces[k][0]], this->sites[Faces[k][1]], this->sites[Faces[k][2]] };
    }
  };

  /// `absolute`: the sites' coordinates, #sites x 3, finite and distinct. Throws Error of kind
  /// Singular where all sites lie in one plane. Cost: n log n for sites on surfaces, about 5
  /// microseconds a site.
  void build(const Points& absolute, Monitor& monitor);

  /// Replaces the tetrahedra by others that fill the same hull, and the sites by those and further
  /// ones. `sites`: relative to origin().
  void replace(Points sites, std::vector<Tetrahedron> tetrahedra);

  /// #sites x 3, relative to origin().
  const Points& sites() const { return this->sites_; }
  /// The shift. A coordinate's shift is its value of smallest magnitude if the largest is at most
  /// twice as large, otherwise 0.
  const Eigen::RowVector3d& origin() const { return this->origin_; }
  const std::vector<Tetrahedron>& tetrahedra() const { return this->tetrahedra_; }
  /// The length by which rounding of the absolute coordinates may move sites against each other.
  double rounding() const { return this->rounding_; }

  /// Finds a tetrahedron that contains `x`, up to rounding. A visibility walk from the tetrahedron
  /// `start` crosses only faces that x is certainly beyond, so it ends. For x outside the hull it
  /// returns a tetrahedron at whose outer face the walk ends. After replace() faces are tried in a
  /// pseudorandom order, since a fixed order might walk in circles. Where sites are flat to
  /// rounding, tetrahedra may overlap, and such a walk finds no end: then all are tried. The result
  /// depends on x and start only. `x` is relative to origin(). Cost: the tetrahedra on the way.
  /// Source: Devillers, Pion, Teillaud, Int. J. Found. Comput. Sci. 13 (2002) 181-199.
  int locate(const Eigen::RowVector3d& x, int start) const;
  /// Returns a start for a first `x`, relative to origin(): a tetrahedron at the nearest of some
  /// sample sites (jump and walk).
  int startNear(const Eigen::RowVector3d& x) const;

  /// Returns the circumcenters, #tetrahedra x 3, relative to origin(). Flat tetrahedra use exact
  /// arithmetic, so their centers are accurate too. Cost: 0.1 microseconds a tetrahedron, 20 a flat
  /// one.
  Points circumcenters(Monitor& monitor) const;

  /// Six times the signed volume of a tetrahedron with its corners at `positions` (#sites x 3).
  static double sixVolumes(const Tetrahedron& tetrahedron, const Points& positions);

private:
  Eigen::RowVector3d origin_ = Eigen::RowVector3d::Zero();
  double rounding_ = 0;
  Points sites_;
  std::vector<Tetrahedron> tetrahedra_;
  std::vector<int> atSite_; ///< #sites, one tetrahedron at each
  bool isDelaunay_ = true;
};
}
