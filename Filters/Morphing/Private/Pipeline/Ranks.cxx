// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Pipeline/Ranks.h"

#include "Support/Error.h"

#include <vtkCommunicator.h>
#include <vtkMultiProcessController.h>

#include <exception>
#include <new>
#include <string>

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
bool TakePieces()
{
  return MORPH_HAS_MPI != 0;
}

int Processes()
{
  auto* c = controller();
  return c ? c->GetNumberOfProcesses() : 1;
}

bool IsFirst()
{
  auto* c = controller();
  return !c || c->GetLocalProcessId() == 0;
}

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

void Together(const std::function<void()>& work)
{
  auto* c = controller();
  if (!c)
  {
    work();
    return;
  }
  int kind = 0;
  std::string message;
  bool failed = true;
  try
  {
    work();
    failed = false;
  }
  catch (const morph::Error& error)
  {
    kind = static_cast<int>(error.kind());
    message = error.what();
  }
  catch (const std::bad_alloc&)
  {
    message =
      "There is not enough memory on MPI rank " + std::to_string(c->GetLocalProcessId()) + ".";
  }
  catch (const std::exception& error)
  {
    message = std::string("Unexpected failure: ") + error.what();
  }
  const int processes = c->GetNumberOfProcesses();
  int mine = failed ? c->GetLocalProcessId() : processes;
  int first = mine;
  c->AllReduce(&mine, &first, 1, vtkCommunicator::MIN_OP);
  if (first == processes)
  {
    return;
  }
  int header[2] = { kind, static_cast<int>(message.size()) };
  c->Broadcast(header, 2, first);
  message.resize(header[1]);
  c->Broadcast(message.data(), header[1], first);
  throw morph::Error(static_cast<morph::Error::Kind>(header[0]), message);
}
}
}
