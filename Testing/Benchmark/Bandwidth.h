// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"

#include <cstddef>

namespace benchmark
{
/// Sustained memory bandwidth, bytes a second.
struct Bandwidth
{
  double read = 0;  ///< sum of one array: 8 bytes an element
  double triad = 0; ///< a = b + s c, counted as McCalpin's STREAM does: 24 bytes an element
  double best() const { return this->read > this->triad ? this->read : this->triad; }
};

/// Measures over three arrays of `bytes` in all, on the monitor's threads; the best of several
/// passes.
Bandwidth measureBandwidth(std::size_t bytes, morph::Monitor& monitor);
}
