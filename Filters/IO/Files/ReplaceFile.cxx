// SPDX-License-Identifier: BSD-3-Clause
#include "Files/ReplaceFile.h"

#include "Support/Error.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
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

[[noreturn]] void failBySystem(const std::string& path, const std::string& what, int error)
{
  fail(path, what + ": " + std::generic_category().message(error) + ".");
}

/// The file that a write to `path` would reach: symbolic links are followed, also one to nothing.
fs::path target(const std::string& path)
{
  fs::path result = path;
  std::error_code error;
  for (int links = 0; fs::is_symlink(fs::symlink_status(result, error)); ++links)
  {
    if (links == 40)
    {
      fail(path, "too many symbolic links.");
    }
    result = result.parent_path() / fs::read_symlink(result);
  }
  return result;
}

fs::path folderOf(const fs::path& file)
{
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// The name of a temporary file, in a list for the signal handler; empty where there is none.
struct TemporaryName
{
  std::array<char, 4096> text{};
  TemporaryName* next = nullptr;
};
TemporaryName* temporaries = nullptr;

void removeTemporaries(int signal)
{
  for (const TemporaryName* name = temporaries; name; name = name->next)
  {
    if (name->text[0] != '\0')
    {
      unlink(name->text.data());
    }
  }
  std::signal(signal, SIG_DFL);
  raise(signal);
}

/// While it lives, what ends the program removes the temporary files first, and a limit on the size
/// of files is an error of write() as any other.
class SignalGuard
{
public:
  SignalGuard()
  {
    for (std::size_t i = 0; i < Ending.size(); ++i)
    {
      struct sigaction action = {};
      action.sa_handler = Ending[i] == SIGXFSZ ? SIG_IGN : removeTemporaries;
      sigaction(Ending[i], nullptr, &this->old_[i]);
      if (this->old_[i].sa_handler != SIG_IGN) // nohup
      {
        sigaction(Ending[i], &action, nullptr);
      }
    }
  }
  ~SignalGuard()
  {
    for (std::size_t i = 0; i < Ending.size(); ++i)
    {
      sigaction(Ending[i], &this->old_[i], nullptr);
    }
  }
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;

private:
  static constexpr std::array<int, 5> Ending = { SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXFSZ };
  std::array<struct sigaction, Ending.size()> old_;
};

/// A file of its own beside `file`; removed with this object, unless renamed.
class TemporaryFile
{
public:
  TemporaryFile(const std::string& path, const fs::path& file, Signals signals)
    : path_(path)
    , file_(file)
    , isListed_(signals == Signals::RemoveTemporaries)
  {
    std::array<char, 4096>& temporaryName = this->name_.text;
    // A part of a long name: the whole must not pass the system's limit.
    const std::string name =
      (folderOf(file) / ("." + file.filename().string().substr(0, 200) + ".morph-mesh-XXXXXX"));
    if (name.size() >= temporaryName.size())
    {
      failBySystem(path, "its path is too long", ENAMETOOLONG);
    }
    std::copy(name.begin(), name.end(), temporaryName.begin());
    temporaryName[name.size()] = '\0';
    if (this->isListed_)
    {
      this->name_.next = std::exchange(temporaries, &this->name_);
    }
    this->descriptor_ = mkstemp(temporaryName.data());
    if (this->descriptor_ < 0)
    {
      const int error = errno;
      this->name_.text[0] = '\0';
      this->unlist();
      failBySystem(path, "no temporary file can be made beside it", error);
    }
    this->takeMode();
  }
  ~TemporaryFile()
  {
    this->remove();
    this->unlist();
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(std::string_view content)
  {
    while (!content.empty())
    {
      const std::size_t most = std::min<std::size_t>(content.size(), 1 << 24);
      const ssize_t count = ::write(this->descriptor_, content.data(), most);
      if (count < 0 && errno != EINTR)
      {
        failBySystem(this->path_, "the old file, if any, stays", errno);
      }
      content.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    }
  }

  /// Lets `edit` change it by its name.
  void change(const std::function<void(const std::string&)>& edit)
  {
    edit(this->name_.text.data());
  }

  void flush()
  {
    if (fsync(this->descriptor_) != 0 || this->close() != 0)
    {
      failBySystem(this->path_, "the old file, if any, stays", errno);
    }
  }

  void rename()
  {
    if (std::rename(this->name_.text.data(), this->file_.c_str()) != 0)
    {
      failBySystem(this->path_, "the temporary file cannot be renamed", errno);
    }
    this->name_.text[0] = '\0';
  }

  fs::path folder() const { return folderOf(this->file_); }

private:
  /// Files are destroyed in the reverse of their order.
  void unlist()
  {
    if (this->isListed_)
    {
      temporaries = this->name_.next;
    }
  }

  void remove()
  {
    this->close();
    if (this->name_.text[0] != '\0')
    {
      unlink(this->name_.text.data());
      this->name_.text[0] = '\0';
    }
  }

  /// The mode and owner of the file that is replaced; those of any new file where there is none.
  void takeMode()
  {
    struct stat old = {};
    if (stat(this->file_.c_str(), &old) != 0)
    {
      const mode_t mask = umask(0);
      umask(mask);
      fchmod(this->descriptor_, 0666 & ~mask);
      return;
    }
    // Only root can give a file away; as with any new file, it is the writer's then.
    if (fchown(this->descriptor_, old.st_uid, old.st_gid) != 0 && errno != EPERM)
    {
      failBySystem(this->path_, "its owner cannot be kept", errno);
    }
    if (fchmod(this->descriptor_, old.st_mode & 07777) != 0)
    {
      failBySystem(this->path_, "its mode cannot be kept", errno);
    }
  }

  int close()
  {
    const int descriptor = std::exchange(this->descriptor_, -1);
    return descriptor < 0 ? 0 : ::close(descriptor);
  }

  const std::string path_;
  const fs::path file_;
  const bool isListed_;
  TemporaryName name_;
  int descriptor_ = -1;
};

/// Without this a power failure could bring back the old file.
void flushFolder(const fs::path& folder)
{
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY);
  if (descriptor >= 0)
  {
    fsync(descriptor); // not every file system can; the file is whole either way
    close(descriptor);
  }
}
}

void requireReplaceable(const std::string& path, bool makesFolder)
{
  const fs::path file = target(path);
  struct stat old = {};
  if (stat(file.c_str(), &old) == 0)
  {
    if (!S_ISREG(old.st_mode))
    {
      fail(path, "it is no regular file.");
    }
    if (access(file.c_str(), W_OK) != 0)
    {
      failBySystem(path, "it must not be changed", errno);
    }
  }
  fs::path folder = folderOf(file);
  std::error_code error;
  while (makesFolder && !fs::exists(folder, error) && folder != folderOf(folder))
  {
    folder = folderOf(folder);
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0)
  {
    failBySystem(path, "no file can be made in its folder", errno);
  }
}

void replaceFile(const std::string& path, std::string_view content, Signals signals)
{
  requireReplaceable(path);
  const auto guard = signals == Signals::Leave ? nullptr : std::make_unique<SignalGuard>();
  TemporaryFile temporary(path, target(path), signals);
  temporary.write(content);
  temporary.flush();
  temporary.rename();
  flushFolder(temporary.folder());
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
  const auto guard = signals == Signals::Leave ? nullptr : std::make_unique<SignalGuard>();
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
    written.push_back(std::make_unique<TemporaryFile>(file.path, target(file.path), signals));
    written.back()->write(file.content);
    if (file.edit)
    {
      written.back()->change(file.edit);
    }
    written.back()->flush();
  }
  for (const auto& file : written)
  {
    file->rename();
    flushFolder(file->folder());
  }
}
}
