// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Support/Communicator.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace morph
{
/// Returns a mesh of faces as a solid one layer thick, so that all that morphs and measures solids
/// works for it: triangles become wedges and quadrilaterals hexahedra. Lines become the faces of
/// its sides. Cells keep their ids, and nodes those of the front; see ShellLayer. Nodes in the
/// middle of edges between front and back, which quadratic cells have, come last. Cells that are
/// wound against their neighbors are turned over, so that only a fold inverts them.
///
/// The layer of a plane mesh is as thick as edges are long on the mean, which no result depends on
/// but by rounding; its normal is that about which most of the area is wound counterclockwise. A
/// mesh that is not plane to 1e-6 of its size is a curved shell, a tenth as thick. Its layer stands
/// on the normals of its nodes: sums of the areas around them. Geometry reads its cells upright;
/// see StandingCells.h.
///
/// Throws Error for a mesh without area, and for cells other than vertices, lines, triangles and
/// quadrilaterals, linear or quadratic. It throws for shells with one side alone or without a
/// normal at a node, too. Cost: passes over the mesh.
///
/// `processes`: that have parts of the shell, each with copies of the cells around its nodes. The
/// layer is that of the whole shell then, at all nodes here. Each process has some nodes, perhaps
/// of no cell. Collective.
Mesh thicken(const Mesh& shell, const Communicator& processes = Communicator::alone());

/// Whether nodes of a plane layer, at `points`, leave its plane by more than 1e-6 of its size.
/// `points`: of the front, and of any others after these. Nodes that are off it in the undeformed
/// mesh, as those of beams, do not. Collective.
bool leavesPlane(const Mesh& rest, const ConstPoints& points,
  const Communicator& processes = Communicator::alone());
/// A plane layer as a curved one that is as thick, for motions that leave the plane.
/// Collective.
Mesh bent(Mesh mesh, const Communicator& processes = Communicator::alone());

/// Throws Error for a curved layer, whose nodes span no region that could be tessellated.
void requireRegion(const Mesh& mesh);

/// The cells of a layer as faces, outward to the front.
BoundaryFaces frontFaces(const Mesh& mesh);

/// Puts the images of the nodes of a curved layer, and the nodes between, behind the front on the
/// normals that the surface has where it has moved. `moved`: #nodes x 3, whose front is read. So a
/// cell that is folded over lies against the normals around it, as these turn along with the
/// surface. Where folded cells leave a node no normal of its own, it has that of three rings of
/// cells. Other meshes stay. `processes`: that have the mesh, or parts of it without copies of
/// cells. Cost: some passes over the cells. Collective.
void placeImages(
  const Mesh& rest, Points& moved, const Communicator& processes = Communicator::alone());

/// Returns the points of all nodes of a layer where those of its front are `front`.
Points layerBehind(const Mesh& rest, const ConstPoints& front);

/// The images of the nodes of a layer among `ids`, ascending: their places in `ids`, front first.
/// Nodes whose image is not among them are left out.
std::vector<std::pair<Index, Index>> imagesAmong(
  const ShellLayer& layer, const std::vector<Index>& ids);

/// The same of a curved layer, whose images have normals of their own; none of others.
std::vector<std::pair<Index, Index>> curvedImages(
  const ShellLayer& layer, const std::vector<Index>& ids);

/// Marks the images of nodes as these, #nodes of the mesh; other nodes keep their mark.
void markImages(const ShellLayer& layer, std::vector<std::uint8_t>& marks);

/// Moves the nodes `ids`, ascending, of a plane layer into their plane, and both images of a node
/// alike; of a curved one, placeImages(). `moved`: #nodes x 3. Nothing happens without a layer.
/// Collective.
void keepInPlane(const Mesh& rest, const std::vector<Index>& ids, Points& moved,
  const Communicator& processes = Communicator::alone());
}
