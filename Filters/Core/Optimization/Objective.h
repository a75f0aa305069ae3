// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Optimization/BlockCsr3f.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <vector>

namespace morph
{
/// A function of the free nodes' positions that a minimiser lowers. Independent of the threads, to
/// the last bit.
class Objective
{
public:
  virtual ~Objective();

  /// Ids of the nodes that move, in the order of the gradient's rows.
  virtual const std::vector<Index>& free() const = 0;

  struct Value
  {
    double energy = 0;   ///< infinite where the function is not defined
    bool allowed = true; ///< false: no step may end here, whatever the energy
  };
  /// `points`: #nodes x 3.
  virtual Value value(const Points& points, Monitor& monitor) const = 0;
  /// `result`: becomes #free x 3, d(energy)/d(position).
  virtual void gradient(const Points& points, Points& result, Monitor& monitor) const = 0;
};

/// An objective with second derivatives, for Newton's method.
class SecondOrderObjective : public Objective
{
public:
  /// A positive semi-definite approximation of the second derivatives, #free x #free blocks; a
  /// matrix that this objective has not filled before is opened first.
  virtual void hessian(const Points& points, BlockCsr3f& result, Monitor& monitor) const = 0;
};
}
