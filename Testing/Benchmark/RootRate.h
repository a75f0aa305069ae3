// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"

namespace benchmark
{
/// Square roots a second in double precision, four at once where the processor can, on the
/// monitor's threads: the limit of kernels of a distance.
double measureRootRate(morph::Monitor& monitor);
}
