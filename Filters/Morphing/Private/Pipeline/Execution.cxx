// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Pipeline/Execution.h"

#include "Private/Pipeline/Ranks.h"
#include "Support/Error.h"

#include <vtkAlgorithm.h>

#include <exception>
#include <new>
#include <string>

namespace morph::filters
{
namespace Execution
{
Outcome Run(vtkAlgorithm* filter, const char* task, const std::function<void()>& work,
  const std::function<void()>& clear, const std::function<void(const std::string&)>& report)
{
  bool cancelled = false;
  std::string problem;
  try
  {
    work();
  }
  catch (const morph::Error& error)
  {
    cancelled = error.kind() == morph::Error::Kind::Cancelled;
    problem = cancelled ? "" : error.what();
  }
  catch (const std::bad_alloc&)
  {
    problem = std::string("There is not enough memory to ") + task + ".";
  }
  catch (const std::exception& error)
  {
    problem = std::string("Unexpected failure: ") + error.what();
  }

  const Ranks::Outcome outcome = Ranks::Agree(problem.empty());
  if (cancelled || outcome != Ranks::Outcome::Success)
  {
    clear();
  }
  if (outcome == Ranks::Outcome::Report && report)
  {
    report(problem);
  }
  else if (outcome == Ranks::Outcome::Report)
  {
    vtkErrorWithObjectMacro(filter, << problem);
  }
  if (outcome != Ranks::Outcome::Success)
  {
    return Outcome::Failed;
  }
  return cancelled ? Outcome::Cancelled : Outcome::Done;
}
}
}
