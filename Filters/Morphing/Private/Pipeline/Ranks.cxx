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

/// Reduces the values in place.
template <typename Value>
void reduce(bool isShared, Value* values, std::size_t size, int operation)
{
  auto* c = isShared ? controller() : nullptr;
  if (c && size > 0)
  {
    const std::vector<Value> mine(values, values + size);
    c->AllReduce(mine.data(), values, static_cast<vtkIdType>(size), operation);
  }
}

/// Gives all processes the values of the first with some.
template <typename Values>
void share(bool isShared, Values& values)
{
  auto* c = isShared ? controller() : nullptr;
  if (!c)
  {
    return;
  }
  const int processes = c->GetNumberOfProcesses();
  const int mine = values.empty() ? processes : c->GetLocalProcessId();
  int first = mine;
  c->AllReduce(&mine, &first, 1, vtkCommunicator::MIN_OP);
  if (first == processes)
  {
    return;
  }
  auto size = static_cast<vtkIdType>(values.size());
  c->Broadcast(&size, 1, first);
  values.resize(size);
  c->Broadcast(values.data(), size, first);
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
void RankGroup::Together(const std::function<void()>& work) const
{
  if (this->IsShared)
  {
    Ranks::Together(work);
  }
  else
  {
    work();
  }
}

bool RankGroup::IsFirst() const
{
  return !this->IsShared || Ranks::IsFirst();
}

bool RankGroup::Any(bool yes) const
{
  return this->IsShared ? Ranks::Count(yes) > 0 : yes;
}

void RankGroup::Sum(morph::Index* values, std::size_t size) const
{
  reduce(this->IsShared, values, size, vtkCommunicator::SUM_OP);
}

void RankGroup::Sum(double* values, std::size_t size) const
{
  reduce(this->IsShared, values, size, vtkCommunicator::SUM_OP);
}

double RankGroup::Minimum(double value) const
{
  reduce(this->IsShared, &value, 1, vtkCommunicator::MIN_OP);
  return value;
}

double RankGroup::Maximum(double value) const
{
  reduce(this->IsShared, &value, 1, vtkCommunicator::MAX_OP);
  return value;
}

std::vector<double> RankGroup::Gather(const std::vector<double>& mine) const
{
  auto* c = this->IsShared ? controller() : nullptr;
  if (!c)
  {
    return mine;
  }
  const auto length = static_cast<vtkIdType>(mine.size());
  std::vector<vtkIdType> lengths(c->GetNumberOfProcesses()), offsets(lengths.size(), 0);
  c->AllGather(&length, lengths.data(), 1);
  for (std::size_t r = 1; r < offsets.size(); ++r)
  {
    offsets[r] = offsets[r - 1] + lengths[r - 1];
  }
  std::vector<double> all(offsets.back() + lengths.back());
  c->AllGatherV(mine.data(), all.data(), length, lengths.data(), offsets.data());
  return all;
}

void RankGroup::Share(std::vector<double>& values) const
{
  share(this->IsShared, values);
}

void RankGroup::Share(std::string& text) const
{
  share(this->IsShared, text);
}
}
