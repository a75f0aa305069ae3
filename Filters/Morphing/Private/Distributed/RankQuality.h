// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"
#include "Quality/InvertedBefore.h"
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

  std::vector<morph::Index> Added; ///< of this process's own cells, those that count as inverted
  morph::Index AddedOfAll = 0;     ///< of all processes

  morph::Index Bad() const { return this->Whole.inverted + this->Whole.degenerate; }
};
/// `points`: #local nodes x 3, ghosts included. `before`: local cells that do not count unless
/// they are worse.
Measured Measure(const morph::distributed::DistributedMesh& mesh, const morph::Points& points,
  const morph::InvertedBefore& before, morph::Monitor& monitor);

/// "N cells are inverted or degenerate ...", and the worst of them by global ids, a line each; of
/// those that count.
std::string Found(const morph::distributed::DistributedMesh& mesh, const Measured& measured,
  const morph::Points& points);
}
