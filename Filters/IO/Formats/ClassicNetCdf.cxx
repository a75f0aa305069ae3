// SPDX-License-Identifier: BSD-3-Clause
// The length that the header of a classic netCDF file asks for: "NetCDF Classic Format
// Specification" in the NetCDF User's Guide.
#include "Files/ReadFile.h"
#include "Formats/NetCdf.h"
#include "Support/Error.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

namespace morph::io
{
namespace
{
class Header
{
public:
  Header(const std::string& path, std::uint64_t fileSize)
    : path_(path)
    , fileSize_(fileSize)
    , bytes_(readHead(path, static_cast<std::size_t>(std::min<std::uint64_t>(fileSize, 1 << 16))))
  {
    this->version_ = static_cast<unsigned char>(this->bytes_[3]);
    this->at_ = 4;
  }

  /// One past the last byte of all variables.
  std::uint64_t end()
  {
    this->records_ = this->size();
    this->readDimensions();
    this->skipAttributes();
    std::uint64_t end = 0, record = 0, recordBegin = UINT64_MAX;
    const std::uint64_t count = this->list(11);
    for (std::uint64_t i = 0; i < count; ++i)
    {
      const Variable one = this->variable();
      if (one.isRecord)
      {
        record = this->added(record, one.size);
        recordBegin = std::min(recordBegin, one.begin);
      }
      else
      {
        end = std::max(end, this->added(one.begin, one.size));
      }
    }
    const std::uint64_t unknown = this->version_ == 5 ? UINT64_MAX : UINT32_MAX; // of a stream
    if (record > 0 && this->records_ != unknown && this->records_ > 0)
    {
      if (this->records_ > this->fileSize_ / record + 1)
      {
        this->fail();
      }
      end = std::max(end, this->added(recordBegin, record * this->records_));
    }
    return end;
  }

  [[noreturn]] void fail() const
  {
    throw Error("Cannot read " + this->path_ + ": it is damaged, or ends too soon.");
  }

private:
  struct Variable
  {
    std::uint64_t begin = 0, size = 0;
    bool isRecord = false;
  };

  std::uint64_t added(std::uint64_t a, std::uint64_t b) const
  {
    if (a > this->fileSize_ || b > this->fileSize_ - a)
    {
      this->fail();
    }
    return a + b;
  }

  std::uint64_t number(int bytes)
  {
    if (this->bytes_.size() - this->at_ < static_cast<std::size_t>(bytes))
    {
      if (this->bytes_.size() >= this->fileSize_)
      {
        this->fail();
      }
      this->bytes_ = readFile(this->path_); // a long header
      if (this->bytes_.size() - this->at_ < static_cast<std::size_t>(bytes))
      {
        this->fail();
      }
    }
    std::uint64_t value = 0;
    for (int i = 0; i < bytes; ++i)
    {
      value = value << 8 | static_cast<unsigned char>(this->bytes_[this->at_++]);
    }
    return value;
  }
  std::uint64_t size() { return this->number(this->version_ == 5 ? 8 : 4); }
  std::uint64_t offset() { return this->number(this->version_ == 1 ? 4 : 8); }

  void skip(std::uint64_t bytes)
  {
    if (bytes > this->fileSize_)
    {
      this->fail();
    }
    for (std::uint64_t i = 0; i < (bytes + 3) / 4; ++i)
    {
      this->number(4);
    }
  }
  void skipName() { this->skip(this->size()); }

  /// The length of a list with this tag, or 0 of an absent one.
  std::uint64_t list(std::uint64_t expectedTag)
  {
    const std::uint64_t tag = this->number(4), count = this->size();
    if ((tag != expectedTag && (tag != 0 || count != 0)) || count > this->fileSize_)
    {
      this->fail();
    }
    return count;
  }

  std::uint64_t bytesOf(std::uint64_t type) const
  {
    static constexpr std::array<std::uint64_t, 12> Bytes = { 0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8 };
    if (type == 0 || type >= Bytes.size())
    {
      this->fail();
    }
    return Bytes[type];
  }

  void readDimensions()
  {
    const std::uint64_t count = this->list(10);
    for (std::uint64_t i = 0; i < count; ++i)
    {
      this->skipName();
      this->dimensions_.push_back(this->size());
    }
  }

  void skipAttributes()
  {
    const std::uint64_t count = this->list(12);
    for (std::uint64_t i = 0; i < count; ++i)
    {
      this->skipName();
      const std::uint64_t bytes = this->bytesOf(this->number(4)), values = this->size();
      if (values > this->fileSize_)
      {
        this->fail();
      }
      this->skip(bytes * values);
    }
  }

  Variable variable()
  {
    Variable result;
    this->skipName();
    const std::uint64_t count = this->size();
    if (count > 1024)
    {
      this->fail();
    }
    std::vector<std::uint64_t> lengths;
    for (std::uint64_t i = 0; i < count; ++i)
    {
      const std::uint64_t dimension = this->size();
      if (dimension >= this->dimensions_.size())
      {
        this->fail();
      }
      lengths.push_back(this->dimensions_[static_cast<std::size_t>(dimension)]);
    }
    this->skipAttributes();
    result.size = this->bytesOf(this->number(4));
    result.isRecord = !lengths.empty() && lengths[0] == 0;
    for (std::size_t i = result.isRecord ? 1 : 0; i < lengths.size(); ++i)
    {
      if (lengths[i] > 0 && result.size > this->fileSize_ / lengths[i])
      {
        this->fail();
      }
      result.size *= lengths[i];
    }
    this->size(); // what the header says of it is less exact
    result.begin = this->offset();
    return result;
  }

  const std::string path_;
  const std::uint64_t fileSize_;
  std::string bytes_;
  std::size_t at_ = 0;
  int version_ = 1;
  std::uint64_t records_ = 0;
  std::vector<std::uint64_t> dimensions_;
};
}

bool isNetCdf(const std::string& path)
{
  const std::string head = readHead(path, 8);
  const bool isClassic = head.size() == 8 && head.compare(0, 3, "CDF") == 0 &&
                         (head[3] == 1 || head[3] == 2 || head[3] == 5);
  return isClassic || head == "\x89HDF\r\n\x1a\n";
}

void requireWholeClassicFile(const std::string& path)
{
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (error || readHead(path, 3) != "CDF" || size < 8)
  {
    return;
  }
  Header header(path, size);
  if (header.end() > size)
  {
    header.fail();
  }
}
}
