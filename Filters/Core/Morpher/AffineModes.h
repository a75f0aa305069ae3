// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/Morpher.h"

namespace morph
{
/// Four numbers of each node: its weight w, and three p that an affine motion multiplies.
using AffineFields = FourFields;

/// What moves a node with the fields (w, p): its displacement is w c + A p. The columns are c and
/// the three of A.
using AffineMotion = Eigen::Matrix<double, 3, 4>;

/// The displacement of a node with these fields.
inline Eigen::RowVector3d affineDisplacement(
  const AffineMotion& motion, const Eigen::Matrix<double, 1, 4>& fields)
{
  return fields * motion.transpose();
}

/// The answer of a linear method to a boundary that moves by w_i c + A p_i, its fields fixed. The
/// method is the same for each coordinate, so four scalar fields of the nodes are enough for every
/// A and c: the method's answers to w and to the three components of p.
class AffineModes
{
public:
  /// Solves for the four fields at once. `fields`: #prescribed x 4, finite, in the order of
  /// NodePartition::prescribed. Collective where several processes have the method's mesh. Cost:
  /// LinearMorpher::fields(), and 32 bytes a node. Throws Error as that does.
  void prepare(const LinearMorpher& method, const AffineFields& fields, Monitor& monitor);
  /// Forgets the fields.
  void clear();
  /// Whether prepare() was called with these fields, and the method had this tolerance.
  bool isPreparedFor(const LinearMorpher& method, const AffineFields& fields) const;

  /// Moves the mesh, as LinearMorpher::evaluate() does with the positions `prescribed`, #prescribed
  /// x 3; prescribed nodes go there exactly. `method`: the one of prepare(). `moved`: becomes
  /// #nodes x 3. The same bits in any number of threads. Cost: one pass, 12 multiplications and 80
  /// bytes a node.
  EvaluateReport evaluate(const LinearMorpher& method, const AffineMotion& motion,
    const ConstPoints& prescribed, Points& moved, Monitor& monitor) const;

private:
  AffineFields given_; ///< #prescribed x 4
  AffineFields modes_; ///< #nodes x 4
  double tolerance_ = 0;
  EvaluateReport report_;
};
}
