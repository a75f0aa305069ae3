// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/SolverFile.h"

namespace morph::io
{
/// Whether a file is a mesh of Gmsh: an .msh that begins with a section.
bool isGmshFile(const std::string& path);

/// Reads nodes, elements and physical groups of a MSH file of version 2 or 4.1, text or binary.
/// Groups are sets by their names; one without a name is "Physical Surface 7". Other versions
/// and elements of third order and more are refused by name.
std::unique_ptr<SolverFile> readGmshFile(const std::string& path);
}
