// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/ModeSolver.h"

#include "Mesh/NodePartition.h"
#include "Support/FirstSpeaks.h"

#include <utility>

namespace morph::filters
{
void ModeSolver::Forget()
{
  this->Method.reset();
  this->Hanging = {};
}

void ModeSolver::ReportMesh(morph::Monitor& whole) const
{
  const morph::UndeformedMesh& rest = this->Rest();
  morph::FirstSpeaks monitor(whole, this->All());
  morph::warnOfShared(rest.repeatedCells(), rest.touchingNodes(), monitor);
  morph::warnOfUnmapped(rest.unmappedCells(), monitor);
}

const morph::InvertedBefore& ModeSolver::Before(morph::Monitor& monitor) const
{
  this->All().together([&] { this->Rest().before(monitor); });
  return this->Rest().before(monitor);
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
  this->All().together(
    [&]
    {
      partition =
        morph::partitionNodes(this->Mesh(), rest.hanging(), rest.prescribedFor(prescribed));
    });
  method->prepare(this->Mesh(), partition, monitor, rest.processes());
  this->Hanging = morph::AttachedNodes(this->Mesh(), partition, this->All());
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
}
