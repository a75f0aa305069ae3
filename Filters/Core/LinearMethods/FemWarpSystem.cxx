// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/FemWarpSystem.h"

#include "LinearMethods/ElementMatrices.h"
#include "LinearMethods/ElementStiffness.h"
#include "LinearMethods/SplitRows.h"
#include "Mesh/CellShape.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/Topology.h"
#include "Quality/ScaledJacobian.h"
#include "Solvers/LocalColumnMap.h"
#include "Support/Error.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace morph
{
namespace
{
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

/// A table of triangleIndex(n, a, b), for the assembly's inner loop.
struct TriangleTable
{
  static constexpr int Most = CentreStars::MostNodes;
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
/// sums do not depend on threads. Stars come last in all rows, so that the matrix is symmetric to
/// the last bit, except where edges of cells are collapsed.
SplitChunks gatherRows(const Mesh& mesh, const Adjacency& around, const std::vector<Index>& free,
  const std::vector<Index>& prescribed, const std::vector<double>& factors, CentreStars& stars,
  FemWarpSystem& system, Monitor& monitor)
{
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

  CellMatrix cellMatrix(mesh, factors, system.cellSign);
  const Matrices ofStars =
    starMatrices(mesh, around, cellMatrix, stars, system.singularCentres, monitor);
  CellMatrices ofCells(mesh, stars.ofCell(), column, rows, cellMatrix, monitor);

  // Visits the cells and stars around a row's free node, once for every corner that is this node.
  // A visit gets the nodes and the matrix, and the index of the corner's entries.
  const TriangleTable triangle;
  const std::vector<int>& starOf = stars.ofCell();
  int same[CentreStars::MostNodes];
  std::iota(std::begin(same), std::end(same), 0);
  const auto visit = [&](Index row, const auto& onCorner)
  {
    const Index node = free[row];
    for (const Index* cell = around.begin(node); cell != around.end(node); ++cell)
    {
      if (!starOf.empty() && starOf[*cell] >= 0)
      {
        continue;
      }
      const CellShape& shape = *cellShape(mesh.types[*cell]);
      const int* cornerNode = shape.cornerNode;
      const Index* nodes = mesh.cell(*cell);
      const double* K = ofCells.of(*cell);
      const int n = shape.numberOfCorners;
      for (int own = 0; own < n; ++own)
      {
        if (nodes[cornerNode[own]] == node) // true more than once in a collapsed cell
        {
          onCorner(nodes, cornerNode, n, K, triangle.at[n][own]);
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
      onCorner(nodes, same, n, ofStars.of(*star), triangle.at[n][own]);
    }
  };

  const auto makeRows = [&]
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
          int index[CentreStars::MostNodes];
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
  };

  SplitChunks chunks(rows, columns);
  for (int band = 0; band < ofCells.size(); ++band)
  {
    monitor.check();
    monitor.progress(0.5 * band / ofCells.size());
    ofCells.compute(band, monitor);
    monitor.check();
    monitor.progress(0.5 * (band + 0.6) / ofCells.size());
    splitRows(ofCells.firstRow(band), ofCells.lastRow(band), chunks, monitor, makeRows);
  }
  system.hasBadCells = cellMatrix.isAnyBad();
  return chunks;
}

}

FemWarpSystem femWarpSystem(const Mesh& mesh, const std::vector<Index>& rows,
  const std::vector<Index>& prescribed, const std::vector<double>& factors, Monitor& monitor)
{
  CentreStars none;
  return femWarpSystem(mesh, nodeToCells(mesh, monitor), rows, prescribed, factors, none, monitor);
}

FemWarpSystem femWarpSystem(const Mesh& mesh, Adjacency around, const std::vector<Index>& rows,
  const std::vector<Index>& prescribed, const std::vector<double>& factors, CentreStars& stars,
  Monitor& monitor)
{
  FemWarpSystem system;
  // Frees the elements' matrices here, before rows are joined.
  SplitChunks chunks = gatherRows(mesh, around, rows, prescribed, factors, stars, system, monitor);
  around = {};
  monitor.check();
  monitor.progress(0.5);
  system.interior = std::move(chunks.interior);
  joinRows(std::move(chunks.coupling), system.coupling, monitor);
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
    if (numberOfCorners(cellShape(mesh.types[c])->shape) == 0)
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
  return text + " Repair the reference mesh if you can.";
}
}
