// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"
#include "Distributed/Piece.h"
#include "Distributed/Ranks.h"
#include "Mesh/Mesh.h"

#include <functional>
#include <string>
#include <vector>

/// Parts of a mesh for the tests on MPI ranks.
namespace pieces
{
/// The ranks of MPI_COMM_WORLD.
morph::distributed::Ranks world();

/// A rank for each cell, at random, the same on all ranks.
std::vector<int> randomOwners(const morph::Mesh& mesh, int ranks, unsigned seed);

/// This rank's cells with their nodes. The ids are those of `mesh`.
morph::distributed::Piece pieceOf(
  const morph::Mesh& mesh, const std::vector<int>& owners, int rank);

/// This rank's random part of a mesh, with ghosts.
morph::distributed::DistributedMesh distribute(
  const morph::distributed::Ranks& ranks, const morph::Mesh& whole, int layers, unsigned seed);

/// The local nodes whose global ids are in `ids`, which are ascending.
std::vector<morph::Index> localNodes(
  const morph::distributed::DistributedMesh& mesh, const std::vector<morph::Index>& ids);

/// The positions of all nodes of the whole mesh; `moved`: of this rank's local nodes. Expects
/// ghosts where their owners have them.
morph::Points gathered(const morph::distributed::DistributedMesh& mesh, const morph::Points& moved);

/// The message of the Error that `work` throws on this rank, or "".
std::string messageOf(const std::function<void()>& work);
}
