// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/CentreStars.h"
#include "Mesh/Mesh.h"
#include "Support/Adjacency.h"
#include "Support/Monitor.h"

#include <Eigen/Core>

#include <algorithm>
#include <cstdint>
#include <vector>

/// Stiffness matrices of elements while FEMWARP's equations are assembled from them.
namespace morph
{
/// Upper triangles of symmetric matrices, one after another.
struct Matrices
{
  std::vector<Index> start; ///< of each element
  Eigen::ArrayXd K; ///< not initialised by resize: each thread is the first to touch its part

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

/// Returns the matrices of all stars without their centres. Sets the weights of the centres, and
/// adds those without stiffness to `singularCentres`. `around`: nodeToCells(mesh).
Matrices starMatrices(const Mesh& mesh, const Adjacency& around, CellMatrix& cell,
  CentreStars& stars, std::vector<Index>& singularCentres, Monitor& monitor);

/// The matrices of the cells around the rows of one band at a time, as those of all cells of a
/// hexahedral mesh would take 0.3 kB a node. Cells of two bands are computed twice, with the same
/// result. A band has an eighth of the rows, and at least 65,536.
class CellMatrices
{
public:
  /// `starOf`: CentreStars::ofCell(); `column`: of each node, which is its row if it is less than
  /// `rows`, or -1.
  CellMatrices(const Mesh& mesh, const std::vector<int>& starOf, const std::vector<int>& column,
    Index rows, CellMatrix& cell, Monitor& monitor);

  /// Number of bands; at least one. The first one has the cells without a row, too.
  int size() const { return this->rows_ == 0 ? 1 : this->bandOf(this->rows_ - 1) + 1; }
  Index firstRow(int band) const { return band * this->bandRows_; }
  Index lastRow(int band) const { return std::min(this->rows_, this->firstRow(band + 1)); }

  /// Computes the matrices of a band; the others are lost.
  void compute(int band, Monitor& monitor);
  const double* of(Index cell) const { return this->matrices_.of(cell); }

private:
  /// The first and last band of a cell's rows; none by default.
  struct Bands
  {
    std::int8_t first = 1, last = 0;
  };

  int bandOf(Index row) const { return static_cast<int>(row / this->bandRows_); }
  Index entries(Index cell) const;
  /// Finds the blocks of cells in which each band has cells.
  void findBlocks();
  Bands bandsOf(Index cell, const std::vector<int>& column) const;

  const Mesh& mesh_;
  CellMatrix& cell_;
  Index bandRows_, rows_;
  std::vector<Bands> bands_;
  std::vector<std::vector<Index>> blocks_; ///< of each band, so that threads share its cells evenly
  Matrices matrices_;
};
}
