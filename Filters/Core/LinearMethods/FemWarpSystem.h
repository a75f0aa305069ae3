// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/CenterStars.h"
#include "Mesh/Mesh.h"
#include "Solvers/CsrMatrix.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <string>
#include <vector>

namespace morph
{
/// The equations of FEMWARP, A_I U_I + A_B U_B = 0.
struct FemWarpSystem
{
  CsrMatrix interior; ///< A_I, #rows x #rows
  CsrMatrix coupling; ///< A_B, #rows x #prescribed

  std::vector<std::int8_t> cellSign;  ///< #cells, from elementStiffness()
  bool hasBadCells = false;           ///< some cell may be inverted or flat; see badCells()
  std::vector<Index> singularCenters; ///< node ids of eliminated centers without stiffness
};

/// Computes the equations. `rows`: the nodes of the matrix rows, in their order. `prescribed`: all
/// other corners of the cells around them. `factors`: the stiffness of the cells, which multiplies
/// their matrices; none: 1. Rows are sums over cells in ascending order. Cost: 0.2
/// to 0.4 microseconds a cell.
FemWarpSystem femWarpSystem(const Mesh& mesh, const std::vector<Index>& rows,
  const std::vector<Index>& prescribed, const std::vector<double>& factors, Monitor& monitor);
/// The same without the centers of `stars`, which are no rows. Sets the weights of the stars.
/// `around`: nodeToCells(mesh), to be freed once it has been used.
FemWarpSystem femWarpSystem(const Mesh& mesh, Adjacency around, const std::vector<Index>& rows,
  const std::vector<Index>& prescribed, const std::vector<double>& factors, CenterStars& stars,
  Monitor& monitor);

/// Ids of cells that are no good reference, ascending.
struct BadCells
{
  std::vector<Index> inverted; ///< by their scaled Jacobian
  std::vector<Index> flat;     ///< not inverted, without usable volume
  std::vector<Index> absolute; ///< of both, those whose stiffness has absolute volumes
};

/// Finds them. `expected`: cellSigns(mesh, ...); `sign`: FemWarpSystem::cellSign.
BadCells badCells(const Mesh& mesh, const std::vector<std::int8_t>& expected,
  const std::vector<std::int8_t>& sign, Monitor& monitor);

/// The warning about bad cells; empty where there are none.
std::string describe(const BadCells& bad);
}
