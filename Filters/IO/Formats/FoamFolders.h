// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace morph::io
{
/// Whether a folder has the file, packed (name.gz) or not.
bool hasFile(const std::filesystem::path& folder, const char* name);

/// Where a mesh of OpenFOAM lies, or a part of one.
struct FoamFolder
{
  std::string points, faces; ///< folders polyMesh; that of a time has points alone
  std::string region;        ///< where the mesh has several of them
};

/// The meshes that a path means together, and the folder of the case where they are several.
struct FoamFolders
{
  std::string root;
  std::vector<FoamFolder> parts; ///< empty: the path means no mesh of OpenFOAM
  bool arePieces = false;        ///< of a decomposed case
  std::string warning;           ///< empty: none

  /// Regions and pieces in the order of their names and numbers. The path: the folder of a case, a
  /// .foam file in one, a folder polyMesh (of a region or a time too) or above it, or a file of
  /// points. A case whose regionProperties, or no constant/polyMesh of its own, says so has the
  /// meshes of its regions; one without a mesh in constant/ those of its pieces.
  static FoamFolders of(const std::string& path);
};

/// The files of points that `out` means, one for each part of `original`: itself, where it is
/// called points or points.gz and there is one part; those of a copy of the case, or of a .foam
/// file in it; that of a folder polyMesh; or those of a new time of a case, as case/0.1. Throws
/// Error for another name.
std::vector<std::string> foamTargets(const FoamFolders& original, const std::string& out);
}
