// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Shapes/KeptModeSolver.h"

#include "Boundary/CrossingFaces.h"
#include "Mesh/NodePartition.h"
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
  morph::warnOfUnmapped(this->Kept.Rest()->unmappedCells(), monitor);
}

morph::BoundaryTargets KeptModeSolver::Match(
  vtkPointSet* boundary, const BoundaryMatch::Options& options) const
{
  const morph::UndeformedMesh& rest = *this->Kept.Rest();
  morph::BoundaryTargets match =
    BoundaryMatch::Match(boundary, rest.mesh(), rest.outerFaces(), rest.size(), options);
  morph::requirePlane(match);
  return match;
}

void KeptModeSolver::Prepare(std::unique_ptr<morph::LinearMorpher> method,
  const std::vector<morph::Index>& prescribed, morph::Monitor& monitor)
{
  this->Method.reset();
  const morph::UndeformedMesh& rest = *this->Kept.Rest();
  // Of a linear method it is a linear one.
  method.reset(dynamic_cast<morph::LinearMorpher*>(rest.fitted(std::move(method)).release()));
  this->Prescribed = prescribed;
  const morph::NodePartition partition =
    morph::partitionNodes(this->Mesh(), rest.hanging(), rest.prescribedFor(prescribed));
  method->prepare(this->Mesh(), partition, monitor);
  this->Hanging = morph::AttachedNodes(this->Mesh(), partition);
  this->Method = std::move(method);
}

std::vector<morph::Points> KeptModeSolver::Basis(const std::vector<morph::Points>& displacements,
  std::vector<morph::EvaluateReport>& reports, morph::Monitor& monitor) const
{
  std::vector<morph::Points> own;
  for (const morph::Points& displacement : displacements)
  {
    morph::Points all = morph::Points::Zero(this->Mesh().numberOfNodes(), 3);
    all(this->Prescribed, morph::allColumns) = displacement;
    own.emplace_back(all(this->Method->partition().prescribed, morph::allColumns));
  }
  return this->Method->basis(own, monitor, &reports);
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
    all ? Quality::Measure(mesh, output, this->Orientation(), monitor)
        : Quality::Measure(mesh, output, this->Orientation(), surface.OuterCells(), monitor);
  result.SurfaceInverted = surface.Write(output->GetPoints(), result.Whole, outputs.Surface);
  Quality::Remove(output);
  if (all)
  {
    Quality::Write(result.Whole, output);
    result.Judged = Quality::Judge(this->Before(monitor), result.Whole, output);
    BadCells::Extract(result.Whole, output, outputs.BadCells);
    const morph::UndeformedMesh& rest = *this->Kept.Rest();
    result.Crossing =
      Crossings::Find(mesh, rest.outerFaces(), this->Orientation(), output, nullptr, monitor);
    surface.MarkCrossing(result.Crossing.Own, outputs.Surface);
  }
  return result;
}

bool KeptModeSolver::Crosses(const morph::Points& moved, morph::Monitor& monitor) const
{
  return !morph::crossingFaces(morph::ConstPoints(this->Mesh().points), morph::ConstPoints(moved),
    this->Kept.Rest()->outerFaces(), this->Orientation(), monitor)
            .empty();
}
}
