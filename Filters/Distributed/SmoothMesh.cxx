// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/SmoothMesh.h"

#include "Distributed/RankCommunicator.h"
#include "Mesh/OwnCells.h"

#include <memory>

namespace morph::distributed
{
SmoothingReport smoothMesh(const DistributedMesh& mesh, const Points& rest,
  const NodePartition& partition, const SmoothingOptions& options, Points& moved, Monitor& monitor)
{
  const Ranks& ranks = mesh.ranks();
  const RankCommunicator processes(mesh);
  std::unique_ptr<OwnCells> own;
  ranks.together([&]
    { own = std::make_unique<OwnCells>(mesh.mesh(), partition, mesh.orientation(), processes); });
  SmoothingReport report;
  Points smoothed;
  own->communicator().together(
    [&]
    {
      own->mesh().points = own->take(rest);
      smoothed = own->take(moved);
      report = morph::smoothMesh(own->mesh(), own->orientation(), own->partition(), options,
        smoothed, monitor, own->communicator());
    });
  moved(own->nodes(), allColumns) = smoothed;
  mesh.halo().update(ranks, moved);
  mesh.copyToDoubles(moved);
  return report;
}
}
