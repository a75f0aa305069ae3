// SPDX-License-Identifier: BSD-3-Clause
#include "Files/MappedFile.h"

#include "Support/Error.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace morph::io
{
MappedFile::MappedFile(const std::string& path)
{
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status = {};
  const bool isOpen = file >= 0 && fstat(file, &status) == 0 && status.st_size > 0;
  if (isOpen)
  {
    this->size_ = static_cast<std::size_t>(status.st_size);
    this->data_ = mmap(nullptr, this->size_, PROT_READ, MAP_PRIVATE, file, 0);
  }
  if (file >= 0)
  {
    close(file);
  }
  if (!isOpen || this->data_ == MAP_FAILED)
  {
    throw Error("Cannot read " + path + ": the system does not give its content.");
  }
}

MappedFile::~MappedFile()
{
  munmap(this->data_, this->size_);
}
}
