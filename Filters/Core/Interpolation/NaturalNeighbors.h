// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/Delaunay.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Natural neighbor coordinates of a point among the sites of a tessellation.
///
/// Sibson's coordinates (Math. Proc. Camb. Phil. Soc. 87 (1980) 151-155): the volume that the
/// point's Voronoi cell would take from the site's, divided by the sum of these. The Voronoi
/// diagram is unique, so they do not depend on the tessellation of cospherical sites.
///
/// The neighbors are the sites of the tetrahedra whose circumscribed spheres contain the point (its
/// conflict zone). New Voronoi vertices lie on the Voronoi edges that cross the zone's border. The
/// point's power distances to the spheres at both ends determine where, so no sphere is fitted
/// through the point. Volumes are sums over the zone's faces. A face's contribution is linear in
/// its dual edge, so the cost is linear in the zone.
class NaturalNeighbors
{
public:
  NaturalNeighbors() = default;
  /// Keeps a reference to `delaunay`, and 64 bytes a tetrahedron.
  NaturalNeighbors(const Delaunay& delaunay, Monitor& monitor);

  /// Buffers of one thread, and its result: sites, ascending, and their weights.
  class Workspace
  {
  public:
    explicit Workspace(const NaturalNeighbors& neighbors);
    std::vector<std::int32_t> sites;
    std::vector<double> weights;

  private:
    friend class NaturalNeighbors;
    using Vector = Eigen::RowVector3d;
    struct Face ///< of the zone's border, seen from outside
    {
      int corners[3]; ///< local numbers
      Vector vertex;  ///< the new Voronoi vertex on its dual edge, relative to the point
      Vector far;     ///< the vertex is at vertex + far / h at a height h over the hull
    };
    struct HalfEdge ///< of a border face, until its other half is found
    {
      std::int64_t key = -1;
      int query = 0, face = -1;
    };
    HalfEdge& halfEdge(int from, int to);

    int query_ = 0;
    std::vector<int> zoneMark_;   ///< #tetrahedra: +query if in conflict, -query if not
    std::vector<double> power_;   ///< #tetrahedra: the power distance where marked
    std::vector<int> siteMark_;   ///< #sites: query where numbered
    std::vector<int> siteNumber_; ///< #sites: local number
    std::vector<int> zone_;
    std::vector<Face> border_;
    std::vector<HalfEdge> edges_;          ///< hashed, open addressing, 2^n
    std::vector<int> local_;               ///< site of each local number
    std::vector<Vector> place_;            ///< site minus point
    std::vector<double> share_, farShare_; ///< without 1 / h, and the factors of 1 / h
    Vector hullNormal_ = Vector::Zero();   ///< if the point is on the hull
    std::vector<int> order_;
  };

  /// Computes the coordinates of `x`, which lies in the tetrahedron `inside`, into the workspace.
  /// In a face of the hull they are the limit from inside, the coordinates in the face's plane.
  /// Returns false, with an undefined result, where they do not exist or rounding spoils them. This
  /// happens outside the hull, on its edges, or if the error in x exceeds 1e-8 of the distance to
  /// its neighbors. A smaller error is distributed over the weights, so they reproduce linear
  /// fields to rounding.
  bool compute(const Eigen::RowVector3d& x, int inside, Workspace& workspace) const;

private:
  /// A tetrahedron in one cache line. The power distance of x to its sphere is |x|^2 - 2 center.x +
  /// constant.
  struct alignas(64) Cell
  {
    std::array<int, 4> sites, neighbors;
    double center[3], constant;
  };

  double power(const Cell& cell, const Eigen::RowVector3d& x, double squaredNorm) const;
  void findZone(const Eigen::RowVector3d& x, int inside, Workspace& workspace) const;
  bool visitFaces(const Eigen::RowVector3d& x, Workspace& workspace) const;
  static void joinBorder(Workspace& workspace);
  static bool finish(Workspace& workspace);

  Eigen::RowVector3d outer_ = Eigen::RowVector3d::Zero(); ///< Delaunay::origin()
  /// The origin of all coordinates here, relative to outer_: the middle of the sites.
  Eigen::RowVector3d origin_ = Eigen::RowVector3d::Zero();
  Points sites_;
  double extent_ = 0; ///< the largest coordinate of a site
  std::vector<Cell> cells_;
};
}
