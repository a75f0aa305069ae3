// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Private/Data/NamedSets.h"

#include <vtkIdList.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace morph
{
class WholeBoundary;
}
namespace morph::distributed
{
class DistributedMesh;
}

namespace morph::filters
{
class RankMesh;

/// The cells with an outer face, the two-dimensional cells and cellsAtInnerFaces() of all
/// processes, or all cells, as one grid, the same on each process; see WholeSurface.
class GatheredSurface
{
public:
  static constexpr const char* CellName = "MorphCellId";

  /// Those cells, with the arrays that all pieces have; null before Gather().
  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  morph::Mesh Shell;                      ///< Grid as a mesh
  morph::BoundaryFaces Faces;             ///< of the whole mesh; partition interfaces are none
  std::vector<morph::Index> BodyOfNode;   ///< of the whole mesh, or -1; see bodyOfNodes()
  std::vector<std::int8_t> Orientation;   ///< #cells, cellSigns() of the whole mesh
  std::vector<std::int64_t> NodeIds;      ///< of Grid, global, ascending
  std::vector<std::int64_t> CellIds;      ///< the same
  std::vector<int> RankOfNode;            ///< of Grid: the lowest one
  std::vector<int> RankOfCell;            ///< of Grid
  std::vector<morph::Index> NumberOfBody; ///< in the order of their lowest cells; by the mesh's one
  std::vector<ListedZone> Zones;          ///< of the whole mesh; their cells of Grid
  std::size_t Bytes = 0;                  ///< that this process received
  bool HasAll = false;                    ///< cells of the whole mesh

  /// The node of Grid with a global id, or -1.
  morph::Index NodeOf(std::int64_t id) const
  {
    const auto found = std::lower_bound(this->NodeIds.begin(), this->NodeIds.end(), id);
    return found != this->NodeIds.end() && *found == id ? found - this->NodeIds.begin() : -1;
  }

  /// Gathers the surface of the mesh that `piece` is a part of, or `all` of its cells, also if
  /// nodes hang in a mesh with something inside. `zones`: with cells of the piece, the same on all
  /// processes. Throws morph::Error on all processes. Collective.
  void Gather(
    const RankMesh& mesh, vtkUnstructuredGrid* piece, std::vector<ListedZone> zones, bool all);

private:
  void NumberBodies(const morph::distributed::DistributedMesh& whole);
  void GatherZones(const morph::distributed::DistributedMesh& whole);
  void Assemble(const std::vector<vtkSmartPointer<vtkUnstructuredGrid>>& parts);
  void MarkLayer(morph::ShellLayer layer, morph::Index behind);
  void DescribeFaces(const morph::WholeBoundary& boundary, bool divided);
};

/// 0, 1, ..., count - 1.
vtkSmartPointer<vtkIdList> firstNumbers(vtkIdType count);
}
