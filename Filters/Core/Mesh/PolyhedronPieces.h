// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/HangingNodes.h"
#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Support/Communicator.h"
#include "Support/Lists.h"
#include "Support/Monitor.h"

#include <Eigen/SparseCore>

#include <memory>
#include <vector>

namespace morph
{
/// The pieces that methods see of the cells of a mesh, or of a process's part of one.
class CellPieces
{
public:
  virtual ~CellPieces();

  /// The pieces and the other cells, with the centers at their first places.
  virtual const Mesh& mesh() const = 0;
  /// Those that have the other parts of mesh(), or this process alone. What it tells of cells it
  /// tells of those that the pieces are cut from. Holds this object by reference.
  virtual std::shared_ptr<const Communicator> processes() const = 0;
  /// The cell that a piece is cut from; -1 for a copy of another process's piece.
  virtual Index cellOf(Index piece) const = 0;
  /// The node of the pieces that a node is; -1 for one that no cell of this process has.
  virtual Index nodeOf(Index node) const = 0;

  /// Returns `points` or displacements, #nodes x 3, for the nodes of mesh(): the center of a face
  /// is the mean of its nodes, and that of a cell the mean of its faces, weighted by their
  /// undeformed areas. Affine motions map them, too. Collective.
  virtual Points extend(const ConstPoints& points) const = 0;
  /// Returns the rows of the nodes without the centers. Nodes of no cell keep their row of
  /// `points`, #nodes x 3. Collective.
  virtual Points reduce(const Points& all, Points points) const = 0;
  /// Adds the gradient of the centers to that of the nodes that they are means of: the adjoint of
  /// extend(). Returns #nodes x 3; copies' rows are to be added to those that count.
  virtual Points extendTranspose(const ConstPoints& all) const = 0;
  /// The groups of all nodes. Centers of faces whose nodes are all prescribed are prescribed, too;
  /// the other centers are free. Nodes that no cell here has are left out. `partition`: of the mesh
  /// without centers. Collective.
  virtual NodePartition extend(const NodePartition& partition) const = 0;
  /// Returns `values`, one a cell, for each piece of this process: that of the cell it is cut from.
  virtual std::vector<double> extend(const std::vector<double>& values) const = 0;
};

/// The processes that have pieces, in whose messages these are the cells that they are cut from.
/// `Processes`: the class of their communicator.
template <typename Processes>
class ProcessesOfPieces : public Processes
{
public:
  /// `ofPieces`: of the pieces, `ofCells`: of the cells. Holds `pieces` by reference.
  ProcessesOfPieces(const CellPieces& pieces, const Processes& ofPieces, const Processes& ofCells)
    : Processes(ofPieces)
    , pieces_(pieces)
    , ofCells_(ofCells)
  {
  }

  std::vector<Index> gatherCells(const std::vector<Index>& pieces) const override
  {
    std::vector<Index> cells;
    for (const Index piece : pieces)
    {
      if (!this->isCopy(piece))
      {
        cells.push_back(this->pieces_.cellOf(piece));
      }
    }
    sortUnique(cells);
    return this->ofCells_.gatherCells(cells);
  }

private:
  const CellPieces& pieces_;
  const Processes ofCells_;
};

/// A mesh whose polyhedra are cut into tetrahedra and pyramids, for methods that know these alone.
///
/// Each polyhedron gets a node at its center, and each face a piece up to there: a tetrahedron on a
/// triangle, a pyramid on a quadrilateral. A face of more nodes, or a quadrilateral with a corner
/// that is flat or turned inward, gets a node at its center and a tetrahedron on each edge. Both
/// cells at a face cut it alike. A quadrilateral of a hexahedron, wedge or pyramid stays whole, so
/// that the mesh is conforming. So does a polyhedron that is a tetrahedron or hexahedron with
/// whole faces and clearly positive corners.
///
/// Node ids stay; the centers of faces follow, then those of cells. Cell ids stay, too: that of a
/// polyhedron is now its first piece, and its other pieces come after all cells.
class PolyhedronPieces : public CellPieces
{
public:
  /// `mesh`: valid, its polyhedra oriented (Polyhedra.h). `cutsAll`: cuts tetrahedra and hexahedra,
  /// too, for tests. Cost: see faceTable(), and a pass.
  PolyhedronPieces(const Mesh& mesh, Monitor& monitor, bool cutsAll = false);

  const Mesh& mesh() const override { return this->pieces_; }
  std::shared_ptr<const Communicator> processes() const override;
  Index cellOf(Index piece) const override;
  Index nodeOf(Index node) const override { return node; }
  Points extend(const ConstPoints& points) const override;
  Points reduce(const Points& all, Points points) const override;
  Points extendTranspose(const ConstPoints& all) const override;
  NodePartition extend(const NodePartition& partition) const override;
  std::vector<double> extend(const std::vector<double>& values) const override;

  /// For parts of a distributed mesh: the number of centers of faces, which come before those of
  /// cells, and the weights of the nodes in all centers.
  ///@{
  using Weights = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;
  Index faceCenters() const { return this->faceCenters_; }
  const Weights& means() const { return this->means_; }
  ///@}

private:
  Mesh pieces_;
  std::vector<Index> cellOfOther_; ///< the cell of each piece beyond the mesh's cells
  Index nodes_ = 0;                ///< without centers
  Index faceCenters_ = 0;
  Weights means_; ///< #centers x #nodes
};

/// Cuts the polyhedra of a mesh, and its cells at divided faces. `hanging`: of the mesh. `layers`:
/// of copies around the pieces of a process. `cutsAll`: see PolyhedronPieces. Collective.
std::shared_ptr<const CellPieces> cutCells(const Mesh& mesh, const HangingNodes& hanging,
  const Communicator& processes, int layers, Monitor& monitor, bool cutsAll = false);
}
