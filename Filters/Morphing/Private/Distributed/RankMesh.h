// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"
#include "Distributed/Ranks.h"
#include "Mesh/Mesh.h"
#include "Private/Data/GridMesh.h"
#include "Private/Morph/KeptMesh.h"

#include <vtkType.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

class vtkDataSetAttributes;

namespace morph::filters
{
/// A grid of which each MPI process has a piece, kept from one execution to the next. All functions
/// but the getters are collective.
class RankMesh : public KeptMesh
{
public:
  RankMesh();

  bool Take(vtkUnstructuredGrid* grid, const std::string& method, const CreateMorpher& create,
    morph::Monitor& monitor) override;
  /// As above, where points and cells are known by their global ids if there are some. `layers`: of
  /// ghost cells.
  bool Take(
    vtkUnstructuredGrid* grid, int layers, GridMesh::UnknownCells unknown, morph::Monitor& monitor);
  void SetFeatureLines(bool on, morph::Monitor& monitor) override;
  /// Throws morph::Error on all processes unless the mesh can be morphed.
  void RequireVolumeCells() const;

  const morph::distributed::Ranks& Ranks() const { return this->Processes; }
  const morph::distributed::DistributedMesh& Whole() const { return *this->Distributed; }
  const std::shared_ptr<const morph::UndeformedMesh>& Rest() const override
  {
    return this->Undeformed;
  }
  /// Rest()->outerFaces(), with edges that are divided by nodes of the piece alone. Not collective.
  morph::BoundaryFaces FacesOfPiece() const;
  const morph::Mesh& Grid() const override { return this->Copy; }
  const std::vector<std::uint8_t>& Unmeasured() const override { return this->Skip; }
  /// Of the whole mesh.
  int HighestDimension() const { return this->Dimension; }
  const morph::Points& OfGrid(const morph::Points& moved, morph::Points& memory) const override;

  BoundaryMatch::Nodes Nodes() const override;

  /// Not collective.
  ///@{
  void WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* output) const override;
  void WriteGlobalIds(vtkDataSet* output) const override;
  ///@}

private:
  morph::distributed::Ranks Processes;
  morph::Mesh Copy;
  std::vector<std::int64_t> NodeIds, CellIds; ///< as they came, or empty
  std::vector<std::uint8_t> Ghosts;
  morph::Index Front = 0; ///< see GridMesh::PointsOfFront()
  int Layers = 0, Dimension = 0;
  std::shared_ptr<morph::distributed::DistributedMesh> Distributed;
  std::vector<std::uint8_t> Skip;
  std::shared_ptr<const morph::UndeformedMesh> Undeformed; ///< of Distributed
};

/// Replaces the values of an array of `count` ids, if it is there, but for negative ones.
void renumber(vtkDataSetAttributes* data, const char* name, vtkIdType count,
  const std::function<vtkIdType(vtkIdType)>& number);
}
