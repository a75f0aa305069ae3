// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/SolverFile.h"

namespace morph::io
{
/// Whether a file is an archive of Ansys: a .cdb, as CDWRITE writes it.
bool isAnsysFile(const std::string& path);

/// Reads the nodes of NBLOCK, the solids and shells of four nodes of EBLOCK, by their types of ET,
/// and the components of CMBLOCK, which are sets. So are the elements of a material,
/// "Material 1". Collapsed hexahedra are tetrahedra, pyramids or wedges. Elements of other types
/// are left out with a warning. An archive that is not blocked is refused by name.
std::unique_ptr<SolverFile> readAnsysFile(const std::string& path);
}
