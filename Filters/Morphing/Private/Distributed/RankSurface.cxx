// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/RankCommunicator.h"
#include "Private/Data/Quality.h"
#include "Private/Data/Surface.h"
#include "Private/Distributed/OnRanks.h"
#include "Private/Distributed/RankMesh.h"

#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

namespace morph::filters::OnRanks
{
void ExtractBoundary(vtkUnstructuredGrid* grid, vtkPolyData* output, morph::Monitor& monitor)
{
  RankMesh mesh;
  mesh.Take(grid, 1, GridMesh::UnknownCells::Refuse, monitor);
  mesh.RequireVolumeCells();
  const morph::distributed::Ranks& ranks = mesh.Ranks();
  const morph::BoundaryFaces faces = mesh.FacesOfPiece();
  if (ranks.sum(static_cast<morph::Index>(faces.cells.size())) == 0 && ranks.rank() == 0)
  {
    Surface::WarnOfNone(faces, monitor);
  }
  ranks.together(
    [&] { Surface::Write(grid, mesh.Grid(), faces, output, &mesh.Whole().orientation()); });
  mesh.WriteGlobalIds(output);
}

std::pair<Quality::Measured, morph::Index> Measure(vtkUnstructuredGrid* grid, bool certified,
  std::vector<Quality::OfCriterion>& criteria, vtkUnstructuredGrid* output, morph::Monitor& monitor)
{
  RankMesh mesh;
  mesh.Take(grid, 1, GridMesh::UnknownCells::Keep, monitor);
  const morph::distributed::DistributedMesh& whole = mesh.Whole();
  const morph::distributed::RankCommunicator processes(whole);
  const Quality::Part part = { mesh.Grid(), whole.mesh(), whole.orientation(), mesh.Unmeasured(),
    mesh.HighestDimension(), processes };
  return { Quality::MeasureAll(part, certified, criteria, grid, output, monitor),
    mesh.Rest()->mirroredBodies() };
}
}
