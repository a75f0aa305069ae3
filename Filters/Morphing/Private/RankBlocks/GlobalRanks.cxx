// SPDX-License-Identifier: BSD-3-Clause
#include "Private/RankBlocks/GlobalRanks.h"

#include "Support/Error.h"
#include "Support/Lists.h"

#include <vtkMPI.h>
#include <vtkMPICommunicator.h>
#include <vtkMultiProcessController.h>

namespace morph::filters
{
morph::distributed::Ranks GlobalRanks()
{
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  auto* communicator =
    controller ? vtkMPICommunicator::SafeDownCast(controller->GetCommunicator()) : nullptr;
  if (!communicator)
  {
    throw morph::Error("The mesh is distributed over processes that do not communicate by MPI. "
                       "Start them by mpiexec.");
  }
  return morph::distributed::Ranks(*communicator->GetMPIComm()->GetHandle());
}

std::vector<std::string> GatherTexts(
  const morph::distributed::Ranks& ranks, const std::vector<std::string>& mine)
{
  std::vector<std::string> all = ranks.gather(mine);
  morph::sortUnique(all);
  return all;
}
}
