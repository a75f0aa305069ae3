// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CommandLine.h"

namespace benchmark
{
/// Figures by the size of the mesh, as Measure in CommandLine.h. `options.files`: cells a side.
Report measureScaleFigures(const Options& options, bool& correct);
}
