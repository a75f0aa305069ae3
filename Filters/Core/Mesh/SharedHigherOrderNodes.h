// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/HigherOrderNodes.h"
#include "Support/Communicator.h"

#include <memory>
#include <vector>

namespace morph
{
/// HigherOrderNodes of a mesh that is on one process or several, each of which has its own cells.
/// All functions but empty() are collective.
class SharedHigherOrderNodes
{
public:
  /// `rest`: with the cells of this process.
  void prepare(const Mesh& rest, const NodePartition& partition, const Communicator& communicator);
  /// Whether no process has such nodes.
  bool empty() const { return !this->rows_; }
  /// Fills the higher-order nodes' rows of `displacement` (#nodes x 3) from the corners' rows.
  void apply(Points& displacement) const;

private:
  std::vector<Index> ids_;
  std::vector<double> share_; ///< the part of each node's cells that this process has
  HigherOrderNodes own_;
  std::unique_ptr<CopiedRows> rows_; ///< of ids_; null without any
};
}
