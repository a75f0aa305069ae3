// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/SolverFile.h"

namespace morph::io
{
/// Whether a path is a mesh of OpenFOAM: the folder of a case, a .foam file in one, a folder
/// polyMesh (of a region or a time too), or a file points or points.gz. A case whose regions or
/// pieces have the meshes is one, too.
bool isOpenFoamMesh(const std::string& path);

/// Reads points, faces, owner, neighbour and boundary, text or binary, packed (.gz) or not; nodes
/// and cells are numbered from 0. A time's folder may have its points alone. Patches and zones are
/// sets of faces, cells or points. Cells of other shapes are polyhedra. Throws Error for a case of
/// several regions, which names them, and for a decomposed case or a piece of it.
std::unique_ptr<SolverFile> readOpenFoamMesh(const std::string& path);

/// The file of points that `out` means: itself, where it is called points or points.gz; or that of
/// a case's folder or of a folder polyMesh. Throws Error for another name.
std::string openFoamTarget(const std::string& original, const std::string& out);
}
