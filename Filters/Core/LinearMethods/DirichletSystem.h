// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/AffineFit.h"
#include "LinearMethods/CenterStars.h"
#include "Mesh/NodePartition.h"
#include "Mesh/Topology.h"
#include "Morpher/Morpher.h"
#include "Solvers/CsrMatrix.h"
#include "Solvers/LinearSolver.h"
#include "Solvers/MultiVector.h"
#include "Solvers/RowComponents.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"

#include <atomic>
#include <memory>
#include <vector>

namespace morph
{
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

/// A method that solves A_I U_I = -A_B U_B. On several processes each has the rows of the free
/// nodes that count there, and its Communicator makes the solver.
///
/// A boundary that moves affinely, to a hundredth of the tolerance, needs no iteration: the fit is
/// the solution.
class DirichletMethod : public LinearMorpher
{
public:
  /// Sets the relative residual at which the solver stops, per coordinate. Throws Error outside
  /// (0, 1); default 1e-10.
  void setTolerance(double tolerance);
  double tolerance() const override { return this->tolerance_; }
  void takeEvaluateOptions(const Morpher& other) override
  {
    this->tolerance_ = static_cast<const DirichletMethod&>(other).tolerance_;
  }

  int layers() const override { return 1; }

  /// Returns the node id of each matrix row: NodePartition::free, or these ids in a better order
  /// for memory. Of a mesh with polyhedra some centers are eliminated and are no rows, if the
  /// stiffness is uniform.
  const std::vector<Index>& rows() const
  {
    return this->rows_.empty() ? this->partition().free : this->rows_;
  }
  /// Returns the solver with its matrix A_I (#rows x #rows), once prepared.
  const LinearSolver& solver() const { return *this->solver_; }
  /// Returns A_B, #rows x #prescribed; rows as above, columns in the order of
  /// NodePartition::prescribed.
  const CsrMatrix& coupling() const { return this->coupling_; }

protected:
  explicit DirichletMethod(bool isSymmetric)
    : isSymmetric_(isSymmetric)
  {
  }

  /// Sets the nodes of the rows, and returns those of all other columns: the prescribed ones, and
  /// rows of other processes. `rows`: in NodePartition::free. `bodies`: of `rest`.
  std::vector<Index> setRows(
    const Mesh& rest, const std::vector<Index>& rows, const ConnectedComponents& bodies);
  /// Takes over A_I and the coupling of the columns that setRows() gave. `isUniform`: affine
  /// motions solve the equations. Otherwise their fit is taken off first. Throws Error as
  /// throwSingular().
  void setEquations(CsrMatrix& interior, CsrMatrix& coupling, const std::vector<Index>& columns,
    bool isUniform, Monitor& monitor);
  /// Throws Error for nodes, here, without an equation. Collective.
  [[noreturn]] void throwSingular(const std::vector<Index>& nodes) const;

  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;
  EvaluateReport displaceFields(
    const FourFields& prescribed, FourFields& free, Monitor& monitor) const override;
  EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const override;

  CenterStars stars_;                 ///< free nodes that are no rows
  std::vector<Statistic> statistics_; ///< of all reports

private:
  static constexpr double Unknown = -1;

  /// By how much affine motions miss the equations; the first call takes affineResidual().
  double affineResidual(Monitor& monitor) const;
  EvaluateReport report(const SolveReport& solved, Monitor& monitor) const;
  template <typename Columns>
  EvaluateReport displaceColumns(const Columns& prescribed, Columns& free, Monitor& monitor) const;

  bool isSymmetric_;
  double tolerance_ = 1e-10;
  std::vector<Index> rows_; ///< empty where they are the free nodes
  std::shared_ptr<LinearSolver> solver_;
  CsrMatrix coupling_;
  AffineGuess guess_;
  bool isUniform_ = true;
  /// Only affine motions ask for it. Whichever thread finds it, it is the same.
  mutable std::atomic<double> affineResidual_{ Unknown };
};

/// By how much affine motions miss the equations: the largest residual of a row, of the sum of its
/// terms' absolute values. `columns`: the nodes of the coupling's columns. About 1e-15 is rounding.
/// Cost: one pass over both matrices.
double affineResidual(const Points& points, const std::vector<Index>& rows,
  const std::vector<Index>& columns, const CsrMatrix& interior, const CsrMatrix& coupling,
  Monitor& monitor);
}
