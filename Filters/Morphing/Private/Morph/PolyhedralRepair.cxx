// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/PolyhedralRepair.h"

#include "Mesh/PolyhedronPieces.h"
#include "Support/ProgressRange.h"
#include "Untangling/InversionFree.h"

#include <utility>

namespace morph::filters::PolyhedralRepair
{
void Adapt(morph::Morpher& method)
{
  if (auto* inversionFree = dynamic_cast<morph::InversionFree*>(&method))
  {
    inversionFree->setRaisesValid(false);
  }
}

bool Run(const morph::Mesh& mesh, const morph::Points& reference,
  const morph::NodePartition& partition,
  const std::function<std::size_t(const morph::Points& points)>& bad, morph::Points& moved,
  morph::Monitor& monitor)
{
  constexpr int Rounds = 4;
  std::size_t left = bad(moved);
  if (left == 0)
  {
    return true;
  }
  morph::ProgressRange preparing(monitor, 0, 0.3);
  const morph::PolyhedronPieces pieces(mesh, preparing);
  morph::InversionFree repair;
  repair.setReference(pieces.extend(reference));
  repair.prepare(pieces.mesh(), pieces.extend(partition), preparing);
  for (int round = 0; round < Rounds && left > 0; ++round)
  {
    morph::ProgressRange part(
      monitor, 0.3 + 0.7 * round / Rounds, 0.3 + 0.7 * (round + 1) / Rounds);
    morph::Points all = pieces.extend(moved);
    repair.repair(all, part);
    morph::Points repaired = all.topRows(moved.rows());
    const std::size_t now = bad(repaired);
    if (now >= left)
    {
      break; // what is left cannot be mended
    }
    left = now;
    moved = std::move(repaired);
  }
  return left == 0;
}
}
