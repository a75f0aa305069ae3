// SPDX-License-Identifier: BSD-3-Clause
#include "Properties.h"

#include "Arguments.h"
#include "Messages.h"
#include "NumberColumns.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <sstream>

namespace morph_mesh
{
namespace
{
/// Neither case nor "-", "_" and " " matter in a word.
std::string plain(const std::string& word)
{
  std::string result;
  for (const char c : word)
  {
    if (std::isalnum(static_cast<unsigned char>(c)))
    {
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return result;
}

/// How many letters have to be changed, added or left out.
std::size_t distance(const std::string& a, const std::string& b)
{
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j)
    {
      const std::size_t changed = diagonal + (a[i] != b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({ changed, row[j] + 1, row[j + 1] + 1 });
    }
  }
  return row.back();
}

std::string digits(const std::string& name)
{
  std::string result;
  std::copy_if(name.begin(), name.end(), std::back_inserter(result),
    [](unsigned char c) { return std::isdigit(c); });
  return result;
}

const Property& named(const std::string& name)
{
  return *std::find_if(properties().begin(), properties().end(),
    [&](const Property& one) { return one.name == name; });
}

double number(const Property& property, const std::string& text)
{
  const std::optional<double> value = decimal(text);
  const bool isWhole = property.kind == Property::Kind::Integer;
  if (!value || *value < property.least || *value > property.most ||
      (isWhole && *value != std::floor(*value)))
  {
    std::ostringstream message;
    message << property.option << " needs a " << (isWhole ? "whole number" : "number");
    if (std::abs(property.least) < 1e300 || std::abs(property.most) < 1e300)
    {
      message << " from " << property.least;
      if (property.most < 1e300)
      {
        message << " to " << property.most;
      }
    }
    throw UsageError(message.str() + ", not '" + text + "'.");
  }
  return *value;
}

/// "1,2,3"; "z,2" with the defaults for the others; "2" for all where the defaults are one number
/// that is not 0.
std::vector<double> numbers(const Property& property, const std::string& text)
{
  std::vector<std::string> parts;
  std::istringstream list(text + ","); // so that what is missing after a comma counts
  for (std::string part; std::getline(list, part, ',');)
  {
    parts.push_back(part);
  }
  const std::vector<double>& usual = property.defaults;
  if (parts.size() == 1 && usual[0] != 0 &&
      std::all_of(usual.begin(), usual.end(), [&](double one) { return one == usual[0]; }))
  {
    parts.resize(property.count, parts[0]);
  }
  const std::size_t axis = parts.empty() ? std::string::npos : std::string("xyz").find(parts[0]);
  if (parts.size() == 2 && property.count == 3 && parts[0].size() == 1 && axis < 3)
  {
    std::vector<double> values = usual;
    values[axis] = number(property, parts[1]);
    return values;
  }
  if (parts.size() != property.count)
  {
    throw UsageError(property.option + " needs " + valueName(property) + ", not '" + text + "'.");
  }
  std::vector<double> values;
  for (const std::string& part : parts)
  {
    values.push_back(number(property, part));
  }
  return values;
}

PropertyValue valueOf(const Property& property, const std::string& text)
{
  switch (property.kind)
  {
    case Property::Kind::Number:
    case Property::Kind::Integer:
      return { numbers(property, text), text };
    case Property::Kind::Flag:
      if (text != "" && text != "on" && text != "off")
      {
        throw UsageError(property.option + " is on or off, not '" + text + "'.");
      }
      return { { text == "off" ? 0. : 1. }, text };
    case Property::Kind::Choice:
    {
      const auto found = std::find_if(property.words.begin(), property.words.end(),
        [&](const std::string& word) { return plain(word) == plain(text); });
      if (found == property.words.end())
      {
        throw UsageError(property.option + " is one of " + wordsOf(property) + ", not '" + text +
                         "'." + didYouMean(text, property.words, 2));
      }
      return { { static_cast<double>(found - property.words.begin()) }, *found };
    }
    default:
      return { {}, text };
  }
}
}

std::string didYouMean(
  const std::string& name, const std::vector<std::string>& names, std::size_t most)
{
  const auto apart = [&](const std::string& other)
  {
    return digits(name) == digits(other)
             ? distance(vtksys::SystemTools::LowerCase(name), vtksys::SystemTools::LowerCase(other))
             : name.size() + other.size() + most;
  };
  const auto near = std::min_element(names.begin(), names.end(),
    [&](const std::string& a, const std::string& b) { return apart(a) < apart(b); });
  return near == names.end() || apart(*near) > most ? "" : " Did you mean " + *near + "?";
}

std::string wordsOf(const Property& property)
{
  std::string result;
  for (const std::string& word : property.words)
  {
    result += (result.empty() ? "" : ", ") + word;
  }
  return result;
}

std::string inOptions(const std::string& message)
{
  std::string text = message;
  for (const Property& property : properties())
  {
    const std::string name = "`" + property.name + "`";
    for (std::size_t at = text.find(name); !property.option.empty() && at != std::string::npos;
         at = text.find(name))
    {
      text.replace(at, name.size(), property.option);
    }
  }
  return text;
}

std::string valueName(const Property& property)
{
  switch (property.kind)
  {
    case Property::Kind::Flag:
      return "";
    case Property::Kind::Choice:
    {
      std::string words;
      if (property.words.size() > 6)
      {
        return "<name>"; // the help has them in a sentence
      }
      for (const std::string& word : property.words)
      {
        std::string one = word;
        std::replace(one.begin(), one.end(), ' ', '-');
        std::transform(one.begin(), one.end(), one.begin(),
          [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        words += (words.empty() ? "" : "|") + one;
      }
      return words;
    }
    case Property::Kind::Number:
    case Property::Kind::Integer:
      return property.count == 1   ? "<number>"
             : property.count == 3 ? "<x,y,z>"
                                   : "<xmin,xmax,ymin,ymax,zmin,zmax>";
    default:
      return "<name>";
  }
}

void GivenProperties::take(const Given& given)
{
  const Given* earlier = this->find(given.property->name);
  if (earlier && given.property->kind != Property::Kind::Names)
  {
    if (earlier->value.numbers != given.value.numbers || earlier->value.text != given.value.text)
    {
      const auto says = [](const Given& one)
      {
        return one.option + (one.isImplied ? " needs " + one.property->name + " " + one.value.text
                                           : " says '" + one.value.text + "'");
      };
      throw UsageError(says(*earlier) + ", and " + says(given) + ": remove one of them.");
    }
    return;
  }
  this->given_.push_back(given);
  for (const auto& [name, word] : given.property->implied)
  {
    this->imply(name, word, given.option);
  }
}

void GivenProperties::add(const Property& property, const std::string& text)
{
  this->take({ &property, valueOf(property, text), property.option, false });
}

void GivenProperties::imply(
  const std::string& name, const std::string& word, const std::string& option)
{
  const Property& property = named(name);
  const bool isFlag = property.kind == Property::Kind::Flag;
  this->take(
    { &property, valueOf(property, isFlag ? (word == "0" ? "off" : "on") : word), option, true });
}

const GivenProperties::Given* GivenProperties::find(const std::string& name) const
{
  const auto found = std::find_if(this->given_.begin(), this->given_.end(),
    [&](const Given& one) { return one.property->name == name; });
  return found == this->given_.end() ? nullptr : &*found;
}

bool GivenProperties::has(const std::string& name) const
{
  return this->find(name) != nullptr;
}

bool GivenProperties::spell(const std::vector<std::string>& listed)
{
  bool isChanged = false;
  for (Given& one : this->given_)
  {
    std::string& name = one.value.text;
    if (one.property->kind != Property::Kind::Names ||
        std::find(listed.begin(), listed.end(), name) != listed.end())
    {
      continue;
    }
    const auto isSame = [&](const std::string& other)
    { return vtksys::SystemTools::LowerCase(other) == vtksys::SystemTools::LowerCase(name); };
    const auto found = std::find_if(listed.begin(), listed.end(), isSame);
    // A set of the file is listed as a surface and as a zone.
    const auto isAnother = [&](const std::string& other)
    { return isSame(other) && other != *found; };
    if (found != listed.end() && std::none_of(found + 1, listed.end(), isAnother))
    {
      name = *found;
      isChanged = true;
    }
    const std::size_t most = std::min<std::size_t>(2, name.size() / 3);
    const std::string meant = found == listed.end() ? didYouMean(name, listed, most) : "";
    if (!meant.empty())
    {
      throw Failure(one.option + " names '" + name + "', which the mesh does not have." + meant);
    }
  }
  return isChanged;
}

std::string GivenProperties::text(const std::string& name) const
{
  const Given* found = this->find(name);
  return found ? found->value.text : std::string();
}

double GivenProperties::number(const std::string& name, double otherwise) const
{
  const Given* found = this->find(name);
  return found ? found->value.numbers.front() : otherwise;
}

bool GivenProperties::hasZero(const std::string& name) const
{
  const Given* given = this->find(name);
  return given && std::count(given->value.numbers.begin(), given->value.numbers.end(), 0.) > 0;
}

std::string GivenProperties::giver(const std::string& name) const
{
  return this->find(name)->option;
}

std::string GivenProperties::all() const
{
  std::string result;
  for (const Given& one : this->given_)
  {
    result += (one.isImplied ? "" : " " + one.option + "=" + one.value.text);
  }
  return result;
}

void GivenProperties::apply(
  const std::vector<vtkAlgorithm*>& filters, const std::string& without) const
{
  for (const Given& one : this->given_)
  {
    const bool isSet =
      one.property->name == "Method" ||
      std::any_of(filters.begin(), filters.end(),
        [&](vtkAlgorithm* filter) { return one.property->set(filter, one.value); });
    if (!isSet && !one.isImplied)
    {
      throw UsageError(one.option + " has no effect " + without + ": remove it.");
    }
  }
}
}
