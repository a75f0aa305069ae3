// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"

#include <set>
#include <string>
#include <vector>

/// Surfaces and curves of a boundary by names that users choose from: "Surface 3", "Curve 7", with
/// the ids that vtkClassifyBoundary writes.
namespace morph::filters::Patches
{
/// Surfaces first, then curves, each ascending by id. Several with one id have one name.
std::vector<std::string> Names(const morph::Classification& geometry);

/// The nodes and faces on some of the boundary.
struct Part
{
  std::vector<std::uint8_t> HasNode; ///< #nodes
  std::vector<std::uint8_t> HasFace; ///< #faces
};

/// All nodes, those on their edges included, and all faces of the patches of these names; a curve
/// has no faces. Throws morph::Error that says `property` and lists what there is for a name that
/// does not exist.
Part Find(
  const morph::Classification& geometry, const std::set<std::string>& names, const char* property);
}
