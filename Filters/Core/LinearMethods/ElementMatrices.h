// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/CenterStars.h"
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

/// Returns the matrices of all stars without their centers. Sets the weights of the centers, and
/// adds those without stiffness to `singularCenters`. `around`: nodeToCells(mesh).
Matrices starMatrices(const Mesh& mesh, const Adjacency& around, CellMatrix& cell,
  CenterStars& stars, std::vector<Index>& singularCenters, Monitor& monitor);

/// Returns the matrices of all cells, without those in stars. `starOf`: CenterStars::ofCell(). They
/// take 0.3 kB a cell of a hexahedral mesh.
Matrices cellMatrices(
  const Mesh& mesh, const std::vector<int>& starOf, CellMatrix& cell, Monitor& monitor);
}
