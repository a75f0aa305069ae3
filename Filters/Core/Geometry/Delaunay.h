// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

#include <array>
#include <vector>

namespace morph
{
/// The Delaunay tessellation of a set of sites in space, made by CGAL with exact predicates and
/// kept in plain arrays that any number of threads may read.
///
/// Where more than four sites lie on one empty sphere (every structured boundary has such sets) the
/// tessellation is not unique: CGAL then decides by a symbolic perturbation that follows the
/// lexicographic order of the coordinates. So the same set of sites gives the same tetrahedra, in
/// whatever order it comes; turned sites may give others.
///
/// All coordinates in here are relative to origin(), which lies at the sites where these are far
/// from the coordinates' origin. Moving the sites there is exact, so the tessellation is the same,
/// and rounding is relative to their size.
class Delaunay
{
public:
  static constexpr int Outside = -1; ///< neighbor beyond the convex hull

  struct Tetrahedron
  {
    std::array<int, 4> sites;     ///< positively oriented, as VTK orders them
    std::array<int, 4> neighbors; ///< neighbors[k] shares the face opposite to sites[k]
  };

  /// `absolute`: #sites x 3, the sites where they are, finite, distinct. Throws Error of kind
  /// Singular where they do not span a volume, that is, lie in one plane. Cost: n log n for sites
  /// on surfaces, some 5 microseconds a site.
  void build(const Points& absolute, Monitor& monitor);

  /// #sites x 3, relative to origin().
  const Points& sites() const { return this->sites_; }
  /// In each coordinate the sites' least value by magnitude where their greatest is at most twice
  /// that; else 0.
  const Eigen::RowVector3d& origin() const { return this->origin_; }
  const std::vector<Tetrahedron>& tetrahedra() const { return this->tetrahedra_; }

  /// A tetrahedron that contains `x`, but for rounding, by a visibility walk from the tetrahedron
  /// `start` that only crosses faces which x is surely beyond, and so ends (Devillers, Pion,
  /// Teillaud, Int. J. Found. Comput. Sci. 13 (2002) 181-199); for x outside the hull one at whose
  /// outer face the walk ends. A function of x and start alone. `x` is relative to origin(), as in
  /// startNear(). Cost: the tetrahedra on the way.
  int locate(const Eigen::RowVector3d& x, int start) const;
  /// Where to start for a first x: a tetrahedron at the nearest of a fixed sample of the sites
  /// (jump and walk).
  int startNear(const Eigen::RowVector3d& x) const;

  /// #tetrahedra x 3, the centres of the circumscribed spheres relative to origin(), right to
  /// rounding for flat tetrahedra too: those take exact arithmetic. Cost: 0.1 microseconds a
  /// tetrahedron, 20 a flat one.
  Points circumcentres(Monitor& monitor) const;

  /// Six times the signed volume of a tetrahedron with its corners at `positions` (#sites x 3).
  static double sixVolumes(const Tetrahedron& tetrahedron, const Points& positions);

private:
  Eigen::RowVector3d origin_ = Eigen::RowVector3d::Zero();
  Points sites_;
  std::vector<Tetrahedron> tetrahedra_;
  std::vector<int> atSite_; ///< #sites, some tetrahedron at each
};
}
