// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"
#include "Distributed/Piece.h"
#include "Distributed/Ranks.h"
#include "Mesh/Mesh.h"
#include "Morpher/Morpher.h"
#include "Session/UndeformedMesh.h"

#include <functional>
#include <memory>
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

/// This rank's part as a session takes it. Holds `mesh` by reference.
std::shared_ptr<const morph::UndeformedMesh> undeformed(
  const morph::distributed::DistributedMesh& mesh);

/// The local nodes whose global ids are in `ids`, which are ascending.
std::vector<morph::Index> localNodes(
  const morph::distributed::DistributedMesh& mesh, const std::vector<morph::Index>& ids);

/// The positions of all nodes of the whole mesh; `moved`: of this rank's local nodes. Expects
/// ghosts where their owners have them.
morph::Points gathered(const morph::distributed::DistributedMesh& mesh, const morph::Points& moved);

/// The largest distance on any rank of `moved`, this rank's local nodes, from where `expected` has
/// the nodes of the whole mesh.
double distance(const morph::distributed::DistributedMesh& mesh, const morph::Points& moved,
  const morph::Points& expected);

/// A method on this rank's random part of a mesh.
struct OnRanks
{
  morph::distributed::DistributedMesh mesh;
  std::unique_ptr<morph::Morpher> method;
  std::vector<morph::Index> prescribed; ///< local nodes

  /// Prepares `unprepared`. `outer`: the prescribed nodes of the whole mesh, ascending.
  OnRanks(const morph::distributed::Ranks& ranks, const morph::Mesh& whole,
    const std::vector<morph::Index>& outer, std::unique_ptr<morph::Morpher> unprepared,
    unsigned seed, morph::Monitor& monitor);
  OnRanks(const OnRanks&) = delete;
  OnRanks& operator=(const OnRanks&) = delete;

  /// `target`: where prescribed nodes of the whole mesh go. `moved`: becomes #local nodes x 3.
  morph::EvaluateReport evaluate(
    const morph::Points& target, morph::Points& moved, morph::Monitor& monitor) const;
  /// Expects all ranks to end where the last one cancels at this part of the progress.
  void expectCancelled(const morph::Points& target, double at) const;
};

/// The message of the Error that `work` throws on this rank, or "".
std::string messageOf(const std::function<void()>& work);
}
