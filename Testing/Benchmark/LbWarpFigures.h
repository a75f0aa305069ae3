// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CommandLine.h"

namespace benchmark
{
/// LBWARP's figures, as Measure in CommandLine.h.
Report measureLbWarpFigures(const Options& options, bool& correct);
}
