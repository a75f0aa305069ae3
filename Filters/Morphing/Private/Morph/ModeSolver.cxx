// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/ModeSolver.h"

#include "Mesh/NodePartition.h"
#include "Support/Communicator.h"

#include <utility>

namespace morph::filters
{
ModeSolver::ModeSolver(std::unique_ptr<KeptMesh> mesh)
  : Kept(std::move(mesh))
{
}

bool ModeSolver::Take(
  vtkUnstructuredGrid* grid, const CreateMorpher& create, morph::Monitor& monitor)
{
  const bool isTaken = this->Kept->Take(grid, "vtkMorphShapes", create, monitor);
  if (isTaken)
  {
    this->Method.reset();
    this->Hanging = {};
  }
  return isTaken;
}

void ModeSolver::ReportMesh(morph::Monitor& whole) const
{
  const morph::UndeformedMesh& rest = this->Rest();
  morph::FirstSpeaks monitor(whole, this->Rest().all());
  morph::warnOfShared(rest.repeatedCells(), rest.touchingNodes(), monitor);
  morph::warnOfUnmapped(rest.unmappedCells(), monitor);
}

morph::BoundaryTargets ModeSolver::Match(
  vtkPointSet* boundary, const BoundaryMatch::Options& options) const
{
  morph::BoundaryTargets match = this->Kept->Match(boundary, options);
  morph::requirePlane(match, this->Rest().all());
  return match;
}

void ModeSolver::Prepare(std::unique_ptr<morph::LinearMorpher> method,
  const std::vector<morph::Index>& prescribed, morph::Monitor& monitor)
{
  this->Method.reset();
  const morph::UndeformedMesh& rest = this->Rest();
  // Of a linear method it is a linear one.
  method.reset(dynamic_cast<morph::LinearMorpher*>(rest.fitted(std::move(method)).release()));
  this->Prescribed = prescribed;
  morph::NodePartition partition;
  this->Rest().all().together(
    [&]
    {
      partition =
        morph::partitionNodes(this->Mesh(), rest.hanging(), rest.prescribedFor(prescribed));
    });
  method->prepare(this->Mesh(), partition, monitor, rest.processes());
  this->Hanging = morph::AttachedNodes(this->Mesh(), partition, this->Rest().all());
  this->Method = std::move(method);
}

std::vector<morph::Points> ModeSolver::Basis(const std::vector<morph::Points>& displacements,
  std::vector<morph::EvaluateReport>& reports, morph::Monitor& monitor) const
{
  std::vector<morph::Points> given;
  for (const morph::Points& displacement : displacements)
  {
    morph::Points all = morph::Points::Zero(this->Mesh().numberOfNodes(), 3);
    all(this->Prescribed, morph::allColumns) = displacement;
    given.emplace_back(all(this->Method->partition().prescribed, morph::allColumns));
  }
  return this->Method->basis(given, monitor, &reports);
}

MorphOutput::Measured ModeSolver::Write(vtkUnstructuredGrid* grid, const morph::Points& moved,
  int precision, bool all, const MorphOutput::Outputs& outputs, morph::Monitor& monitor) const
{
  MorphOutput::WriteMesh(*this->Kept, moved, precision, grid, outputs.Mesh, monitor);
  MorphOutput::Measures measures;
  measures.All = all;
  measures.WorstMean = false;
  return MorphOutput::Measure(*this->Kept, {}, measures, nullptr, outputs, monitor);
}

bool ModeSolver::Crosses(const morph::Points& moved, morph::Monitor& monitor) const
{
  const morph::WholeBoundary& boundary = this->Rest().boundary();
  return !boundary.crossings(boundary.faces(), boundary.gather(moved), monitor).empty();
}
}
