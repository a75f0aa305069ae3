// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/NodeWeights.h"
#include "Mesh/Mesh.h"
#include "Solvers/CsrMatrix.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// The equations of LBWARP, (I - W_I) U_I - W_B U_B = 0: rows of sum zero.
struct LogBarrierSystem
{
  CsrMatrix interior; ///< I - W_I, #rows x #rows
  CsrMatrix coupling; ///< -W_B, #rows x #prescribed

  /// nodes without log-barrier weights among their neighbors, in the order of the rows
  std::vector<Index> outside;
  std::vector<Index> empty; ///< those among them without any weights; their rows are not valid
  Index twoRing = 0, affine = 0, stiffness = 0; ///< how many of `outside` took which fall-back
  int mostIterations = 0;                       ///< Newton steps, of all nodes
  double meanIterations = 0;
};

/// `rows`: the free nodes in the order of the matrix rows. With `relax` nodes outside take the
/// fall-backs of NodeWeights::Kind; without it each of them is in `empty`. Cost: 1 to 2
/// microseconds a node of a hexahedral mesh.
LogBarrierSystem logBarrierSystem(const Mesh& mesh, const std::vector<Index>& rows,
  const std::vector<Index>& prescribed, bool relax, Monitor& monitor);
}
