// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/AffineFit.h"
#include "Interpolation/InterpolationSites.h"
#include "Interpolation/WeightMatrix.h"
#include "Morpher/Morpher.h"

#include <memory>

namespace morph
{
/// Weighted residuals: an affine fit of the whole boundary's motion plus weighted residuals of
/// nearby nodes. Residuals are weighted by inverse squared distance. The method is meshless: it
/// ignores cells.
///
/// Sources: equations (3) to (6) of M. L. Staten, S. J. Owen, S. M. Shontz, A. G. Salinger, T. S.
/// Coffey, "A Comparison of Mesh Morphing Methods for 3D Shape Optimization", IMR 2011; equation
/// (3) with the square of least squares. With sites b_k (see InterpolationSites), their
/// displacements U_k and the fit L:
///
///     u(x) = L(x) + sum over the n nearest sites of w_k (U_k - L(b_k)),
///     w_k = |x - b_k|^-2 / sum_j |x - b_j|^-2
///
/// It is exact for affine motions of prescribed nodes that do not all lie in one plane. If they do,
/// the fit of minimum norm keeps the method linear, and nodes off the plane move as their
/// projections. A free node within 1e-12 of the size of a site has the site's displacement. Sites
/// as far as the n-th nearest count, too (NearestNodes). The map is not continuous in x: where the
/// n-th neighbor changes, u jumps by its share of the residual. On fine meshes, nodes on either
/// side of the middle depend on different walls, so this method inverts cells first.
///
/// prepare(): a neighbor search, O((free + prescribed) log(prescribed)). It keeps 12 bytes per
/// neighbor of a free node (1 kB a node with 80). evaluate() and applyTranspose(): one pass over
/// the weights. Options take effect at the next prepare().
class WeightedResidual : public LinearMorpher
{
public:
  /// Sets the number of prescribed nodes that influence a free node (or all of fewer). At least 1,
  /// default 80, the paper's choice for volumes.
  void setNumberOfNeighbors(Index count);
  Index numberOfNeighbors() const { return this->numberOfNeighbors_; }

  /// Returns the sites of the weights' columns.
  const InterpolationSites& sites() const { return this->sites_; }
  /// #free x #sites, rows in the order of NodePartition::free.
  const WeightMatrix& weights() const { return this->weights_; }

  std::unique_ptr<Morpher> copyWithoutCells() const override
  {
    return std::make_unique<WeightedResidual>(*this);
  }

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  bool hasPrepareOptionsOf(const Morpher& other) const override
  {
    const auto& residual = static_cast<const WeightedResidual&>(other);
    return this->numberOfNeighbors_ == residual.numberOfNeighbors_;
  }
  /// Warns where the fit reflects or flattens the mesh: the result is then rarely useful.
  void warnOf(const Points& prescribed, Monitor& monitor) const override;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;
  EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const override;

private:
  Index numberOfNeighbors_ = 80;
  InterpolationSites sites_;
  AffineLeastSquares fit_;
  Points freePlaces_; ///< #free x 3
  WeightMatrix weights_;
};
}
