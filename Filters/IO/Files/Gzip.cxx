// SPDX-License-Identifier: BSD-3-Clause
#include "Files/Gzip.h"

#include "Support/Error.h"

#ifdef MESHMORPHING_HAS_ZLIB
#include <zlib.h>
#endif

#include <algorithm>
#include <limits>
#include <vector>

namespace morph::io
{
#ifdef MESHMORPHING_HAS_ZLIB
namespace
{
constexpr int GzipWindow = 15 + 16; // zlib's flag for gzip's header
constexpr std::size_t Step = 1 << 20;

/// Gives the stream the next part of its input, and moves what it made to `result`.
template <typename Work>
int feed(z_stream& stream, const std::string& input, std::size_t& at, std::string& result,
  std::vector<unsigned char>& buffer, Work work)
{
  if (stream.avail_in == 0)
  {
    const std::size_t size = std::min(input.size() - at, Step);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(input.data() + at));
    stream.avail_in = static_cast<uInt>(size);
    at += size;
  }
  stream.next_out = buffer.data();
  stream.avail_out = static_cast<uInt>(buffer.size());
  const int status = work(at == input.size() ? Z_FINISH : Z_NO_FLUSH);
  result.append(reinterpret_cast<char*>(buffer.data()), buffer.size() - stream.avail_out);
  return status;
}
}

std::string gunzip(const std::string& packed, const std::string& path)
{
  z_stream stream = {};
  std::string result;
  std::vector<unsigned char> buffer(Step);
  std::size_t at = 0;
  int status = inflateInit2(&stream, GzipWindow);
  while (status == Z_OK)
  {
    const std::size_t before = result.size();
    status =
      feed(stream, packed, at, result, buffer, [&](int) { return inflate(&stream, Z_NO_FLUSH); });
    const bool hasMore = at < packed.size() || stream.avail_in > 0;
    if (status == Z_STREAM_END && hasMore)
    {
      status = inflateReset(&stream);
    }
    else if (status == Z_OK && !hasMore && result.size() == before)
    {
      status = Z_DATA_ERROR; // it ends too soon
    }
  }
  inflateEnd(&stream);
  if (status != Z_STREAM_END)
  {
    throw Error("Cannot read " + path + ": it is damaged, or no gzip file.");
  }
  return result;
}

std::string gzip(const std::string& content, const std::string& path)
{
  z_stream stream = {};
  std::string result;
  std::vector<unsigned char> buffer(Step);
  std::size_t at = 0;
  int status =
    deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, GzipWindow, 8, Z_DEFAULT_STRATEGY);
  while (status == Z_OK)
  {
    status =
      feed(stream, content, at, result, buffer, [&](int how) { return deflate(&stream, how); });
  }
  deflateEnd(&stream);
  if (status != Z_STREAM_END)
  {
    throw Error("Cannot write " + path + ": zlib cannot pack it.");
  }
  return result;
}
#else
std::string gunzip(const std::string&, const std::string& path)
{
  throw Error("Cannot read " + path +
              ": this MeshMorphing was built without zlib. Unpack the file "
              "(gunzip), or build with zlib (zlib1g-dev).");
}

std::string gzip(const std::string&, const std::string& path)
{
  throw Error("Cannot write " + path +
              ": this MeshMorphing was built without zlib. Name a file "
              "without .gz, or build with zlib (zlib1g-dev).");
}
#endif
}
