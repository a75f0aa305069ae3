// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/Gmres.h"

#include <Eigen/IterativeLinearSolvers>
#include <unsupported/Eigen/IterativeSolvers>

#include <algorithm>
#include <cmath>

namespace morph
{
namespace
{
constexpr int Steps = 30;
constexpr double DropTolerance = 1e-3;
constexpr int FillFactor = 3;

/// Counts its applications, each of which asks whether to stop.
class Preconditioner : public Eigen::IncompleteLUT<double, int>
{
public:
  Preconditioner()
  {
    this->setDroptol(DropTolerance);
    this->setFillfactor(FillFactor);
  }

  template <typename Vector>
  auto solve(const Vector& v) const
  {
    this->monitor->check();
    ++this->applications;
    return this->IncompleteLUT::solve(v);
  }

  Monitor* monitor = nullptr;
  mutable int applications = 0;
};
}

struct Gmres::Implementation
{
  Eigen::DGMRES<CsrMatrix, Preconditioner> solver;
};

Gmres::Gmres(const CsrMatrix& matrix)
  : implementation_(std::make_unique<Implementation>())
{
  this->implementation_->solver.compute(matrix);
  this->implementation_->solver.set_restart(Steps);
  this->implementation_->solver.setMaxIterations(Steps);
}

Gmres::~Gmres() = default;

int Gmres::run(const RightHandSide& b, const MultiVectorRow& norm2, const MultiVectorRow& goal2,
  MultiVector& x, Monitor& monitor)
{
  monitor.check();
  auto& solver = this->implementation_->solver;
  Preconditioner& preconditioner = solver.preconditioner();
  preconditioner.monitor = &monitor;
  int most = 1;
  for (int c = 0; c < 4; ++c)
  {
    if (!(norm2[c] > goal2[c] && std::isfinite(norm2[c])))
    {
      continue;
    }
    Eigen::VectorXd column(b.rows()), guess(column.size());
    for (Index i = 0; i < guess.size(); ++i)
    {
      column[i] = b[i][c];
      guess[i] = x[i][c];
    }
    solver.setTolerance(std::sqrt(goal2[c]) / column.norm());
    preconditioner.applications = 0;
    const Eigen::VectorXd found = solver.solveWithGuess(column, guess);
    most = std::max(most, preconditioner.applications);
    for (Index i = 0; i < found.size(); ++i)
    {
      x[i][c] = found[i];
    }
  }
  return most;
}
}
