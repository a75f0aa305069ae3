// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/AttachedNodes.h"
#include "Mesh/Mesh.h"
#include "Morpher/Morpher.h"
#include "Private/Morph/KeptMesh.h"
#include "Private/Morph/MorphOutput.h"
#include "Session/UndeformedMesh.h"

#include <functional>
#include <memory>
#include <vector>

class vtkPolyData;
class vtkUnstructuredGrid;

namespace morph::filters
{
/// The undeformed mesh of vtkMorphShapes and its linear method, kept between executions. Either
/// this process has the whole mesh, or several have pieces of it. In the second case all of them
/// call each function that takes a monitor, and Match(), and these throw on all or none.
class ModeSolver
{
public:
  using CreateMorpher = std::function<std::unique_ptr<morph::LinearMorpher>()>;
  explicit ModeSolver(std::unique_ptr<KeptMesh> mesh);

  /// See KeptMesh::Take().
  bool Take(vtkUnstructuredGrid* grid, const CreateMorpher& create, morph::Monitor& monitor);
  /// See KeptMesh. After Take().
  void SetFeatureLines(bool on, morph::Monitor& monitor)
  {
    this->Kept->SetFeatureLines(on, monitor);
  }

  /// The mesh of this process. Of a piece, nodes and cells of other processes come behind its own.
  const morph::UndeformedMesh& Rest() const { return *this->Kept->Rest(); }
  const morph::Mesh& Mesh() const { return this->Rest().mesh(); }
  /// The nodes of the grid itself.
  morph::Index GridNodes() const { return this->Kept->Grid().numberOfNodes(); }
  /// Warns of what is odd about the whole mesh.
  void ReportMesh(morph::Monitor& monitor) const;
  /// Of Mesh(). Cost of the first call: a measure.
  const morph::InvertedBefore& Before(morph::Monitor& monitor) const
  {
    return this->Kept->Before(monitor);
  }
  /// Whether this process counts a node: one of those that have it does.
  bool Owns(morph::Index node) const { return this->Kept->Owns(node); }
  /// The number of a node in the whole mesh.
  morph::Index NodeId(morph::Index node) const
  {
    return this->Rest().all().idsOf({ node }).front();
  }

  /// KeptMesh::Match(). Throws morph::Error where a plane mesh's boundary leaves the plane.
  morph::BoundaryTargets Match(vtkPointSet* boundary, const BoundaryMatch::Options& options) const;
  /// Prepares the method for these nodes of Mesh(), ascending.
  void Prepare(std::unique_ptr<morph::LinearMorpher> method,
    const std::vector<morph::Index>& prescribed, morph::Monitor& monitor);
  /// See LinearMorpher::basis(). After Prepare().
  std::vector<morph::Points> Basis(const std::vector<morph::Points>& displacements,
    std::vector<morph::EvaluateReport>& reports, morph::Monitor& monitor) const;

  /// The nodes that no volume cell uses. After Prepare(). Their functions are collective.
  const morph::AttachedNodes& Attached() const { return this->Hanging; }

  /// Writes the grid with its nodes at `moved`, #nodes of Mesh() x 3, and measures all cells, or
  /// those behind the outer faces alone. `precision`: see MorphOutput::WriteMesh().
  MorphOutput::Measured Write(vtkUnstructuredGrid* grid, const morph::Points& moved, int precision,
    bool all, const MorphOutput::Outputs& outputs, morph::Monitor& monitor) const;
  /// Whether the boundary of the whole mesh runs into itself, and did not undeformed, where the
  /// nodes are at `moved`, #nodes of Mesh() x 3.
  bool Crosses(const morph::Points& moved, morph::Monitor& monitor) const;
  /// See KeptMesh.
  void WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* surface) const
  {
    this->Kept->WriteUndeformedSurface(grid, surface);
  }

private:
  std::unique_ptr<KeptMesh> Kept;
  std::unique_ptr<morph::LinearMorpher> Method; ///< prepared, or null
  std::vector<morph::Index> Prescribed;         ///< by the caller
  morph::AttachedNodes Hanging;                 ///< of Method
};
}
