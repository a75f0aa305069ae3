// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/Morpher.h"
#include "Private/Data/MovedSurface.h"
#include "Private/Morph/BoundaryMatch.h"
#include "Session/UndeformedMesh.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

class vtkDataSet;
class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace morph::filters
{
/// The grid of a filter as a mesh and its surface, kept from one execution to the next. Either this
/// process has the whole mesh, or several have pieces of it. In the second case all of them call
/// each function that says it is collective, and it throws on all or none.
class KeptMesh
{
public:
  using CreateMorpher = std::function<std::unique_ptr<morph::Morpher>()>;
  virtual ~KeptMesh() = default;

  /// Takes the grid, unless it is the same as the kept one; returns whether it did. Throws
  /// morph::Error for a grid that cannot be morphed, and for a method that needs one process.
  /// `method`: its name. Cost: nothing for a grid that is not modified, else a comparison, or the
  /// search of the outer faces. Collective.
  virtual bool Take(vtkUnstructuredGrid* grid, const std::string& method,
    const CreateMorpher& create, morph::Monitor& monitor) = 0;
  /// Adds lines along sharp edges to Surface(), or takes them away; see MovedSurface. Each is on
  /// one process. After Take(). Collective.
  virtual void SetFeatureLines(bool on, morph::Monitor& monitor) = 0;

  /// The same object while the grid stays the same. Of a piece, nodes and cells of other processes
  /// come behind its own. Making it is collective.
  virtual const std::shared_ptr<const morph::UndeformedMesh>& Rest() const = 0;
  /// Those that have parts of the mesh.
  const morph::Communicator& All() const { return this->Rest()->all(); }
  /// Of Rest(). Collective. Cost of the first call: a measure.
  const morph::InvertedBefore& Before(morph::Monitor& monitor) const
  {
    this->All().together([&] { this->Rest()->before(monitor); });
    return this->Rest()->before(monitor);
  }
  /// The grid itself.
  virtual const morph::Mesh& Grid() const = 0;
  /// #cells of Grid(): nonzero for ghosts, and for cells of a lower dimension than the whole mesh
  /// has; empty for one process.
  virtual const std::vector<std::uint8_t>& Unmeasured() const = 0;
  /// The outer faces of this process's cells as polygons that are made once.
  const MovedSurface& Surface() const { return this->Polygons; }
  /// Whether this process counts a node: one of those that have it does.
  bool Owns(morph::Index node) const { return this->All().owns(node); }
  /// The places of the nodes of Grid(). `moved`: of those of Rest(). Returns it, or `memory`.
  virtual const morph::Points& OfGrid(const morph::Points& moved, morph::Points& memory) const = 0;

  /// The nodes of Rest().
  virtual BoundaryMatch::Nodes Nodes() const = 0;
  /// BoundaryMatch::Match(). Collective.
  morph::BoundaryTargets Match(vtkPointSet* boundary, const BoundaryMatch::Options& options,
    BoundaryMatch::Followers* followers = nullptr) const
  {
    return BoundaryMatch::Match(boundary, this->Nodes(), options, this->All(), followers);
  }

  /// Fills `surface` with the outer faces of `grid`, which may be the kept mesh or another, without
  /// quality. It is empty for a grid that cannot be morphed, and for a piece of another mesh.
  virtual void WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* surface) const = 0;
  /// Replaces the numbers of Grid() in the arrays MorphPointId and MorphCellId by those in the
  /// whole mesh.
  virtual void WriteGlobalIds(vtkDataSet* output) const = 0;

protected:
  MovedSurface Polygons;
};
}
