// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/HypreSolver.h"

#include "Support/Error.h"

#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_krylov.h>
#include <HYPRE_parcsr_ls.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace morph::distributed
{
namespace
{
#ifdef __GLIBC__
/// libsuperlu_dist, which hypre loads, tells malloc to keep all memory that is freed, also that of
/// ParaView. This takes it back, with the thresholds up to which malloc adapts by itself.
const bool isMallocRestored = []
{
  constexpr int MiB = 1 << 20;
  return mallopt(M_MMAP_MAX, 65536) == 1 && mallopt(M_MMAP_THRESHOLD, 32 * MiB) == 1 &&
         mallopt(M_TRIM_THRESHOLD, 64 * MiB) == 1;
}();
#endif

void startHypre()
{
  static const bool started = []
  {
#if HYPRE_RELEASE_NUMBER >= 22900
    HYPRE_Initialize();
#else
    HYPRE_Init();
#endif
    return true;
  }();
  static_cast<void>(started);
}

bool isMpiRunning()
{
  int finalized = 0;
  MPI_Finalized(&finalized);
  return finalized == 0;
}

/// A distributed vector of hypre over this rank's unknowns.
class Vector
{
public:
  Vector(MPI_Comm communicator, std::int64_t first, std::int64_t size)
    : numbers_(size)
  {
    HYPRE_IJVectorCreate(communicator, static_cast<HYPRE_BigInt>(first),
      static_cast<HYPRE_BigInt>(first + size - 1), &this->ij_);
    HYPRE_IJVectorSetObjectType(this->ij_, HYPRE_PARCSR);
    std::iota(this->numbers_.begin(), this->numbers_.end(), static_cast<HYPRE_BigInt>(first));
  }
  ~Vector() { HYPRE_IJVectorDestroy(this->ij_); }
  Vector(const Vector&) = delete;
  Vector& operator=(const Vector&) = delete;

  HYPRE_ParVector set(const std::vector<double>& values)
  {
    HYPRE_IJVectorInitialize(this->ij_);
    HYPRE_IJVectorSetValues(
      this->ij_, static_cast<HYPRE_Int>(values.size()), this->numbers_.data(), values.data());
    HYPRE_IJVectorAssemble(this->ij_);
    void* object = nullptr;
    HYPRE_IJVectorGetObject(this->ij_, &object);
    return static_cast<HYPRE_ParVector>(object);
  }
  void get(std::vector<double>& values)
  {
    HYPRE_IJVectorGetValues(
      this->ij_, static_cast<HYPRE_Int>(values.size()), this->numbers_.data(), values.data());
  }

private:
  HYPRE_IJVector ij_ = nullptr;
  std::vector<HYPRE_BigInt> numbers_;
};
}

struct HypreSolver::Handles
{
  Kind kind = Kind::Symmetric;
  HYPRE_IJMatrix ij = nullptr;
  HYPRE_ParCSRMatrix matrix = nullptr;
  HYPRE_Solver multigrid = nullptr;
  HYPRE_Solver krylov = nullptr;
  bool isSetUp = false;

  ~Handles() { this->clear(); }

  void clear()
  {
    if (isMpiRunning())
    {
      if (this->krylov)
      {
        this->kind == Kind::Symmetric ? HYPRE_ParCSRPCGDestroy(this->krylov)
                                      : HYPRE_ParCSRBiCGSTABDestroy(this->krylov);
      }
      if (this->multigrid)
      {
        HYPRE_BoomerAMGDestroy(this->multigrid);
      }
      if (this->ij)
      {
        HYPRE_IJMatrixDestroy(this->ij);
      }
    }
    this->krylov = this->multigrid = nullptr;
    this->ij = nullptr;
    this->isSetUp = false;
  }

  void createMultigrid()
  {
    HYPRE_BoomerAMGCreate(&this->multigrid);
    HYPRE_BoomerAMGSetPrintLevel(this->multigrid, 0);
    HYPRE_BoomerAMGSetCoarsenType(this->multigrid, 10); // HMIS
    HYPRE_BoomerAMGSetInterpType(this->multigrid, 6);   // extended+i
    HYPRE_BoomerAMGSetPMaxElmts(this->multigrid, 4);
    HYPRE_BoomerAMGSetStrongThreshold(this->multigrid, 0.5); // hypre's advice in three dimensions
    HYPRE_BoomerAMGSetRelaxType(this->multigrid, 8);         // symmetric l1 Gauss-Seidel
    HYPRE_BoomerAMGSetRelaxOrder(this->multigrid, 0);
    HYPRE_BoomerAMGSetTol(this->multigrid, 0);
    HYPRE_BoomerAMGSetMaxIter(this->multigrid, 1);
  }

  void createKrylov(MPI_Comm communicator)
  {
    if (this->kind == Kind::Symmetric)
    {
      HYPRE_ParCSRPCGCreate(communicator, &this->krylov);
      HYPRE_PCGSetTwoNorm(this->krylov, 1);
      HYPRE_PCGSetPrintLevel(this->krylov, 0);
      HYPRE_PCGSetLogging(this->krylov, 0);
      HYPRE_ParCSRPCGSetPrecond(
        this->krylov, HYPRE_BoomerAMGSolve, HYPRE_BoomerAMGSetup, this->multigrid);
    }
    else
    {
      HYPRE_ParCSRBiCGSTABCreate(communicator, &this->krylov);
      HYPRE_BiCGSTABSetPrintLevel(this->krylov, 0);
      HYPRE_BiCGSTABSetLogging(this->krylov, 0);
      HYPRE_ParCSRBiCGSTABSetPrecond(
        this->krylov, HYPRE_BoomerAMGSolve, HYPRE_BoomerAMGSetup, this->multigrid);
    }
  }

  void setUp(HYPRE_ParVector b, HYPRE_ParVector x)
  {
    this->kind == Kind::Symmetric ? HYPRE_ParCSRPCGSetup(this->krylov, this->matrix, b, x)
                                  : HYPRE_ParCSRBiCGSTABSetup(this->krylov, this->matrix, b, x);
    this->isSetUp = true;
  }

  int solve(HYPRE_ParVector b, HYPRE_ParVector x, double tolerance, int maxIterations)
  {
    HYPRE_Int iterations = 0;
    if (this->kind == Kind::Symmetric)
    {
      HYPRE_PCGSetTol(this->krylov, tolerance);
      HYPRE_PCGSetMaxIter(this->krylov, maxIterations);
      HYPRE_ParCSRPCGSolve(this->krylov, this->matrix, b, x);
      HYPRE_PCGGetNumIterations(this->krylov, &iterations);
    }
    else
    {
      HYPRE_BiCGSTABSetTol(this->krylov, tolerance);
      HYPRE_BiCGSTABSetMaxIter(this->krylov, maxIterations);
      HYPRE_ParCSRBiCGSTABSolve(this->krylov, this->matrix, b, x);
      HYPRE_BiCGSTABGetNumIterations(this->krylov, &iterations);
    }
    HYPRE_ClearAllErrors(); // no convergence is seen in the residual
    return static_cast<int>(iterations);
  }
};

HypreSolver::HypreSolver(const Ranks& ranks, Kind kind)
  : ranks_(ranks)
  , kind_(kind)
{
}
HypreSolver::~HypreSolver() = default;

std::int64_t HypreSolver::mostUnknowns()
{
  return std::numeric_limits<HYPRE_BigInt>::max();
}

std::int64_t HypreSolver::countUnknowns(const Ranks& ranks, std::int64_t rows)
{
  const std::int64_t unknowns = ranks.sum(rows), most = mostUnknowns();
  if (unknowns > most)
  {
    throw Error("The mesh has " + std::to_string(unknowns) +
                " free nodes; this build of hypre numbers " + std::to_string(most) +
                ". Build with a hypre of 64-bit integers (libhypre64m-dev).");
  }
  return unknowns;
}

void HypreSolver::prepare(LinearEquations&& equations, Monitor&)
{
  startHypre();
  const std::vector<Index> singular = equations.singularRows();
  if (this->ranks_.sum(static_cast<Index>(singular.size())) > 0)
  {
    throw SingularRows(singular);
  }
  this->transposed_.reset();
  this->components_ = std::move(equations.components);
  const CsrMatrix &own = equations.matrix, &ghosts = equations.ghosts;
  const Index rows = own.rows();
  this->begin(rows);
  if (this->unknowns_ == 0)
  {
    return;
  }
  HYPRE_IJMatrix matrix = this->handles_->ij;
  std::vector<HYPRE_Int> inside(rows), outside(rows);
  for (Index i = 0; i < rows; ++i)
  {
    inside[i] = own.outerIndexPtr()[i + 1] - own.outerIndexPtr()[i];
    outside[i] = ghosts.outerIndexPtr()[i + 1] - ghosts.outerIndexPtr()[i];
  }
  HYPRE_IJMatrixSetDiagOffdSizes(matrix, inside.data(), outside.data());
  HYPRE_IJMatrixInitialize(matrix);
  const auto first = static_cast<HYPRE_BigInt>(this->first_);
  std::vector<HYPRE_BigInt> columns;
  std::vector<double> values;
  for (Index i = 0; i < rows; ++i)
  {
    columns.clear();
    values.clear();
    for (CsrMatrix::InnerIterator entry(own, i); entry; ++entry)
    {
      columns.push_back(first + static_cast<HYPRE_BigInt>(entry.col()));
      values.push_back(entry.value());
    }
    for (CsrMatrix::InnerIterator entry(ghosts, i); entry; ++entry)
    {
      columns.push_back(static_cast<HYPRE_BigInt>(equations.ghostNumbers[entry.col()]));
      values.push_back(entry.value());
    }
    HYPRE_Int size = static_cast<HYPRE_Int>(columns.size());
    const HYPRE_BigInt row = first + static_cast<HYPRE_BigInt>(i);
    HYPRE_IJMatrixSetValues(matrix, 1, &size, &row, columns.data(), values.data());
  }
  this->end();
}

/// Numbers the rows, and creates the matrix, if there are unknowns.
void HypreSolver::begin(std::int64_t rows)
{
  const Ranks& ranks = this->ranks_;
  this->rows_ = rows;
  this->first_ = ranks.sumBefore(rows);
  this->unknowns_ = countUnknowns(ranks, rows);
  this->handles_ = std::make_unique<Handles>();
  this->handles_->kind = this->kind_;
  if (this->unknowns_ > 0)
  {
    const auto first = static_cast<HYPRE_BigInt>(this->first_);
    const auto last = static_cast<HYPRE_BigInt>(this->first_ + rows - 1);
    HYPRE_IJMatrixCreate(ranks.communicator(), first, last, first, last, &this->handles_->ij);
    HYPRE_IJMatrixSetObjectType(this->handles_->ij, HYPRE_PARCSR);
  }
}

/// Sets up the preconditioner of the matrix, whose entries are set.
void HypreSolver::end()
{
  Handles& handles = *this->handles_;
  const MPI_Comm communicator = this->ranks_.communicator();
  HYPRE_IJMatrixAssemble(handles.ij);
  void* object = nullptr;
  HYPRE_IJMatrixGetObject(handles.ij, &object);
  handles.matrix = static_cast<HYPRE_ParCSRMatrix>(object);
  handles.createMultigrid();
  handles.createKrylov(communicator);
  Vector b(communicator, this->first_, this->rows_), x(communicator, this->first_, this->rows_);
  const std::vector<double> zeros(this->rows_, 0.);
  HYPRE_ParVector pb = b.set(zeros);
  HYPRE_ParVector px = x.set(zeros);
  handles.setUp(pb, px);
}

SolveReport HypreSolver::solve(
  const RightHandSide& rhs, MultiVector& x, double tolerance, int maxIterations, Monitor&) const
{
  const Ranks& ranks = this->ranks_;
  SolveReport report;
  if (this->unknowns_ == 0)
  {
    return report;
  }
  Handles& handles = *this->handles_;
  const Index rows = rhs.rows();
  // hypre's norms are over all rows, so each component gets its own unit.
  std::vector<double> size(std::max<Index>(1, this->components_.count), 0);
  for (Index i = 0; i < rows; ++i)
  {
    size[this->components_.of(i)] += rhs[i].squaredNorm();
  }
  ranks.sum(size.data(), size.size());
  for (double& value : size)
  {
    value = size.size() > 1 && value > 0 && std::isfinite(value) ? std::sqrt(value) : 1;
  }
  const auto unit = [&](Index i) { return size[this->components_.of(i)]; };
  tolerance /= std::sqrt(static_cast<double>(size.size()));
  Vector b(ranks.communicator(), this->first_, rows), u(ranks.communicator(), this->first_, rows);
  std::vector<double> column(rows);
  for (int j = 0; j < 4; ++j)
  {
    for (Index i = 0; i < rows; ++i)
    {
      column[i] = rhs[i][j] / unit(i);
    }
    const auto norm2 = [&]
    { return ranks.sum(Eigen::Map<const Eigen::VectorXd>(column.data(), rows).squaredNorm()); };
    const double norm = std::sqrt(norm2());
    HYPRE_ParVector pb = b.set(column);
    for (Index i = 0; i < rows; ++i)
    {
      column[i] = norm > 0 ? x[i][j] / unit(i) : 0;
    }
    HYPRE_ParVector pu = u.set(column);
    if (norm > 0)
    {
      report.iterations += handles.solve(pb, pu, tolerance, maxIterations);
      u.get(column);
    }
    for (Index i = 0; i < rows; ++i)
    {
      x[i][j] = unit(i) * column[i];
    }
    if (!(norm > 0))
    {
      continue;
    }
    // b - A x, in place of b: what the iteration reports may have drifted.
    HYPRE_ParCSRMatrixMatvec(-1, handles.matrix, pu, 1, pb);
    b.get(column);
    const double residual = std::sqrt(norm2());
    report.relativeResidual = std::max(report.relativeResidual, residual / norm);
    if (!(residual <= 1e3 * tolerance * norm) && !(residual <= 1e-9 * norm))
    {
      throw Error(Error::Kind::NoConvergence,
        "hypre's solver did not converge: after " + std::to_string(maxIterations) +
          " iterations the residual is " + std::to_string(residual / norm) +
          " of the right-hand side. Repair flat cells, or raise `Tolerance`.");
    }
  }
  return report;
}

SolveReport HypreSolver::solveTransposed(
  const Points& b, Points& x, double tolerance, int maxIterations, Monitor& monitor) const
{
  if (this->kind_ == Kind::Symmetric)
  {
    return this->solve(b, x, tolerance, maxIterations, monitor);
  }
  if (!this->transposed_)
  {
    this->transposed_ = this->makeTransposed();
  }
  return this->transposed_->solve(b, x, tolerance, maxIterations, monitor);
}

template <typename Action>
void HypreSolver::byColumns(const Points& columns, Points& results, const Action& action) const
{
  const Index rows = columns.rows();
  results.setZero(rows, 3);
  if (this->unknowns_ == 0)
  {
    return;
  }
  const MPI_Comm communicator = this->ranks_.communicator();
  Vector from(communicator, this->first_, rows), to(communicator, this->first_, rows);
  std::vector<double> column(rows);
  for (int j = 0; j < 3; ++j)
  {
    Eigen::Map<Eigen::VectorXd>(column.data(), rows) = columns.col(j);
    HYPRE_ParVector pFrom = from.set(column);
    std::fill(column.begin(), column.end(), 0.);
    HYPRE_ParVector pTo = to.set(column);
    action(pFrom, pTo);
    to.get(column);
    results.col(j) = Eigen::Map<const Eigen::VectorXd>(column.data(), rows);
  }
}

void HypreSolver::product(const Points& from, Points& to, Monitor&) const
{
  this->byColumns(from, to,
    [this](HYPRE_ParVector x, HYPRE_ParVector y)
    { HYPRE_ParCSRMatrixMatvec(1, this->handles_->matrix, x, 0, y); });
}

void HypreSolver::precondition(const Points& from, Points& to, Monitor&) const
{
  this->byColumns(from, to,
    [this](HYPRE_ParVector x, HYPRE_ParVector y)
    {
      HYPRE_BoomerAMGSolve(this->handles_->multigrid, this->handles_->matrix, x, y);
      HYPRE_ClearAllErrors(); // one cycle does not converge
    });
}

std::unique_ptr<HypreSolver> HypreSolver::makeTransposed() const
{
  auto result = std::make_unique<HypreSolver>(this->ranks_, Kind::General);
  result->components_ = this->components_;
  result->begin(this->rows_);
  if (this->unknowns_ == 0)
  {
    return result;
  }
  HYPRE_IJMatrixInitialize(result->handles_->ij);
  for (std::int64_t i = 0; i < this->rows_; ++i)
  {
    HYPRE_Int size = 0;
    HYPRE_BigInt* columns = nullptr;
    HYPRE_Complex* values = nullptr;
    const auto row = static_cast<HYPRE_BigInt>(this->first_ + i);
    HYPRE_ParCSRMatrixGetRow(this->handles_->matrix, row, &size, &columns, &values);
    // Other ranks' rows get their entries as the matrix is assembled.
    std::vector<HYPRE_Int> ones(size, 1);
    const std::vector<HYPRE_BigInt> rows(size, row);
    HYPRE_IJMatrixAddToValues(
      result->handles_->ij, size, ones.data(), columns, rows.data(), values);
    HYPRE_ParCSRMatrixRestoreRow(this->handles_->matrix, row, &size, &columns, &values);
  }
  result->end();
  return result;
}
}
