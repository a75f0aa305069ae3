// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

class vtkInformation;
class vtkInformationVector;

namespace morph::filters
{
/// The steps of a morph in time: the boundary's own, or equal parts of its motion.
class Steps
{
public:
  Steps() = default;
  /// `number`: the number of steps, 0 for none. `boundary`: the boundary's pipeline information,
  /// may be null. A boundary with several time steps keeps them. One with a time range alone is
  /// taken at the ends of `number` equal parts of it. Any other is constant in time, and its motion
  /// is divided into `number` equal parts.
  Steps(int number, vtkInformation* boundary);

  /// The number of meshes, one more than NumberOfSteps.
  int Number() const { return this->Count; }
  bool Any() const { return this->Count > 0; }
  /// Whether the boundary varies in time.
  bool FromBoundary() const { return this->Varies; }
  double Time(int step) const;
  /// The fraction of the boundary's motion at a step: 1 where the boundary itself varies.
  double Fraction(int step) const;
  /// The step that `output` is asked for: the last one not after its time, or the first. Without a
  /// time it is the last step of a constant boundary, and the first of one that varies. -1 where
  /// there are no steps.
  int Asked(vtkInformation* output) const;
  /// Sets the output's time steps and range, where there are steps.
  void Write(vtkInformation* output) const;
  /// Gives all outputs the time of a step, unless that is the boundary's.
  void WriteTime(int step, vtkInformationVector* outputs) const;

private:
  // An update of one step must not cost a pass over a million of them: equal parts are not stored.
  int Count = 0;
  std::vector<double> Own;    ///< the boundary's own times, where it has several
  double First = 0, Last = 0; ///< of its range, else
  bool Varies = false;
};
}
