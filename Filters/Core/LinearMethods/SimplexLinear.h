// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/Delaunay.h"
#include "Interpolation/InterpolationSites.h"
#include "Interpolation/WeightMatrix.h"
#include "Mesh/ShellLayer.h"
#include "Morpher/Morpher.h"

#include <memory>
#include <vector>

namespace morph
{
/// Simplex-linear: free nodes follow a Delaunay tessellation of the prescribed nodes by barycentric
/// coordinates. It is the fastest method, and affine motions are exact. Source: Staten et al., IMR
/// 2011, section 3.3, equation (7). The method ignores the mesh's cells: in a mesh that is not
/// convex, tetrahedra bridge the voids and couple opposite walls.
///
/// Coincident prescribed nodes (1e-12 of the size) count as one that moves by their mean.
/// Cospherical nodes (on every structured boundary) leave the tessellation undetermined. Their
/// convex cells are divided from the means of their corners (CosphericalStars.h). So neither
/// renumbering nor turning the mesh has an effect beyond rounding on nodes in the convex hull.
/// Outside, rounding decides at which of several outer faces a walk ends.
///
/// Counts: `FoldedTetrahedra`, with free nodes and without positive volume after the motion, which
/// invert cells. `ExtrapolatedNodes`, outside the prescribed nodes' convex hull by more than
/// rounding. `AffineNodes`, those of them whose tetrahedron would give a weight above 10. They
/// follow the affine fit to the nearest sites instead (AffineWeights.h).
///
/// prepare(): about 5 microseconds a site and 1 a free node. It keeps 56 bytes a free node and 50 a
/// tetrahedron. It throws Error of kind Singular if the prescribed nodes lie in one plane.
/// evaluate(): one pass over the weights.
class SimplexLinear : public LinearMorpher
{
public:
  const Delaunay& tessellation() const { return this->delaunay_; }
  /// Returns the sites that the tessellation's first numbers denote.
  const InterpolationSites& sites() const { return this->sites_; }
  /// Returns the sites whose means the further numbers denote.
  const Adjacency& means() const { return this->means_; }
  /// #free x #sites and means, four entries a row.
  const WeightMatrix& weights() const { return this->weights_; }

  std::unique_ptr<Morpher> copyWithoutCells() const override
  {
    return std::make_unique<SimplexLinear>(*this);
  }
  void requireMesh(const Mesh& rest) const override { requireRegion(rest); }

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;
  EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const override;

private:
  InterpolationSites sites_;
  Adjacency means_;
  Delaunay delaunay_;
  WeightMatrix weights_;
  std::vector<int> used_; ///< tetrahedra with free nodes, ascending
  Index extrapolated_ = 0;
  Index affine_ = 0;
};
}
