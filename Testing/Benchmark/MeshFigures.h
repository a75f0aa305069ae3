// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CommandLine.h"

namespace benchmark
{
/// FEMWARP's and LBWARP's figures on Options::files, as Measure in CommandLine.h.
Report measureMeshFigures(const Options& options, bool& correct);
}
