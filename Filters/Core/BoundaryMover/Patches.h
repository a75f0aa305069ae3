// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/BoundaryModel.h"

#include <Eigen/Geometry>

#include <set>
#include <string>
#include <vector>

namespace morph
{
/// Returns the names of the surfaces and curves of a boundary, for users to choose from: those that
/// the mesh's file gives, those of inner surfaces, as "a | b" of two parts, and "Surface 3",
/// "Curve 7", with the ids of the geometry. Those of the file come first. Inner surfaces follow,
/// asked for or not, then surfaces, then curves, each ascending by id. Several patches with one id
/// have one name. Surfaces of sheets have no such number.
std::vector<std::string> patchNames(const BoundaryModel& model);

/// How large what has a name is.
struct PatchSize
{
  std::string name;
  Index count = 0;      ///< of faces; of a curve: of edges
  double measure = 0;   ///< area; of a curve, or of edges of a mesh of faces: length
  bool isInner = false; ///< all faces lie inside of the mesh
  Eigen::AlignedBox3d box;
};
/// Undeformed, in the order of patchNames(). Cost: a pass over the faces for each name of the file,
/// and one for all others.
std::vector<PatchSize> patchSizes(const BoundaryModel& model);

/// The shape of what has a name, undeformed, as SurfaceShape::text() gives it; empty for a curve.
/// In the order of patchNames(). Cost: a few passes over the nodes of each.
std::vector<std::string> patchShapes(const BoundaryModel& model);

/// The nodes and faces on some of the boundary.
struct PatchPart
{
  std::vector<std::uint8_t> hasNode; ///< #nodes
  std::vector<std::uint8_t> hasFace; ///< #faces
};

/// The numbers of the surfaces of these names, ascending. Throws as findPatches() does, for a curve
/// too, and for a name of the file that stands for a part of a surface.
std::vector<Index> surfacesNamed(
  const BoundaryModel& model, const std::set<std::string>& names, const char* option);

/// What of the patches that a file calls planes of symmetry can slide.
struct SymmetryPlanes
{
  std::vector<Index> surfaces;     ///< ascending, each a plane
  std::vector<std::string> others; ///< names of patches that have other surfaces, or parts of them
};
/// `names`: those that stand for no faces of the boundary count for nothing. Cost: a pass over the
/// patches' nodes.
SymmetryPlanes symmetryPlanes(const BoundaryModel& model, const std::set<std::string>& names);

/// All nodes, those on the edges included, and all faces of the patches of these names; a curve has
/// no faces. For a name that does not exist, throws an Error that names `option` and lists
/// the names that do.
PatchPart findPatches(
  const BoundaryModel& model, const std::set<std::string>& names, const char* option);

/// The name of a surface, by its number in `geometry`.
std::string surfaceName(const Classification& geometry, Index surface);

/// The numbers of the curves whose names are among these, ascending.
std::vector<Index> curvesNamed(const Classification& geometry, const std::set<std::string>& names);
}
