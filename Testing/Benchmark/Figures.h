// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Report.h"

namespace benchmark
{
struct Options
{
  /// Repetitions, whose medians are reported.
  int repeat = 3;
  /// Seconds to wait before each measurement for other processes to be idle.
  double waitIdle = 0;
  /// KLU alone takes about a minute.
  bool skipKlu = false;
  /// Small meshes: the answers are checked, but the figures are not held against the targets.
  bool quick = false;
};

/// Measures everything, progress on standard error. `correct` becomes false if a result is wrong. Throws
/// std::runtime_error or morph::Error where something cannot be measured.
Report measureFigures(const Options& options, bool& correct);
}
