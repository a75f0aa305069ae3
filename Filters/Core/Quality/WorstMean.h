// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Quality/ScaledJacobian.h"

namespace morph
{
/// Returns the mean scaled Jacobian of the worst `share` of the measured cells, one cell at least.
/// `share`: in (0, 1]. NaN if no cell was measured. It does not depend on the cells' numbering.
/// Cost: a pass over the cells.
double worstMean(const Quality& quality, double share = 0.01);

/// Returns how many cells that is, of `measured` ones, at least 1.
Index worstCount(Index measured, double share);
}
