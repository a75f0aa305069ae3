// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/SolverFile.h"

namespace morph::io
{
/// Whether a file is one of CGNS: a .cgns in HDF5 or ADF.
bool isCgnsFile(const std::string& path);

/// Reads the unstructured zones of the first base: coordinates, element sections, and the boundary
/// conditions and families as sets. Nodes are numbered from 1 through all zones; nodes of different
/// zones at the very same position are one. Structured zones, planar bases, polyhedra and links to
/// other files are refused by name, and so are all files where this was built without CGNS.
std::unique_ptr<SolverFile> readCgnsFile(const std::string& path);
}
