// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Mesh/HangingNodes.h"
#include "Mesh/InnerFaces.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace morph
{
/// The part of a boundary that the mesh's file names: a node set, side set, patch or marker.
struct NamedSet
{
  std::string name;
  std::vector<Index> nodes; ///< ascending
  std::vector<Index> faces; ///< ascending
};

/// Returns what a set of nodes and cells has of a boundary. A node of an outer face belongs to it
/// if it is marked, and an outer face if all of its corners are. A face belongs, too, if a marked
/// two-dimensional cell lies on it. Without these and without marked boundary nodes, an outer face
/// does if the volume cell behind it is. The `inside` last faces are not outer. `isNode`: #nodes,
/// `isCell`: #cells or, of a boundary alone, #faces; either may be empty.
NamedSet boundarySet(const std::string& name, const Mesh& mesh, const BoundaryFaces& faces,
  std::size_t inside, const std::vector<std::uint8_t>& isNode,
  const std::vector<std::uint8_t>& isCell);

/// The boundary of a mesh with its geometry and its names. It may stand alone: then `mesh` has
/// points and no cells, and `undeformed` is where its geometry was found.
struct BoundaryModel
{
  Mesh mesh;            ///< its points are the current positions
  Points undeformed;    ///< of a boundary alone: #nodes x 3
  HangingNodes hanging; ///< of `mesh`
  /// The outer faces, then those of baffles, then those of sheets; see innerFaces().
  BoundaryFaces faces;
  /// Nodes between corners on edges that linear cells have, too, by their numbers in faces.nodes.
  /// A boundary alone has none.
  std::vector<Index> onLinearEdges;
  InnerFaces inner;                        ///< the last ones of `faces`
  std::vector<InnerSurface> innerSurfaces; ///< of its parts and of sets of nodes
  /// The names of those that are sheets, too. Others are listed alone.
  std::set<std::string> asked;
  std::vector<std::int8_t> orientation; ///< #faces: -1 where the cell behind is wound inside out
  std::vector<Index> bodyOfNode;        ///< see bodyOfNodes()
  Classification geometry;              ///< found at undeformed positions
  std::vector<NamedSet> namedSets;      ///< outer ones first
  std::vector<NamedSet> setsInside;     ///< without any node on the boundary
  /// Diagonal of the bounding box of the boundary's nodes, of which there is one at least.
  double size = 0;
  /// Change with all of this, and with points(), faces and geometry alone. What is kept for a
  /// number is used again while that number stays.
  ///@{
  std::int64_t inputVersion = 0;
  std::int64_t motionVersion = 0;
  ///@}

  const Points& points() const { return this->mesh.points; } ///< #nodes x 3, current positions
  /// Undeformed positions: of a mesh, its own points.
  const Points& rest() const
  {
    return this->mesh.numberOfCells() > 0 ? this->mesh.points : this->undeformed;
  }
  /// Whether all of these faces lie inside of the mesh; false for none.
  bool areInner(const std::vector<Index>& ids) const;
  /// The numbers of the surfaces that are sheets, ascending. They go along with the interior unless
  /// they are named.
  std::vector<Index> sheets() const;
  /// #nodes: whether a node is on some of these surfaces, ascending, and on no other.
  std::vector<std::uint8_t> nodesOnlyOn(const std::vector<Index>& surfaces) const;
  /// The areas of faceAreas(), but outwards where cells are wound inside out.
  Points outwardAreas(const Points& at) const;

  /// Finds faces, inner faces, orientation and bodies of `mesh`. `isNamed`: #cells, those of named
  /// sets: two-dimensional ones are inner faces where they lie inside. So are the inner
  /// surfaces that are asked for. Cost: that of boundaryFaces() and connectedComponents().
  void findFaces(const std::vector<std::uint8_t>& isNamed, Monitor& monitor);
  /// The part of findFaces() that is left once `faces` are the outer ones, and `hanging` is known.
  /// `ofCell`: #cells, cellSigns() of the whole mesh. Cost: that of innerFaces().
  void addInnerFaces(const std::vector<std::uint8_t>& isNamed,
    const std::vector<std::int8_t>& ofCell, Monitor& monitor);
  /// See ClassificationOptions::sheets: the same number for faces of the same inner surfaces.
  std::vector<Index> sheetNumbers() const;
  /// Takes the sets, with their nodes on the boundary alone, and the inner surfaces that are asked
  /// for, which go before sets of their names. Moves those without nodes to `setsInside`, and sets
  /// `size`.
  void takeSets(std::vector<NamedSet> sets);
};
}
