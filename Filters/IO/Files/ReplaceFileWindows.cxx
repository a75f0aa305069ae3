// SPDX-License-Identifier: BSD-3-Clause
// The twin of ReplaceFile.cxx for Windows.
#include "Files/ReplaceFile.h"

#include "Support/Error.h"

#ifndef NOMINMAX
#define NOMINMAX
#endif
#define WIN32_LEAN_AND_MEAN
#include <windows.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

namespace morph::io
{
namespace
{
namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& reason)
{
  throw Error("Cannot write " + path + ": " + reason);
}

[[noreturn]] void failBySystem(const std::string& path, const std::string& what)
{
  fail(path, what + ": " + std::system_category().message(static_cast<int>(GetLastError())) + ".");
}

fs::path folderOf(const fs::path& file)
{
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// A file of its own beside `path`; removed with this object, unless renamed. Listed ones are
/// removed by signals, too.
class TemporaryFile
{
public:
  TemporaryFile(const std::string& path, Signals signals)
    : path_(path)
    , isListed_(signals == Signals::RemoveTemporaries)
  {
    const fs::path file = path;
    for (unsigned number = GetTickCount(); this->handle_ == INVALID_HANDLE_VALUE; ++number)
    {
      this->name_ = folderOf(file) / ("." + file.filename().string().substr(0, 200) +
                                       ".morph-mesh-" + std::to_string(number % 1000000));
      this->handle_ = CreateFileW(this->name_.c_str(), GENERIC_WRITE, FILE_SHARE_READ, nullptr,
        CREATE_NEW, FILE_ATTRIBUTE_NORMAL, nullptr);
      if (this->handle_ == INVALID_HANDLE_VALUE && GetLastError() != ERROR_FILE_EXISTS)
      {
        failBySystem(path, "no temporary file can be made beside it");
      }
    }
    this->next_ = std::exchange(newest, this);
  }
  /// Files are destroyed in the reverse of their order.
  ~TemporaryFile()
  {
    newest = this->next_;
    this->close();
    if (!this->name_.empty())
    {
      DeleteFileW(this->name_.c_str());
    }
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(std::string_view content)
  {
    while (!content.empty())
    {
      const auto most = static_cast<DWORD>(std::min<std::size_t>(content.size(), 1 << 24));
      DWORD count = 0;
      if (!WriteFile(this->handle_, content.data(), most, &count, nullptr))
      {
        failBySystem(this->path_, "the old file, if any, stays");
      }
      content.remove_prefix(count);
    }
  }
  /// `edit` opens the file by its name, which needs it closed.
  void flush(const std::function<void(const std::string&)>& edit)
  {
    const bool isFlushed = FlushFileBuffers(this->handle_) != 0;
    if (!isFlushed || !this->close())
    {
      failBySystem(this->path_, "the old file, if any, stays");
    }
    if (edit)
    {
      edit(this->name_.string());
    }
  }
  void rename()
  {
    const fs::path file = this->path_;
    if (!MoveFileExW(
          this->name_.c_str(), file.c_str(), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH))
    {
      failBySystem(this->path_, "the temporary file cannot be renamed");
    }
    this->name_.clear();
  }

  static void removeAll(int signal)
  {
    for (TemporaryFile* file = newest; file; file = file->next_)
    {
      if (file->isListed_ && !file->name_.empty())
      {
        file->close();
        DeleteFileW(file->name_.c_str());
      }
    }
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }

private:
  bool close()
  {
    const HANDLE handle = std::exchange(this->handle_, INVALID_HANDLE_VALUE);
    return handle == INVALID_HANDLE_VALUE || CloseHandle(handle) != 0;
  }

  static TemporaryFile* newest;
  const std::string path_;
  const bool isListed_;
  fs::path name_;
  HANDLE handle_ = INVALID_HANDLE_VALUE;
  TemporaryFile* next_ = nullptr;
};
TemporaryFile* TemporaryFile::newest = nullptr;
}

void requireReplaceable(const std::string& path, bool makesFolder)
{
  const fs::path file = path;
  std::error_code error;
  if (fs::exists(file, error) && !fs::is_regular_file(file, error))
  {
    fail(path, "it is no regular file.");
  }
  const DWORD attributes = GetFileAttributesW(file.c_str());
  if (attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_READONLY) != 0)
  {
    fail(path, "it must not be changed.");
  }
  if (!makesFolder && !fs::is_directory(folderOf(file), error))
  {
    fail(path, "its folder is not there.");
  }
}

void replaceFile(const std::string& path, std::string_view content, Signals signals)
{
  replaceFiles({ { path, std::string(content), {}, false } }, signals);
}

void replaceFiles(const std::vector<NewFile>& files, Signals signals)
{
  for (const NewFile& file : files)
  {
    if (file.makeFolder)
    {
      std::error_code error;
      fs::create_directories(folderOf(file.path), error); // requireReplaceable() says why not
    }
    requireReplaceable(file.path);
  }
  if (signals == Signals::RemoveTemporaries)
  {
    std::signal(SIGINT, TemporaryFile::removeAll);
    std::signal(SIGTERM, TemporaryFile::removeAll);
  }
  std::vector<std::unique_ptr<TemporaryFile>> written;
  struct InReverse // the order that TemporaryFile needs
  {
    std::vector<std::unique_ptr<TemporaryFile>>& files;
    ~InReverse()
    {
      while (!this->files.empty())
      {
        this->files.pop_back();
      }
    }
  } const inReverse{ written };
  for (const NewFile& file : files)
  {
    written.push_back(std::make_unique<TemporaryFile>(file.path, signals));
    written.back()->write(file.content);
    written.back()->flush(file.edit);
  }
  for (const auto& file : written)
  {
    file->rename();
  }
}
}
