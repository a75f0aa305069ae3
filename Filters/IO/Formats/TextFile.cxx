// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/TextFile.h"

#include "Files/ReadFile.h"
#include "Support/Error.h"
#include "Text/NumberText.h"
#include "Text/Printable.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
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
  const std::string& text = this->parts_.back().text;
  if (text.find('\n') == std::string::npos && text.find('\r') != std::string::npos)
  {
    throw Error(printable("Cannot read " + path + ": its lines end with carriage returns alone. " +
                          "Convert them to line feeds."));
  }
  return this->parts_.size() - 1;
}

std::size_t TextFile::addIncluded(std::size_t part, const std::string& name)
{
  const fs::path root = fs::path(this->path()).parent_path();
  fs::path first = fs::path(this->parts_[part].name).parent_path() / name, second = name;
  if (second.has_parent_path())
  {
    std::swap(first, second);
  }
  std::error_code error;
  const bool isSecond = fs::exists(root / second, error);
  if (isSecond && !fs::exists(root / first, error))
  {
    std::swap(first, second);
  }
  else if (isSecond && !fs::equivalent(root / first, root / second, error))
  {
    this->mesh_.warnings.push_back("The included file '" + name + "' is " + first.string() +
                                   ", and not " + second.string() + ", which is there, too.");
  }
  return this->addPart((root / first).string(), first.string());
}

TextFile::NodePlace TextFile::nodePlace(std::size_t part, const NumberField* fields,
  const NumberRules& rules, std::array<double, 3>& coordinates, bool isSplit) const
{
  NodePlace place;
  place.part = part;
  place.rules = rules;
  for (std::size_t j = 0; j < 3; ++j)
  {
    const NumberField& field = fields[j];
    place.numbers[j] = field.place;
    // A coordinate that its line ends in is written in full before the next one.
    const bool hasNewLine = isSplit && j == 2;
    if (field.width > 0 && j > 0 && !hasNewLine && fields[j - 1].place.length < field.width)
    {
      place.numbers[j].missing = 0;
    }
    coordinates[j] = field.span.size() == 0 ? 0 : this->numberAt(part, field.span);
  }
  return place;
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

std::deque<CoordinateFrame> TextFile::framesAt(const std::vector<double>&) const
{
  return this->frames_;
}

std::vector<double> TextFile::atPlaces(const std::vector<double>& coordinates,
  const std::string& out, std::vector<std::uint8_t>& isKept, double& largestRounding) const
{
  const std::vector<double>& old = this->mesh().coordinates;
  std::vector<double> result = coordinates;
  isKept.resize(result.size());
  std::transform(result.begin(), result.end(), old.begin(), isKept.begin(), std::equal_to<>());
  double size = 0;
  for (const double x : old)
  {
    size = std::max(size, std::abs(x));
  }
  const double rounding = 16 * std::numeric_limits<double>::epsilon() * size;
  const std::deque<CoordinateFrame> frames = this->framesAt(coordinates);
  std::map<std::pair<std::size_t, std::uint64_t>, std::size_t> moved; // by place
  std::vector<Index> apart;
  for (std::size_t node = 0; node < this->places_.size(); ++node)
  {
    const NodePlace& place = this->places_[node];
    std::uint8_t* kept = isKept.data() + 3 * node;
    const CoordinateFrame& frame = frames[place.frame];
    const bool isStill = kept[0] && kept[1] && kept[2] && frame == this->frames_[place.frame];
    if (isStill || (place.frame == 0 && !this->sharesPlaces_))
    {
      continue;
    }
    const Eigen::Map<const Eigen::Vector3d> basic(coordinates.data() + 3 * node);
    Eigen::Map<Eigen::Vector3d> local(result.data() + 3 * node);
    Eigen::Vector3d before;
    for (int j = 0; j < 3; ++j)
    {
      const NumberPlace& number = place.numbers[static_cast<std::size_t>(j)];
      const std::string_view text = this->parts_[place.part].text;
      before[j] = parseNumber(trimmed(text.substr(number.begin, number.length))).value_or(0);
    }
    local = frame.fromBasic(basic, before, rounding);
    for (int j = 0; j < 3; ++j)
    {
      kept[j] = local[j] == before[j];
    }
    const auto [other, isFirst] =
      moved.emplace(std::pair{ place.part, place.numbers[0].begin }, node);
    if (!this->sharesPlaces_ || isFirst)
    {
      continue;
    }
    std::fill(kept, kept + 3, std::uint8_t(1));
    const Eigen::Map<const Eigen::Vector3d> written(result.data() + 3 * other->second);
    const double difference = (frame.toBasic(written) - basic).norm();
    largestRounding = std::max(largestRounding, difference);
    if (!(difference <= 1e-6 * size))
    {
      apart.push_back(this->mesh().nodeNumbers[node]);
    }
  }
  if (!apart.empty())
  {
    throw Error("Cannot write " + out + ": instances of one part move differently at the nodes " +
                listIds(apart) +
                ". The file has the nodes of the part once. Move them alike, or give each "
                "instance a part of its own.");
  }
  return result;
}

std::vector<NewFile> TextFile::withCoordinates(
  const std::vector<double>& coordinates, const std::string& out, double& largestRounding) const
{
  std::vector<std::uint8_t> isKept;
  const std::vector<double> values = this->atPlaces(coordinates, out, isKept, largestRounding);
  std::vector<std::vector<NumberChange>> changes(this->parts_.size());
  for (std::size_t node = 0; node < this->places_.size(); ++node)
  {
    const NodePlace& place = this->places_[node];
    for (std::size_t j = 0; j < 3; ++j)
    {
      const auto changesAt = [&](std::size_t k) { return !isKept[3 * node + k]; };
      // Where a line ends too soon, what is written there needs what comes before.
      const auto isShort = [&](std::size_t k)
      {
        const NumberPlace& number = place.numbers[k];
        const bool hasTab = number.length > 0 &&
                            this->parts_[place.part].text[number.begin + number.length - 1] == '\t';
        return number.missing > 0 || (number.length < place.rules.width && !hasTab);
      };
      bool isNeeded = changesAt(j);
      for (std::size_t k = j + 1; k < 3 && isShort(j); ++k)
      {
        isNeeded = isNeeded || (isShort(k) && changesAt(k));
      }
      if (isNeeded)
      {
        const double value = values[3 * node + j];
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
