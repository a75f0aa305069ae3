// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/Morpher.h"
#include "Private/Morph/Validity.h"

#include <map>
#include <memory>
#include <vector>

namespace morph::filters
{
/// A step's mesh, and how it came about.
struct StepResult
{
  morph::Points Moved; ///< #nodes x 3
  Validity::Outcome Valid;
  int Iterations = 0;
  std::vector<morph::Statistic> Statistics;
  morph::Index Prescribed = 0;
  morph::Index Unmatched = 0;
  morph::Index BoundaryInverted = 0; ///< see vtkMorphAlgorithm::GetBoundaryInvertedCells()
};

/// The meshes of a run in which each step starts from the mesh of the one before, as many as memory
/// may hold: the last one, and of the others every first, second, fourth, ... Going back costs less
/// than that many steps.
class Series
{
public:
  using Step = std::shared_ptr<const StepResult>;

  void Clear();
  /// Keeps a step's mesh; others make room for it. `megabytes`: of 10^6 bytes, for all meshes; the
  /// last one is kept besides.
  void Keep(int number, Step step, double megabytes);
  /// The nearest step that is kept, `number` itself or one before it: its number, or -1 and null.
  std::pair<int, Step> LastUntil(int number) const;

private:
  std::map<int, Step> Kept;
  int Stride = 1;
  /// the step that came last: of the kept ones the only one that may be between strides
  int Last = 0;

  /// Drops all but every Stride-th and the last one.
  void Thin();
};
}
