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
  const morph::Mesh& Mesh() const override { return this->Kept.Rest()->mesh(); }
  morph::Index GridNodes() const override { return this->Kept.Rest()->mesh().numberOfNodes(); }
  const std::vector<std::int8_t>& Orientation() const override
  {
    return this->Kept.Rest()->orientation();
  }
  double Size() const override { return this->Kept.Rest()->size(); }
  morph::Index MirroredBodies() const override { return this->Kept.Rest()->mirroredBodies(); }
  void ReportMesh(morph::Monitor& monitor) const override;
  const morph::InvertedBefore& Before(morph::Monitor& monitor) const override
  {
    return this->Kept.Rest()->before(monitor);
  }
  bool Owns(morph::Index) const override { return true; }
  std::int64_t NodeId(morph::Index node) const override { return node; }
  morph::BoundaryTargets Match(
    vtkPointSet* boundary, const BoundaryMatch::Options& options) const override;
  void Prepare(std::unique_ptr<morph::LinearMorpher> method,
    const std::vector<morph::Index>& prescribed, morph::Monitor& monitor) override;
  std::vector<morph::Points> Basis(const std::vector<morph::Points>& displacements,
    std::vector<morph::EvaluateReport>& reports, morph::Monitor& monitor) const override;
  const morph::AttachedNodes& Attached() const override { return this->Hanging; }
  Measured Write(vtkUnstructuredGrid* grid, const morph::Points& moved, int precision, bool all,
    const MorphOutput::Outputs& outputs, morph::Monitor& monitor) const override;
  bool Crosses(const morph::Points& moved, morph::Monitor& monitor) const override;
  void WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* surface) const override
  {
    this->Kept.WriteUndeformedSurface(grid, surface);
  }

private:
  KeptMesh Kept;
  std::unique_ptr<morph::LinearMorpher> Method; ///< prepared, or null
  std::vector<morph::Index> Prescribed;         ///< by the caller
  morph::AttachedNodes Hanging;                 ///< of Method
};
}
