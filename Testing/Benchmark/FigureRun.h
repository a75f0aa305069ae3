// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CommandLine.h"
#include "MethodTimes.h"
#include "TwistedBrick.h"

#include <string>

namespace benchmark
{
/// A line on standard error: what is measured now.
void say(const std::string& text);

/// ", 1 thread" or ", 2 threads".
std::string withThreads(int n);

/// The figures of one benchmark as they come in. A subclass measures.
class FigureRun
{
public:
  explicit FigureRun(const Options& options);

  Report report;
  bool correct = true;

protected:
  void add(const Problem& problem, const std::string& figure, double measured,
    const std::string& unit, Target target = Target::none());
  /// Adds a figure that decides whether the run is correct, on small meshes too.
  void check(const Problem& problem, const std::string& figure, double measured, double atMost);
  /// Checks that two solutions differ by at most 1e-6 of the mesh's size.
  void checkAgainst(const Problem& problem, const std::string& figure,
    const morph::Points& reference, const morph::Points& x);
  void addTimes(const Problem& problem, int threads, const MethodTimes& times);
  /// Before each measurement: lets the machine come to rest.
  void settleDown() const;

  Options options_;
  int cores_;
};
}
