// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Ranks.h"
#include "Support/Error.h"

#include <vtkCharArray.h>
#include <vtkCommunicator.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace morph::filters
{
/// All processes' data objects, by rank; `bytes` grows by what this process received.
/// `onlyDistinct`: without those that are equal to an earlier one. Throws morph::Error on all
/// processes where one cannot be sent. Collective.
template <typename Data>
std::vector<vtkSmartPointer<Data>> gatherData(
  const morph::distributed::Ranks& ranks, Data* mine, bool onlyDistinct, std::size_t& bytes)
{
  vtkNew<vtkCharArray> buffer;
  ranks.together(
    [&]
    {
      if (!vtkCommunicator::MarshalDataObject(mine, buffer))
      {
        throw morph::Error("The boundary cannot be sent to the other MPI ranks.");
      }
    });
  const std::vector<char> packed(
    buffer->GetPointer(0), buffer->GetPointer(0) + buffer->GetNumberOfValues());
  const auto messages =
    ranks.exchange(std::vector<std::vector<char>>(static_cast<std::size_t>(ranks.count()), packed));
  std::vector<vtkSmartPointer<Data>> result;
  ranks.together(
    [&]
    {
      for (auto message = messages.begin(); message != messages.end(); ++message)
      {
        const std::vector<char>& one = *message;
        bytes += one.size();
        if (onlyDistinct && std::find(messages.begin(), message, one) != message)
        {
          continue;
        }
        buffer->SetNumberOfValues(static_cast<vtkIdType>(one.size()));
        std::copy(one.begin(), one.end(), buffer->GetPointer(0));
        result.emplace_back(Data::SafeDownCast(vtkCommunicator::UnMarshalDataObject(buffer.Get())));
      }
    });
  return result;
}
}
