// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/Morpher.h"
#include "Session/Validity.h"
#include "Support/Error.h"

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace morph
{
/// The mesh of one motion, with the numbers of its computation.
struct StepResult
{
  Points moved; ///< #nodes x 3
  Validity::Outcome valid;
  int iterations = 0;                ///< of the method's solver
  std::vector<Statistic> statistics; ///< the method's own, and PostSmoothSteps
  Index prescribed = 0;              ///< nodes
  Index unmatched = 0;               ///< see BoundaryTargets
  Index attached = 0;                ///< nodes; see AttachedNodes.h
  std::vector<Index> loose;          ///< ids; see AttachedNodes.h
  /// Of an inverted mesh: the cells that the boundary inverts at corners that no free node can
  /// mend.
  Index boundaryInverted = 0;
  /// The minimum scaled Jacobian at corners whose nodes are all prescribed; NaN without one.
  double boundaryMinimum = std::numeric_limits<double>::quiet_NaN();
};

/// The meshes of a run in which each step starts from the mesh of the step before. As many are kept
/// as the memory allows: the last one, and of the others every first, second, fourth, ... Going
/// back costs fewer steps than that number.
class Series
{
public:
  using Step = std::shared_ptr<const StepResult>;

  void clear();
  /// Clears if a number is not that of the last call: `options` tells the state of the options,
  /// `boundary` that of a boundary that varies from step to step. VTK's times of modification are
  /// such numbers.
  void check(std::uint64_t options, bool varies, std::uint64_t boundary);
  /// Keeps a step's mesh, and drops others if necessary. `megabytes`: the memory for all meshes in
  /// 10^6 bytes; the last one is kept besides.
  void keep(int number, Step step, double megabytes);
  /// The nearest step that is kept, `number` itself or one before it: its number, or -1 and null.
  std::pair<int, Step> lastUntil(int number) const;

private:
  std::map<int, Step> kept_;
  int stride_ = 1;
  /// the last step: the only kept one that may be between strides
  int last_ = 0;
  using State = std::tuple<std::uint64_t, bool, std::uint64_t>;
  State state_; ///< of the last check()

  /// Drops all but every stride_-th and the last one.
  void thin();
};

/// Returns what `work` does. Its errors name the step.
template <typename Work>
auto inStep(int step, const Work& work)
{
  const std::string subject = "Step " + std::to_string(step) + ": ";
  try
  {
    return work();
  }
  catch (const Validity::Infeasible& infeasible)
  {
    throw Validity::Infeasible(subject + infeasible.what(), infeasible.cells);
  }
  catch (const Error& error)
  {
    throw Error(error.kind(), subject + error.what());
  }
}
}
