// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

class vtkAlgorithm;

/// The frame of every filter's RequestData: no exception reaches VTK.
namespace morph::filters::Execution
{
enum class Outcome
{
  Done,
  Cancelled,
  Failed
};

/// Calls `work` on each MPI process. If it throws on any of them, all of them call `clear`, and one
/// reports the error as one of `filter`'s, or by `report` where that is given. If it was cancelled,
/// `clear` is called without a message: whoever cancelled knows. RequestData has to return 1 in any
/// case: after a 0 the executive adds ten lines of its own. `task`: the words after "not enough
/// memory to" ("morph this mesh").
Outcome Run(vtkAlgorithm* filter, const char* task, const std::function<void()>& work,
  const std::function<void()>& clear,
  const std::function<void(const std::string& problem)>& report = {});
}
