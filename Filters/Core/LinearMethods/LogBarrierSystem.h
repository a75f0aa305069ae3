// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/NodeWeights.h"
#include "Mesh/Mesh.h"
#include "Solvers/CsrMatrix.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// The equations of LBWARP, (I - W_I) U_I - W_B U_B = 0; their rows sum to zero.
struct LogBarrierSystem
{
  CsrMatrix interior; ///< I - W_I, #rows x #rows
  CsrMatrix coupling; ///< -W_B, #rows x #prescribed

  /// nodes without log-barrier weights among their neighbors, in the order of the rows
  std::vector<Index> outside;
  std::vector<Index> empty; ///< those of `outside` without any weights; their rows are invalid
  Index twoRing = 0, affine = 0, stiffness = 0; ///< number of nodes of `outside` by fall-back
  int mostIterations = 0;                       ///< maximum of Newton steps over the nodes
  double meanIterations = 0;
};

/// Computes the equations. `rows`: the free nodes in the order of the matrix rows. With `relax`,
/// nodes outside take the fall-backs of NodeWeights::Kind; otherwise all are in `empty`. Cost: 1 to
/// 2 microseconds a node of a hexahedral mesh.
LogBarrierSystem logBarrierSystem(const Mesh& mesh, const std::vector<Index>& rows,
  const std::vector<Index>& prescribed, bool relax, Monitor& monitor);
}
