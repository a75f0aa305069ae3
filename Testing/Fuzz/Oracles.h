// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Case.h"

#include <functional>
#include <string>

namespace fuzz
{
/// What is wrong with a case: the oracle's name, empty if nothing is, and what it saw.
struct Finding
{
  std::string oracle;
  std::string detail;
  explicit operator bool() const { return !this->oracle.empty(); }
};

/// What came of a case.
struct Verdict
{
  Finding finding;
  std::string filter;
  bool hasFreeNodes = false;
  bool hasError = false;
  /// properties and what else was asked for, each with + where the case has it, else -
  std::string features;
  std::vector<std::string> messages;
};

/// Makes the case, executes its filter twice, and asks all oracles.
/// `made` is called before, with a summary of the inputs.
Verdict judge(
  Choices& choices, const Filter& filter,
  const std::function<void(const std::string&)>& made = [](const std::string&) {});

/// Oracles of one execution: see Oracles.cxx, OutputOracles.cxx.
Finding checkMessages(const Case& made, const Run& run);
Finding checkOutput(const Case& made, vtkAlgorithm* filter, const Run& run);
}
