// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Methods.h"

#include "Distributed/PolyhedralMethod.h"
#include "Distributed/RankCommunicator.h"
#include "Morpher/SiteMethod.h"

#include <utility>

namespace morph::distributed
{
const DistributedMesh& meshOf(const Communicator& processes)
{
  return static_cast<const RankCommunicator&>(processes).mesh();
}

std::unique_ptr<Morpher> makeMethod(std::unique_ptr<Morpher> serial, bool onPieces)
{
  if (serial->copyWithoutCells())
  {
    serial = std::make_unique<SiteMethod>(std::move(serial));
  }
  else if (serial->layers() == 0)
  {
    return nullptr;
  }
  if (onPieces)
  {
    serial = std::make_unique<PolyhedralMethod>(std::move(serial));
  }
  return serial;
}
}
