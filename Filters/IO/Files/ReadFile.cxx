// SPDX-License-Identifier: BSD-3-Clause
#include "Files/ReadFile.h"

#include "Support/Error.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace morph::io
{
namespace fs = std::filesystem;

std::string readFile(const std::string& path)
{
  std::error_code error;
  if (!fs::is_regular_file(path, error))
  {
    throw Error(
      "Cannot read " + path +
      (fs::exists(path, error) ? ": it is no regular file." : ": there is no such file."));
  }
  std::ifstream file(path, std::ios::binary);
  std::string content(static_cast<std::size_t>(fs::file_size(path, error)), '\0');
  if (error || !file.read(content.data(), static_cast<std::streamsize>(content.size())))
  {
    throw Error("Cannot read " + path + ": the system does not give its content.");
  }
  return content;
}

std::string readHead(const std::string& path, std::size_t most)
{
  std::error_code error;
  std::string content;
  if (fs::is_regular_file(path, error))
  {
    std::ifstream file(path, std::ios::binary);
    content.resize(most);
    file.read(content.data(), static_cast<std::streamsize>(most));
    content.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  }
  return content;
}

std::string extensionOf(const std::string& path)
{
  fs::path name = fs::path(path).filename();
  if (name.extension() == ".gz")
  {
    name = name.stem();
  }
  std::string result = name.extension().string();
  std::transform(result.begin(), result.end(), result.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}
}
