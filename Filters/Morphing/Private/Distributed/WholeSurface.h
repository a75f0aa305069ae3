// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/InnerPieces.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Private/Morph/BoundaryMatch.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

class vtkPolyData;
class vtkUnstructuredGrid;

namespace morph::filters
{
class RankMesh;

/// The boundary of a mesh whose pieces are on several MPI processes, whole and the same on each of
/// them. So serial code of surfaces runs on each process alike, with the same bits, and each keeps
/// the part of the result that its own cells have. Not to be used unless Ranks::TakePieces().
///
/// It has the cells with an outer face and the two-dimensional cells; nodes and cells in the order
/// of their global ids. Where the serial filter has this order too, surfaces and curves have the
/// same numbers. Memory and messages of each process grow with the whole boundary, not with the
/// mesh: see Bytes().
class WholeSurface
{
public:
  /// Throws std::logic_error in a build without MPI.
  static std::unique_ptr<WholeSurface> Make();
  virtual ~WholeSurface() = default;

  /// Gathers the boundary, unless the pieces are those that it was gathered from. Throws
  /// morph::Error on all processes for a mesh that cannot be read or has no volume cells.
  /// Collective, as all functions that say so.
  virtual void Take(vtkUnstructuredGrid* piece, morph::Monitor& monitor) = 0;

  /// Those cells, with the arrays that all pieces have.
  virtual vtkUnstructuredGrid* Grid() const = 0;
  virtual const morph::Mesh& Mesh() const = 0; ///< of Grid()
  /// The outer faces of the whole mesh; partition interfaces are none.
  virtual const morph::BoundaryFaces& Faces() const = 0;
  /// #nodes: the body of the whole mesh, or -1; see bodyOfNodes().
  virtual const std::vector<morph::Index>& BodyOfNode() const = 0;
  /// #cells: cellSigns() of the whole mesh.
  virtual const std::vector<std::int8_t>& Orientation() const = 0;
  /// The diagonal of the whole mesh's bounding box.
  virtual double Size() const = 0;
  /// Bytes that this process received to gather the boundary.
  virtual std::size_t Bytes() const = 0;

  /// The pieces that it was gathered from.
  virtual const RankMesh& Pieces() const = 0;

  /// Bodies of the whole mesh, numbered by their lowest cell.
  virtual morph::Index NumberOfBodies() const = 0;
  /// For each point of the piece its node of Grid(), or #nodes + its body or, for a point of no
  /// volume cell, #nodes + NumberOfBodies().
  virtual std::vector<morph::Index> Places() const = 0;
  /// The node of Grid() with a global id, or -1.
  virtual morph::Index NodeOf(std::int64_t id) const = 0;
  /// The global ids of the nodes and cells of Grid(), ascending.
  ///@{
  virtual const std::vector<std::int64_t>& NodeIds() const = 0;
  virtual const std::vector<std::int64_t>& CellIds() const = 0;
  ///@}
  /// BoundaryMatch::Match() for the nodes of Grid(). `boundary`: the points of this process. Inner
  /// nodes that it names are left out. Collective.
  virtual morph::BoundaryTargets Match(
    vtkPointSet* boundary, const BoundaryMatch::Options& options) const = 0;

  /// Calls `work`, the same on each process, which must not communicate; throws as
  /// Ranks::Together() does. A message with ids says of what they are. Collective.
  virtual void Together(const std::function<void()>& work) const = 0;

  /// Whether any process sets a node's flag. `ofPiece`: of its points, or empty. Collective.
  virtual std::vector<std::uint8_t> AnyFlags(const std::vector<std::uint8_t>& ofPiece) const = 0;

  /// Leaves those cells of a surface of Grid() that belong to cells of this process, and the
  /// points on them; a cell without MorphCellId belongs where its first point does. MorphPointId
  /// and MorphCellId, nodes and cells of Grid() before, become global ids.
  virtual void KeepOwn(vtkPolyData* surface) const = 0;
  /// Replaces points of the piece in MorphPointId by global ids, for the last `count` points.
  virtual void MakeIdsGlobal(vtkPolyData* surface, vtkIdType count) const = 0;
  /// A shallow copy of what KeepOwn() left, where MorphPointId and MorphCellId are points and cells
  /// of this process's piece.
  virtual vtkSmartPointer<vtkPolyData> OfPiece(vtkPolyData* surface) const = 0;
  /// The global ids of points of the piece.
  virtual std::vector<std::int64_t> IdsOfPiece(const std::vector<morph::Index>& points) const = 0;
  /// The largest and the mean of values of nodes, each of which counts once. `ids`: global, of the
  /// nodes that this process has a value for. NaN without any. Collective.
  virtual std::pair<double, double> MaximumAndMean(
    const std::vector<std::int64_t>& ids, const std::vector<double>& values) const = 0;

  /// All processes' parts of a surface as one, the same on each of them. Where processes have equal
  /// parts, as where each has read the whole surface, one of these counts. Collective.
  virtual vtkSmartPointer<vtkPolyData> Gather(vtkPolyData* part) const = 0;

  /// The inner nodes of the mesh, by nodes of Grid(). Holds this object by reference, after Take().
  virtual std::unique_ptr<morph::InnerPieces> Volume() const = 0;
};
}
