// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/SolverFile.h"

namespace morph::io
{
/// Whether a file holds bulk data of Nastran: a .bdf, .nas, .fem or .dat that has a line GRID,
/// BEGIN BULK or INCLUDE.
bool isNastranFile(const std::string& path);

/// Reads GRID and the elements CTETRA, CPYRAM, CPENTA, CHEXA, CTRIA3, CTRIA6, CTRIAR, CQUAD4,
/// CQUAD8, CQUADR, CSHEAR, CBAR, CBEAM and CROD of a file and of those that it includes. The
/// elements of a property are a set, "PID 7". Rigid elements (RBE2, RBE3, RBAR, RROD), springs,
/// dampers, gaps and other bars are lines without a number. Nodes in other coordinate systems (CP)
/// are read in the basic one.
std::unique_ptr<SolverFile> readNastranFile(const std::string& path);
}
