// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/GmshSections.h"

#include "Support/Error.h"
#include "Text/NumberText.h"
#include "Text/Printable.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace morph::io
{
namespace
{
bool isBlank(char c)
{
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}
}

GmshCursor::GmshCursor(const std::string& content, const std::string& path, std::size_t at,
  std::size_t end, bool isBinary)
  : content_(content)
  , path_(path)
  , at_(at)
  , end_(end)
  , isBinary_(isBinary)
{
}

void GmshCursor::fail(const std::string& reason) const
{
  const auto end = this->content_.begin() +
                   static_cast<std::ptrdiff_t>(std::min(this->at_, this->content_.size()));
  const std::string where =
    this->isBinary_ ? ", byte " + std::to_string(this->at_)
                    : ", line " + std::to_string(1 + std::count(this->content_.begin(), end, '\n'));
  throw Error(printable("Cannot read " + this->path_ + where + ": " + reason));
}

std::string_view GmshCursor::word()
{
  while (this->at_ < this->end_ && isBlank(this->content_[this->at_]))
  {
    ++this->at_;
  }
  std::size_t end = this->at_;
  while (end < this->end_ && !isBlank(this->content_[end]))
  {
    ++end;
  }
  if (end == this->at_)
  {
    this->fail("the section ends where a number should follow.");
  }
  this->place_ = { this->at_, end };
  return this->place_.of(this->content_);
}

Index GmshCursor::whole(std::size_t bytes)
{
  if (!this->isBinary_)
  {
    const std::string_view text = this->word();
    const auto value = parseInteger(text);
    if (!value)
    {
      this->fail("'" + std::string(text.substr(0, 40)) + "' is no whole number.");
    }
    this->at_ = this->place_.end;
    return *value;
  }
  if (this->end_ - this->at_ < bytes)
  {
    this->fail("the section ends where a number should follow.");
  }
  std::int32_t small = 0;
  std::int64_t large = 0;
  std::memcpy(
    bytes == 4 ? static_cast<void*>(&small) : &large, this->content_.data() + this->at_, bytes);
  this->at_ += bytes;
  return bytes == 4 ? small : large;
}

Index GmshCursor::integer()
{
  return this->whole(4);
}

Index GmshCursor::size()
{
  return this->whole(8);
}

double GmshCursor::number()
{
  if (!this->isBinary_)
  {
    const std::string_view text = this->word();
    const auto value = parseNumber(text);
    if (!value)
    {
      this->fail("'" + std::string(text.substr(0, 40)) + "' is no number.");
    }
    this->at_ = this->place_.end;
    return *value;
  }
  if (this->end_ - this->at_ < sizeof(double))
  {
    this->fail("the section ends where a number should follow.");
  }
  double value = 0;
  std::memcpy(&value, this->content_.data() + this->at_, sizeof(double));
  if (!std::isfinite(value))
  {
    this->fail("a number is not finite.");
  }
  this->place_ = { this->at_, this->at_ + sizeof(double) };
  this->at_ += sizeof(double);
  return value;
}

Index GmshCursor::count(bool isSize, std::size_t leastBytes)
{
  const Index value = isSize ? this->size() : this->integer();
  const std::size_t bytes = this->isBinary_ ? leastBytes : 2;
  if (value < 0 || static_cast<std::size_t>(value) > (this->end_ - this->at_ + 1) / bytes)
  {
    this->fail("the number " + std::to_string(value) + " is out of range.");
  }
  return value;
}

std::string GmshCursor::quoted()
{
  const std::size_t begin = this->content_.find('"', this->at_);
  const std::size_t end =
    begin < this->end_ ? this->content_.find('"', begin + 1) : std::string::npos;
  if (end >= this->end_)
  {
    this->fail("a name in quotes is missing.");
  }
  this->at_ = end + 1;
  return this->content_.substr(begin + 1, end - begin - 1);
}

void GmshCursor::toNextLine()
{
  const std::size_t line = this->content_.find('\n', this->at_);
  this->at_ = line < this->end_ ? line + 1 : this->end_;
}

GmshSections::GmshSections(const std::string& content, const std::string& path)
  : content_(content)
  , path_(path)
{
  if (content.rfind("$NOD", 0) == 0)
  {
    throw Error("Cannot read " + path +
                ": its version 1 is not supported. Let Gmsh write version 4.1 or 2.2.");
  }
  std::size_t at = 0;
  while (at < content.size())
  {
    const std::size_t line = std::min(content.find('\n', at), content.size());
    if (content[at] == '$')
    {
      std::string name = content.substr(at + 1, std::min<std::size_t>(line - at - 1, 100));
      name.resize(std::min(name.find_first_of(" \t\r"), name.size()));
      const std::size_t end = content.find("$End" + name, line);
      if (name.empty() || end == std::string::npos)
      {
        throw Error(printable("Cannot read " + path + ": the section $" + name.substr(0, 40) +
                              " has no end: the file is damaged, or ends too soon."));
      }
      this->sections_.push_back({ name, std::min(line + 1, end), end });
      at = std::min(content.find('\n', end), content.size()) + 1;
      continue;
    }
    at = line + 1; // what is outside of sections has no meaning
  }
  this->readFormat();
}

void GmshSections::readFormat()
{
  const Section* format = this->find("MeshFormat");
  if (!format)
  {
    throw Error("Cannot read " + this->path_ + ": it has no section $MeshFormat.");
  }
  GmshCursor cursor(this->content_, this->path_, format->begin, format->end, false);
  const double version = cursor.number();
  this->isVersion4 = version == 4.1;
  if (!this->isVersion4 && (version < 2 || version >= 3))
  {
    cursor.fail("its version " + std::string(cursor.place().of(this->content_)) +
                " is not supported. Let Gmsh write version 4.1 or 2.2.");
  }
  this->isBinary = cursor.integer() != 0;
  if (cursor.integer() != 8)
  {
    cursor.fail("its numbers do not have 8 bytes.");
  }
  if (this->isBinary)
  {
    cursor.toNextLine();
    GmshCursor one(this->content_, this->path_, cursor.at(), format->end, true);
    if (one.integer() != 1)
    {
      one.fail("its bytes have another order than on this machine.");
    }
  }
}

const GmshSections::Section* GmshSections::find(const std::string& name) const
{
  const Section* result = nullptr;
  for (const Section& section : this->sections_)
  {
    if (section.name == name && result)
    {
      throw Error(
        printable("Cannot read " + this->path_ + ": it has the section $" + name + " twice."));
    }
    result = section.name == name ? &section : result;
  }
  return result;
}

GmshCursor GmshSections::cursor(const Section& section) const
{
  return GmshCursor(this->content_, this->path_, section.begin, section.end, this->isBinary);
}

GmshCursor GmshSections::listCursor(
  const Section& section, std::size_t leastBytes, Index& count) const
{
  GmshCursor text(this->content_, this->path_, section.begin, section.end, false);
  count = text.integer();
  if (!this->isBinary)
  {
    leastBytes = 2;
  }
  else
  {
    text.toNextLine();
  }
  if (count < 0 || static_cast<std::size_t>(count) > (section.end - text.at()) / leastBytes)
  {
    text.fail("the number " + std::to_string(count) + " is out of range.");
  }
  return GmshCursor(this->content_, this->path_, text.at(), section.end, this->isBinary);
}
}
