// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Methods.h"

#include "Distributed/InversionFree.h"
#include "Distributed/PolyhedralMethod.h"
#include "Distributed/RankCommunicator.h"
#include "Distributed/SiteMethod.h"
#include "Distributed/Smoothing.h"
#include "Distributed/SystemMethod.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "Support/Error.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace morph::distributed
{
const DistributedMesh& meshOf(const Communicator& processes)
{
  return static_cast<const RankCommunicator&>(processes).mesh();
}

std::unique_ptr<Morpher> makeMethod(std::unique_ptr<Morpher> serial, bool onPieces)
{
  if (onPieces)
  {
    return std::make_unique<PolyhedralMethod>(makeMethod(std::move(serial)));
  }
  if (const auto* warp = dynamic_cast<const morph::FemWarp*>(serial.get()))
  {
    auto method = std::make_unique<FemWarp>();
    method->setStiffness(warp->stiffness());
    method->takeEvaluateOptions(*serial);
    return method;
  }
  if (const auto* warp = dynamic_cast<const morph::LogBarrierWarp*>(serial.get()))
  {
    auto method = std::make_unique<LogBarrierWarp>(
      warp->outsideHull() == morph::LogBarrierWarp::OutsideHull::Relax);
    method->takeEvaluateOptions(*serial);
    return method;
  }
  if (serial->copyWithoutCells())
  {
    return std::make_unique<SiteMethod>(std::move(serial));
  }
  if (const auto* inversionFree = dynamic_cast<const morph::InversionFree*>(serial.get()))
  {
    return std::make_unique<InversionFree>(*inversionFree);
  }
  if (const auto* smoothing = dynamic_cast<const morph::Smoothing*>(serial.get()))
  {
    return std::make_unique<Smoothing>(*smoothing);
  }
  return nullptr;
}

void requirePrescribedBodies(const DistributedMesh& mesh, const NodePartition& partition)
{
  const Ranks& ranks = mesh.ranks();
  const ConnectedComponents& bodies = mesh.bodies();
  std::vector<Index> held(bodies.count, 0);
  for (Index node : partition.prescribed)
  {
    if (bodies.ofNode[node] >= 0 && mesh.owns(node))
    {
      held[bodies.ofNode[node]] = 1;
    }
  }
  std::int64_t firstCell = -1;
  ranks.sum(held.data(), held.size());
  const auto bare = std::find(held.begin(), held.end(), 0);
  if (bare == held.end())
  {
    return;
  }
  const Index body = bare - held.begin();
  Index count = 0;
  for (std::size_t c = 0; c < bodies.ofCell.size(); ++c)
  {
    if (bodies.ofCell[c] == body && mesh.isGhost()[c] == 0)
    {
      const std::int64_t id = mesh.cellId(static_cast<Index>(c));
      firstCell = count == 0 ? id : std::min(firstCell, id);
      ++count;
    }
  }
  firstCell = ranks.minimum(count > 0 ? firstCell : std::numeric_limits<std::int64_t>::max());
  count = ranks.sum(count);
  throw Error(Error::Kind::Singular,
    "Body " + std::to_string(body) + " (" + std::to_string(count) + " cells, the first is cell " +
      std::to_string(firstCell) +
      ") has no prescribed node, so nothing says where it goes. Prescribe at least one of its "
      "nodes, or remove it from the grid.");
}
}
