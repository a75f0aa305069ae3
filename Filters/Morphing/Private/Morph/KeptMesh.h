// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Private/Data/MovedSurface.h"
#include "Private/Data/Unchanged.h"
#include "Quality/InvertedBefore.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

class vtkPolyData;
class vtkUnstructuredGrid;

namespace morph
{
class Monitor;
}

namespace morph::filters
{
/// The undeformed mesh of a filter, kept from one execution to the next, with what follows from it.
class KeptMesh
{
public:
  /// Copies the grid, unless it is the same as the kept one; returns whether it was copied. Throws
  /// morph::Error for a grid that cannot be morphed; the kept one stays. Cost: nothing for a grid
  /// that is not modified, else a comparison, or the search of the outer faces.
  bool Take(vtkUnstructuredGrid* grid, morph::Monitor& monitor);

  /// Whether Surface() has lines along sharp edges; see MovedSurface. After Take().
  void SetFeatureLines(bool on) { this->Polygons.SetFeatureLines(on, *this->Copy, this->Outer); }

  const morph::Mesh& Mesh() const { return *this->Copy; }
  /// The same, for a method that keeps it.
  const std::shared_ptr<const morph::Mesh>& SharedMesh() const { return this->Copy; }
  const morph::BoundaryFaces& OuterFaces() const { return this->Outer; }
  /// See GridMesh::Size.
  double Size() const { return this->Diameter; }
  /// #cells; see Topology.h.
  const std::vector<std::int8_t>& Orientation() const { return this->Signs; }
  morph::Index MirroredBodies() const { return this->Mirrored; }
  /// Cells that are there twice, and nodes where bodies touch by chance; see SharedCorners.h.
  ///@{
  const std::vector<morph::Index>& RepeatedCells() const { return this->Repeated; }
  const std::vector<morph::Index>& TouchingNodes() const { return this->Touching; }
  ///@}
  /// Cost of the first call: a measure of the mesh.
  const morph::InvertedBefore& Before(morph::Monitor& monitor) const;
  /// The outer faces as polygons that are made once.
  const MovedSurface& Surface() const { return this->Polygons; }
  /// Fills `surface` with the outer faces of `grid`, which may be the kept mesh or another, without
  /// quality. It is empty for a grid that cannot be morphed.
  void WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* surface) const;

private:
  Unchanged Taken; ///< the grid that is the same as Copy
  std::shared_ptr<const morph::Mesh> Copy = std::make_shared<morph::Mesh>();
  morph::BoundaryFaces Outer;
  MovedSurface Polygons;
  double Diameter = 0;
  std::vector<std::int8_t> Signs;
  morph::Index Mirrored = 0;
  std::vector<morph::Index> Repeated, Touching;
  mutable std::optional<morph::InvertedBefore> Inverted; ///< of Copy, once it was asked for
};
}
