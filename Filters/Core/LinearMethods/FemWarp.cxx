// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/FemWarp.h"

#include "LinearMethods/ElementStiffness.h"
#include "LinearMethods/SplitRows.h"
#include "LinearMethods/StiffnessFactors.h"
#include "Mesh/CellShape.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/Topology.h"
#include "Mesh/UnknownOrdering.h"
#include "Quality/ScaledJacobian.h"
#include "Solvers/LocalColumnMap.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"

#include <algorithm>

namespace morph
{
namespace
{
constexpr Index Grain = 4096;
constexpr int MaxIterations = 2000;
constexpr std::size_t MostIds = 100; // in a warning

/// Stiffness matrices of all volume cells, upper triangles one after another.
struct CellMatrices
{
  std::vector<Index> start; ///< #cells + 1
  Eigen::ArrayXd K; ///< not initialised by resize: each thread is the first to touch its part
};

/// Whether two corners of a cell coincide, as in a hexahedron that is used as a wedge.
bool isCollapsed(const Mesh& mesh, Index cell)
{
  const CellShape& shape = *cellShape(mesh.types[cell]);
  for (int a = 0; a < shape.numberOfCorners; ++a)
  {
    for (int b = 0; b < a; ++b)
    {
      if (mesh.points.row(mesh.cell(cell)[a]) == mesh.points.row(mesh.cell(cell)[b]))
      {
        return true;
      }
    }
  }
  return false;
}

/// Warns of cells that are inverted by their scaled Jacobian or have no usable volume. `sign`:
/// #cells, from elementStiffness().
void reportBadCells(const Mesh& mesh, const ConnectedComponents& bodies,
  const std::vector<std::int8_t>& sign, Monitor& monitor)
{
  const std::vector<std::int8_t> expected = cellSigns(mesh, bodies);
  // The method reads no other nodes of quadratic cells.
  const Quality quality = measureCorners(mesh, mesh.points, expected, {}, monitor);
  std::vector<Index> inverted, flat;
  Index absolute = 0;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (numberOfCorners(cellShape(mesh.types[c])->shape) == 0)
    {
      continue;
    }
    const double jacobian = quality.scaledJacobian[c];
    const bool unusable = sign[c] != expected[c];
    absolute += unusable;
    if (jacobian < 0 || (jacobian == 0 && !unusable && !isCollapsed(mesh, c)))
    {
      inverted.push_back(c);
    }
    else if (unusable)
    {
      flat.push_back(c);
    }
  }
  if (inverted.empty() && flat.empty())
  {
    return;
  }
  std::string text = "The reference mesh has";
  if (!inverted.empty())
  {
    text +=
      " " + std::to_string(inverted.size()) + " inverted cells: ids " + listIds(inverted, MostIds);
  }
  if (!flat.empty())
  {
    text += std::string(inverted.empty() ? " " : ", and ") + std::to_string(flat.size()) +
            " cells of zero volume or nearly so: ids " + listIds(flat, MostIds);
  }
  text += ".";
  if (absolute > 0)
  {
    text += " " + std::to_string(absolute) +
            " of them enter with absolute volumes, so near them affine motions are reproduced "
            "approximately.";
  }
  monitor.warn(text + " Repair the reference mesh if you can.");
}

/// `factors`: of the cells; none: 1.
CellMatrices cellMatrices(const Mesh& mesh, const ConnectedComponents& bodies,
  const std::vector<double>& factors, Monitor& monitor)
{
  const Index cells = mesh.numberOfCells();
  CellMatrices result;
  result.start.assign(cells + 1, 0);
  for (Index c = 0; c < cells; ++c)
  {
    result.start[c + 1] =
      result.start[c] + triangleSize(numberOfCorners(cellShape(mesh.types[c])->shape));
  }
  result.K.resize(result.start.back());

  std::vector<std::int8_t> sign(cells, 1);
  std::vector<std::uint8_t> isBad(cells, 0);
  monitor.parallelFor(cells, Grain,
    [&](Index first, Index last)
    {
      for (Index c = first; c < last; ++c)
      {
        const CellShape& shape = *cellShape(mesh.types[c]);
        const int n = numberOfCorners(shape.shape);
        if (n == 0)
        {
          continue;
        }
        double corners[8][3];
        copyCorners(mesh, c, shape, mesh.points, corners[0]);
        sign[c] = static_cast<std::int8_t>(
          elementStiffness(shape.shape, corners, result.K.data() + result.start[c]));
        if (!factors.empty())
        {
          result.K.segment(result.start[c], triangleSize(n)) *= factors[c];
        }
        // The sign of a tetrahedron or pyramid is that of its corners.
        const bool isElsewhere = shape.shape == Shape::Hex || shape.shape == Shape::Wedge;
        isBad[c] =
          sign[c] != 1 || (isElsewhere && !areCornersSurelyPositive(shape.shape, corners) &&
                            !(scaledJacobian(mesh.types[c], corners) > 0));
      }
    });
  if (std::find(isBad.begin(), isBad.end(), 1) != isBad.end())
  {
    reportBadCells(mesh, bodies, sign, monitor);
  }
  return result;
}

/// A table of triangleIndex(n, a, b) for n up to 8, for the assembly's inner loop.
struct TriangleTable
{
  std::uint8_t at[9][8][8] = {};
  TriangleTable()
  {
    for (int n = 1; n <= 8; ++n)
    {
      for (int a = 0; a < n; ++a)
      {
        for (int b = 0; b < n; ++b)
        {
          this->at[n][a][b] = static_cast<std::uint8_t>(triangleIndex(n, a, b));
        }
      }
    }
  }
};

struct System
{
  CsrMatrix interior; ///< A_I, #free x #free
  CsrMatrix coupling; ///< A_B, #free x #prescribed
};

/// Sorts the columns of one row.
class ColumnRanks
{
public:
  /// Returns for each of the distinct `columns` its rank.
  const std::vector<int>& of(const std::vector<int>& columns)
  {
    const int n = static_cast<int>(columns.size());
    this->ranks_.resize(n);
    if (n > MostCounted)
    {
      this->sorted_ = columns;
      std::sort(this->sorted_.begin(), this->sorted_.end());
      for (int i = 0; i < n; ++i)
      {
        this->ranks_[i] = static_cast<int>(
          std::lower_bound(this->sorted_.begin(), this->sorted_.end(), columns[i]) -
          this->sorted_.begin());
      }
      return this->ranks_;
    }
    const int* all = columns.data();
    for (int i = 0; i < n; ++i)
    {
      int less = 0;
      for (int j = 0; j < n; ++j)
      {
        less += all[j] < all[i];
      }
      this->ranks_[i] = less;
    }
    return this->ranks_;
  }

private:
  static constexpr int MostCounted = 96; // counting has no branches to mispredict, unlike sorting

  std::vector<int> ranks_, sorted_;
};

/// Gathers the rows of the free nodes from their cells, in ascending order of the cells. So the
/// sums do not depend on threads.
std::vector<SplitRows> gatherRows(const Mesh& mesh, const ConnectedComponents& bodies,
  const std::vector<double>& factors, const std::vector<Index>& free,
  const std::vector<Index>& prescribed, Monitor& monitor)
{
  const CellMatrices matrices = cellMatrices(mesh, bodies, factors, monitor);
  monitor.check();
  monitor.progress(0.3);
  const Adjacency around = nodeToCells(mesh);

  // Columns of [A_I A_B]: the free nodes by row, then the prescribed nodes.
  const Index rows = static_cast<Index>(free.size());
  const Index columns = static_cast<Index>(prescribed.size());
  std::vector<int> column(mesh.numberOfNodes(), -1);
  for (Index i = 0; i < rows; ++i)
  {
    column[free[i]] = static_cast<int>(i);
  }
  for (Index i = 0; i < columns; ++i)
  {
    column[prescribed[i]] = static_cast<int>(rows + i);
  }

  // Visits the cells around a row's free node, once for every corner that is this node. A visit
  // gets the cell's nodes and matrix, and the index of the corner's entries.
  const TriangleTable triangle;
  const auto visit = [&](Index row, const auto& onCorner)
  {
    const Index node = free[row];
    for (const Index* cell = around.begin(node); cell != around.end(node); ++cell)
    {
      const CellShape& shape = *cellShape(mesh.types[*cell]);
      const int* cornerNode = shape.cornerNode;
      const Index* nodes = mesh.cell(*cell);
      const double* K = matrices.K.data() + matrices.start[*cell];
      const int n = shape.numberOfCorners;
      for (int own = 0; own < n; ++own)
      {
        if (nodes[cornerNode[own]] == node) // true more than once in a collapsed cell
        {
          onCorner(nodes, cornerNode, n, K, triangle.at[n][own]);
        }
      }
    }
  };

  return splitRows(rows, monitor,
    [&]
    {
      return [&, local = LocalColumnMap(), ranks = ColumnRanks(), columnsHere = std::vector<int>(),
               values = std::vector<double>()](Index row, SplitRows& chunk) mutable
      {
        values.clear();
        local.clear();
        visit(row,
          [&](const Index* nodes, const int* cornerNode, int n, const double* K,
            const std::uint8_t* entry)
          {
            int index[8];
            for (int a = 0; a < n; ++a)
            {
              index[a] = local.localIndex(column[nodes[cornerNode[a]]]);
            }
            // adding any number to -0 gives this number, also for zeros
            values.resize(local.size(), -0.);
            double* sums = values.data();
            for (int a = 0; a < n; ++a)
            {
              sums[index[a]] += K[entry[a]];
            }
          });
        columnsHere.resize(values.size());
        int inside = 0;
        for (std::size_t k = 0; k < values.size(); ++k)
        {
          columnsHere[k] = local.column(static_cast<int>(k));
          inside += columnsHere[k] < rows;
        }
        const int outside = static_cast<int>(values.size()) - inside;
        const std::vector<int>& rank = ranks.of(columnsHere);
        const auto open = [](SplitRows::Part& part, int size)
        {
          const std::size_t before = part.column.size();
          part.size.push_back(size);
          part.column.resize(before + size);
          part.value.resize(before + size);
          return before;
        };
        const std::size_t firstInside = open(chunk.interior, inside);
        const std::size_t firstOutside = open(chunk.coupling, outside);
        for (std::size_t k = 0; k < values.size(); ++k)
        {
          const bool isInside = rank[k] < inside; // the free nodes' columns come first
          SplitRows::Part& part = isInside ? chunk.interior : chunk.coupling;
          const std::size_t at = isInside ? firstInside + rank[k] : firstOutside + rank[k] - inside;
          part.column[at] = static_cast<int>(isInside ? columnsHere[k] : columnsHere[k] - rows);
          part.value[at] = values[k];
        }
      };
    });
}

System assemble(const Mesh& mesh, const ConnectedComponents& bodies,
  const std::vector<double>& factors, const std::vector<Index>& free,
  const std::vector<Index>& prescribed, Monitor& monitor)
{
  // Frees the cells' matrices before the rows are joined.
  std::vector<SplitRows> chunks = gatherRows(mesh, bodies, factors, free, prescribed, monitor);
  monitor.check();
  monitor.progress(0.5);
  System system;
  joinRows(system.interior, static_cast<Index>(free.size()), chunks, &SplitRows::interior, monitor);
  joinRows(
    system.coupling, static_cast<Index>(prescribed.size()), chunks, &SplitRows::coupling, monitor);
  return system;
}
}

void FemWarp::setTolerance(double tolerance)
{
  requireTolerance(tolerance);
  this->tolerance_ = tolerance;
}

void FemWarp::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const NodePartition& partition = this->partition();
  const ConnectedComponents parts = connectedComponents(rest);
  requirePrescribedBodies(rest, parts, partition);
  this->rows_ = unknownOrdering(rest, partition.free);
  const std::vector<double> factors =
    stiffnessFactors(rest, partition.prescribed, this->stiffness(), monitor);
  this->isUniform_ = factors.empty();
  System system = assemble(rest, parts, factors, this->rows_, partition.prescribed, monitor);
  monitor.check();
  monitor.progress(0.6);

  const Points coordinates = rest.points(this->rows_, allColumns);
  this->coupling_.swap(system.coupling);
  try
  {
    ProgressRange last(monitor, 0.6, 1);
    this->solver_.prepare(system.interior, coordinates, last);
  }
  catch (const SingularRows& error)
  {
    std::vector<Index> nodes;
    for (Index row : error.rows())
    {
      nodes.push_back(this->rows_[row]);
    }
    throw Error(Error::Kind::Singular,
      "Every cell around node ids " + listIds(nodes) +
        " has zero volume, so nothing says where they go. Prescribe them or repair the cells.");
  }
  this->guess_ = AffineGuess(rest.points, partition, this->solver_.components(), this->coupling_);
}

EvaluateReport FemWarp::displace(const Points& prescribed, Points& free, Monitor& monitor) const
{
  Points rhs, x, fitted;
  rightHandSideAndGuess(
    this->restPoints(), this->rows_, this->guess_, this->coupling_, prescribed, rhs, x, monitor);
  if (!this->isUniform_)
  {
    this->guess_.takeOff(
      this->restPoints(), this->partition(), this->coupling_, prescribed, rhs, x, fitted, monitor);
  }
  const SolveReport report = this->solver_.solve(rhs, x, this->tolerance_, MaxIterations, monitor);
  reportRounding(report, this->tolerance_, monitor);
  if (!this->isUniform_)
  {
    x += fitted;
  }
  unpermute(x, this->rows_, this->partition(), free, monitor);
  return { report.iterations, report.relativeResidual, report.bytesMoved, {} };
}

EvaluateReport FemWarp::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  // M = -A_I^-1 A_B and A_I is symmetric, so M^T g = -A_B^T A_I^-1 g.
  const Points rhs = permute(free, this->rows_, this->partition());
  Points solution = Points::Zero(free.rows(), 3);
  const SolveReport report =
    this->solver_.solve(rhs, solution, this->tolerance_, MaxIterations, monitor);
  reportRounding(report, this->tolerance_, monitor);
  prescribed -= this->coupling_.transpose() * solution;
  if (!this->isUniform_)
  {
    this->guess_.addTranspose(this->restPoints(), this->partition(), this->rows_, this->coupling_,
      rhs, solution, prescribed);
  }
  return { report.iterations, report.relativeResidual, report.bytesMoved, {} };
}

std::size_t FemWarp::memory() const
{
  const NodePartition& partition = this->partition();
  return this->solver_.memory() + this->guess_.memory() +
         12 * static_cast<std::size_t>(this->coupling_.nonZeros()) + 4 * this->coupling_.rows() +
         24 * this->restPoints().rows() +
         8 * (partition.free.size() + partition.prescribed.size() + this->rows_.size());
}
}
