// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Quality/Certificate.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace morph
{
/// The pieces by which a polyhedron is measured and certified: for each edge of a face the
/// tetrahedron with the face's center and the cell's.
///
/// The centers are those that OpenFOAM computes. The area vector of a face is the sum of its
/// triangles, between the edges and the mean of the nodes. Its center is the mean of the triangles'
/// centers, weighted by the size of their areas. The cell's center is that of the pyramids between
/// the faces and the mean of the face centers. Source: OpenFOAM,
/// primitiveMeshFaceCentresAndAreas.C and primitiveMeshCellCentresAndVols.C. With these weights the
/// centers are linear in the nodes.
///
/// A face's pyramid is the sum of its tetrahedra. So where all of these are positive, OpenFOAM's
/// tests of volumes and face pyramids pass. The pieces that methods see (PolyhedronPieces.h) are
/// sums of these: with the same centers, a positive pyramid on a quadrilateral has positive
/// tetrahedra, since each is the mean of those at two of its corners.
class PolyhedronPlaces
{
public:
  /// Takes a cell. `x`: positions of its nodes, in their order, at which the weights are found.
  /// Returns whether it has faces, and all of their edges a length. Cost: some passes over the
  /// faces, about 3 microseconds for six.
  bool take(const Mesh& mesh, Index cell, const std::vector<Eigen::Vector3d>& x);

  /// Calls act(a, b, c) for each tetrahedron with the edge, the line from its middle to the face's
  /// center, and the line from the cell's center to the face's. `x`: of the cell's nodes, in their
  /// order; positions, or matrices of three rows that are linear in them.
  template <typename X, typename Act>
  void forEach(const X* x, const Act& act) const
  {
    std::vector<X> centers(this->shares_.size());
    X middle;
    middle.setZero();
    for (std::size_t f = 0; f < centers.size(); ++f)
    {
      centers[f].setZero();
      for (std::size_t k = this->start_[f]; k < this->start_[f + 1]; ++k)
      {
        centers[f] += this->weights_[k] * x[this->nodes_[k]];
      }
      middle += this->shares_[f] * centers[f];
    }
    for (std::size_t f = 0; f < centers.size(); ++f)
    {
      for (std::size_t k = this->start_[f]; k < this->start_[f + 1]; ++k)
      {
        const X& a = x[this->nodes_[k]];
        const X& b = x[this->nodes_[k + 1 < this->start_[f + 1] ? k + 1 : this->start_[f]]];
        act(X(b - a), X(centers[f] - (a + b) / 2), X(centers[f] - middle));
      }
    }
  }

  /// The scaled Jacobian of a polyhedron: the minimum determinant of the three lines of forEach(),
  /// scaled to length 1, times `sign`, the cell's orientation. It is 1 for a box. Takes the cell at
  /// `points`, #nodes x 3. NaN where a coordinate is not finite, or without faces. Sets
  /// `isCollapsed` where a line has no length; the value is then 0.
  double scaledJacobian(
    const Mesh& mesh, Index cell, const ConstPoints& points, double sign, bool& isCollapsed);

  /// Certified if every tetrahedron is positive, Inverted if one is not, Undecided if one is 0 but
  /// for rounding. Takes the cell.
  Certificate certify(const Mesh& mesh, Index cell, const ConstPoints& points, double sign);

private:
  /// Takes the cell, and calls act() with `sign` times the determinants of the lines, scaled to
  /// length 1; NaN where one has no length. Returns false if a coordinate is not finite, or without
  /// faces.
  template <typename Act>
  bool forEachValue(
    const Mesh& mesh, Index cell, const ConstPoints& points, double sign, const Act& act);

  std::vector<std::size_t> start_; ///< of each face in nodes_, and their end
  std::vector<int> nodes_;         ///< of the faces, numbers in the cell
  std::vector<double> weights_;    ///< #nodes_, in the face's center
  std::vector<double> shares_;     ///< #faces, in the cell's center
  std::vector<Eigen::Vector3d> x_; ///< of the cell's nodes, from the first one
  std::vector<Index> sorted_;      ///< the cell's nodes
  std::vector<int> place_;         ///< of these in the cell
};
}
