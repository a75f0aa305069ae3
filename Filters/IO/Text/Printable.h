// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>

namespace morph::io
{
/// A message that may cite a file's bytes, on one line: control characters become question marks.
inline std::string printable(std::string message)
{
  const auto isControl = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  std::replace_if(message.begin(), message.end(), isControl, '?');
  return message;
}
}
