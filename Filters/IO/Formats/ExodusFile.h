// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/SolverFile.h"

namespace morph::io
{
/// Whether a file is one of Exodus II: .e, .ex2, .exo, .exii, .g or .gen, in a format of netCDF.
bool isExodusFile(const std::string& path);

/// Reads nodes, element blocks, node sets and side sets; time steps stay in the file. Coordinates
/// are the file's own, without displacements. A block or set without a name is "block_7",
/// "nodelist_7" or "surface_7". Nodes with two coordinates are refused by name, and so is each file
/// where this was built without netCDF.
std::unique_ptr<SolverFile> readExodusFile(const std::string& path);
}
