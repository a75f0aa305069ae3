// SPDX-License-Identifier: BSD-3-Clause
#include "Threads.h"

#include "Private/Pipeline/CrewMonitor.h"

#include <algorithm>
#include <thread>

namespace benchmark
{
std::unique_ptr<morph::Monitor> makeMonitor(int threads)
{
  return std::make_unique<morph::filters::CrewMonitor>(nullptr, threads);
}

int numberOfCores()
{
  return static_cast<int>(std::max(std::thread::hardware_concurrency(), 1u));
}
}
