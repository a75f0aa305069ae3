// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"

#include "Support/Communicator.h"

#include <functional>
#include <memory>
#include <vector>

namespace morph::distributed
{
/// The communicator of the part of a distributed mesh that has each rank's own cells. Each function
/// begins with a vote: if another rank has failed meanwhile, all throw that rank's Error.
class RankCommunicator : public Communicator
{
public:
  /// `nodes`: of `mesh`, those that own volume cells use: node i of the part is `nodes`[i]. Holds
  /// `mesh` by reference.
  RankCommunicator(const DistributedMesh& mesh, std::vector<Index> nodes);

  /// Calls `work`, in which ranks communicate by this object and its parts alone. If it throws on
  /// one rank, all ranks throw its Error: the others at their next communication. Collective.
  void run(const std::function<void()>& work) const;

  double sum(double value) const override;
  double minimum(double value) const override;
  void sum(double* values, int count) const override;
  using Communicator::sum;
  void maximum(double* values, int count) const override;
  using Communicator::maximum;
  void spread(std::vector<Index>& nodes) const override;
  /// Cost: two messages for each neighbor of a rank, of 8 bytes a node that both have.
  std::unique_ptr<CopiedRows> rows(const std::vector<Index>& nodes) const override;
  std::unique_ptr<Communicator> part(const std::vector<Index>& nodes) const override;

  /// Whether ranks have failed, and have told one another.
  class Votes;

private:
  RankCommunicator(const RankCommunicator& whole, std::vector<Index> nodes);

  const DistributedMesh& mesh_;
  std::vector<Index> nodes_;
  std::shared_ptr<Votes> votes_;
};
}
