// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"

#include <vtkCallbackCommand.h>
#include <vtkNew.h>

#include <string>
#include <vector>

class vtkAlgorithm;

namespace morph::filters
{
/// Observes a filter that runs inside another one, while it lives. It keeps the filter's messages
/// off the console, and passes progress and abort on.
class Follower
{
public:
  Follower(vtkAlgorithm* filter, morph::Monitor& monitor);
  ~Follower();
  Follower(const Follower&) = delete;
  void operator=(const Follower&) = delete;

  /// The filter's messages, without the source file, line and object with which VTK's begin.
  const std::vector<std::string>& Errors() const { return this->ErrorTexts; }
  const std::vector<std::string>& Warnings() const { return this->WarningTexts; }

private:
  static void Called(vtkObject*, unsigned long event, void* self, void* data);

  vtkAlgorithm* Filter;
  morph::Monitor& Monitor;
  std::vector<std::string> ErrorTexts, WarningTexts;
  vtkNew<vtkCallbackCommand> Command;
  std::vector<unsigned long> Tags;
};
}
