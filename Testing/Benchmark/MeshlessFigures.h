// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CommandLine.h"

namespace benchmark
{
/// Figures of weighted residual, simplex-linear and simplex-natural neighbor, as Measure in
/// CommandLine.h.
Report measureMeshlessFigures(const Options& options, bool& correct);
}
