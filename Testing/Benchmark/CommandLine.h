// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Report.h"

#include <string>
#include <vector>

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
  /// Seconds after which KLU is stopped.
  double kluLimit = 600;
  /// Small meshes: the answers are checked, but the figures are not held against the targets.
  bool quick = false;
  /// What the command line names besides, where the benchmark takes files.
  std::vector<std::string> files;
};

/// Measures everything, progress on standard error. `correct` becomes false if a result is wrong.
/// Throws std::runtime_error or morph::Error where something cannot be measured.
using Measure = Report (*)(const Options& options, bool& correct);

/// The main function of a benchmark: reads the command line, measures and prints. `name`: of the
/// executable; `about`: two lines or three for --help; `libraries`: what else to say of the
/// machine, or empty. Returns the exit status. `files`: what --help calls the files that the
/// benchmark takes, one at least; empty where it takes none.
int commandLine(int argc, char** argv, const std::string& name, const std::string& about,
  const std::string& libraries, Measure measure, const std::string& files = "");
}
