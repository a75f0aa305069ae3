// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"

#include <stdexcept>

namespace meshes
{
/// Serial; watches that a computation keeps asking whether it is to stop.
struct WatchingMonitor : morph::Monitor
{
  /// Counts the question, and answers yes after `cancelAfter` of them.
  bool cancelled() override
  {
    this->loopsSince = 0;
    return ++this->questions > this->cancelAfter;
  }

  int threads() const override { return 2; } // so that it is told of each loop
  /// Throws after `mostLoops` loops without a question: the computation does not listen.
  void share(morph::Index n, morph::Index grain,
    const std::function<void(morph::Index, morph::Index)>& body) override
  {
    if (++this->loopsSince > this->mostLoops)
    {
      throw std::runtime_error("many loops without asking whether to stop");
    }
    Monitor::share(n, grain, body);
  }

  int mostLoops = 1000;
  int cancelAfter = 1000000;
  int questions = 0;
  int loopsSince = 0;
};
}
