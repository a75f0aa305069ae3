// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Data/Quality.h"

#include <vtkType.h>

#include <string>
#include <vector>

class vtkTable;
class vtkUnstructuredGrid;

namespace morph::filters
{
class RankGroup;
class Results;

/// The results of one method with one stepping in vtkCompareMorphMethods.
struct MethodRun
{
  struct Step
  {
    double Time;
    double Minimum, Mean, Low; ///< scaled Jacobians; Low: the percentile
    vtkIdType Inverted, Degenerate, BoundaryInverted;
    double PrepareSeconds, EvaluateSeconds;
    std::vector<Quality::OfCriterion> Criteria;
  };
  std::string Method;
  std::string Stepping;
  std::vector<Step> Steps; ///< one for each step that gave a mesh
  std::string Failure;     ///< the error that ended the run before its last step
  vtkIdType BadAtRest = 0; ///< inverted and degenerate cells of the mesh itself
  double PeakMegabytes = 0;
  int Rank = 0; ///< 1 is best

  std::string Title() const;
  /// The number of steps up to the first with more inverted and degenerate cells than the
  /// undeformed mesh.
  int ValidSteps() const;
  /// The minimum scaled Jacobian at the last valid step; NaN where there is none.
  double LastValidMinimum() const;
  double Seconds() const;
};

namespace Comparison
{
/// The step of which a GridMorpher has just written `results` and the mesh, the same on all
/// `processes`, which have parts of it or none. `percentile`: see vtkCompareMorphMethods.
MethodRun::Step Measure(const Results& results, vtkUnstructuredGrid* mesh, double time,
  double percentile, const RankGroup& processes);

/// Gives every run its rank: by valid steps, then by the minimum scaled Jacobian at the last of
/// them, to 0.01, then by seconds, then by order.
void Rank(std::vector<MethodRun>& runs);

/// A row for each run and step, one at least.
void WriteSteps(const std::vector<MethodRun>& runs, vtkTable* output);
/// A row for each of `times`, a column of minimum scaled Jacobians for each run.
void WriteChart(
  const std::vector<MethodRun>& runs, const std::vector<double>& times, vtkTable* output);
/// A row for each run, best first. `steps`: the number of steps.
void WriteRanking(const std::vector<MethodRun>& runs, int steps, vtkTable* output);
}
}
