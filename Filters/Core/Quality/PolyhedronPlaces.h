// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Quality/PolyhedronCorners.h"
#include "Quality/PolyhedronQuality.h"

#include <cstddef>
#include <vector>

namespace morph
{
/// The places at which PolyhedronMeasure takes determinants, linear in the nodes of the cell.
///
/// These are the corners where three edges meet, and for each edge of a face the tetrahedron with
/// the face's centre and the cell's. The measure finds centres that are weighted by areas and
/// volumes, which change as the nodes move. Here they keep the weights of some positions, at which
/// both agree.
class PolyhedronPlaces
{
public:
  /// Takes a cell; `points`: #nodes x 3, where the weights are found; `sign`: see nodeAt(). Returns
  /// whether it has faces, and all of their edges a length. Cost: that of one measure of the cell.
  bool take(const Mesh& mesh, Index cell, const ConstPoints& points, double sign);

  /// Calls act(a, b, c) with three edges for each place: the corners, then the edges of the faces.
  /// `x`: of the cell's nodes, in their order; positions, or matrices of three rows that are linear
  /// in them.
  template <typename X, typename Act>
  void forEach(const X* x, const Act& act) const
  {
    for (const Corner& c : this->corners_)
    {
      act(X(x[c.last] - x[c.node]), X(x[c.next] - x[c.node]), X(x[c.other] - x[c.node]));
    }
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

private:
  struct Corner
  {
    int node, last, next, other;
  };
  std::vector<Corner> corners_;
  std::vector<std::size_t> start_; ///< of each face in nodes_, and their end
  std::vector<int> nodes_;         ///< of the faces, numbers in the cell
  std::vector<double> weights_;    ///< #nodes_, in the face's centre
  std::vector<double> shares_;     ///< #faces, in the cell's centre
  std::vector<Index> sorted_;      ///< the cell's nodes
  std::vector<int> place_;         ///< of these in the cell
  PolyhedronCorners find_;
  PolyhedronCenters centers_;
};
}
