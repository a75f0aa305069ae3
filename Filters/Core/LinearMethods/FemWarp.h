// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/CenterStars.h"
#include "LinearMethods/DirichletSystem.h"
#include "Morpher/CellStiffness.h"
#include "Solvers/SpdSolver.h"

#include <vector>

namespace morph
{
/// FEMWARP: displacements solve Laplace's equation by finite elements on the undeformed mesh, A_I
/// U_I = -A_B U_B. The boundary values are the prescribed displacements. Sources: Baker,
/// Engineering with Computers 18 (2002) 188-198; Shontz and Vavasis, BIT 50 (2010) 863-884; Staten
/// et al., IMR 2011, equations (9) to (12).
///
/// Stiffness: see elementStiffness(). Affine motions are exact to the solver's tolerance. A cell
/// whose Jacobian is not positive at all its quadrature points takes the averaged simplicial
/// stiffness with absolute volumes. So the system stays positive definite. A warning names these
/// cells, and all others that are inverted by their scaled Jacobian.
///
/// With a stiffness k of the cells other than Uniform, the equation is that of div k grad u = 0.
/// Affine motions do not solve it, so that their least-squares fit is taken off first: u is the fit
/// plus the solution for the rest.
///
/// A boundary that moves affinely, to a hundredth of the tolerance, needs no iteration: the fit is
/// the solution.
///
/// prepare(): one pass over the cells. It keeps about 0.5 kB a node of a hexahedral mesh and 0.35
/// of a tetrahedral one. evaluate(): conjugate gradients to 1e-10, nearly independent of the mesh's
/// size. With 10^5 nodes they take 12 iterations on a cube of hexahedra. On boxes of stretched
/// cells of all types they take 12 to 27, with aspect ratios up to 100 in layers that grow by up to
/// 1.3; and they take hundreds where many slivers have a height of 1e-6.
class FemWarp : public StiffMorpher
{
public:
  /// Sets the relative residual at which the solver stops, per coordinate. Range (0, 1), default
  /// 1e-10.
  void setTolerance(double tolerance);
  double tolerance() const override { return this->tolerance_; }
  void takeEvaluateOptions(const Morpher& other) override
  {
    this->tolerance_ = static_cast<const FemWarp&>(other).tolerance_;
  }

  /// Returns the node id of each matrix row: NodePartition::free, or these ids in a better order
  /// for memory. Of a mesh with polyhedra some centers are eliminated and are no rows, if the
  /// stiffness is uniform.
  const std::vector<Index>& rows() const
  {
    return this->rows_.empty() ? this->partition().free : this->rows_;
  }
  /// Returns the solver with its matrix A_I (#rows x #rows), for benchmarks and checks.
  const SpdSolver& solver() const { return this->solver_; }
  /// Returns A_B, #rows x #prescribed; rows as above, columns in the order of
  /// NodePartition::prescribed.
  const CsrMatrix& coupling() const { return this->coupling_; }

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;
  EvaluateReport displaceFields(
    const FourFields& prescribed, FourFields& free, Monitor& monitor) const override;
  EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const override;

private:
  /// Sets `x` to the displacements of the rows.
  EvaluateReport solve(const MultiVector& prescribed, MultiVector& x, Monitor& monitor) const;

  double tolerance_ = 1e-10;
  std::vector<Index> rows_; ///< empty where they are the free nodes
  CenterStars stars_;
  SpdSolver solver_;
  CsrMatrix coupling_;
  AffineGuess guess_;
  bool isUniform_ = true;
  AffineResidual affineResidual_;
};
}
