// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/DirichletSystem.h"

#include "Mesh/NodePartition.h"
#include "Solvers/MultigridSolver.h"
#include "Support/Error.h"
#include "Support/Lists.h"
#include "Support/Parallel.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <sstream>
#include <utility>

namespace morph
{
namespace
{
constexpr Index Grain = 4096;
constexpr int MaxIterations = 3000;

std::vector<Index> nodesOf(const std::vector<int>& columns, const NodePartition& partition)
{
  std::vector<Index> nodes;
  std::transform(columns.begin(), columns.end(), std::back_inserter(nodes),
    [&](int column) { return partition.prescribed[column]; });
  return nodes;
}
}

AffineGuess::AffineGuess(const Points& points, const NodePartition& partition,
  const std::vector<Index>& rows, const RowComponents& components, const CsrMatrix& coupling,
  const Communicator& processes)
  : processes_(&processes)
  , components_(components)
  , isShared_(components.count)
  , coupled_(components.count)
{
  for (Index row = 0; row < coupling.rows(); ++row)
  {
    std::vector<int>& columns = this->coupled_[components.of(row)];
    for (CsrMatrix::InnerIterator entry(coupling, row); entry; ++entry)
    {
      columns.push_back(static_cast<int>(entry.col()));
    }
  }
  std::vector<std::vector<Index>> moved(components.count);
  for (std::size_t row = 0; row < rows.size(); ++row)
  {
    moved[components.of(static_cast<Index>(row))].push_back(rows[row]);
  }
  std::vector<double> owners(moved.size());
  std::transform(moved.begin(), moved.end(), owners.begin(),
    [](const std::vector<Index>& some) { return some.empty() ? 0. : 1.; });
  processes.sum(owners.data(), static_cast<int>(owners.size()));
  for (std::size_t c = 0; c < this->coupled_.size(); ++c)
  {
    std::vector<int>& columns = this->coupled_[c];
    sortUnique(columns);
    this->isShared_[c] = owners[c] > 1;
    std::vector<Index> nodes = nodesOf(columns, partition);
    const std::unique_ptr<CopiedRows> copies = this->processesOf(c).rows(nodes);
    for (auto row = copies->countedElsewhere().rbegin(); row != copies->countedElsewhere().rend();
         ++row)
    {
      columns.erase(columns.begin() + *row);
    }
    columns.shrink_to_fit();
    nodes = nodesOf(columns, partition);
    this->leastSquares_.emplace_back(
      points(nodes, allColumns), points(moved[c], allColumns), this->processesOf(c));
  }
}

AffineGuess::Fits AffineGuess::fits(const MultiVector& prescribed) const
{
  const bool hasFourth = !this->processes_->all(std::all_of(
    prescribed.begin(), prescribed.end(), [](const MultiVectorRow& row) { return row[3] == 0; }));
  Fits result;
  result.three_.reserve(this->coupled_.size());
  for (std::size_t c = 0; c < this->coupled_.size(); ++c)
  {
    const std::vector<int>& columns = this->coupled_[c];
    Points some(static_cast<Index>(columns.size()), 3);
    for (Index i = 0; i < some.rows(); ++i)
    {
      some.row(i) = prescribed[columns[i]].head<3>();
    }
    result.three_.push_back(this->leastSquares_[c].fit(some, this->processesOf(c)));
    if (hasFourth)
    {
      for (Index i = 0; i < some.rows(); ++i)
      {
        some.row(i) << prescribed[columns[i]][3], 0, 0;
      }
      result.fourth_.push_back(this->leastSquares_[c].fit(some, this->processesOf(c)));
    }
  }
  return result;
}

bool AffineGuess::agree(const Points& points, const NodePartition& partition,
  const MultiVector& prescribed, const Fits& fits, double tolerance) const
{
  bool all = true;
  for (std::size_t c = 0; c < this->coupled_.size(); ++c)
  {
    Eigen::Array<double, 4, 2> largest = Eigen::Array<double, 4, 2>::Zero(); // of all, and off
    for (const int column : this->coupled_[c])
    {
      const MultiVectorRow& given = prescribed[column];
      const MultiVectorRow off =
        given - fits.displacement(static_cast<int>(c), points.row(partition.prescribed[column]));
      largest.col(0) = largest.col(0).max(given.array().abs());
      largest.col(1) = largest.col(1).max(off.array().abs());
    }
    this->processesOf(c).maximum(largest.data(), 8);
    // Not for numbers that have overflowed.
    all = all && (largest.col(1) <= tolerance * largest.col(0)).all();
  }
  return this->processes_->all(all);
}

void AffineGuess::takeOff(const Points& points, const NodePartition& partition,
  const CsrMatrix& coupling, const MultiVector& prescribed, const Fits& fits, MultiVector& rhs,
  MultiVector& x, MultiVector& fitted, Monitor& monitor) const
{
  rhs.resize(x.size());
  fitted.assign(x.size(), MultiVectorRow::Zero());
  fitted.swap(x);
  parallel(coupling.rows(), Grain, monitor,
    [&](Index i)
    {
      const int component = this->component(i);
      MultiVectorRow sum = MultiVectorRow::Zero();
      for (CsrMatrix::InnerIterator entry(coupling, static_cast<int>(i)); entry; ++entry)
      {
        const Index node = partition.prescribed[entry.col()];
        sum -= entry.value() *
               (prescribed[entry.col()] - fits.displacement(component, points.row(node)));
      }
      rhs[i] = sum;
    });
}

void AffineGuess::addTranspose(const Points& points, const NodePartition& partition,
  const std::vector<Index>& rows, const CsrMatrix& coupling, const Points& gradient,
  const Points& solution, Points& prescribed) const
{
  const std::size_t components = this->coupled_.size();
  // The places at which each component's fit is evaluated, and the gradient there.
  std::vector<std::vector<Index>> places(components);
  std::vector<std::vector<Eigen::RowVector3d>> loads(components);
  for (Index i = 0; i < coupling.rows(); ++i)
  {
    const int c = this->component(i);
    places[c].push_back(rows[i]);
    loads[c].push_back(gradient.row(i));
    for (CsrMatrix::InnerIterator entry(coupling, static_cast<int>(i)); entry; ++entry)
    {
      places[c].push_back(partition.prescribed[entry.col()]);
      loads[c].push_back(entry.value() * solution.row(i));
    }
  }
  for (std::size_t c = 0; c < components; ++c)
  {
    Points x(static_cast<Index>(places[c].size()), 3), load = x;
    for (Index k = 0; k < x.rows(); ++k)
    {
      x.row(k) = points.row(places[c][k]);
      load.row(k) = loads[c][k];
    }
    Points some = Points::Zero(static_cast<Index>(this->coupled_[c].size()), 3);
    this->leastSquares_[c].fitTranspose(x, load, some, this->processesOf(c));
    for (Index k = 0; k < some.rows(); ++k)
    {
      prescribed.row(this->coupled_[c][k]) += some.row(k);
    }
  }
}

double affineResidual(const Points& points, const std::vector<Index>& rows,
  const std::vector<Index>& columns, const CsrMatrix& interior, const CsrMatrix& coupling,
  Monitor& monitor)
{
  const auto count = static_cast<Index>(rows.size());
  std::vector<double> part(static_cast<std::size_t>((count + Grain - 1) / Grain), 0);
  parallel(static_cast<Index>(part.size()), 1, monitor,
    [&](Index p)
    {
      for (Index i = p * Grain; i < std::min(count, (p + 1) * Grain); ++i)
      {
        // The motions 1 and x: constants, and coordinates about the row's own node.
        const Eigen::RowVector3d center = points.row(rows[i]);
        Eigen::Array4d sum = Eigen::Array4d::Zero(), size = sum;
        const auto add = [&](double value, Index node)
        {
          Eigen::Array4d term;
          term << value, value * (points.row(node) - center).transpose().array();
          sum += term;
          size += term.abs();
        };
        for (CsrMatrix::InnerIterator entry(interior, i); entry; ++entry)
        {
          add(entry.value(), rows[entry.col()]);
        }
        for (CsrMatrix::InnerIterator entry(coupling, static_cast<int>(i)); entry; ++entry)
        {
          add(entry.value(), columns[entry.col()]);
        }
        const double scale = size.tail<3>().maxCoeff();
        const double missed = std::max(
          std::abs(sum[0]) / size[0], scale > 0 ? sum.tail<3>().abs().maxCoeff() / scale : 0.);
        part[p] = std::isfinite(missed) ? std::max(part[p], missed)
                                        : std::numeric_limits<double>::infinity();
      }
    });
  return part.empty() ? 0 : *std::max_element(part.begin(), part.end());
}

namespace
{
MultiVector toRows(const FourFields& fields, Monitor&)
{
  MultiVector rows(static_cast<std::size_t>(fields.rows()));
  for (Index i = 0; i < fields.rows(); ++i)
  {
    rows[i] = fields.row(i).transpose();
  }
  return rows;
}

/// rowComponents() of the rows of all processes. `ghosts`: the nodes of the ghosts' columns.
RowComponents componentsOf(const LinearEquations& equations, const std::vector<Index>& rows,
  const std::vector<Index>& ghosts, Index nodes, const Communicator& processes, Monitor& monitor)
{
  const RowComponents here = rowComponents(equations.matrix, monitor, equations.ghosts);
  std::vector<Index> ofNode(nodes, -1);
  Index next = 0;
  for (const std::vector<Index>* some : { &rows, &ghosts })
  {
    for (const Index node : *some)
    {
      ofNode[node] = here.of(next++);
    }
  }
  RowComponents result;
  result.count = processes.join(ofNode);
  std::transform(rows.begin(), rows.end(), std::back_inserter(result.ofRow),
    [&](Index node) { return static_cast<int>(ofNode[node]); });
  return result;
}
}

void DirichletMethod::setTolerance(double tolerance)
{
  if (!(tolerance > 0 && tolerance < 1))
  {
    std::ostringstream text;
    text << "The tolerance must lie between 0 and 1; it is " << tolerance << ".";
    throw Error(text.str());
  }
  this->tolerance_ = tolerance;
}

std::vector<Index> DirichletMethod::setRows(
  const Mesh& rest, const std::vector<Index>& rows, const ConnectedComponents& bodies)
{
  this->rows_ = unknownOrdering(rest, rows);
  if (this->rows_ == this->partition().free)
  {
    this->rows_ = {};
  }
  const std::vector<Index>& prescribed = this->partition().prescribed;
  std::vector<Index> columns = prescribed;
  for (const Index node : this->countedElsewhere())
  {
    if (bodies.ofNode[node] >= 0 && !std::binary_search(prescribed.begin(), prescribed.end(), node))
    {
      columns.push_back(node);
    }
  }
  return columns;
}

void DirichletMethod::setEquations(CsrMatrix& interior, CsrMatrix& coupling,
  const std::vector<Index>& columns, bool isUniform, Monitor& monitor)
{
  const Points& rest = this->restPoints();
  this->isUniform_ = isUniform;
  this->affineResidual_ = Unknown;
  LinearEquations equations;
  this->solver_ = this->processes().makeSolver(this->isSymmetric_);
  if (this->solver_) // of several processes, which takes the matrix
  {
    this->affineResidual_ = this->processes().maximum(
      morph::affineResidual(rest, this->rows(), columns, interior, coupling, monitor));
  }
  equations.matrix.swap(interior);
  if (this->solver_)
  {
    const auto held = static_cast<Index>(this->partition().prescribed.size());
    const std::vector<Index> ghosts(columns.begin() + held, columns.end());
    equations.ghosts = coupling.middleCols(held, coupling.cols() - held);
    coupling = CsrMatrix(coupling.middleCols(0, held));
    equations.ghostNumbers = this->processes().numbersOf(this->rows(), ghosts);
    equations.components =
      componentsOf(equations, this->rows(), ghosts, rest.rows(), this->processes(), monitor);
  }
  else if (this->isSymmetric_)
  {
    this->solver_ = std::make_shared<SpdSolver>();
  }
  else
  {
    this->solver_ = std::make_shared<GeneralSolver>();
  }
  equations.coordinates = rest(this->rows(), allColumns);
  this->coupling_.swap(coupling);
  try
  {
    this->solver_->prepare(std::move(equations), monitor);
  }
  catch (const SingularRows& error)
  {
    std::vector<Index> nodes;
    for (const Index row : error.rows())
    {
      nodes.push_back(this->rows()[row]);
    }
    this->throwSingular(nodes);
  }
  this->guess_ = AffineGuess(rest, this->partition(), this->rows(), this->solver_->components(),
    this->coupling_, this->processes());
}

void DirichletMethod::throwSingular(const std::vector<Index>& nodes) const
{
  throw Error(Error::Kind::Singular,
    "Every cell around node ids " + listIds(this->processes().gatherNodes(nodes)) +
      " has zero volume, so nothing says where they go. Prescribe them or repair the cells.");
}

double DirichletMethod::affineResidual(Monitor& monitor) const
{
  double value = this->affineResidual_;
  if (value == Unknown)
  {
    value = morph::affineResidual(this->restPoints(), this->rows(), this->partition().prescribed,
      this->solver_->matrix(), this->coupling_, monitor);
    this->affineResidual_ = value;
  }
  return value;
}

EvaluateReport DirichletMethod::report(const SolveReport& solved, Monitor& monitor) const
{
  reportRounding(solved, this->tolerance_, monitor);
  return { solved.iterations, solved.relativeResidual, this->statistics_ };
}

template <typename Columns>
EvaluateReport DirichletMethod::displaceColumns(
  const Columns& prescribed, Columns& free, Monitor& monitor) const
{
  constexpr double AffineShare = 0.01; // of the tolerance, within which a motion counts as affine
  const double affine = AffineShare * this->tolerance_;
  const Points& rest = this->restPoints();
  const NodePartition& partition = this->partition();
  const MultiVector given = toRows(prescribed, monitor);
  const AffineGuess::Fits fits = this->guess_.fits(given);
  MultiVector x(this->rows().size());
  parallel(static_cast<Index>(x.size()), Grain, monitor,
    [&](Index i)
    { x[i] = fits.displacement(this->guess_.component(i), rest.row(this->rows()[i])); });
  SolveReport solved;
  // A pass over the matrix takes longer than all else.
  const bool isAffine = this->guess_.agree(rest, partition, given, fits, affine) &&
                        (!this->isUniform_ || this->affineResidual(monitor) <= affine);
  if (!isAffine)
  {
    MultiVector rhs, fitted;
    if (!this->isUniform_)
    {
      this->guess_.takeOff(rest, partition, this->coupling_, given, fits, rhs, x, fitted, monitor);
    }
    solved = this->solver_->solve(
      this->isUniform_ ? RightHandSide(this->coupling_, given) : RightHandSide(rhs), x,
      this->tolerance_, MaxIterations, monitor);
    for (std::size_t i = 0; i < fitted.size(); ++i)
    {
      x[i] += fitted[i];
    }
  }
  parallel(static_cast<Index>(x.size()), Grain, monitor,
    [&](Index i)
    {
      free.row(indexInFree(this->rows(), partition.free, i)) =
        x[i].template head<Columns::ColsAtCompileTime>().transpose();
    });
  this->stars_.recover(prescribed, free, monitor);
  return this->report(solved, monitor);
}

EvaluateReport DirichletMethod::displace(
  const Points& prescribed, Points& free, Monitor& monitor) const
{
  return this->displaceColumns(prescribed, free, monitor);
}

EvaluateReport DirichletMethod::displaceFields(
  const FourFields& prescribed, FourFields& free, Monitor& monitor) const
{
  return this->displaceColumns(prescribed, free, monitor);
}

EvaluateReport DirichletMethod::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  // M = -A_I^-1 A_B, so M^T g = -A_B^T A_I^-T g.
  Points gradient = free;
  this->stars_.recoverTranspose(gradient, prescribed);
  Points rhs(static_cast<Index>(this->rows().size()), 3);
  for (Index i = 0; i < rhs.rows(); ++i)
  {
    rhs.row(i) = gradient.row(indexInFree(this->rows(), this->partition().free, i));
  }
  Points solution = Points::Zero(rhs.rows(), 3);
  const SolveReport solved =
    this->solver_->solveTransposed(rhs, solution, this->tolerance_, MaxIterations, monitor);
  prescribed -= this->coupling_.transpose() * solution;
  if (!this->isUniform_)
  {
    this->guess_.addTranspose(this->restPoints(), this->partition(), this->rows(), this->coupling_,
      rhs, solution, prescribed);
  }
  return this->report(solved, monitor);
}
}
