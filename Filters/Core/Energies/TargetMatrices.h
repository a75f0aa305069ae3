// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Mesh/Mesh.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/Topology.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"

#include <Eigen/Core>

#include <cstdint>
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

/// Target matrices of all cells, kept as the corners of each target cell. Its tetrahedra are those
/// of the averaged simplicial decomposition. J = [x1 - x0, x2 - x0, x3 - x0] times the inverse of
/// the same edges of the target is the identity for the target's shape and size. All matrices of a
/// hexahedron would take four times as much memory as its corners.
struct TargetMatrices
{
  std::vector<Index> start{ 0 }; ///< #cells + 1: the first corner of each volume cell
  std::vector<double> corners;   ///< three numbers a corner, in the order of the shape
  /// #cells. A tetrahedron's weight is this, times its weight in the decomposition, times the
  /// determinant of the target's edges. The mean over all is 1; with CellWeights::Equal a cell's
  /// sum does not depend on its volume. It has the sign of the cell.
  std::vector<double> factor;
  std::vector<std::uint32_t> included; ///< #cells: bit t is set unless tetrahedron t is left out
  double theta = 0; ///< of FoldoverDensity: 0.5 in meshes of tetrahedra alone, 0.1 in others

  bool includes(Index cell, int tetrahedron) const
  {
    return (this->included[cell] >> tetrahedron & 1u) != 0;
  }
  void exclude(Index cell, int tetrahedron) { this->included[cell] &= ~(1u << tetrahedron); }
  /// The target's edges from the tetrahedron's first corner, by columns.
  Eigen::Matrix3d edges(Index cell, const WeightedTet& tetrahedron) const;
  /// Makes room for the corners of a mesh's cells, with all tetrahedra left out.
  void open(const Mesh& mesh);
};

/// Computes the target matrices of a mesh. `orientation`: #cells, see cellSigns() in Topology.h;
/// `guide`: #nodes x 3, gives the edge lengths of Stretched and IdealSkew. Stretched uses ratios of
/// the sums of parallel edges, within [1/20, 20]; tetrahedra are as for Initial. Initial and
/// Stretched cannot use an undeformed cell with a scaled Jacobian of 1e-3 or less. It takes
/// IdealSkew with the edge lengths of its valid undeformed neighbors. Inner tetrahedra of a valid
/// cell that are not positive are left out. On several processes `rest` has the cells of this one,
/// and neighbors are those of this one. Cost: one pass, 24 bytes a corner of each cell.
TargetMatrices targetMatrices(const Mesh& rest, const std::vector<std::int8_t>& orientation,
  const Points& guide, TargetConstruction target, CellWeights weights, Monitor& monitor,
  const Communicator& communicator = Communicator::alone());

/// Leaves out the tetrahedra with three corners on one of the boundary `faces` numbered in
/// `folded`. On a folded face, either these tetrahedra or their neighbors are inverted.
void excludeOnFoldedFaces(const Mesh& mesh, const BoundaryFaces& faces,
  const std::vector<Index>& folded, TargetMatrices& targets);

/// Returns the cells with a tetrahedron, not left out, that is inverted or flat at `points` (#nodes
/// x 3).
std::vector<Index> tangledCells(
  const Mesh& mesh, const Points& points, const TargetMatrices& targets);

/// Leaves out the tetrahedra that are inverted or flat at `points` (#nodes x 3) and have two or
/// more fixed corners. Behind a fold of the boundary such tetrahedra cannot be positive. `isFixed`:
/// #nodes, nonzero where fixed. Returns their number.
Index excludeInvertedAtFixedNodes(const Mesh& mesh, const std::vector<char>& isFixed,
  const Points& points, TargetMatrices& targets);

/// The shapes that smoothing aims for.
enum class SmoothingTarget
{
  Initial, ///< the undeformed cell: targetMatrices(), weighted by volume
  /// a cube, a regular tetrahedron, or a wedge or pyramid with equal edges, all cells of equal
  /// weight; one tetrahedron at each corner except a pyramid's apex
  Ideal
};

/// Computes target matrices for the inverse mean ratio: theta is 0, so only the shape counts. An
/// Ideal cell has the undeformed cell's volume, or the mean volume if that is nearly 0.
/// `orientation`: #cells, see cellSigns() in Topology.h. Cost: as targetMatrices().
TargetMatrices smoothingTargets(const Mesh& rest, const std::vector<std::int8_t>& orientation,
  SmoothingTarget target, Monitor& monitor,
  const Communicator& communicator = Communicator::alone());
}
