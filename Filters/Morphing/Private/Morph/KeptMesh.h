// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Data/MovedSurface.h"
#include "Private/Data/Unchanged.h"
#include "Session/UndeformedMesh.h"

#include <memory>

class vtkPolyData;
class vtkUnstructuredGrid;

namespace morph::filters
{
/// The grid of a filter as a mesh and its surface, kept from one execution to the next.
class KeptMesh
{
public:
  /// Copies the grid, unless it is the same as the kept one; returns whether it was copied. Throws
  /// morph::Error for a grid that cannot be morphed; the kept one stays. Cost: nothing for a grid
  /// that is not modified, else a comparison, or the search of the outer faces.
  bool Take(vtkUnstructuredGrid* grid, morph::Monitor& monitor);

  /// Whether Surface() has lines along sharp edges; see MovedSurface. After Take().
  void SetFeatureLines(bool on)
  {
    this->Polygons.SetFeatureLines(on, this->Copy->mesh(), this->Copy->outerFaces());
  }

  /// The same object while the grid stays the same.
  const std::shared_ptr<const morph::UndeformedMesh>& Rest() const { return this->Copy; }
  /// The outer faces as polygons that are made once.
  const MovedSurface& Surface() const { return this->Polygons; }
  /// Fills `surface` with the outer faces of `grid`, which may be the kept mesh or another, without
  /// quality. It is empty for a grid that cannot be morphed.
  void WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* surface) const;

private:
  Unchanged Taken; ///< the grid that is the same as Copy
  std::shared_ptr<const morph::UndeformedMesh> Copy = std::make_shared<morph::UndeformedMesh>();
  MovedSurface Polygons;
};
}
