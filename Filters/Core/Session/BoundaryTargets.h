// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace morph
{
/// Which nodes a boundary prescribes, and where they go. A session reads `ids`, `targets` and
/// `unmatched`; findTargets() fills in the rest.
struct BoundaryTargets
{
  std::vector<Index> ids = {};     ///< sorted, unique
  Points targets = {};             ///< #ids x 3, finite
  std::vector<Index> sources = {}; ///< #ids, the boundary point that a node follows, -1: held
  /// Nodes of a plane layer that leave the plane, ascending. It is morphed as a curved one then.
  std::vector<Index> leaving = {};
  std::vector<std::string> warnings = {};

  // Numbers that conclude() judges. On several processes they are summed first.
  Index points = 0;    ///< of the boundary
  Index unmatched = 0; ///< boundary points that stand for no node
  Index valueless = 0; ///< boundary points that have no displacement
  Index freed = 0;     ///< points that are free
  Index following = 0; ///< points that are not
  Index staying = 0;   ///< nodes in `ids` whose target is their place
  Index open = 0;      ///< corners of outer faces that are not in `ids`
};

struct TargetOptions
{
  double scaleFactor = 1;         ///< target = rest + scaleFactor * (target - rest)
  double matchTolerance = 1e-6;   ///< of the undeformed mesh's size
  bool fixUnnamedBoundary = true; ///< other outer nodes are held
  std::string displacementArray;  ///< the displacements in messages; empty: there are none
};

/// The points of a boundary that stand for nodes.
struct NamedPoints
{
  /// Point and node, in the order of the points; a node may come up again.
  std::vector<std::pair<Index, Index>> pairs;
  Points positions;                 ///< #points x 3
  Points rest;                      ///< #points x 3, or no rows: unknown
  Points displacements;             ///< #points x 3, or no rows: `positions` are the targets
  std::vector<std::uint8_t> isFree; ///< #points, or empty: none is
  Index unmatched = 0;              ///< points that stand for no node
  Index valueless = 0;              ///< free points that have no displacement
};

/// Makes a boundary of a layer that of the plane mesh: points stand for nodes of the front, and for
/// their images. Nodes between them are in the middle of edges, and follow these.
void nameImages(const ShellLayer& layer, NamedPoints& named);

/// Gives each process the points of all, one process after the other. Nodes are numbers in the
/// whole mesh; `rest` counts where all points have it. Cost: 120 bytes a point on every process.
/// Collective.
void gatherPoints(const Communicator& processes, NamedPoints& named);

/// Computes where nodes go. `rest`, `outer`, `size`: the undeformed mesh, its boundaryFaces() and
/// meshSize(). A node that is named more than once goes where it is named first. Nodes of free
/// points are solved with the interior, unless another point names them. With `fixUnnamedBoundary`
/// all other outer nodes are held, except those in the middle of an edge or face one of whose
/// corners moves or is free. Throws Error, naming ids, where NamedPoints::rest is not at the nodes,
/// for targets that are not finite or beyond 1e50, and where points of one node part. `globalIds`:
/// of the nodes, for a part of a mesh that is distributed over processes. Messages name these then.
/// Cost: a pass over the points, and one over the nodes.
BoundaryTargets findTargets(NamedPoints named, const Mesh& rest, const BoundaryFaces& outer,
  double size, const TargetOptions& options, const std::vector<std::int64_t>* globalIds = nullptr);

/// Counts the nodes that stay and those that are open. `owns`: whether a node counts here.
void countStaying(const Mesh& rest, const BoundaryFaces& outer,
  const std::function<bool(Index node)>& owns, BoundaryTargets& result);
/// Adds warnings of the numbers in `result`. Throws Error where all points are free.
void conclude(const TargetOptions& options, BoundaryTargets& result);
/// Throws Error, naming the nodes, where a plane mesh's boundary leaves the plane. For what is
/// linear in the motion: the methods for a surface in space are others than those in a plane.
/// Collective.
void requirePlane(const BoundaryTargets& result, const Communicator& processes);
/// Passes its warnings on, and warns where all prescribed nodes move, and others of the boundary
/// are open: nothing holds the mesh then.
void warnOf(const BoundaryTargets& result, Monitor& monitor);
}
