// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Shapes/KeptModeSolver.h"

#include "Mesh/NodePartition.h"
#include "Morpher/PolyhedralMorpher.h"
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
    this->Method.reset();
    this->Hanging = {};
  }
  return isCopied;
}

void KeptModeSolver::ReportMesh(morph::Monitor& monitor) const
{
  morph::warnOfShared(
    this->Kept.Rest()->repeatedCells(), this->Kept.Rest()->touchingNodes(), monitor);
}

morph::BoundaryTargets KeptModeSolver::Match(
  vtkPointSet* boundary, const BoundaryMatch::Options& options) const
{
  const morph::UndeformedMesh& rest = *this->Kept.Rest();
  return BoundaryMatch::Match(boundary, rest.mesh(), rest.outerFaces(), rest.size(), options);
}

void KeptModeSolver::Prepare(std::unique_ptr<morph::LinearMorpher> method,
  const std::vector<morph::Index>& prescribed, morph::Monitor& monitor)
{
  this->Method.reset();
  std::unique_ptr<morph::Morpher> onPieces =
    morph::morpherForCells(this->Mesh(), this->Kept.Rest()->hanging(), std::move(method));
  // Of a linear method it is a linear one.
  method.reset(dynamic_cast<morph::LinearMorpher*>(onPieces.release()));
  this->Others = this->Kept.Rest()->hanging().othersOf(prescribed);
  const morph::NodePartition partition =
    morph::partitionNodes(this->Mesh(), morph::HangingNodes::at(this->Others, prescribed));
  method->prepare(this->Mesh(), partition, monitor);
  this->Hanging = morph::AttachedNodes(this->Mesh(), partition);
  this->Method = std::move(method);
}

std::vector<morph::Points> KeptModeSolver::Basis(const std::vector<morph::Points>& displacements,
  std::vector<morph::EvaluateReport>& reports, morph::Monitor& monitor) const
{
  std::vector<morph::Points> others;
  for (const morph::Points& displacement : displacements)
  {
    others.emplace_back(displacement(this->Others, morph::allColumns));
  }
  return this->Method->basis(others, monitor, &reports);
}

ModeSolver::Measured KeptModeSolver::Write(vtkUnstructuredGrid* grid, const morph::Points& moved,
  int precision, bool all, const Outputs& outputs, morph::Monitor& monitor) const
{
  const morph::Mesh& mesh = this->Mesh();
  const MovedSurface& surface = this->Kept.Surface();
  vtkUnstructuredGrid* output = outputs.Mesh;
  Output::Write(grid, mesh.points, moved, precision, output, monitor);
  Measured result;
  result.Whole =
    all ? Quality::Measure(mesh, output, this->Orientation(), monitor)
        : Quality::Measure(mesh, output, this->Orientation(), surface.OuterCells(), monitor);
  result.SurfaceInverted = surface.Write(output->GetPoints(), result.Whole, outputs.Surface);
  Quality::Remove(output);
  if (all)
  {
    Quality::Write(result.Whole, output);
    result.Judged = Quality::Judge(this->Before(monitor), result.Whole, output);
    BadCells::Extract(result.Whole, output, outputs.BadCells);
  }
  return result;
}
}
