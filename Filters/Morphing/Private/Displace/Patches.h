// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Displace/BoundaryModel.h"

#include <Eigen/Geometry>

#include <set>
#include <string>
#include <vector>

/// Names of the surfaces and curves of a boundary, for users to choose from: those that the mesh's
/// file gives, and "Surface 3", "Curve 7", with the ids that vtkClassifyBoundary writes.
namespace morph::filters::Patches
{
/// All names: those of the file first, then surfaces, then curves, each ascending by id. Several
/// patches with one id have one name.
std::vector<std::string> Names(const BoundaryModel& model);

/// How large what has a name is.
struct Size
{
  std::string Name;
  morph::Index Count = 0; ///< of faces; of a curve: of edges
  double Measure = 0;     ///< area; of a curve: length
  bool IsInner = false;   ///< all faces lie inside of the mesh
  Eigen::AlignedBox3d Box;
};
/// Undeformed, in the order of Names(). Cost: a pass over the faces for each name of the file, and
/// one for all others.
std::vector<Size> Sizes(const BoundaryModel& model);

/// The nodes and faces on some of the boundary.
struct Part
{
  std::vector<std::uint8_t> HasNode; ///< #nodes
  std::vector<std::uint8_t> HasFace; ///< #faces
};

/// The numbers of the surfaces of these names, ascending. Throws as Find() does, for a curve too,
/// and for a name of the file that stands for a part of a surface.
std::vector<morph::Index> Surfaces(
  const BoundaryModel& model, const std::set<std::string>& names, const char* property);

/// All nodes, those on the edges included, and all faces of the patches of these names; a curve has
/// no faces. For a name that does not exist, throws a morph::Error that names `property` and lists
/// the names that do.
Part Find(const BoundaryModel& model, const std::set<std::string>& names, const char* property);

/// The name of a surface, by its number in `geometry`.
std::string SurfaceName(const morph::Classification& geometry, morph::Index surface);

/// The numbers of the curves whose names are among these, ascending.
std::vector<morph::Index> Curves(
  const morph::Classification& geometry, const std::set<std::string>& names);
}
