// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/SolverFile.h"

namespace morph::io
{
/// Whether a path is a mesh of OpenFOAM: the folder of a case, a .foam file in one, a folder
/// polyMesh (of a region or a time too), or a file points or points.gz. A case whose regions or
/// pieces have the meshes is one, too; see FoamFolders.
bool isOpenFoamMesh(const std::string& path);

/// Reads points, faces, owner, neighbour and boundary, text or binary, packed (.gz) or not,
/// collated or not; nodes and cells are numbered from 0. A time's folder may have its points alone.
/// Patches and zones are sets of faces, cells or points. Cells of other shapes are polyhedra.
///
/// Several regions are one mesh: nodes of two at the very same position are one, and the faces of
/// their interface are one sheet inside. Sets are "fluid/inlet", and the cells of each region are a
/// set of its name. So are the pieces of a decomposed case, whose nodes are one, and have their
/// numbers, by pointProcAddressing, or else by position. Throws Error for a piece alone, and for
/// pieces whose cuts do not fit.
std::unique_ptr<SolverFile> readOpenFoamMesh(const std::string& path);

/// The files of points that `out` means; see foamTargets().
std::vector<std::string> openFoamTargets(const std::string& original, const std::string& out);
}
