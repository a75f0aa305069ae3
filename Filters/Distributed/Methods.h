// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"

#include "Morpher/Morpher.h"

#include <memory>

namespace morph::distributed
{
/// The form that a serial method takes on ranks, with its options: its own, or that on sites. Null
/// for methods that need one rank.
/// `onPieces`: see PolyhedralMethod.
std::unique_ptr<Morpher> makeMethod(std::unique_ptr<Morpher> serial, bool onPieces = false);

/// The mesh that a RankCommunicator is of.
const DistributedMesh& meshOf(const Communicator& processes);
}
