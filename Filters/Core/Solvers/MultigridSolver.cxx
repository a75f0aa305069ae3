// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/MultigridSolver.h"

#include "Solvers/RowProducts.h"
#include "Support/Error.h"
#include "Support/Parallel.h"
#include "Support/ReproducibleSum.h"

#include <cassert>
#include <cmath>

namespace morph
{
void MultigridSolver::prepare(LinearEquations&& equations, Monitor& monitor)
{
  assert(equations.ghostNumbers.empty());
  const std::vector<Index> singular = equations.singularRows();
  if (!singular.empty())
  {
    throw SingularRows(singular);
  }
  auto fresh = std::make_unique<Parts>();
  fresh->A.swap(equations.matrix); // Eigen 3.4 would copy on a move
  fresh->A.makeCompressed();
  fresh->components = rowComponents(fresh->A, monitor);
  fresh->multigrid.prepare(fresh->A, this->symmetry_, equations.coordinates, monitor);
  this->parts_ = std::move(fresh);
}

void MultigridSolver::product(const Points& from, Points& to, Monitor& monitor) const
{
  constexpr Index Grain = 4096;
  const auto kept = this->parts_->workspace();
  MultiVector& rows = kept->residual;
  parallel(from.rows(), monitor, [&](Index i) { rows[i] = toRow(from.row(i)); });
  to.resize(from.rows(), 3);
  monitor.parallelFor(from.rows(), Grain,
    [&](Index first, Index last)
    {
      forRowProducts(CsrRows<double>(this->matrix()), rows.data(), first, last,
        [&](Index i, const MultiVectorRow& product) { to.row(i) = product.head<3>(); });
    });
}

void MultigridSolver::precondition(const Points& from, Points& to, Monitor& monitor) const
{
  const Index n = from.rows();
  const auto kept = this->parts_->workspace();
  Workspace& work = *kept;
  // Single precision: scales the numbers to the preconditioner's size.
  const double norm2 = dot(from, from, monitor);
  const double unscale =
    norm2 > 0 ? std::sqrt(norm2 / static_cast<double>(n)) / Multigrid::Size : 1;
  parallel(n, monitor,
    [&](Index i) { work.residual32[i] = (toRow(from.row(i)) / unscale).cast<float>(); });
  this->parts_->multigrid.apply(work.residual32.data(), work.step.data(), work.multigrid, monitor);
  const double factor = unscale / this->parts_->multigrid.unit();
  to.resize(n, 3);
  parallel(
    n, monitor, [&](Index i) { to.row(i) = factor * work.step[i].head<3>().cast<double>(); });
}

std::shared_ptr<MultigridSolver::Workspace> MultigridSolver::Parts::workspace() const
{
  std::unique_ptr<Workspace> work;
  {
    const std::lock_guard<std::mutex> lock(this->mutex);
    work.swap(this->spare);
  }
  if (!work)
  {
    work = std::make_unique<Workspace>(this->A.rows(), this->multigrid);
  }
  return { work.release(), [this](Workspace* used)
    {
      const std::lock_guard<std::mutex> lock(this->mutex);
      this->spare.reset(used);
    } };
}

Sums MultigridSolver::Parts::residual(
  const RightHandSide& b, const MultiVector& x, MultiVector& r, Monitor& monitor) const
{
  return this->components.sums(this->A.rows(), monitor,
    [&](Index first, Index last, int)
    {
      MultiVectorRow norm2 = MultiVectorRow::Zero();
      forRowProducts(CsrRows<double>(this->A), x.data(), first, last,
        [&](Index i, const MultiVectorRow& product)
        {
          r[i] = b[i] - product;
          norm2 += r[i].cwiseAbs2();
        });
      return norm2;
    });
}

Sums MultigridSolver::Parts::unscale(const Sums& norm2, const SumsMask& wanted) const
{
  // By the mean over all rows: the sizes of components need not be exact.
  const auto rows = static_cast<double>(this->A.rows());
  return wanted.select((norm2 / rows).sqrt() / Multigrid::Size, 0);
}
}
