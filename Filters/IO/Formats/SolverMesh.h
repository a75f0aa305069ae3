// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Mesh/Mesh.h"
#include "Support/Types.h"

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace morph::io
{
/// Nodes and cells that a file names: a node set, element set, surface, marker, patch or physical
/// group.
struct NamedSet
{
  std::string name;
  std::vector<Index> nodes; ///< positions in the mesh
  std::vector<Index> cells; ///< positions in the mesh, of cells of any dimension
};

/// The mesh of a solver's file, with the numbers that the file gives to nodes and cells.
struct SolverMesh
{
  std::vector<Index> nodeNumbers;
  std::vector<double> coordinates;     ///< 3 x #nodes, in the unit of the file
  std::vector<std::uint8_t> cellTypes; ///< VTK's
  std::vector<Index> offsets = { 0 };  ///< #cells + 1, into `connectivity`
  std::vector<Index> connectivity;     ///< positions of nodes, in VTK's order
  /// #cells + 1, into `faces`; empty in a mesh without polyhedra
  std::vector<Index> faceOffsets;
  /// each face of a polyhedron: its number of nodes, then their positions, outward
  std::vector<Index> faces;
  std::vector<Index> cellNumbers; ///< -1: a face that is no element of the file, but of a set
  std::vector<NamedSet> sets;
  /// Pairs of sets whose faces are images of each other; one name twice: front and back are one
  /// set.
  std::set<std::pair<std::string, std::string>> periodic;
  std::set<std::string> symmetry; ///< sets that are planes of symmetry
  /// The name of the displacements that other readers add to the coordinates, as ParaView does with
  /// those of Exodus II; empty: there are none. 3 x #nodes, of the last time step or of that of
  /// SolverFile::takeStep().
  std::string displacementName;
  std::vector<double> displacements;
  std::vector<std::string> warnings; ///< of what was left out

  Index nodes() const { return static_cast<Index>(this->nodeNumbers.size()); }
  Index cells() const { return static_cast<Index>(this->cellTypes.size()); }
  void addNode(Index number, double x, double y, double z);
  /// Adds a cell; returns its position. A quadratic pyramid may have a 14th node, in the middle of
  /// its base, which VTK's type lacks: a face without a number, of nine nodes, then follows it.
  /// Nodes after the corners of a quadratic cell may be -1, as solvers leave them out. Then the
  /// cell is linear, and quadratic edges without numbers follow it, which have the other nodes.
  Index addCell(std::uint8_t type, const std::vector<Index>& nodes, Index number);
  /// Adds a polyhedron; returns its position. `faces`: their nodes, outward.
  Index addPolyhedron(const std::vector<std::vector<Index>>& faces, Index number);
  /// The set of that name, which is made where there is none.
  NamedSet& set(const std::string& name);
};

/// The mesh of the core, with the same numbers of nodes and cells; see validate() and
/// recognizeCells().
Mesh coreMesh(const SolverMesh& mesh);

/// The nodes and cells at these positions, in the order given, and what is left of each set, also
/// of those of which nothing is left. `nodes`: ascending; they include those of the cells. Cost:
/// one pass over the nodes, the cells and the sets' members.
SolverMesh partOf(
  const SolverMesh& mesh, const std::vector<Index>& nodes, const std::vector<Index>& cells);

/// Of a cell of VTK's type: 0 to 3.
int dimensionOf(std::uint8_t type);
}
