// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"

#include "Morpher/Morpher.h"

#include <memory>

namespace morph::distributed
{
/// The distributed form of a serial method, with its options: FEMWARP, LBWARP, weighted residual,
/// simplex-linear, simplex natural neighbor, radial basis or inversion-free. Null for the others,
/// which need one rank.
/// `onPieces`: see PolyhedralMethod.
std::unique_ptr<Morpher> makeMethod(std::unique_ptr<Morpher> serial, bool onPieces = false);

/// The mesh that a RankCommunicator is of.
const DistributedMesh& meshOf(const Communicator& processes);

/// Throws Error on all ranks unless each body of the mesh has a prescribed corner. Collective.
void requirePrescribedBodies(const DistributedMesh& mesh, const NodePartition& partition);
}
