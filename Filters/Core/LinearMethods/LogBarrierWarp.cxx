// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/LogBarrierWarp.h"

#include "LinearMethods/LogBarrierSystem.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"

#include <sstream>
#include <string>
#include <vector>

namespace morph
{
void LogBarrierWarp::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const NodePartition& partition = this->partition();
  const Communicator& processes = this->processes();
  const ConnectedComponents parts = connectedComponents(rest, monitor, processes);
  requirePrescribedBodies(parts, partition, processes);
  const std::vector<Index> columns = this->setRows(rest, partition.free, parts);
  const bool relax = this->outsideHull_ == OutsideHull::Relax;
  LogBarrierSystem system = logBarrierSystem(rest, this->rows(), columns, relax, monitor);
  const std::vector<Index> empty = processes.gatherNodes(system.empty),
                           outside = processes.gatherNodes(system.outside);
  if (!empty.empty() && relax)
  {
    this->throwSingular(system.empty);
  }
  if (!empty.empty())
  {
    std::ostringstream text;
    text << empty.size() << (empty.size() == 1 ? " free node does" : " free nodes do")
         << " not lie inside the hull of the neighbors, at inverted or strongly concave cells, and "
         << "so cannot be a convex combination of them: node ids " << listIds(empty)
         << ". Repair the undeformed mesh, prescribe those nodes, or set `OutsideHull` to Relax.";
    throw Error(text.str());
  }
  this->meanWeightIterations_ = system.meanIterations;
  this->mostWeightIterations_ = system.mostIterations;
  const Index twoRing = processes.sum(system.twoRing), affine = processes.sum(system.affine),
              stiffness = processes.sum(system.stiffness);
  this->statistics_ = { { "OutsideHullNodes", static_cast<Index>(outside.size()) },
    { "TwoRingNodes", twoRing }, { "AffineNodes", affine }, { "StiffnessNodes", stiffness } };
  if (!outside.empty())
  {
    monitor.warn("Free nodes outside the hull of their neighbors: node ids " + listIds(outside) +
                 ". " + std::to_string(twoRing) +
                 " took weights among a second ring of neighbors, " + std::to_string(affine) +
                 " affine weights, " + std::to_string(stiffness) + " FEMWARP's row.");
  }
  monitor.check();
  monitor.progress(0.6);
  ProgressRange last(monitor, 0.6, 1);
  this->setEquations(system.interior, system.coupling, columns, true, last);
}
}
