// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"

#include <memory>

namespace benchmark
{
/// The monitor that the VTK filters hand to the core, so that what is measured is what a user gets.
std::unique_ptr<morph::Monitor> makeMonitor(int threads);

/// Cores of this machine, at least 1.
int numberOfCores();
}
