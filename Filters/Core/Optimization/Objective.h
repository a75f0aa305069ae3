// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Optimization/BlockCsr3f.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <vector>

namespace morph
{
/// An objective function of the free nodes' positions, to be minimised. Its values do not depend on
/// threads, bit for bit.
class Objective
{
public:
  virtual ~Objective();

  /// Returns the ids of the nodes that move, in the order of the gradient's rows.
  virtual const std::vector<Index>& free() const = 0;

  struct Value
  {
    double energy = 0;   ///< infinite where the function is undefined
    bool allowed = true; ///< false: no step may end here
    bool enough = false; ///< a minimiser may end here
  };
  /// `points`: #nodes x 3.
  virtual Value value(const Points& points, Monitor& monitor) const = 0;
  /// `result`: becomes #free x 3, d(energy)/d(position).
  virtual void gradient(const Points& points, Points& result, Monitor& monitor) const = 0;
  /// Both at once, where that takes less than one after the other. `result` has no meaning where
  /// the value is not finite.
  virtual Value valueAndGradient(const Points& points, Points& result, Monitor& monitor) const;
};

/// An objective with second derivatives, for Newton's method.
class SecondOrderObjective : public Objective
{
public:
  /// Computes a positive semi-definite approximation of the second derivatives, #free x #free
  /// blocks. It first opens a matrix that this objective has not filled before.
  virtual void hessian(const Points& points, BlockCsr3f& result, Monitor& monitor) const = 0;
};
}
