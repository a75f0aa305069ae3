// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/FemWarp.h"

#include "LinearMethods/ElementStiffness.h"
#include "Mesh/CellShape.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/Topology.h"
#include "Mesh/UnknownOrdering.h"
#include "Quality/ScaledJacobian.h"
#include "Solvers/RowPlaces.h"
#include "Support/Error.h"

#include <algorithm>
#include <utility>

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

/// Whether two corners of a cell are in one place, as in a hexahedron that is used as a wedge.
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

/// Warns of cells that are inverted by their scaled Jacobian or that have no usable volume.
/// `sign`: #cells, from elementStiffness().
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

CellMatrices cellMatrices(const Mesh& mesh, const ConnectedComponents& bodies, Monitor& monitor)
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
        for (int a = 0; a < n; ++a)
        {
          const auto point = mesh.points.row(mesh.cell(c)[shape.cornerNode[a]]);
          std::copy(point.data(), point.data() + 3, corners[a]);
        }
        sign[c] = static_cast<std::int8_t>(
          elementStiffness(shape.shape, corners, result.K.data() + result.start[c]));
        isBad[c] = sign[c] != 1 || !(scaledJacobian(mesh.types[c], corners) > 0);
      }
    });
  if (std::find(isBad.begin(), isBad.end(), 1) != isBad.end())
  {
    reportBadCells(mesh, bodies, sign, monitor);
  }
  return result;
}

/// triangleIndex(n, a, b) of every n up to 8, looked up: the assembly's inner loop.
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

/// Entries of the free nodes' rows, gathered node by node from the cells around, in ascending order
/// of the cells: the sums do not depend on the threads.
System assemble(const Mesh& mesh, const ConnectedComponents& bodies, const std::vector<Index>& free,
  const std::vector<Index>& prescribed, Monitor& monitor)
{
  const CellMatrices matrices = cellMatrices(mesh, bodies, monitor);
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

  // Visits every corner of every cell around the free node of a row, and its share of the row.
  const TriangleTable triangle;
  const auto visit = [&](Index row, const auto& onEntry)
  {
    const Index node = free[row];
    for (const Index* cell = around.begin(node); cell != around.end(node); ++cell)
    {
      const CellShape& shape = *cellShape(mesh.types[*cell]);
      const Index* nodes = mesh.cell(*cell);
      const double* K = matrices.K.data() + matrices.start[*cell];
      const int n = shape.numberOfCorners;
      for (int own = 0; own < n; ++own)
      {
        if (nodes[shape.cornerNode[own]] != node) // true more than once in a collapsed cell
        {
          continue;
        }
        const std::uint8_t* entry = triangle.at[n][own];
        for (int a = 0; a < n; ++a)
        {
          onEntry(column[nodes[shape.cornerNode[a]]], K[entry[a]]);
        }
      }
    }
  };

  std::vector<int> interiorSize(rows + 1, 0), couplingSize(rows + 1, 0);
  monitor.parallelFor(rows, Grain,
    [&](Index first, Index last)
    {
      RowPlaces places;
      for (Index row = first; row < last; ++row)
      {
        int inside = 0, outside = 0;
        places.clear();
        visit(row,
          [&](int at, double)
          {
            const int known = places.size();
            if (places.find(at) == known)
            {
              ++(at < rows ? inside : outside);
            }
          });
        interiorSize[row + 1] = inside;
        couplingSize[row + 1] = outside;
      }
    });
  monitor.check();
  monitor.progress(0.4);

  System system;
  allocateRows(system.interior, rows, interiorSize);
  allocateRows(system.coupling, columns, couplingSize);

  monitor.parallelFor(rows, Grain,
    [&](Index first, Index last)
    {
      RowPlaces places; // of the columns in `entries`
      std::vector<std::pair<int, double>> entries;
      for (Index row = first; row < last; ++row)
      {
        entries.clear();
        places.clear();
        visit(row,
          [&](int at, double value)
          {
            const std::size_t place = static_cast<std::size_t>(places.find(at));
            if (place < entries.size())
            {
              entries[place].second += value;
              return;
            }
            entries.emplace_back(at, value);
          });
        std::sort(entries.begin(), entries.end(),
          [](const auto& a, const auto& b) { return a.first < b.first; });
        int inside = system.interior.outerIndexPtr()[row];
        int outside = system.coupling.outerIndexPtr()[row];
        for (const auto& [at, value] : entries)
        {
          if (at < rows)
          {
            system.interior.innerIndexPtr()[inside] = at;
            system.interior.valuePtr()[inside++] = value;
          }
          else
          {
            system.coupling.innerIndexPtr()[outside] = static_cast<int>(at - rows);
            system.coupling.valuePtr()[outside++] = value;
          }
        }
      }
    });
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
  System system = assemble(rest, parts, this->rows_, partition.prescribed, monitor);
  monitor.check();
  monitor.progress(0.6);

  const Points coordinates = rowPositions(rest.points, this->rows_);
  this->coupling_.swap(system.coupling);
  try
  {
    this->solver_.prepare(system.interior, coordinates, monitor);
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
  Points rhs, x;
  rightHandSideAndGuess(
    this->restPoints(), this->rows_, this->guess_, this->coupling_, prescribed, rhs, x, monitor);
  const SolveReport report = this->solver_.solve(rhs, x, this->tolerance_, MaxIterations, monitor);
  reportRounding(report, this->tolerance_, monitor);
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
