// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/DirichletSystem.h"
#include "Morpher/CellStiffness.h"

namespace morph
{
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
