// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/FemWarp.h"

#include "LinearMethods/CenterStars.h"
#include "LinearMethods/ElementStiffness.h"
#include "Mesh/CellShape.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/StandingCells.h"
#include "Mesh/Topology.h"
#include "Quality/ScaledJacobian.h"
#include "Solvers/CsrMatrix.h"
#include "Support/Error.h"
#include "Support/Monitor.h"
#include "Support/Parallel.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace morph
{
namespace
{
/// Upper triangles of symmetric matrices, one after another.
struct Matrices
{
  std::vector<Index> start; ///< of each element
  Eigen::ArrayXd K; ///< not initialized by resize: each thread is the first to touch its part

  double* of(Index element) { return this->K.data() + this->start[element]; }
  const double* of(Index element) const { return this->K.data() + this->start[element]; }
};

/// Computes the matrices of single cells, and notes what is wrong with the cells.
class CellMatrix
{
public:
  /// `factors`: of the cells' stiffness; none: 1. `sign`: becomes elementStiffness() of each cell,
  /// 1 for cells that are not computed.
  CellMatrix(const Mesh& mesh, const std::vector<double>& factors, std::vector<std::int8_t>& sign);

  /// Sets K of cell c; threads may call it for different volume cells.
  void compute(Index c, double* K);
  /// Whether a cell may be inverted or flat.
  bool isAnyBad() const;

private:
  const Mesh& mesh_;
  const std::vector<double>& factors_;
  std::vector<std::int8_t>& sign_;
  std::vector<std::uint8_t> isBad_;
};

CellMatrix::CellMatrix(
  const Mesh& mesh, const std::vector<double>& factors, std::vector<std::int8_t>& sign)
  : mesh_(mesh)
  , factors_(factors)
  , sign_(sign)
  , isBad_(mesh.numberOfCells(), 0)
{
  sign.assign(mesh.numberOfCells(), 1);
}

void CellMatrix::compute(Index c, double* K)
{
  const CellShape& shape = *cellShape(this->mesh_, c);
  double corners[8][3];
  copyStanding(this->mesh_, c, shape, this->mesh_.points, corners[0]);
  const int sign = elementStiffness(shape.shape, corners, K);
  this->sign_[c] = static_cast<std::int8_t>(sign);
  if (!this->factors_.empty())
  {
    Eigen::Map<Eigen::ArrayXd>(K, triangleSize(numberOfCorners(shape.shape))) *= this->factors_[c];
  }
  // The sign of a tetrahedron or pyramid is that of its corners.
  const bool isElsewhere = shape.shape == Shape::Hex || shape.shape == Shape::Wedge;
  this->isBad_[c] = sign != 1 || (isElsewhere && !(scaledJacobian(shape, corners) > 0));
}

bool CellMatrix::isAnyBad() const
{
  return std::find(this->isBad_.begin(), this->isBad_.end(), 1) != this->isBad_.end();
}

/// Sets K of a star, eliminates its center, and sets the center's weights. Returns false where the
/// center has no stiffness.
bool starMatrix(const Mesh& mesh, const Adjacency& around, CellMatrix& cell, CenterStars& stars,
  Index star, double* K)
{
  const Index* nodes = stars.nodes().begin(star);
  const auto n = static_cast<int>(stars.nodes().end(star) - nodes);
  double sum[CenterStars::MostNodes + 1][CenterStars::MostNodes + 1] = {}; // the center is last
  const Index center = stars.center(star);
  for (const Index* c = around.begin(center); c != around.end(center); ++c)
  {
    double part[triangleSize(8)];
    cell.compute(*c, part);
    const CellShape& shape = *cellShape(mesh.types[*c]);
    int place[8];
    for (int a = 0; a < shape.numberOfCorners; ++a)
    {
      const Index node = mesh.cell(*c)[shape.cornerNode[a]];
      place[a] =
        node == center ? n : static_cast<int>(std::lower_bound(nodes, nodes + n, node) - nodes);
    }
    for (int a = 0, k = 0; a < shape.numberOfCorners; ++a)
    {
      for (int b = a; b < shape.numberOfCorners; ++b, ++k)
      {
        const bool isTwice = a != b && place[a] == place[b]; // (a, b) and (b, a)
        sum[std::min(place[a], place[b])][std::max(place[a], place[b])] +=
          isTwice ? 2 * part[k] : part[k];
      }
    }
  }
  const double diagonal = sum[n][n];
  const bool isUsable = diagonal > 0 && std::isfinite(diagonal) && std::isfinite(1 / diagonal);
  const double inverse = isUsable ? 1 / diagonal : 0;
  for (int a = 0, k = 0; a < n; ++a)
  {
    stars.weights(star)[a] = -sum[a][n] * inverse;
    for (int b = a; b < n; ++b, ++k)
    {
      K[k] = sum[a][b] + stars.weights(star)[a] * sum[b][n];
    }
  }
  return isUsable;
}

/// Returns the matrices of all stars without their centers. Sets the weights of the centers, and
/// adds those without stiffness to `singularCenters`. `around`: nodeToCells(mesh).
Matrices starMatrices(const Mesh& mesh, const Adjacency& around, CellMatrix& cell,
  CenterStars& stars, std::vector<Index>& singularCenters, Monitor& monitor)
{
  Matrices result;
  Index entries = 0;
  for (Index s = 0; s < stars.size(); ++s)
  {
    result.start.push_back(entries);
    entries += triangleSize(static_cast<int>(stars.nodes().end(s) - stars.nodes().begin(s)));
  }
  result.K.resize(entries);
  std::vector<std::uint8_t> isUsable(stars.size(), 1);
  parallel(stars.size(), monitor,
    [&](Index s) { isUsable[s] = starMatrix(mesh, around, cell, stars, s, result.of(s)); });
  for (Index s = 0; s < stars.size(); ++s)
  {
    if (!isUsable[s])
    {
      singularCenters.push_back(stars.center(s));
    }
  }
  return result;
}

/// Returns the matrices of all cells, without those in stars. `starOf`: CenterStars::ofCell(). They
/// take 0.3 kB a cell of a hexahedral mesh.
Matrices cellMatrices(
  const Mesh& mesh, const std::vector<int>& starOf, CellMatrix& cell, Monitor& monitor)
{
  const auto entriesOf = [&](Index c)
  {
    const bool isInStar = !starOf.empty() && starOf[c] >= 0;
    return isInStar ? 0 : triangleSize(numberOfCorners(cellShape(mesh, c)->shape));
  };
  Matrices result;
  result.start.resize(mesh.numberOfCells());
  Index entries = 0;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    result.start[c] = entries;
    entries += entriesOf(c);
  }
  result.K.resize(entries);
  parallel(mesh.numberOfCells(), monitor,
    [&](Index c)
    {
      if (entriesOf(c) > 0)
      {
        cell.compute(c, result.of(c));
      }
    });
  return result;
}

/// Whether two corners of a cell coincide, as in a hexahedron that is used as a wedge.
bool isCollapsed(const Mesh& mesh, Index cell)
{
  const CellShape& shape = *cellShape(mesh, cell);
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

/// A table of triangleIndex(n, a, b), for the assembly's inner loop.
struct TriangleTable
{
  static constexpr int Most = CenterStars::MostNodes;
  std::uint8_t at[Most + 1][Most][Most] = {};
  TriangleTable()
  {
    for (int n = 1; n <= Most; ++n)
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

/// Gathers the rows of the free nodes from their cells, in ascending order of the cells. So the
/// sums do not depend on threads. Stars come last in all rows, so that the matrix is symmetric to
/// the last bit, except where edges of cells are collapsed.
SplitMatrix gatherRows(const Mesh& mesh, Adjacency& around, const std::vector<Index>& free,
  const std::vector<Index>& prescribed, const std::vector<double>& factors, CenterStars& stars,
  FemWarpSystem& system, Monitor& monitor)
{
  // Columns of [A_I A_B]: the free nodes by row, then the prescribed nodes.
  const Index rows = static_cast<Index>(free.size());
  const Index columns = rows + static_cast<Index>(prescribed.size());
  std::vector<int> column(mesh.numberOfNodes(), -1);
  for (Index i = 0; i < columns; ++i)
  {
    column[i < rows ? free[i] : prescribed[i - rows]] = static_cast<int>(i);
  }

  CellMatrix cellMatrix(mesh, factors, system.cellSign);
  const Matrices ofStars =
    starMatrices(mesh, around, cellMatrix, stars, system.singularCenters, monitor);
  const std::vector<int>& starOf = stars.ofCell();
  Matrices ofCells = cellMatrices(mesh, starOf, cellMatrix, monitor);
  system.hasBadCells = cellMatrix.isAnyBad();
  monitor.check();
  monitor.progress(0.3);

  const TriangleTable triangle;
  int same[CenterStars::MostNodes];
  std::iota(std::begin(same), std::end(same), 0);
  // Adds the row of a corner of a cell or star with this matrix.
  const auto addCorner = [&](SparseRow& row, const Index* nodes, const int* cornerNode, int n,
                           const double* K, std::ptrdiff_t own)
  {
    const std::uint8_t* entry = triangle.at[n][own];
    for (int a = 0; a < n; ++a)
    {
      row.add(column[nodes[cornerNode[a]]], K[entry[a]]);
    }
  };
  const MakeRow makeRow = [&](Index i, SparseRow& row)
  {
    const Index node = free[i];
    for (const Index* cell = around.begin(node); cell != around.end(node); ++cell)
    {
      const CellShape& shape = *cellShape(mesh.types[*cell]);
      const Index* nodes = mesh.cell(*cell);
      const bool isInStar = !starOf.empty() && starOf[*cell] >= 0;
      const int n = isInStar ? 0 : shape.numberOfCorners;
      for (int own = 0; own < n; ++own)
      {
        if (nodes[shape.cornerNode[own]] == node) // true more than once in a collapsed cell
        {
          addCorner(row, nodes, shape.cornerNode, n, ofCells.of(*cell), own);
        }
      }
    }
    if (starOf.empty())
    {
      return;
    }
    for (const Index* star = stars.ofNode().begin(node); star != stars.ofNode().end(node); ++star)
    {
      const Index* nodes = stars.nodes().begin(*star);
      const auto n = static_cast<int>(stars.nodes().end(*star) - nodes);
      const auto own = std::lower_bound(nodes, nodes + n, node) - nodes;
      addCorner(row, nodes, same, n, ofStars.of(*star), own);
    }
  };
  const auto allMade = [&]
  {
    ofCells = {};
    around = {};
  };
  return assembleRows(
    rows, rows, columns, monitor, [&] { return makeRow; }, allMade);
}
}

FemWarpSystem femWarpSystem(const Mesh& mesh, const std::vector<Index>& rows,
  const std::vector<Index>& prescribed, const std::vector<double>& factors, Monitor& monitor)
{
  CenterStars none;
  return femWarpSystem(mesh, nodeToCells(mesh, monitor), rows, prescribed, factors, none, monitor);
}

FemWarpSystem femWarpSystem(const Mesh& mesh, Adjacency around, const std::vector<Index>& rows,
  const std::vector<Index>& prescribed, const std::vector<double>& factors, CenterStars& stars,
  Monitor& monitor)
{
  FemWarpSystem system;
  SplitMatrix matrix = gatherRows(mesh, around, rows, prescribed, factors, stars, system, monitor);
  monitor.check();
  monitor.progress(0.5);
  system.interior.swap(matrix.inside); // Eigen 3.4 would copy on a move
  system.coupling.swap(matrix.outside);
  return system;
}

BadCells badCells(const Mesh& mesh, const std::vector<std::int8_t>& expected,
  const std::vector<std::int8_t>& sign, Monitor& monitor)
{
  // The method reads no other nodes of quadratic cells.
  const Quality quality = measureCorners(mesh, mesh.points, expected, {}, monitor);
  BadCells bad;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (!hasCorners(mesh, c))
    {
      continue;
    }
    const double jacobian = quality.scaledJacobian[c];
    const bool unusable = sign[c] != expected[c];
    if (unusable)
    {
      bad.absolute.push_back(c);
    }
    if (jacobian < 0 || (jacobian == 0 && !unusable && !isCollapsed(mesh, c)))
    {
      bad.inverted.push_back(c);
    }
    else if (unusable)
    {
      bad.flat.push_back(c);
    }
  }
  return bad;
}

std::string describe(const BadCells& bad)
{
  if (bad.inverted.empty() && bad.flat.empty())
  {
    return {};
  }
  std::string text = "The reference mesh has";
  if (!bad.inverted.empty())
  {
    text +=
      " " + std::to_string(bad.inverted.size()) + " inverted cells: ids " + listIds(bad.inverted);
  }
  if (!bad.flat.empty())
  {
    text += std::string(bad.inverted.empty() ? " " : ", and ") + std::to_string(bad.flat.size()) +
            " cells of zero volume or nearly so: ids " + listIds(bad.flat);
  }
  text += ".";
  if (!bad.absolute.empty())
  {
    text += " " + std::to_string(bad.absolute.size()) +
            " of them enter with absolute volumes, so near them affine motions are reproduced "
            "approximately.";
  }
  return text;
}

void FemWarp::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const NodePartition& partition = this->partition();
  const Communicator& processes = this->processes();
  const ConnectedComponents parts = connectedComponents(rest, monitor, processes);
  requirePrescribedBodies(parts, partition, processes);
  const std::vector<double> factors =
    stiffnessFactors(rest, partition.prescribed, this->stiffness(), monitor, processes);
  const bool isUniform = processes.all(factors.empty()); // a process may have no cells
  Adjacency around = nodeToCells(rest, monitor);
  // Where the stiffness varies, the fit that is taken off would have to be taken off centers, too.
  this->stars_ =
    isUniform ? CenterStars(rest, partition.free, this->firstCenter(), around) : CenterStars();
  if (this->stars_.size() == static_cast<Index>(partition.free.size()))
  {
    this->stars_ = CenterStars(); // a matrix without rows is none
  }
  const std::vector<Index> columns =
    this->setRows(rest, this->stars_.others(partition.free), parts);
  FemWarpSystem system =
    femWarpSystem(rest, std::move(around), this->rows(), columns, factors, this->stars_, monitor);
  this->stars_.assembled(rest.numberOfNodes(), partition);
  if (!processes.all(!system.hasBadCells))
  {
    BadCells bad =
      badCells(rest, cellSigns(rest, parts, monitor, processes), system.cellSign, monitor);
    for (std::vector<Index>* cells : { &bad.inverted, &bad.flat, &bad.absolute })
    {
      *cells = processes.gatherCells(*cells);
    }
    const std::string warning = describe(bad);
    if (!warning.empty())
    {
      monitor.warn(warning);
    }
  }
  if (!processes.all(system.singularCenters.empty()))
  {
    this->throwSingular(system.singularCenters);
  }
  monitor.check();
  monitor.progress(0.6);
  ProgressRange last(monitor, 0.6, 1);
  this->setEquations(system.interior, system.coupling, columns, isUniform, last);
}
}
