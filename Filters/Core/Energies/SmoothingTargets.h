// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/TargetMatrices.h"

namespace morph
{
/// The shapes that smoothing aims for.
enum class SmoothingTarget
{
  Initial, ///< the undeformed cell: targetMatrices(), weighted by volume
  /// a cube, a regular tetrahedron, or a wedge or pyramid with equal edges, all cells of equal
  /// weight; one tetrahedron at each corner except a pyramid's apex
  Ideal
};

/// Computes target matrices for the inverse mean ratio: theta is 0, so only the shape counts. An
/// Ideal cell has the undeformed cell's volume, or the mean volume if that is nearly 0.
/// `orientation`: #cells, see cellSigns() in Topology.h. Cost: as targetMatrices().
TargetMatrices smoothingTargets(const Mesh& rest, const std::vector<std::int8_t>& orientation,
  SmoothingTarget target, Monitor& monitor,
  const Communicator& communicator = Communicator::alone());
}
