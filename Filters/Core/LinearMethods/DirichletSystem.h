// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/AffineFit.h"
#include "Mesh/NodePartition.h"
#include "Morpher/Morpher.h"
#include "Solvers/CsrMatrix.h"
#include "Solvers/MultiVector.h"
#include "Solvers/RightHandSide.h"
#include "Solvers/RowComponents.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"

#include <atomic>
#include <functional>
#include <vector>

namespace morph
{
/// Parts shared by methods that solve A_I U_I = -A_B U_B. `rows`: the node id of each matrix row,
/// see UnknownOrdering.h.

/// Throws Error unless the tolerance lies in (0, 1).
void requireTolerance(double tolerance);

/// The first guess of A_I U_I = -A_B U_B: an affine displacement field in each component of the
/// rows. It fits the prescribed nodes that A_B couples with the component. Affine motions solve the
/// equations, so the iteration finds only the remainder.
///
/// On several processes each has some of the rows, and all functions but component() and takeOff()
/// are collective. Components with rows on one process need no messages.
class AffineGuess
{
public:
  AffineGuess() = default;
  /// `rows`: the nodes of A_I's rows; `components`: of A_I, copied, by the same numbers on all
  /// processes; `coupling`: A_B. `processes`: of the nodes of `points`, kept by reference. Cost:
  /// one pass over A_B and the rows.
  AffineGuess(const Points& points, const NodePartition& partition, const std::vector<Index>& rows,
    const RowComponents& components, const CsrMatrix& coupling,
    const Communicator& processes = Communicator::alone());

  /// The fit of each component, for the columns of a MultiVector.
  class Fits
  {
  public:
    template <typename Row>
    MultiVectorRow displacement(int component, const Row& x) const
    {
      MultiVectorRow result = toRow(this->three_[component].displacement(x));
      if (!this->fourth_.empty())
      {
        result[3] = this->fourth_[component].displacement(x)[0];
      }
      return result;
    }

  private:
    friend class AffineGuess;
    std::vector<AffineFit> three_;
    std::vector<AffineFit> fourth_; ///< its first column; empty where that is zero
  };
  /// `prescribed`: #prescribed displacements.
  Fits fits(const MultiVector& prescribed) const;
  int component(Index row) const { return this->components_.of(row); }
  Index components() const { return this->components_.count; }
  /// Whether the fits give the displacements of all coupled nodes, to `tolerance` of the largest of
  /// each column and component. Cost: one pass over these nodes.
  bool agree(const Points& points, const NodePartition& partition, const MultiVector& prescribed,
    const Fits& fits, double tolerance) const;

  /// For equations that affine motions do not solve, and whose solution is the fit plus the answer
  /// to the rest. `coupling`, `prescribed`: as above; `rhs`: #rows x 3.
  ///@{
  /// Sets `rhs` to -A_B (U_B - F_B), where F is the fit of the row's component. Moves the guess
  /// `x`, F_I, to `fitted`, to be added to the solution, and leaves zero.
  void takeOff(const Points& points, const NodePartition& partition, const CsrMatrix& coupling,
    const MultiVector& prescribed, const Fits& fits, MultiVector& rhs, MultiVector& x,
    MultiVector& fitted, Monitor& monitor) const;
  /// Adds to `prescribed` what the fit has in the adjoint: F_I^T g + F_B^T A_B^T y. `gradient`, g,
  /// and `solution`, y with A_I y = g: #rows x 3.
  void addTranspose(const Points& points, const NodePartition& partition,
    const std::vector<Index>& rows, const CsrMatrix& coupling, const Points& gradient,
    const Points& solution, Points& prescribed) const;
  ///@}

private:
  /// Those with rows of a component.
  const Communicator& processesOf(std::size_t component) const
  {
    return this->isShared_[component] ? *this->processes_ : Communicator::alone();
  }

  const Communicator* processes_ = &Communicator::alone();
  RowComponents components_;
  std::vector<bool> isShared_; ///< per component: several processes have rows
  /// per component, its columns of A_B, ascending; each node counts on one process
  std::vector<std::vector<int>> coupled_;
  std::vector<AffineLeastSquares> leastSquares_;
};

/// Sets `x` to the first guess, #rows.
void firstGuess(const Points& points, const std::vector<Index>& rows, const AffineGuess& guess,
  const AffineGuess::Fits& fits, MultiVector& x, Monitor& monitor);

/// affineResidual() of equations, computed when it is first asked for: only affine motions ask.
class AffineResidual
{
public:
  /// The equations are others from now on.
  void reset() { this->value_ = Unknown; }
  /// Several threads may call it at once. Cost of the first calls: that of affineResidual(), which
  /// has these arguments.
  double of(const Points& points, const std::vector<Index>& rows, const std::vector<Index>& columns,
    const CsrMatrix& interior, const CsrMatrix& coupling, Monitor& monitor) const;

private:
  static constexpr double Unknown = -1;
  mutable std::atomic<double> value_{ Unknown }; // whoever computes it, it is the same
};

/// Equations A_I U_I = -A_B U_B with their guess, whose rows may be on several processes. It has
/// references alone.
struct DirichletEquations
{
  const Points& points; ///< undeformed
  const NodePartition& partition;
  const std::vector<Index>& rows;
  const CsrMatrix& coupling; ///< A_B
  const AffineGuess& guess;
  bool isUniform;                               ///< affine motions solve them, but for rounding
  const std::function<double()> affineResidual; ///< asked where they are uniform

  /// Solves to `tolerance` by solveEach(), and sets `x`, #rows. Returns false where the guess is
  /// the solution to a hundredth of the tolerance. `solver` is not called then, as a pass over the
  /// matrix takes longer than all else.
  bool solve(const MultiVector& prescribed, double tolerance, MultiVector& x, Monitor& monitor,
    const std::function<void(const RightHandSide&, MultiVector&)>& solver) const;
};

/// By how much affine motions miss the equations: the largest residual of a row, of the sum of its
/// terms' absolute values. `columns`: the nodes of the coupling's columns. About 1e-15 is rounding.
/// Cost: one pass over both matrices.
double affineResidual(const Points& points, const std::vector<Index>& rows,
  const std::vector<Index>& columns, const CsrMatrix& interior, const CsrMatrix& coupling,
  Monitor& monitor);

/// Reorders rows from NodePartition::free's order to the matrix order, and back. `free`: #free x 3,
/// or #free x 4. Free nodes without a row are left out, and their rows of `free` stay.
///@{
Points permute(const Points& free, const std::vector<Index>& rows, const NodePartition& partition);
void unpermute(const MultiVector& x, const std::vector<Index>& rows, const NodePartition& partition,
  Points& free, Monitor& monitor);
void unpermute(const MultiVector& x, const std::vector<Index>& rows, const NodePartition& partition,
  FourFields& free, Monitor& monitor);
///@}

/// The rows of four scalar fields.
MultiVector toRows(const FourFields& fields);
}
