// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Shapes/KeptModeSolver.h"

#include "Mesh/NodePartition.h"
#include "Mesh/Polyhedra.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Private/Data/BadCells.h"
#include "Private/Data/MeshNotes.h"
#include "Private/Data/Output.h"
#include "Private/Data/Quality.h"

#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <utility>

namespace morph::filters
{
namespace
{
/// The method, not prepared, for the cells of `mesh`.
std::unique_ptr<morph::LinearMorpher> forCellsOf(
  const morph::Mesh& mesh, std::unique_ptr<morph::LinearMorpher> method)
{
  if (!morph::hasPolyhedra(mesh))
  {
    return method;
  }
  // Of a linear method it is a linear one.
  std::unique_ptr<morph::Morpher> onPieces = morph::morpherForPolyhedra(std::move(method));
  return std::unique_ptr<morph::LinearMorpher>(
    dynamic_cast<morph::LinearMorpher*>(onPieces.release()));
}
}

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
  MeshNotes::WarnOfShared(this->Kept.RepeatedCells(), this->Kept.TouchingNodes(), monitor);
}

BoundaryMatch::Result KeptModeSolver::Match(
  vtkPointSet* boundary, const BoundaryMatch::Options& options) const
{
  return BoundaryMatch::Match(
    boundary, this->Kept.Mesh(), this->Kept.OuterFaces(), this->Kept.Size(), options);
}

void KeptModeSolver::Prepare(std::unique_ptr<morph::LinearMorpher> method,
  const std::vector<morph::Index>& prescribed, morph::Monitor& monitor)
{
  this->Method.reset();
  method = forCellsOf(this->Kept.Mesh(), std::move(method));
  const morph::NodePartition partition = morph::partitionNodes(this->Kept.Mesh(), prescribed);
  method->prepare(this->Kept.Mesh(), partition, monitor);
  this->Hanging = morph::AttachedNodes(this->Kept.Mesh(), partition);
  this->Method = std::move(method);
}

std::vector<morph::Points> KeptModeSolver::Basis(const std::vector<morph::Points>& displacements,
  std::vector<morph::EvaluateReport>& reports, morph::Monitor& monitor) const
{
  return this->Method->basis(displacements, monitor, &reports);
}

ModeSolver::Measured KeptModeSolver::Write(vtkUnstructuredGrid* grid, const morph::Points& moved,
  int precision, bool all, const Outputs& outputs, morph::Monitor& monitor) const
{
  const morph::Mesh& mesh = this->Kept.Mesh();
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
