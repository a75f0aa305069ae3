// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CommandLine.h"

namespace benchmark
{
/// The inversion-free morph's figures, as Measure in CommandLine.h.
Report measureInversionFreeFigures(const Options& options, bool& correct);
}
