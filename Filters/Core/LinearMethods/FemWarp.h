// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/CenterStars.h"
#include "LinearMethods/DirichletSystem.h"
#include "Mesh/Mesh.h"
#include "Morpher/Morpher.h"
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

/// FEMWARP: displacements solve Laplace's equation by finite elements on the undeformed mesh, A_I
/// U_I = -A_B U_B. The boundary values are the prescribed displacements. Sources: Baker,
/// Engineering with Computers 18 (2002) 188-198; Shontz and Vavasis, BIT 50 (2010) 863-884; Staten
/// et al., IMR 2011, equations (9) to (12).
///
/// Stiffness: see elementStiffness(). Affine motions are exact to the solver's tolerance. A cell
/// whose Jacobian is not positive at all its quadrature points takes the averaged simplicial
/// stiffness with absolute volumes. So the system stays positive definite. A warning names these
/// cells, and all others that are inverted by their scaled Jacobian.
///
/// With a stiffness k of the cells other than Uniform, the equation is that of div k grad u = 0.
/// Affine motions do not solve it, so that their least-squares fit is taken off first: u is the fit
/// plus the solution for the rest.
///
/// prepare(): one pass over the cells. It keeps about 0.5 kB a node of a hexahedral mesh and 0.35
/// of a tetrahedral one. evaluate(): conjugate gradients to 1e-10, nearly independent of the mesh's
/// size. With 10^5 nodes they take 12 iterations on a cube of hexahedra. On boxes of stretched
/// cells of all types they take 12 to 27, with aspect ratios up to 100 in layers that grow by up to
/// 1.3; and they take hundreds where many slivers have a height of 1e-6.
class FemWarp
  : public DirichletMethod
  , public StiffMethod
{
public:
  FemWarp()
    : DirichletMethod(true)
  {
  }

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  bool hasPrepareOptionsOf(const Morpher& other) const override
  {
    return this->stiffness() == static_cast<const FemWarp&>(other).stiffness();
  }
};
}
