// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

namespace morph
{
/// Approximates the inverse of a scalar matrix K over the nodes, in each of three columns. It sees
/// the whole mesh at once, where diagonal blocks see a node alone.
class NodePreconditioner
{
public:
  virtual ~NodePreconditioner() = default;
  /// Computes `to` = B `from` (#rows x 3). B is symmetric and positive definite, near K^-1.
  virtual void apply(const Points& from, Points& to, Monitor& monitor) const = 0;
  /// The diagonal of K, all positive.
  virtual double diagonal(Index row) const = 0;
  /// The number of nodes: that of the block rows of the matrix that it is for.
  virtual Index rows() const = 0;
};
}
