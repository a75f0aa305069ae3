// SPDX-License-Identifier: BSD-3-Clause
#include "Support/FreePageReporting.h"

#include <exception>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace morph
{
namespace
{
/// Returns the first word of a file, or nothing.
std::string firstWord(const std::filesystem::path& file)
{
  std::ifstream stream(file);
  std::string word;
  stream >> word;
  return word;
}
}

bool reportsFreePages(const std::string& devices) noexcept
{
  constexpr std::size_t PageReporting = 5; // the feature's bit; the first character is bit 0
  try
  {
    std::error_code error;
    for (std::filesystem::directory_iterator device(devices, error), end; device != end && !error;
         device.increment(error))
    {
      const std::string features = firstWord(device->path() / "features");
      if (firstWord(device->path() / "device") == "0x0005" && features.size() > PageReporting &&
          features[PageReporting] == '1')
      {
        return true;
      }
    }
  }
  catch (const std::exception&) // no memory for a path
  {
  }
  return false;
}
}
