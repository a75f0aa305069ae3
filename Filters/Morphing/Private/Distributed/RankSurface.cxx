// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Quality.h"
#include "Private/Data/Quality.h"
#include "Private/Data/Surface.h"
#include "Private/Distributed/OnRanks.h"
#include "Private/Distributed/RankMesh.h"
#include "Private/Distributed/RankOutput.h"

#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <cmath>
#include <limits>

namespace morph::filters::OnRanks
{
void ExtractBoundary(vtkUnstructuredGrid* grid, vtkPolyData* output, morph::Monitor& monitor)
{
  RankMesh mesh;
  mesh.Take(grid, 1, GridMesh::UnknownCells::Refuse, monitor);
  mesh.RequireVolumeCells();
  const morph::distributed::Ranks& ranks = mesh.Ranks();
  const morph::BoundaryFaces& faces = mesh.Whole().outerFaces();
  if (ranks.sum(static_cast<morph::Index>(faces.cells.size())) == 0 && ranks.rank() == 0)
  {
    Surface::WarnOfNone(faces, monitor);
  }
  ranks.together([&] { Surface::Write(grid, mesh.Piece(), faces, output, &mesh.Orientation()); });
  mesh.WriteGlobalIds(output);
}

Measured Measure(vtkUnstructuredGrid* grid, bool certified,
  std::vector<Quality::OfCriterion>& criteria, vtkUnstructuredGrid* output, morph::Monitor& monitor)
{
  RankMesh mesh;
  mesh.Take(grid, 1, GridMesh::UnknownCells::Keep, monitor);
  Measured result;
  const std::vector<std::uint8_t>& skip = mesh.Unmeasured();
  morph::Quality mine;
  mesh.Ranks().together(
    [&]
    {
      output->ShallowCopy(grid);
      mine = Quality::Measure(mesh.Piece(), output, mesh.Orientation(), skip, monitor);
      Quality::Remove(output);
      Quality::Write(mine, output);
      result.Unmeasured = Quality::Unmeasured(mesh.Piece(), mine, skip, grid);
    });
  mesh.Ranks().sum(result.Unmeasured.data(), result.Unmeasured.size());
  result.Whole = morph::distributed::reduce(mesh.Ranks(), mine, mesh.Whole().cellIds());
  if (certified)
  {
    result.Certificates = RankOutput::Certify(mesh, output,
      mesh.HighestDimension() == 3 ? skip : std::vector<std::uint8_t>(skip.size(), 1), monitor);
    Quality::Write(result.Certificates, output);
  }
  for (Quality::OfCriterion& criterion : criteria)
  {
    const morph::distributed::DistributedMesh& whole = mesh.Whole();
    mesh.Ranks().together(
      [&]
      {
        Quality::Measure(
          criterion, whole.mesh(), output, whole.orientation(), skip, whole.cellIds(), monitor);
      });
    const double sign = criterion.Sign(), none = -std::numeric_limits<double>::infinity();
    const bool isMeasured = criterion.WorstCell >= 0;
    const double worst = mesh.Ranks().maximum(isMeasured ? sign * criterion.Worst : none);
    const bool isWorst = isMeasured && sign * criterion.Worst == worst;
    const morph::Index last = std::numeric_limits<morph::Index>::max();
    criterion.WorstCell = mesh.Ranks().minimum(isWorst ? criterion.WorstCell : last);
    criterion.WorstCell = criterion.WorstCell == last ? -1 : criterion.WorstCell;
    criterion.Worst = criterion.WorstCell < 0 ? std::nan("") : sign * worst;
    criterion.Beyond = mesh.Ranks().sum(criterion.Beyond);
  }
  Quality::Write(criteria, output);
  result.MirroredBodies = mesh.Whole().mirroredBodies();
  return result;
}
}
