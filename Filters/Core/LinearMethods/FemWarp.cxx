// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/FemWarp.h"

#include "LinearMethods/FemWarpSystem.h"
#include "LinearMethods/StiffnessFactors.h"
#include "Support/ProgressRange.h"

#include <string>
#include <utility>
#include <vector>

namespace morph
{
void FemWarp::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const NodePartition& partition = this->partition();
  const Communicator& processes = this->processes();
  const ConnectedComponents parts = connectedComponents(rest, monitor, processes);
  requirePrescribedBodies(parts, partition, processes);
  const std::vector<double> factors =
    stiffnessFactors(rest, partition.prescribed, this->stiffness(), monitor, processes);
  const bool isUniform = processes.all(factors.empty()); // a process may have no cells
  Adjacency around = nodeToCells(rest, monitor);
  // Where the stiffness varies, the fit that is taken off would have to be taken off centers, too.
  this->stars_ =
    isUniform ? CenterStars(rest, partition.free, this->firstCenter(), around) : CenterStars();
  if (this->stars_.size() == static_cast<Index>(partition.free.size()))
  {
    this->stars_ = CenterStars(); // a matrix without rows is none
  }
  const std::vector<Index> columns =
    this->setRows(rest, this->stars_.others(partition.free), parts);
  FemWarpSystem system =
    femWarpSystem(rest, std::move(around), this->rows(), columns, factors, this->stars_, monitor);
  this->stars_.assembled(rest.numberOfNodes(), partition);
  if (!processes.all(!system.hasBadCells))
  {
    BadCells bad =
      badCells(rest, cellSigns(rest, parts, monitor, processes), system.cellSign, monitor);
    for (std::vector<Index>* cells : { &bad.inverted, &bad.flat, &bad.absolute })
    {
      *cells = processes.gatherCells(*cells);
    }
    const std::string warning = describe(bad);
    if (!warning.empty())
    {
      monitor.warn(warning);
    }
  }
  if (!processes.all(system.singularCenters.empty()))
  {
    this->throwSingular(system.singularCenters);
  }
  monitor.check();
  monitor.progress(0.6);
  ProgressRange last(monitor, 0.6, 1);
  this->setEquations(system.interior, system.coupling, columns, isUniform, last);
}
}
