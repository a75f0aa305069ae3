// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Data/Unchanged.h"
#include "Private/Morph/KeptMesh.h"

namespace morph::filters
{
/// A mesh that this process has all of.
class SerialMesh : public KeptMesh
{
public:
  bool Take(vtkUnstructuredGrid* grid, const std::string& method, const CreateMorpher& create,
    morph::Monitor& monitor) override;
  void SetFeatureLines(bool on, morph::Monitor& monitor) override;
  const std::shared_ptr<const morph::UndeformedMesh>& Rest() const override { return this->Copy; }
  const morph::Mesh& Grid() const override { return this->Copy->mesh(); }
  const std::vector<std::uint8_t>& Unmeasured() const override { return this->None; }
  const morph::Points& OfGrid(const morph::Points& moved, morph::Points&) const override
  {
    return moved;
  }
  BoundaryMatch::Nodes Nodes() const override
  {
    return { this->Copy->mesh(), this->Copy->outerFaces(), this->Copy->size() };
  }
  void WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* surface) const override;
  void WriteGlobalIds(vtkDataSet*) const override {}

private:
  Unchanged Taken; ///< the grid that is the same as Copy
  std::shared_ptr<const morph::UndeformedMesh> Copy = std::make_shared<morph::UndeformedMesh>();
  std::vector<std::uint8_t> None;
};
}
