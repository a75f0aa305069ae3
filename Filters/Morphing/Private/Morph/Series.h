// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/Morpher.h"
#include "Private/Morph/Validity.h"

#include <vtkType.h>

#include <limits>
#include <map>
#include <memory>
#include <vector>

namespace morph::filters
{
/// The mesh of one step, with the numbers of its computation.
struct StepResult
{
  morph::Points Moved; ///< #nodes x 3
  Validity::Outcome Valid;
  int Iterations = 0;
  std::vector<morph::Statistic> Statistics;
  morph::Index Prescribed = 0;
  morph::Index Unmatched = 0;
  morph::Index Attached = 0;         ///< nodes; see AttachedNodes.h
  std::vector<morph::Index> Loose;   ///< ids
  morph::Index BoundaryInverted = 0; ///< see vtkMorphAlgorithm::GetBoundaryInvertedCells()
  /// see vtkMorphAlgorithm::GetBoundaryMinimum(), NaN without such a corner
  double BoundaryMinimum = std::numeric_limits<double>::quiet_NaN();
};

/// The meshes of a run in which each step starts from the mesh of the step before. As many are kept
/// as the memory allows: the last one, and of the others every first, second, fourth, ... Going
/// back costs fewer steps than that number.
class Series
{
public:
  using Step = std::shared_ptr<const StepResult>;

  void Clear();
  /// Clears if the options, or a boundary that varies, were modified since the last call. All
  /// numbers but `varies` are times of modification.
  void Check(vtkMTimeType options, bool varies, vtkMTimeType boundary);
  /// Keeps a step's mesh, and drops others if necessary. `megabytes`: the memory for all meshes in
  /// 10^6 bytes; the last one is kept besides.
  void Keep(int number, Step step, double megabytes);
  /// The nearest step that is kept, `number` itself or one before it: its number, or -1 and null.
  std::pair<int, Step> LastUntil(int number) const;

private:
  std::map<int, Step> Kept;
  int Stride = 1;
  /// the last step: the only kept one that may be between strides
  int Last = 0;
  vtkMTimeType OptionsTime = 0, BoundaryTime = 0;
  bool Varied = false;

  /// Drops all but every Stride-th and the last one.
  void Thin();
};
}
