// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/AttachedNodes.h"
#include "Mesh/Mesh.h"
#include "Morpher/Morpher.h"
#include "Private/Data/Crossings.h"
#include "Private/Data/Quality.h"
#include "Private/Morph/BoundaryMatch.h"
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
  virtual ~ModeSolver() = default;

  /// Takes the grid, unless it is the same as the kept one; returns whether it did. Throws
  /// morph::Error for a grid that cannot be morphed.
  virtual bool Take(
    vtkUnstructuredGrid* grid, const CreateMorpher& create, morph::Monitor& monitor) = 0;
  /// See KeptMesh. After Take().
  virtual void SetFeatureLines(bool on, morph::Monitor& monitor) = 0;

  /// The mesh of this process. Of a piece, nodes and cells of other processes come behind its own.
  virtual const morph::UndeformedMesh& Rest() const = 0;
  const morph::Mesh& Mesh() const { return this->Rest().mesh(); }
  /// The nodes of the grid itself.
  virtual morph::Index GridNodes() const = 0;
  /// Warns of what is odd about the whole mesh.
  void ReportMesh(morph::Monitor& monitor) const;
  /// Of Mesh(). Cost of the first call: a measure.
  const morph::InvertedBefore& Before(morph::Monitor& monitor) const;
  /// Whether this process counts a node: one of those that have it does.
  virtual bool Owns(morph::Index node) const = 0;
  /// The number of a node in the whole mesh.
  morph::Index NodeId(morph::Index node) const { return this->All().idsOf({ node }).front(); }

  /// BoundaryMatch::Match(). Of Sources the signs alone are known on several processes.
  virtual morph::BoundaryTargets Match(
    vtkPointSet* boundary, const BoundaryMatch::Options& options) const = 0;
  /// Prepares the method for these nodes of Mesh(), ascending.
  void Prepare(std::unique_ptr<morph::LinearMorpher> method,
    const std::vector<morph::Index>& prescribed, morph::Monitor& monitor);
  /// See LinearMorpher::basis(). After Prepare().
  std::vector<morph::Points> Basis(const std::vector<morph::Points>& displacements,
    std::vector<morph::EvaluateReport>& reports, morph::Monitor& monitor) const;

  /// The nodes that no volume cell uses. After Prepare(). Their functions are collective.
  const morph::AttachedNodes& Attached() const { return this->Hanging; }

  struct Measured
  {
    morph::Quality Whole;   ///< the numbers of the whole mesh; of `all` cells alone
    Quality::Judged Judged; ///< of `all` cells alone
    morph::Index SurfaceInverted = 0;
    Crossings::Found Crossing; ///< of `all` cells alone
  };
  /// Writes the grid with its nodes at `moved`, #nodes of Mesh() x 3, and measures all cells, or
  /// those behind the outer faces alone. `precision`: see MorphOutput::WriteMesh().
  virtual Measured Write(vtkUnstructuredGrid* grid, const morph::Points& moved, int precision,
    bool all, const MorphOutput::Outputs& outputs, morph::Monitor& monitor) const = 0;
  /// Whether the boundary of the whole mesh runs into itself, and did not undeformed, where the
  /// nodes are at `moved`, #nodes of Mesh() x 3.
  virtual bool Crosses(const morph::Points& moved, morph::Monitor& monitor) const = 0;
  /// The surface of `grid` in its undeformed state, as far as it is known.
  virtual void WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* surface) const = 0;

protected:
  /// Forgets what was prepared for another mesh.
  void Forget();

private:
  const morph::Communicator& All() const
  {
    return this->Rest().processes() ? *this->Rest().processes() : morph::Communicator::alone();
  }

  std::unique_ptr<morph::LinearMorpher> Method; ///< prepared, or null
  std::vector<morph::Index> Prescribed;         ///< by the caller
  morph::AttachedNodes Hanging;                 ///< of Method
};
}
