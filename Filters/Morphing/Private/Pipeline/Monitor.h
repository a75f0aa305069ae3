// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"

#include <string>
#include <unordered_set>
#include <vector>

class vtkAlgorithm;

namespace morph::filters
{
/// The core's monitor over VTK: threads through vtkSMPTools, progress and abort through an
/// algorithm.
class Monitor : public morph::Monitor
{
public:
  /// `algorithm`: whose progress is updated and whose abort flag is read; null for neither.
  /// `threads`: 0 = as many as vtkSMPTools would use at most with the backend that is used (all
  /// cores, or VTK_SMP_MAX_THREADS).
  Monitor(vtkAlgorithm* algorithm, int threads);

  /// The part of the algorithm's progress that the core's [0, 1] is mapped to from now on.
  void SetRange(double first, double last);

  void progress(double fraction) override;
  bool cancelled() override;
  /// Kept until TakeWarnings(); the same text is kept once.
  void warn(const std::string& message) override;
  std::vector<std::string> TakeWarnings();

  /// Through the backend of vtkSMPTools, or STDThread where that is Sequential (as ParaView's is by
  /// default). STDThread starts its threads for each call, about 70 microseconds: a range not
  /// longer than `grain` runs in the caller's thread. An exception thrown by `body` arrives in the
  /// caller's thread once the other ranges have ended.
  void parallelFor(morph::Index n, morph::Index grain,
    const std::function<void(morph::Index first, morph::Index last)>& body) override;

protected:
  int GetThreads() const { return this->Threads; }
  /// Whether the user's backend computes with one thread only, so that this class brings its own.
  static bool IsSequential();
  /// How long to make the ranges of a loop: a few ranges a thread even out their loads.
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
