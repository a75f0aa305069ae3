// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/InnerPieces.h"
#include "Mesh/Mesh.h"
#include "Private/Distributed/GatheredSurface.h"
#include "Private/Morph/BoundaryMatch.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <functional>
#include <memory>
#include <utility>
#include <vector>

class vtkPolyData;
class vtkUnstructuredGrid;

namespace morph::filters
{
/// The boundary of a mesh whose pieces are on several MPI processes, whole and the same on each of
/// them. So serial code of surfaces runs on each process alike, with the same bits, and each keeps
/// the part of the result that its own cells have. Not to be used unless Ranks::TakePieces().
///
/// It has the cells with an outer face, the two-dimensional cells and those at inner surfaces.
/// Nodes and cells are in the order of their global ids. Where the serial filter has this order
/// too, surfaces and curves have the same numbers. Memory and messages of each process grow with
/// the whole boundary, inner surfaces included, and not with the mesh, unless all of it is asked
/// for: see GatheredSurface::Bytes.
///
/// Beside it are the inner nodes of the mesh: nodes of InnerPieces are those of Boundary().
class WholeSurface : public morph::InnerPieces
{
public:
  /// Throws std::logic_error in a build without MPI.
  static std::unique_ptr<WholeSurface> Make();

  /// Gathers the boundary, unless the pieces are those that it was gathered from. `list`: gives the
  /// zones of the whole mesh with this process's cells, collective. Then gathers the whole mesh if
  /// `needsAll`, called by together(), says so of the boundary. Throws morph::Error on all
  /// processes for a mesh that cannot be read or has no volume cells. Collective, as all functions
  /// that say so.
  virtual void Take(vtkUnstructuredGrid* piece, morph::Monitor& monitor,
    const std::function<std::vector<ListedZone>()>& list = nullptr,
    const std::function<bool()>& needsAll = nullptr) = 0;

  const GatheredSurface& Boundary() const { return this->Surface; }
  /// The diagonal of the whole mesh's bounding box.
  virtual double Size() const = 0;

  /// For each point of the piece its node of the boundary, or #nodes + its body or, for a point of
  /// no volume cell, #nodes + #bodies.
  virtual std::vector<morph::Index> Places() const = 0;
  /// BoundaryMatch::Match() for the nodes of Boundary(). `boundary`: the points of this process.
  /// Inner nodes that it names are left out. Collective.
  virtual morph::BoundaryTargets Match(
    vtkPointSet* boundary, const BoundaryMatch::Options& options) const = 0;

  /// Leaves those cells of a surface of Boundary() that belong to cells of this process, and the
  /// points on them; a cell without MorphCellId belongs where its first point does. MorphPointId
  /// and MorphCellId, nodes and cells of Boundary() before, become global ids.
  virtual void KeepOwn(vtkPolyData* surface) const = 0;
  /// Replaces points of the piece in MorphPointId by global ids, for the last `count` points.
  virtual void MakeIdsGlobal(vtkPolyData* surface, vtkIdType count) const = 0;
  /// A shallow copy of what KeepOwn() left, where MorphPointId and MorphCellId are points and cells
  /// of this process's piece.
  virtual vtkSmartPointer<vtkPolyData> OfPiece(vtkPolyData* surface) const = 0;
  /// The largest and the mean of values of nodes, each of which counts once. `points`: those of the
  /// piece that this process has a value for. NaN without any. Collective.
  virtual std::pair<double, double> MaximumAndMean(
    const std::vector<morph::Index>& points, const std::vector<double>& values) const = 0;

  /// All processes' parts of a surface as one, the same on each of them. Where processes have equal
  /// parts, as where each has read the whole surface, one of these counts. Collective.
  virtual vtkSmartPointer<vtkPolyData> Gather(vtkPolyData* part) const = 0;

protected:
  GatheredSurface Surface;
};
}
