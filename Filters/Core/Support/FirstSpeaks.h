// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Communicator.h"
#include "Support/ProgressRange.h"

#include <string>

namespace morph
{
/// Keeps back the warnings of all processes but the first: they are of the whole mesh.
class FirstSpeaks : public ProgressRange
{
public:
  FirstSpeaks(Monitor& whole, const Communicator& processes)
    : ProgressRange(whole, 0, 1)
    , speaks_(processes.isFirst())
  {
  }
  void warn(const std::string& message) override
  {
    if (this->speaks_)
    {
      ProgressRange::warn(message);
    }
  }

private:
  bool speaks_;
};
}
