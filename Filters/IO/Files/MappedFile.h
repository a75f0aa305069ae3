// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace morph::io
{
/// The content of a file in memory, for reading. The system loads parts of it as they are read.
class MappedFile
{
public:
  /// Throws Error where the system does not give its content.
  explicit MappedFile(const std::string& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::size_t size() const { return this->size_; }
  /// Must not be written.
  void* data() const { return this->data_; }

private:
  std::size_t size_ = 0;
  void* data_ = nullptr;
};
}
