// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/SolverFile.h"

namespace morph::io
{
/// Whether a file is a deck of LS-DYNA: a .k, .key or .dyn whose first line, comments apart, is a
/// keyword.
bool isLsDynaFile(const std::string& path);

/// Reads *NODE, *ELEMENT_SOLID (collapsed hexahedra are tetrahedra, pyramids or wedges; those of
/// ten nodes), *ELEMENT_SHELL and *ELEMENT_BEAM. *ELEMENT_DISCRETE and nodal rigid bodies are
/// lines, the latter without a number. Sets of nodes, segments, elements and parts are read, of a
/// deck and of those that it includes, in fixed (also LONG) and free fields. The elements of a part
/// are a set, of its title or "PID 7". Parameters, and included files or nodes that are
/// transformed, are refused by name.
std::unique_ptr<SolverFile> readLsDynaFile(const std::string& path);
}
