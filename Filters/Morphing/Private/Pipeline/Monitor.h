// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"

#include <string>
#include <unordered_set>
#include <vector>

class vtkAlgorithm;

namespace morph::filters
{
/// The core's monitor for VTK. Threads are those of vtkSMPTools; progress and abort go through an
/// algorithm.
class Monitor : public morph::Monitor
{
public:
  /// `algorithm`: its progress is updated and its abort flag is read; null for neither. `threads`:
  /// their number; 0 is the maximum of the backend of vtkSMPTools (all cores, or
  /// VTK_SMP_MAX_THREADS).
  Monitor(vtkAlgorithm* algorithm, int threads);

  /// Sets the part of the algorithm's progress to which the core's [0, 1] is mapped from now on.
  void SetRange(double first, double last);

  void progress(double fraction) override;
  bool cancelled() override;
  /// Keeps the message until TakeWarnings(); the same text is kept once.
  void warn(const std::string& message) override;
  std::vector<std::string> TakeWarnings();
  /// Takes the warnings, and raises them as those of the algorithm.
  void TellWarnings();
  int threads() const override { return this->Threads; }

protected:
  /// Uses the backend of vtkSMPTools, or STDThread where that is Sequential (ParaView's default).
  /// STDThread starts its threads for each call, about 70 microseconds: a range not longer than
  /// `grain` runs in the caller's thread. An exception thrown by `body` arrives in the
  /// caller's thread once the other ranges have ended.
  void share(morph::Index n, morph::Index grain,
    const std::function<void(morph::Index first, morph::Index last)>& body) override;
  /// Whether the user's backend computes with one thread only, so that this class brings its own.
  static bool IsSequential();
  /// The length of the ranges of a loop: a few ranges a thread balance the load.
  morph::Index RangeLength(morph::Index n, morph::Index grain) const;

private:
  vtkAlgorithm* Algorithm;
  int Threads;
  double First = 0;
  double Last = 1;
  double Reported = 0;
  std::vector<std::string> Warnings;
  std::unordered_set<std::string> Told; ///< Warnings again, to be found
};
}
