// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"

#include <set>
#include <string>
#include <vector>

/// Names of the surfaces and curves of a boundary, for users to choose from: "Surface 3", "Curve
/// 7", with the ids that vtkClassifyBoundary writes.
namespace morph::filters::Patches
{
/// All names: surfaces first, then curves, each ascending by id. Several patches with one id have
/// one name.
std::vector<std::string> Names(const morph::Classification& geometry);

/// The nodes and faces on some of the boundary.
struct Part
{
  std::vector<std::uint8_t> HasNode; ///< #nodes
  std::vector<std::uint8_t> HasFace; ///< #faces
};

/// The numbers of the surfaces of these names, ascending. Throws as Find() does, for a curve too.
std::vector<morph::Index> Surfaces(
  const morph::Classification& geometry, const std::set<std::string>& names, const char* property);

/// All nodes, those on the edges included, and all faces of the patches of these names; a curve has
/// no faces. For a name that does not exist, throws a morph::Error that names `property` and lists
/// the names that do.
Part Find(
  const morph::Classification& geometry, const std::set<std::string>& names, const char* property);
}
