// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Shapes/KeptModeSolver.h"

#include "Boundary/CrossingFaces.h"
#include "Private/Data/BadCells.h"
#include "Private/Data/Output.h"
#include "Private/Data/Quality.h"
#include "Session/UndeformedMesh.h"

#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <utility>

namespace morph::filters
{
bool KeptModeSolver::Take(vtkUnstructuredGrid* grid, const CreateMorpher&, morph::Monitor& monitor)
{
  const bool isCopied = this->Kept.Take(grid, monitor);
  if (isCopied)
  {
    this->Forget();
  }
  return isCopied;
}

morph::BoundaryTargets KeptModeSolver::Match(
  vtkPointSet* boundary, const BoundaryMatch::Options& options) const
{
  const morph::UndeformedMesh& rest = this->Rest();
  morph::BoundaryTargets match =
    BoundaryMatch::Match(boundary, rest.mesh(), rest.outerFaces(), rest.size(), options);
  morph::requirePlane(match);
  return match;
}

ModeSolver::Measured KeptModeSolver::Write(vtkUnstructuredGrid* grid, const morph::Points& moved,
  int precision, bool all, const MorphOutput::Outputs& outputs, morph::Monitor& monitor) const
{
  const morph::Mesh& mesh = this->Mesh();
  const MovedSurface& surface = this->Kept.Surface();
  vtkUnstructuredGrid* output = outputs.Mesh;
  Output::Write(grid, mesh.points, moved, precision, output, monitor);
  Measured result;
  result.Whole =
    all ? Quality::Measure(mesh, output, this->Rest().orientation(), monitor)
        : Quality::Measure(mesh, output, this->Rest().orientation(), surface.OuterCells(), monitor);
  result.SurfaceInverted = surface.Write(output->GetPoints(), result.Whole, outputs.Surface);
  Quality::Remove(output);
  if (all)
  {
    Quality::Write(result.Whole, output);
    result.Judged = Quality::Judge(this->Before(monitor), result.Whole, output);
    BadCells::Extract(result.Whole, output, outputs.BadCells);
    const morph::UndeformedMesh& rest = this->Rest();
    result.Crossing = Crossings::Find(
      mesh, rest.outerFaces(), this->Rest().orientation(), output, nullptr, monitor);
    surface.MarkCrossing(result.Crossing.Own, outputs.Surface);
  }
  return result;
}

bool KeptModeSolver::Crosses(const morph::Points& moved, morph::Monitor& monitor) const
{
  return !morph::crossingFaces(morph::ConstPoints(this->Mesh().points), morph::ConstPoints(moved),
    this->Rest().outerFaces(), this->Rest().orientation(), monitor)
            .empty();
}
}
