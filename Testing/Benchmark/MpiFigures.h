// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CommandLine.h"

namespace benchmark
{
/// Called on all ranks of MPI_COMM_WORLD. The first rank has the figures of all.
Report measureMpi(const Options& options, bool& correct);
}
