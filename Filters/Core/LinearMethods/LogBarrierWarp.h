// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/DirichletSystem.h"

namespace morph
{
/// LBWARP: (I - W_I) U_I = W_B U_B, where every free node is a convex combination of its neighbors.
/// Neighbors share a volume cell with the node. A log barrier determines the weights on the
/// undeformed mesh; the moved mesh keeps them. Sources: Shontz and Vavasis, IMR 2003, 147-158;
/// Staten et al., IMR 2011, equation (13).
///
/// The matrix is an M-matrix, so every free node stays in the convex hull of the prescribed ones.
/// Affine motions are exact to the solver's tolerance. Weights exist for a node strictly inside the
/// hull of its neighbors, whatever its cells are like. For a node on a face of the hull they exist
/// as a limit (see LogBarrierWeights.h).
///
/// prepare(): one pass over the nodes, 1 to 2 microseconds a node of a hexahedral mesh; keeps about
/// 0.5 kB a node. evaluate(): 6 to 20 applications of the preconditioner to 1e-10, nearly
/// independent of the mesh's size. applyTranspose(): as evaluate(); the first call also makes the
/// transposed system, 0.4 kB a node.
class LogBarrierWarp : public DirichletMethod
{
public:
  /// The treatment of a node outside its neighbors' hull, at an inverted or strongly concave place
  /// of the undeformed mesh.
  enum class OutsideHull
  {
    /// prepare() throws Error with their number and the first ids.
    Error,
    /// The node takes the first of these that exists: log-barrier weights among its neighbors and
    /// theirs; affine weights of minimum norm; FEMWARP's row of the matrix. Affine weights keep
    /// affine motions exact, but may be negative, so the node is not bounded.
    Relax
  };

  LogBarrierWarp()
    : DirichletMethod(false)
  {
  }

  /// Call it before prepare(). Default Error.
  void setOutsideHull(OutsideHull outsideHull) { this->outsideHull_ = outsideHull; }
  OutsideHull outsideHull() const { return this->outsideHull_; }

  /// The second ring of a node's neighbors is a fall-back.
  int layers() const override { return 2; }

protected:
  /// Reports count OutsideHullNodes, and the TwoRingNodes, AffineNodes and StiffnessNodes among
  /// them.
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  bool hasPrepareOptionsOf(const Morpher& other) const override
  {
    return this->outsideHull_ == static_cast<const LogBarrierWarp&>(other).outsideHull_;
  }

private:
  OutsideHull outsideHull_ = OutsideHull::Error;
};
}
