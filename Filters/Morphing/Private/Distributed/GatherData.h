// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Ranks.h"
#include "Support/Error.h"

#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace morph::filters
{
/// All processes' data objects, by rank, which `Writer` writes and `Reader` reads; `bytes` grows by
/// what this process received. `onlyDistinct`: without those that are equal to an earlier one.
/// Throws morph::Error on all processes where one cannot be sent. Collective.
template <typename Writer, typename Reader, typename Data>
std::vector<vtkSmartPointer<Data>> gatherData(
  const morph::distributed::Ranks& ranks, Data* mine, bool onlyDistinct, std::size_t& bytes)
{
  std::vector<char> packed;
  ranks.together(
    [&]
    {
      vtkNew<Writer> writer;
      writer->SetInputData(mine);
      writer->WriteToOutputStringOn();
      writer->SetDataModeToAppended();
      writer->EncodeAppendedDataOff();
      writer->SetCompressorTypeToNone();
      writer->SetHeaderTypeToUInt64();
      if (!writer->Write())
      {
        throw morph::Error("The boundary cannot be sent to the other MPI ranks.");
      }
      const std::string text = writer->GetOutputString();
      packed.assign(text.begin(), text.end());
    });
  const auto messages =
    ranks.exchange(std::vector<std::vector<char>>(static_cast<std::size_t>(ranks.count()), packed));
  std::vector<vtkSmartPointer<Data>> result;
  ranks.together(
    [&]
    {
      for (auto message = messages.begin(); message != messages.end(); ++message)
      {
        bytes += message->size();
        if (!onlyDistinct || std::find(messages.begin(), message, *message) == message)
        {
          vtkNew<Reader> reader;
          reader->ReadFromInputStringOn();
          reader->SetInputString(std::string(message->begin(), message->end()));
          reader->Update();
          result.emplace_back(reader->GetOutput());
        }
      }
    });
  return result;
}
}
