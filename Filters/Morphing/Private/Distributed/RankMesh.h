// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"
#include "Distributed/Ranks.h"
#include "Mesh/Mesh.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/MovedSurface.h"
#include "Quality/InvertedBefore.h"
#include "Session/UndeformedMesh.h"

#include <cstdint>
#include <memory>
#include <vector>

class vtkDataSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace morph::filters
{
/// A grid of which each MPI process has a piece, kept from one execution to the next. All functions
/// but the getters are collective.
class RankMesh
{
public:
  RankMesh();

  /// Takes the pieces, unless they are the ones that are kept; returns whether it did. Points and
  /// cells are known by their global ids where there are some. Throws morph::Error on all
  /// processes for a mesh that cannot be read. `layers`: of ghost cells.
  bool Take(
    vtkUnstructuredGrid* grid, int layers, GridMesh::UnknownCells unknown, morph::Monitor& monitor);
  /// Adds lines to Surface(), or takes them away; see MovedSurface. Each line is on one process.
  void SetFeatureLines(bool on, morph::Monitor& monitor);
  /// Throws morph::Error on all processes unless the mesh can be morphed.
  void RequireVolumeCells() const;

  const morph::distributed::Ranks& Ranks() const { return this->Processes; }
  const morph::distributed::DistributedMesh& Whole() const { return *this->Distributed; }
  /// Whole() for the core's code, made when it is first asked for. It outlives this object.
  const std::shared_ptr<const morph::UndeformedMesh>& Rest() const;
  /// The grid of this process as it came, ghost cells included.
  const morph::Mesh& Piece() const { return this->Copy; }
  /// Of the piece's cells, as of the whole mesh.
  const std::vector<std::int8_t>& Orientation() const { return this->Signs; }
  /// #cells of the piece: nonzero for ghosts, and for cells of a lower dimension than the whole
  /// mesh has.
  const std::vector<std::uint8_t>& Unmeasured() const { return this->Skip; }
  /// Of the whole mesh.
  ///@{
  int HighestDimension() const { return this->Dimension; }
  ///@}
  /// Of the cells in Whole(), ghosts included. Collective. Cost of the first call: a measure.
  const morph::InvertedBefore& Before(morph::Monitor& monitor) const;
  /// The outer faces of this process's cells.
  const MovedSurface& Surface() const { return this->Polygons; }

  /// Writes Surface() without quality, if `grid` has the cells of the piece, or else nothing. Not
  /// collective.
  void WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* output) const;
  /// Replaces the local numbers in the arrays MorphPointId and MorphCellId by global ids.
  void WriteGlobalIds(vtkDataSet* output) const;

private:
  morph::distributed::Ranks Processes;
  morph::Mesh Copy;
  std::vector<std::int64_t> NodeIds, CellIds; ///< as they came, or empty
  std::vector<std::uint8_t> Ghosts;
  int Layers = 0, Dimension = 0;
  bool Polyhedral = false;
  std::shared_ptr<morph::distributed::DistributedMesh> Distributed;
  std::vector<std::int8_t> Signs;
  std::vector<std::uint8_t> Skip;
  MovedSurface Polygons;
  mutable std::shared_ptr<const morph::UndeformedMesh> Undeformed; ///< or null
};
}
