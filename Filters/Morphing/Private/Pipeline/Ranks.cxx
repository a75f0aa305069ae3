// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Pipeline/Ranks.h"

#include <vtkCommunicator.h>
#include <vtkMultiProcessController.h>

namespace morph::filters
{
namespace
{
vtkMultiProcessController* controller()
{
  vtkMultiProcessController* global = vtkMultiProcessController::GetGlobalController();
  return global && global->GetNumberOfProcesses() > 1 ? global : nullptr;
}
}

namespace Ranks
{
int Count(bool yes)
{
  int mine = yes ? 1 : 0;
  int all = mine;
  if (auto* c = controller())
  {
    c->AllReduce(&mine, &all, 1, vtkCommunicator::SUM_OP);
  }
  return all;
}

Outcome Agree(bool succeeded)
{
  auto* c = controller();
  if (!c)
  {
    return succeeded ? Outcome::Success : Outcome::Report;
  }
  const int processes = c->GetNumberOfProcesses();
  const int rank = c->GetLocalProcessId();
  int mine = succeeded ? processes : rank;
  int first = mine;
  c->AllReduce(&mine, &first, 1, vtkCommunicator::MIN_OP);
  if (first == processes)
  {
    return Outcome::Success;
  }
  return first == rank ? Outcome::Report : Outcome::Failure;
}
}
}
