// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/TextFile.h"

#include "Files/ReadFile.h"
#include "Support/Error.h"
#include "Text/NumberText.h"
#include "Text/Printable.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace morph::io
{
namespace fs = std::filesystem;

namespace
{
constexpr std::size_t MostIncludes = 1000;

bool isSameFile(const std::string& a, const std::string& b)
{
  std::error_code error;
  return fs::equivalent(a, b, error);
}
}

std::size_t TextFile::addPart(const std::string& path, const std::string& name)
{
  if (this->parts_.size() > MostIncludes)
  {
    throw Error(printable("Cannot read " + this->parts_.front().path + ": it includes more than " +
                          std::to_string(MostIncludes) + " files. Join them."));
  }
  this->parts_.push_back({ path, name, readFile(path) });
  return this->parts_.size() - 1;
}

std::string TextFile::where(std::size_t part, std::size_t at) const
{
  const std::string& text = this->parts_[part].text;
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(at, text.size()));
  return this->parts_[part].path + ", line " +
         std::to_string(1 + std::count(text.begin(), end, '\n'));
}

void TextFile::failAt(std::size_t part, std::size_t at, const std::string& reason) const
{
  throw Error(printable("Cannot read " + this->where(part, at) + ": " + reason));
}

double TextFile::numberAt(std::size_t part, Span span) const
{
  const std::string_view text = span.of(this->parts_[part].text);
  const auto value = parseNumber(text);
  if (!value)
  {
    this->failAt(part, span.begin, "'" + std::string(text.substr(0, 40)) + "' is no number.");
  }
  return *value;
}

long long TextFile::integerAt(std::size_t part, Span span) const
{
  const std::string_view text = span.of(this->parts_[part].text);
  const auto value = parseInteger(text);
  if (!value)
  {
    this->failAt(part, span.begin, "'" + std::string(text.substr(0, 40)) + "' is no whole number.");
  }
  return *value;
}

std::vector<NewFile> TextFile::withCoordinates(
  const std::vector<double>& coordinates, const std::string& out, double& largestRounding) const
{
  std::vector<std::vector<NumberChange>> changes(this->parts_.size());
  for (std::size_t node = 0; node < this->places_.size(); ++node)
  {
    const NodePlace& place = this->places_[node];
    for (std::size_t j = 0; j < 3; ++j)
    {
      const auto changesAt = [&](std::size_t k)
      { return coordinates[3 * node + k] != this->mesh().coordinates[3 * node + k]; };
      // Where a line ends too soon, what is written there needs what comes before.
      const auto isShort = [&](std::size_t k)
      { return place.numbers[k].missing > 0 || place.numbers[k].length < place.rules.width; };
      bool isNeeded = changesAt(j);
      for (std::size_t k = j + 1; k < 3 && isShort(j); ++k)
      {
        isNeeded = isNeeded || (isShort(k) && changesAt(k));
      }
      if (isNeeded)
      {
        const double value = coordinates[3 * node + j];
        changes[place.part].push_back({ place.numbers[j], value, place.rules });
      }
    }
  }
  // In place, with its nodes in an included file alone, the file itself stays as it is.
  const bool inPlace = isSameFile(out, this->path());
  std::vector<NewFile> files;
  for (std::size_t part = this->parts_.size(); part-- > 0;)
  {
    const Part& one = this->parts_[part];
    std::stable_sort(changes[part].begin(), changes[part].end(),
      [](const NumberChange& a, const NumberChange& b) { return a.place.begin < b.place.begin; });
    if (inPlace && changes[part].empty())
    {
      continue;
    }
    const fs::path name = one.name;
    std::string path = out;
    if (!one.name.empty() && inPlace)
    {
      path = one.path;
    }
    else if (!one.name.empty() && name.is_absolute())
    {
      if (changes[part].empty())
      {
        continue;
      }
      throw Error("Cannot write " + out + ": nodes are in " + one.path +
                  ", which the file includes by its absolute path. Include it by a relative path.");
    }
    else if (!one.name.empty())
    {
      path = (fs::path(out).parent_path() / name).string();
      if (isSameFile(path, one.path))
      {
        if (changes[part].empty())
        {
          continue;
        }
        throw Error("Cannot write " + out + ": nodes are in " + one.path +
                    ", which would be overwritten. Give an output in another folder.");
      }
    }
    files.push_back({ path, withNumbers(one.text, changes[part], largestRounding) });
    files.back().makeFolder = !one.name.empty();
  }
  if (inPlace && files.size() > 1)
  {
    throw Error("Cannot write " + out +
                ": the nodes are in several files, of which each could be "
                "written without the others. Give an output in another folder.");
  }
  return files;
}

NumberPlace placeOf(Span span)
{
  NumberPlace place;
  place.begin = span.begin;
  place.length = static_cast<std::uint32_t>(span.size());
  return place;
}
}
