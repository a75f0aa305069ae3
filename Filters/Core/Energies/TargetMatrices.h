// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// What a cell should look like in the morphed mesh, up to a rotation.
enum class TargetConstruction
{
  Initial, ///< the cell at rest
  /// the cell at rest, stretched along its own axes to the edge lengths of a guide: keeps angles,
  /// accepts sizes
  Stretched,
  /// right angles, or a regular tetrahedron, with the mean edge lengths along each axis of the
  /// guide
  Ideal
};

/// Target matrices of all cells: for each tetrahedron of the averaged simplicial decompositions,
/// the inverse of its target and a weight.
struct TargetMatrices
{
  /// One tetrahedron: J = [x1 - x0, x2 - x0, x3 - x0] inverse(t) is the identity for the target's
  /// shape and size. The corners are those of the same entry in the shape's
  /// simplicialDecomposition(). A cell has the first of these tetrahedra or all.
  struct Tetrahedron
  {
    bool stiffened;    ///< not in tetrahedral cells, whose scaled Jacobian it lowers
    double inverse[9]; ///< column major
    double weight;     ///< decomposition weight times target volume; the mean over all is 1
    double theta;      ///< of FoldoverDensity: 0.5 in tetrahedral cells, 0.1 in others
  };
  std::vector<Index> start; ///< #cells + 1
  std::vector<Tetrahedron> tetrahedra;
};

/// `guide`: #nodes x 3, whose edge lengths Stretched and Ideal take; `orientation`: #cells, see
/// Topology's cellSigns().
/// Stretched: ratios of the sums of parallel edges, within [1/20, 20]; for tetrahedra as Initial. A
/// cell at rest whose scaled Jacobian is 1e-3 or less, which Initial and Stretched would divide by,
/// takes the Ideal shape with the edge lengths of its valid neighbors at rest. Tetrahedra inside a
/// valid cell that are not positive there have weight 0. Cost: one pass, 96 bytes a tetrahedron
/// (ten a hexahedron).
TargetMatrices targetMatrices(const Mesh& rest, const std::vector<std::int8_t>& orientation,
  const Points& guide, TargetConstruction target, Monitor& monitor);

/// Sets weight 0 for tetrahedra with three corners on one of the boundary `faces` numbered in
/// `folded`. On a folded face, either these tetrahedra or their neighbors are inverted.
void excludeOnFoldedFaces(const Mesh& mesh, const BoundaryFaces& faces,
  const std::vector<Index>& folded, TargetMatrices& targets);

/// Returns the cells with a tetrahedron of positive weight that is inverted or flat at `points`
/// (#nodes x 3).
std::vector<Index> tangledCells(
  const Mesh& mesh, const Points& points, const TargetMatrices& targets);

/// Sets weight 0 for tetrahedra that are inverted or flat at `points` (#nodes x 3) and have two or
/// more fixed corners. Behind a fold of the boundary such tetrahedra cannot be positive. `isFixed`:
/// #nodes, nonzero where fixed. Returns their number.
Index excludeInvertedAtFixedNodes(const Mesh& mesh, const std::vector<char>& isFixed,
  const Points& points, TargetMatrices& targets);
}
