// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Morph/KeptMesh.h"
#include "Private/Morph/ModeSolver.h"

namespace morph::filters
{
/// ModeSolver of a mesh that this process has all of.
class KeptModeSolver : public ModeSolver
{
public:
  bool Take(
    vtkUnstructuredGrid* grid, const CreateMorpher& create, morph::Monitor& monitor) override;
  void SetFeatureLines(bool on, morph::Monitor&) override { this->Kept.SetFeatureLines(on); }
  const morph::UndeformedMesh& Rest() const override { return *this->Kept.Rest(); }
  morph::Index GridNodes() const override { return this->Mesh().numberOfNodes(); }
  bool Owns(morph::Index) const override { return true; }
  morph::BoundaryTargets Match(
    vtkPointSet* boundary, const BoundaryMatch::Options& options) const override;
  Measured Write(vtkUnstructuredGrid* grid, const morph::Points& moved, int precision, bool all,
    const MorphOutput::Outputs& outputs, morph::Monitor& monitor) const override;
  bool Crosses(const morph::Points& moved, morph::Monitor& monitor) const override;
  void WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* surface) const override
  {
    this->Kept.WriteUndeformedSurface(grid, surface);
  }

private:
  KeptMesh Kept;
};
}
