// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Private/Distributed/RankMesh.h"

#include <vtkIdList.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>
#include <vtkUnstructuredGrid.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace morph::filters
{
/// The cells with an outer face and the two-dimensional cells of all processes as one grid, the
/// same on each process. See WholeSurface, which answers what filters ask of it.
class GatheredSurface
{
public:
  static constexpr const char* CellName = "MorphCellId";

  vtkSmartPointer<vtkUnstructuredGrid> Grid; ///< null before Gather()
  morph::Mesh Shell;                         ///< Grid as a mesh
  morph::BoundaryFaces Faces;
  std::vector<morph::Index> BodyOfNode;
  std::vector<std::int8_t> Orientation;
  std::vector<std::int64_t> NodeIds, CellIds; ///< of Grid, ascending
  std::vector<int> RankOfNode, RankOfCell;    ///< of Grid: the lowest one
  std::vector<morph::Index> NumberOfBody;     ///< by the number that the distributed mesh has
  std::size_t Bytes = 0;                      ///< that this process received

  /// Gathers the surface of the mesh that `piece` is a part of. Throws morph::Error on all
  /// processes. Collective.
  void Gather(const RankMesh& mesh, vtkUnstructuredGrid* piece);

private:
  struct CellRecord;
  void NumberBodies(const morph::distributed::DistributedMesh& whole);
  void Assemble(const std::vector<vtkSmartPointer<vtkUnstructuredGrid>>& parts,
    const std::vector<std::vector<std::int64_t>>& nodes,
    const std::vector<std::vector<CellRecord>>& cells);
  void DescribeFaces(const morph::WholeBoundary& boundary, bool divided);
  void DescribeCells(const std::vector<std::vector<CellRecord>>& cells,
    const std::vector<vtkSmartPointer<vtkIdList>>& numbers);
};

/// 0, 1, ..., count - 1.
vtkSmartPointer<vtkIdList> firstNumbers(vtkIdType count);
}
