// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Choices.h"
#include "Oracles.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace fuzz
{
struct Report
{
  std::uint64_t seed = 0;
  std::string filter;
  bool hasFreeNodes = false;
  bool hasError = false;
  std::string oracle;   ///< "crash" and "time-out" too; empty: nothing was found
  std::string detail;   ///< of a crash, what the process wrote before it ended
  std::string features; ///< see Verdict
};

/// Runs the seeds in processes of their own, 500 in each, so that a crash ends no more than that
/// case. Calls `report` for each, in order, until it returns false. `set`: see Choices.
void runSeeds(std::uint64_t from, std::uint64_t count, const std::string& filter,
  const Choices::Values& set, const std::function<bool(const Report&)>& report);

/// One case with all that it was made from.
struct Trial
{
  Report report;
  std::vector<Choices::Choice> choices; ///< those that are not plain
  std::vector<std::string> messages;
  std::string data; ///< a summary of the inputs
};
Trial runOne(std::uint64_t seed, const std::string& filter, const Choices::Values& set);

/// The case with as many plain choices, and as simple numbers, as still give the same finding.
Trial reduce(const Trial& failing, const std::string& filter, Choices::Values& set);

/// Seconds of processor time after which a case counts as endless.
constexpr unsigned TimeOut = 30;
}
