// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/FoamList.h"

#include "Files/Gzip.h"
#include "Files/ReadFile.h"
#include "Support/Error.h"
#include "Text/NumberText.h"
#include "Text/Printable.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>

namespace morph::io
{
namespace
{
template <typename Value>
Value valueAt(const char* bytes)
{
  Value value;
  std::memcpy(&value, bytes, sizeof(Value));
  return value;
}
}

FoamBlocks::FoamBlocks(const std::string& path)
  : path(path)
{
  std::error_code error;
  if (!std::filesystem::exists(path, error) && std::filesystem::exists(path + ".gz", error))
  {
    this->path += ".gz";
  }
  this->content = readFile(this->path);
  if (this->content.rfind("\x1f\x8b", 0) == 0)
  {
    this->content = gunzip(this->content, this->path);
  }
  const std::string_view text(this->content);
  const std::size_t kind = text.find("decomposedBlockData");
  std::size_t at = text.find('}');
  if (kind == std::string_view::npos || kind > at)
  {
    return;
  }
  // "// Processor0", its length, and its bytes in parentheses; after the last only comments.
  const auto fail = [&]
  {
    throw Error("Cannot read " + printable(this->path) + ": its block " +
                std::to_string(this->blocks.size()) + " is damaged, or ends too soon.");
  };
  for (++at; (at = text.find("// Processor", at)) != std::string_view::npos;)
  {
    at = std::min(text.find('\n', at), text.size());
    at = std::min(text.find_first_not_of(" \t\r\n", at), text.size());
    Span length{ at, std::min(text.find_first_not_of("0123456789", at), text.size()) };
    const auto size = parseInteger(length.of(text));
    const std::size_t begin = text.find('(', length.end);
    if (!size || *size < 0 || begin == std::string_view::npos ||
        static_cast<std::size_t>(*size) >= text.size() - begin - 1 ||
        text[begin + 1 + static_cast<std::size_t>(*size)] != ')')
    {
      fail();
    }
    at = begin + 1 + static_cast<std::size_t>(*size);
    this->lengths.push_back(length);
    this->blocks.push_back({ begin + 1, at });
  }
  if (this->blocks.empty())
  {
    fail();
  }
}

std::string FoamBlocks::with(const std::vector<std::string>& others) const
{
  std::string result;
  std::size_t at = 0;
  for (std::size_t i = 0; i < this->blocks.size(); ++i)
  {
    const Span &length = this->lengths[i], &block = this->blocks[i];
    result += this->content.substr(at, length.begin - at) + std::to_string(others[i].size()) +
              this->content.substr(length.end, block.begin - length.end) + others[i];
    at = block.end;
  }
  return result + this->content.substr(at);
}

FoamList::FoamList(const std::string& path)
{
  FoamBlocks file(path);
  this->path_ = std::move(file.path);
  this->content_ = std::move(file.content);
  this->readHeader();
  if (!file.blocks.empty())
  {
    this->fail("it holds the pieces of a decomposed case. Give the case.");
  }
}

std::vector<FoamList> FoamList::all(const std::string& path)
{
  FoamBlocks file(path);
  std::vector<FoamList> lists;
  const auto add = [&](std::string name, std::string content)
  {
    // The first block has the header of all.
    FoamList list = lists.empty() ? FoamList() : lists.front();
    list.path_ = std::move(name);
    list.content_ = std::move(content);
    list.at_ = 0;
    if (lists.empty())
    {
      list.readHeader();
    }
    lists.push_back(std::move(list));
  };
  for (std::size_t i = 0; i < file.blocks.size(); ++i)
  {
    add(file.path + ", block " + std::to_string(i), std::string(file.blocks[i].of(file.content)));
  }
  if (lists.empty())
  {
    add(file.path, std::move(file.content));
  }
  return lists;
}

void FoamList::fail(const std::string& reason) const
{
  throw Error(printable("Cannot read " + this->path_ + ": " + reason));
}

void FoamList::skipBlanks()
{
  const std::string& text = this->content_;
  while (this->at_ < text.size())
  {
    if (std::strchr(" \t\r\n", text[this->at_]) && text[this->at_] != '\0')
    {
      ++this->at_;
    }
    else if (text.compare(this->at_, 2, "//") == 0)
    {
      this->at_ = std::min(text.find('\n', this->at_), text.size());
    }
    else if (text.compare(this->at_, 2, "/*") == 0)
    {
      const std::size_t end = text.find("*/", this->at_ + 2);
      this->at_ = end == std::string::npos ? text.size() : end + 2;
    }
    else
    {
      return;
    }
  }
}

char FoamList::peek()
{
  this->skipBlanks();
  if (this->at_ >= this->content_.size())
  {
    this->fail("it ends too soon.");
  }
  return this->content_[this->at_];
}

void FoamList::expect(char character)
{
  if (this->peek() != character)
  {
    this->fail(
      std::string("a '") + character + "' is missing at byte " + std::to_string(this->at_) + ".");
  }
  ++this->at_;
}

Span FoamList::word()
{
  this->peek();
  Span span{ this->at_, this->at_ };
  const std::size_t end = this->content_.find_first_of(" \t\r\n(){};", this->at_);
  span.end = std::min(end, this->content_.size());
  this->at_ = span.end;
  return span;
}

Index FoamList::integer()
{
  const Span span = this->word();
  const auto value = parseInteger(span.of(this->content_));
  if (!value)
  {
    this->fail("a whole number is missing at byte " + std::to_string(span.begin) + ".");
  }
  return *value;
}

Index FoamList::count(std::size_t leastBytes)
{
  const Index value = this->integer();
  const std::size_t left = this->content_.size() - this->at_;
  if (value < 0 || static_cast<std::size_t>(value) > left / leastBytes)
  {
    this->fail("it names " + std::to_string(value) + " entries, for which it is too short.");
  }
  if (this->peek() == '{')
  {
    this->fail("it has a list in the form 'N{value}', which is not supported.");
  }
  return value;
}

const char* FoamList::bytes(std::size_t size)
{
  if (this->content_.size() - this->at_ < size)
  {
    this->fail("it ends too soon.");
  }
  const char* result = this->content_.data() + this->at_;
  this->at_ += size;
  return result;
}

void FoamList::readHeader()
{
  const Span name = this->word();
  if (name.of(this->content_) != "FoamFile")
  {
    this->fail("it has no header FoamFile.");
  }
  this->expect('{');
  std::map<std::string, std::string> entries;
  while (this->peek() != '}')
  {
    const std::string key(this->word().of(this->content_));
    this->skipBlanks();
    // A value may be quoted, and hold semicolons.
    bool isQuoted = false;
    std::string value;
    for (; this->at_ < this->content_.size(); ++this->at_)
    {
      const char c = this->content_[this->at_];
      isQuoted = c == '"' ? !isQuoted : isQuoted;
      if (c == ';' && !isQuoted)
      {
        break;
      }
      value += c == '"' ? std::string() : std::string(1, c);
    }
    this->expect(';');
    entries[key] = trimmed(value);
  }
  this->expect('}');
  this->type_ = entries["class"];
  this->isBinary_ = entries["format"] == "binary";
  const std::string& arch = entries["arch"];
  this->bytesOfLabel_ = arch.find("label=64") != std::string::npos ? 8 : 4;
  this->bytesOfScalar_ = arch.find("scalar=32") != std::string::npos ? 4 : 8;
  if (this->isBinary_ && arch.find("MSB") != std::string::npos)
  {
    this->fail("it is binary, and of a processor with another order of bytes (MSB).");
  }
}

std::vector<Index> FoamList::labels()
{
  std::vector<Index> result(
    static_cast<std::size_t>(this->count(this->isBinary_ ? this->bytesOfLabel_ : 2)));
  if (result.empty() && this->peek() != '(')
  {
    return result; // as binary files have it
  }
  this->expect('(');
  if (!this->isBinary_)
  {
    std::generate(result.begin(), result.end(), [&] { return this->integer(); });
  }
  else
  {
    const char* from = this->bytes(result.size() * this->bytesOfLabel_);
    for (Index& label : result)
    {
      label = this->bytesOfLabel_ == 8 ? valueAt<std::int64_t>(from) : valueAt<std::int32_t>(from);
      from += this->bytesOfLabel_;
    }
  }
  this->expect(')');
  return result;
}

/// Adds "(x y z)".
void FoamList::vector(const std::string& what, Vectors& to)
{
  this->expect('(');
  for (int j = 0; j < 3; ++j)
  {
    to.places.push_back(this->word());
    const std::string_view text = to.places.back().of(this->content_);
    const auto value = parseNumber(text);
    if (!value)
    {
      this->fail(what + " has the coordinate '" + std::string(text.substr(0, 40)) +
                 "', which is no number.");
    }
    to.values.push_back(*value);
  }
  this->expect(')');
}

FoamList::Vectors FoamList::vectors()
{
  Vectors result;
  const std::size_t size = 3 * this->bytesOfScalar_;
  const auto vectors = static_cast<std::size_t>(this->count(this->isBinary_ ? size : 7));
  result.values.reserve(3 * vectors);
  this->expect('(');
  result.first = this->at_;
  if (this->isBinary_)
  {
    const char* from = this->bytes(vectors * size);
    for (std::size_t i = 0; i < 3 * vectors; ++i, from += this->bytesOfScalar_)
    {
      result.values.push_back(
        this->bytesOfScalar_ == 4 ? valueAt<float>(from) : valueAt<double>(from));
    }
  }
  for (std::size_t i = 0; !this->isBinary_ && i < vectors; ++i)
  {
    this->vector("point " + std::to_string(i), result);
  }
  this->expect(')');
  return result;
}

std::vector<std::vector<Index>> FoamList::faces()
{
  std::vector<std::vector<Index>> result;
  if (!this->isBinary_)
  {
    result.resize(static_cast<std::size_t>(this->count(4)));
    this->expect('(');
    for (std::vector<Index>& face : result)
    {
      face = this->labels();
    }
    this->expect(')');
    return result;
  }
  if (this->type_ != "faceCompactList")
  {
    this->fail("its class is " + this->type_ + ", where faceCompactList is read of binary files.");
  }
  const std::vector<Index> offsets = this->labels();
  const std::vector<Index> all = this->labels();
  for (std::size_t f = 0; f + 1 < offsets.size(); ++f)
  {
    if (offsets[f] < 0 || offsets[f] > offsets[f + 1] ||
        offsets[f + 1] > static_cast<Index>(all.size()))
    {
      this->fail("the offsets of face " + std::to_string(f) + " are out of range.");
    }
    result.emplace_back(all.begin() + offsets[f], all.begin() + offsets[f + 1]);
  }
  return result;
}

/// A name that may be quoted, as patterns of names are.
std::string FoamList::name(bool& isQuoted)
{
  isQuoted = this->peek() == '"';
  if (!isQuoted)
  {
    return std::string(this->word().of(this->content_));
  }
  const std::size_t begin = this->at_ + 1;
  const std::size_t end = this->content_.find('"', begin);
  if (end == std::string::npos)
  {
    this->fail("a quotation mark is missing after byte " + std::to_string(begin) + ".");
  }
  this->at_ = end + 1;
  return this->content_.substr(begin, end - begin);
}

/// To behind the ';' of an entry, or the '}' of a dictionary.
void FoamList::skipEntry()
{
  for (int depth = 0;;)
  {
    const char c = this->peek();
    if (c == '"' || !std::strchr("(){};", c))
    {
      bool isQuoted = false;
      this->name(isQuoted);
      continue;
    }
    ++this->at_;
    depth += c == '(' || c == '{' ? 1 : c == ';' ? 0 : -1;
    if (depth < 0)
    {
      this->fail("a ';' is missing at byte " + std::to_string(this->at_) + ".");
    }
    if (depth == 0 && (c == ';' || c == '}'))
    {
      return;
    }
  }
}

template <typename Take>
void FoamList::readDictionary(Take take)
{
  this->expect('{');
  while (this->peek() != '}')
  {
    bool isQuoted = false;
    const std::string key = this->name(isQuoted);
    if (key.empty())
    {
      this->fail("a name is missing at byte " + std::to_string(this->at_) + ".");
    }
    if (!take(key, isQuoted))
    {
      this->skipEntry();
    }
  }
  this->expect('}');
}

template <typename Entry, typename Take>
std::vector<Entry> FoamList::namedEntries(Take take)
{
  std::vector<Entry> result(static_cast<std::size_t>(this->count(4)));
  this->expect('(');
  for (Entry& entry : result)
  {
    entry.name = std::string(this->word().of(this->content_));
    this->readDictionary([&](const std::string& key, bool) { return take(entry, key); });
  }
  return result;
}

std::vector<FoamList::Patch> FoamList::patches()
{
  return this->namedEntries<Patch>(
    [this](Patch& patch, const std::string& key)
    {
      std::string* text = key == "type"             ? &patch.type
                          : key == "neighbourPatch" ? &patch.neighbour
                          : key == "referPatch"     ? &patch.cyclic
                                                    : nullptr;
      if (text)
      {
        *text = std::string(this->word().of(this->content_));
      }
      else if (key == "nFaces" || key == "startFace")
      {
        (key == "nFaces" ? patch.count : patch.first) = this->integer();
      }
      else
      {
        return false;
      }
      this->expect(';');
      return true;
    });
}

/// "List<label>" before a list.
void FoamList::skipListType()
{
  this->skipBlanks();
  if (this->content_.compare(this->at_, 5, "List<") == 0)
  {
    this->word();
  }
}

/// "flipMap List<bool> 3(0 1 0);", "3{0};" or, of a binary file, bytes or "0;".
void FoamList::skipFlips()
{
  this->skipListType();
  const auto flips = static_cast<std::size_t>(std::max<Index>(this->integer(), 0));
  const bool areAlike = this->peek() == '{';
  if (flips > 0 && (areAlike || this->isBinary_))
  {
    ++this->at_;
    this->bytes(areAlike ? 1 : flips);
    this->expect(areAlike ? '}' : ')');
  }
  this->skipEntry();
}

std::vector<FoamList::Zone> FoamList::zones()
{
  return this->namedEntries<Zone>(
    [this](Zone& zone, const std::string& key)
    {
      if (key == "flipMap")
      {
        this->skipFlips();
        return true;
      }
      if (key != "cellLabels" && key != "faceLabels" && key != "pointLabels")
      {
        return false;
      }
      this->skipListType();
      zone.members = this->labels();
      this->expect(';');
      return true;
    });
}

/// "uniform (x y z);" or "nonuniform List<vector> N(...);"
std::vector<double> FoamList::fieldValues(bool& isUniform)
{
  Vectors found;
  const std::string_view kind = this->word().of(this->content_);
  isUniform = kind == "uniform";
  if (isUniform)
  {
    this->vector("a patch", found);
  }
  else if (kind == "nonuniform")
  {
    this->skipListType();
    found = this->vectors();
  }
  else
  {
    this->fail("a value is '" + std::string(kind.substr(0, 40)) +
               "', where 'uniform' or 'nonuniform' is read.");
  }
  this->expect(';');
  return found.values;
}

std::vector<FoamList::PatchVectors> FoamList::boundaryField()
{
  std::vector<PatchVectors> result;
  const auto takePatch = [&](const std::string& name, bool isQuoted)
  {
    PatchVectors patch{ name, isQuoted, "", false, {} };
    this->readDictionary(
      [&](const std::string& key, bool)
      {
        if (key == "value")
        {
          patch.values = this->fieldValues(patch.isUniform);
        }
        else if (key == "type")
        {
          patch.type = std::string(this->word().of(this->content_));
          this->expect(';');
        }
        return key == "value" || key == "type";
      });
    result.push_back(std::move(patch));
    return true;
  };
  for (this->skipBlanks(); this->at_ < this->content_.size(); this->skipBlanks())
  {
    const std::string_view key = this->word().of(this->content_);
    const std::size_t begin = this->at_;
    if (key == "boundaryField")
    {
      this->readDictionary(takePatch);
    }
    else if (key == "internalField") // which may be binary
    {
      bool isUniform = false;
      this->fieldValues(isUniform);
    }
    else
    {
      this->skipEntry();
    }
    if (key == "dimensions")
    {
      const std::string_view text(this->content_);
      this->dimensions_ = trimmed(text.substr(begin, this->at_ - begin - 1));
    }
  }
  return result;
}
}
