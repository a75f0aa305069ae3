// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Monitor.h"

#include <string>
#include <vector>

/// The quality of a distributed mesh at other points. All functions are collective.
namespace morph::filters::RankQuality
{
struct Measured
{
  morph::Quality Mine;  ///< of this process's own cells, #local cells
  morph::Quality Whole; ///< the numbers of the whole mesh, without cells

  morph::Index Bad() const { return this->Whole.inverted + this->Whole.degenerate; }
};
/// `points`: #local nodes x 3, ghosts included.
Measured Measure(const morph::distributed::DistributedMesh& mesh, const morph::Points& points,
  morph::Monitor& monitor);

/// The global ids of this process's cells in `cells`, of all processes, ascending. `cells`: local;
/// ghosts are left out.
std::vector<morph::Index> GatherIds(
  const morph::distributed::DistributedMesh& mesh, const std::vector<morph::Index>& cells);

/// "N cells are inverted or degenerate ...", and the worst of them by global ids, a line each.
std::string Found(const morph::distributed::DistributedMesh& mesh, const Measured& measured,
  const morph::Points& points);
}
