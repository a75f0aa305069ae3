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

/// The tetrahedra of all cells' averaged simplicial decompositions, with the inverse of their
/// target and their weight.
struct TargetMatrices
{
  /// Of tetrahedron t: J = [x1 - x0, x2 - x0, x3 - x0] inverse(t) is the identity where it has its
  /// target's shape and size. Its corners are those of the same place in the shape's
  /// simplicialDecomposition(), of which a cell has the first ones or all.
  struct Tetrahedron
  {
    bool stiffened;    ///< not in tetrahedral cells: it lowers their scaled Jacobian
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

/// Gives weight 0 to the tetrahedra that have three corners on one of the boundary `faces` numbered
/// in `folded`, which are turned over: either these are inverted or their neighbors.
void excludeOnFoldedFaces(const Mesh& mesh, const BoundaryFaces& faces,
  const std::vector<Index>& folded, TargetMatrices& targets);

/// Ids of the cells with a tetrahedron of positive weight that is inverted or flat at `points`
/// (#nodes x 3).
std::vector<Index> tangledCells(
  const Mesh& mesh, const Points& points, const TargetMatrices& targets);

/// Gives weight 0 to the tetrahedra that are inverted or flat at `points` (#nodes x 3) and have at
/// least two corners whose `isFixed` (#nodes) is not 0: behind a fold of the boundary, where none
/// can be positive. Returns how many.
Index excludeInvertedAtFixedNodes(const Mesh& mesh, const std::vector<char>& isFixed,
  const Points& points, TargetMatrices& targets);
}
