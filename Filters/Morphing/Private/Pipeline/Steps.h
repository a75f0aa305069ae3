// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

class vtkInformation;

namespace morph::filters
{
/// The steps of a morph in time: the boundary's own, or equal parts of its motion.
class Steps
{
public:
  Steps() = default;
  /// `number`: steps asked for, 0 for none; `boundary`: what its pipeline says, may be null. A
  /// boundary with several time steps has its own; one with a time range alone is taken at the ends
  /// of `number` equal parts of it; any other is still, and its motion is cut in `number` parts.
  Steps(int number, vtkInformation* boundary);

  /// How many meshes there are: one more than NumberOfSteps asks for.
  int Number() const { return this->Count; }
  bool Any() const { return this->Count > 0; }
  /// Whether the boundary is another one at each step.
  bool FromBoundary() const { return this->Varies; }
  double Time(int step) const;
  /// Of the boundary's motion, at that step: 1 where the boundary itself varies.
  double Fraction(int step) const;
  /// The step that `output` is asked for: the last not after its time, or the first. Where it is
  /// asked for no time: the last of a still boundary's, the first of a varying one's. -1 where
  /// there are no steps.
  int Asked(vtkInformation* output) const;
  /// Sets the output's time steps and range, where there are steps.
  void Write(vtkInformation* output) const;

private:
  // An update of one step must not cost a pass over a million of them: equal parts are not stored.
  int Count = 0;
  std::vector<double> Own;    ///< the boundary's own times, where it has several
  double First = 0, Last = 0; ///< of its range, else
  bool Varies = false;
};
}
