// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"

#include "Session/UndeformedMesh.h"
#include "Support/Communicator.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace morph::distributed
{
/// The communicator of the local nodes of a distributed mesh, or of a part of them. All its
/// functions communicate by the mesh's Ranks.
class RankCommunicator : public Communicator
{
public:
  /// `nodes`: of `mesh`: node i of the part is `nodes`[i]; by default all. Holds `mesh` by
  /// reference.
  ///@{
  explicit RankCommunicator(const DistributedMesh& mesh);
  RankCommunicator(const DistributedMesh& mesh, std::vector<Index> nodes);
  ///@}

  const DistributedMesh& mesh() const { return this->mesh_; }
  void together(const std::function<void()>& work) const override;
  std::vector<Index> idsOf(const std::vector<Index>& nodes) const override;
  double sum(double value) const override;
  double minimum(double value) const override;
  void sum(double* values, int count) const override;
  using Communicator::sum;
  void maximum(double* values, int count) const override;
  using Communicator::maximum;
  void spread(std::vector<Index>& nodes) const override;
  /// Cost: two messages for each neighbor of a rank, of 8 bytes a node that both have.
  std::unique_ptr<CopiedRows> rows() const override;
  using Communicator::rows;
  std::unique_ptr<Communicator> part(const std::vector<Index>& nodes) const override;

  bool isFirst() const override { return this->mesh_.ranks().rank() == 0; }
  const ConnectedComponents* bodies() const override { return &this->mesh_.bodies(); }
  const std::vector<std::int8_t>* orientation() const override
  {
    return &this->mesh_.orientation();
  }
  Index sumBefore(Index value) const override { return this->mesh_.ranks().sumBefore(value); }
  bool isCopy(Index cell) const override
  {
    return !this->isPart_ && this->mesh_.isGhost()[cell] != 0;
  }
  bool owns(Index node) const override { return this->mesh_.owns(node); }
  void update(Points& rows) const override { this->mesh_.halo().update(this->mesh_.ranks(), rows); }
  std::vector<double> gather(const std::vector<double>& values) const override
  {
    return this->mesh_.ranks().gather(values);
  }
  std::vector<Index> idsOfCells(const std::vector<Index>& cells) const override;
  std::vector<Index> cellsOf(const std::vector<Index>& ids) const override;
  std::vector<Index> gatherNodes(const std::vector<Index>& nodes) const override;
  std::vector<Index> gatherCells(const std::vector<Index>& cells) const override;
  std::vector<Index> nodesOf(const std::vector<Index>& ids) const override;
  Points gather(const Points& rows, const std::vector<Index>& nodes) const override;
  void completeCells(std::vector<double>& values) const override;
  Index join(std::vector<Index>& ofNode) const override { return this->mesh_.join(ofNode); }
  std::vector<Index> numbersOf(
    const std::vector<Index>& nodes, const std::vector<Index>& others) const override;
  /// Returns a HypreSolver.
  std::shared_ptr<LinearSolver> makeSolver(bool isSymmetric) const override;
  /// Returns a CutMesh.
  std::shared_ptr<CellPieces> cut(const Mesh& mesh, int layers, Monitor& monitor) const override;

private:
  std::vector<Index> ofMesh(std::vector<Index> nodes) const;

  const DistributedMesh& mesh_;
  std::vector<Index> nodes_;
  bool isPart_ = true;
};

/// The mesh for a session. Collective.
std::shared_ptr<const UndeformedMesh> undeformedMesh(
  const std::shared_ptr<const DistributedMesh>& mesh, Monitor& monitor);
}
