// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CommandLine.h"

namespace benchmark
{
/// FEMWARP's figures, as Measure in CommandLine.h.
Report measureFigures(const Options& options, bool& correct);
}
