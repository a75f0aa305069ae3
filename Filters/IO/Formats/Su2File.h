// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/SolverFile.h"

namespace morph::io
{
/// Whether a file is a mesh of SU2: its extension is .su2.
bool isSu2File(const std::string& path);

/// Reads a mesh of SU2: the points (NPOIN), numbered from 0 in their order, the elements (NELEM),
/// and the markers as sets of faces, or of edges in two dimensions. Several zones are refused by
/// name.
std::unique_ptr<SolverFile> readSu2File(const std::string& path);
}
