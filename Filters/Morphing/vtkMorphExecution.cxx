// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphExecution.h"

#include "Support/Error.h"
#include "vtkMorphRanks.h"

#include <vtkAlgorithm.h>

#include <exception>
#include <new>
#include <string>

namespace vtkMorphExecution
{
Outcome Run(vtkAlgorithm* filter, const char* task, const std::function<void()>& work,
  const std::function<void()>& clear)
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

  const vtkMorphRanks::Outcome outcome = vtkMorphRanks::Agree(problem.empty());
  if (cancelled || outcome != vtkMorphRanks::Outcome::Success)
  {
    clear();
  }
  if (outcome == vtkMorphRanks::Outcome::Report)
  {
    vtkErrorWithObjectMacro(filter, << problem);
  }
  if (outcome != vtkMorphRanks::Outcome::Success)
  {
    return Outcome::Failed;
  }
  return cancelled ? Outcome::Cancelled : Outcome::Done;
}
}
