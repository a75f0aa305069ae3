// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Pipeline/Monitor.h"

#include <memory>

namespace morph::filters
{
/// A monitor for iterative methods, which have hundreds of short loops, and for a drag, in which
/// each loop is short. Where the backend of
/// vtkSMPTools is Sequential it has threads of its own, which start with the first loop and end
/// with the monitor. STDThread starts its threads for each loop, which costs 70 microseconds: a
/// third of an evaluation on a mesh of 130,000 nodes. A backend that the user chose is used as it
/// is.
class CrewMonitor : public Monitor
{
public:
  CrewMonitor(vtkAlgorithm* algorithm, int threads);
  ~CrewMonitor() override;

private:
  /// As Monitor's; not to be called from within `body`.
  void share(morph::Index n, morph::Index grain,
    const std::function<void(morph::Index first, morph::Index last)>& body) override;

  class Crew;
  std::unique_ptr<Crew> Members;
};
}
