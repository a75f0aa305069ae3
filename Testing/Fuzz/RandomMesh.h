// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Choices.h"

#include "../Core/Octree.h"
#include "Mesh/Mesh.h"

#include <array>
#include <utility>
#include <vector>

namespace fuzz
{
/// What is known of a mesh by how it was made. Such meshes are never hostile.
struct Known
{
  enum Faces
  {
    None,
    Plane,
    Curved
  };
  int faces = None;                             ///< cells are triangles and quadrilaterals alone
  std::vector<morph::Index> outer;              ///< of an octree or faces, ascending; else none
  std::vector<meshes::Octree::Hanging> hanging; ///< of an octree
  /// Nodes of one side and their images on the other, which are translated.
  std::vector<std::pair<morph::Index, morph::Index>> images;
  std::vector<morph::Index> plane; ///< the nodes of a plane of symmetry
  bool isCollapsed = false;        ///< hexahedra have a corner twice, and are polyhedra or wedges
  struct Between
  {
    morph::Index node;
    std::array<morph::Index, 2> ends; ///< corners
    double at;                        ///< which part of the way to the second one
  };
  std::vector<Between> between;   ///< nodes on edges, anywhere in the middle third
  std::vector<morph::Index> twin; ///< nodes of a copy beside the mesh, ascending
  std::vector<std::pair<morph::Index, morph::Index>> slit; ///< nodes at one place, of two sides

  bool isAny() const
  {
    return this->faces != None || !this->outer.empty() || !this->images.empty() ||
           !this->plane.empty() || this->isCollapsed || !this->between.empty() ||
           !this->slit.empty();
  }
  /// The largest distance of a node that hangs from its place.
  double gap(const morph::Points& points) const;
  /// The largest difference of the motions of two images, and that along the plane's normal.
  ///@{
  double parted(const morph::Points& rest, const morph::Points& moved) const;
  double offPlane(const morph::Points& rest, const morph::Points& moved) const;
  ///@}
};

/// A small random mesh of volumes or of faces alone: all cell types, perfect to tangled shapes,
/// several bodies, places far away and sizes out of bounds. Node ids are right and every cell has
/// the nodes that its type asks for. Faces alone are triangles and quadrilaterals.
morph::Mesh randomMesh(Choices& choices, Known& known);

/// Nodes on faces that belong to one volume cell alone, mid-side and face nodes included,
/// ascending. Told by the nodes of VTK's own faces, so that it does not depend on what is tested.
std::vector<morph::Index> outerNodes(const morph::Mesh& mesh);
/// Nodes of cells of the mesh's dimension, ascending: of volume cells or, of a mesh that is known
/// to have faces alone, of these.
std::vector<morph::Index> cellNodes(const morph::Mesh& mesh, const Known& known);
/// Nodes that no volume cell uses but cells of dimension 1 or 2 do: in parts that such cells hold
/// together apart from volume nodes. Of a mesh with volume cells.
struct AttachedPart
{
  std::vector<morph::Index> nodes;   ///< ascending
  std::vector<morph::Index> anchors; ///< the volume nodes in their cells, ascending
};
std::vector<AttachedPart> attachedParts(const morph::Mesh& mesh);
/// Diagonal of the box of these nodes.
double meshSize(const morph::Mesh& mesh, const std::vector<morph::Index>& nodes);
/// How far these faces are off the plane that fits their nodes best, and its normal.
std::pair<double, Eigen::RowVector3d> planeOf(const morph::Points& nodes);
}
