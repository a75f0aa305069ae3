// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// How the target of a cell is constructed. Targets are independent of rotation.
enum class TargetConstruction
{
  Initial, ///< the undeformed cell
  /// the undeformed cell's angles: stretched along its axes to the edge lengths of a guide
  Stretched,
  /// right angles, or a regular tetrahedron, with the guide's mean edge length along each axis
  IdealSkew
};

/// What a cell counts for in the energy.
enum class CellWeights
{
  Volume, ///< of its target: affine motions are stationary with Initial targets
  /// all cells alike: inverted cells of a boundary layer would hardly count by their volume
  Equal
};

/// The corners of a cell, one a column, in the order of its shape.
using CellCorners = Eigen::Matrix<double, 3, 8>;

/// A cell with right angles, or a regular tetrahedron, that has these mean edge lengths along its
/// axes. Its corners are in VTK's order.
CellCorners idealShape(Shape shape, const Eigen::Vector3d& lengths);

/// Target matrices of all cells: for each tetrahedron of the averaged simplicial decompositions,
/// the inverse of its target and a weight.
struct TargetMatrices
{
  /// One tetrahedron: J = [x1 - x0, x2 - x0, x3 - x0] inverse(t) is the identity for the target's
  /// shape and size. The corners are those of the same entry in the shape's
  /// simplicialDecomposition(). A cell has the first of these tetrahedra or all.
  struct Tetrahedron
  {
    double inverse[9]; ///< column major
    /// decomposition weight times target volume, with CellWeights::Equal in units of the cell's
    /// mean; the mean over all is 1
    double weight;
    double theta; ///< of FoldoverDensity: 0.5 in tetrahedral cells, 0.1 in others
  };
  std::vector<Index> start; ///< #cells + 1
  std::vector<Tetrahedron> tetrahedra;
};

/// Computes the target matrices of a mesh. `orientation`: #cells, see cellSigns() in Topology.h;
/// `guide`: #nodes x 3, gives the edge lengths of Stretched and IdealSkew. Stretched uses ratios of
/// the sums of parallel edges, within [1/20, 20]; tetrahedra are as for Initial. Initial and
/// Stretched cannot use an undeformed cell with a scaled Jacobian of 1e-3 or less. It takes
/// IdealSkew with the edge lengths of its valid undeformed neighbors. Inner tetrahedra of a valid
/// cell that are not positive have weight 0. On several processes `rest` has the cells of this one,
/// and neighbors are those of this one. Cost: one pass, 96 bytes a tetrahedron (ten a hexahedron).
TargetMatrices targetMatrices(const Mesh& rest, const std::vector<std::int8_t>& orientation,
  const Points& guide, TargetConstruction target, CellWeights weights, Monitor& monitor,
  const Communicator& communicator = Communicator::alone());

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
