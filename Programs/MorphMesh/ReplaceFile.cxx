// SPDX-License-Identifier: BSD-3-Clause
#include "ReplaceFile.h"

#include "Messages.h"

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
#include <system_error>
#include <utility>

namespace morph_mesh
{
namespace
{
namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& reason)
{
  throw Failure("Cannot write " + path + ": " + reason);
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

/// The name of the temporary file, for the signal handler; empty where there is none.
std::array<char, 4096> temporaryName{};

void removeTemporary(int signal)
{
  if (temporaryName[0] != '\0')
  {
    unlink(temporaryName.data());
  }
  std::signal(signal, SIG_DFL);
  raise(signal);
}

/// While it lives, what ends the program removes the temporary file first, and a limit on the size
/// of files is an error of write() as any other.
class SignalGuard
{
public:
  SignalGuard()
  {
    for (std::size_t i = 0; i < Signals.size(); ++i)
    {
      struct sigaction action = {};
      action.sa_handler = Signals[i] == SIGXFSZ ? SIG_IGN : removeTemporary;
      sigaction(Signals[i], nullptr, &this->old_[i]);
      if (this->old_[i].sa_handler != SIG_IGN) // nohup
      {
        sigaction(Signals[i], &action, nullptr);
      }
    }
  }
  ~SignalGuard()
  {
    for (std::size_t i = 0; i < Signals.size(); ++i)
    {
      sigaction(Signals[i], &this->old_[i], nullptr);
    }
  }
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;

private:
  static constexpr std::array<int, 5> Signals = { SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXFSZ };
  std::array<struct sigaction, Signals.size()> old_;
};

/// A file of its own beside `file`; removed with this object, unless renamed.
class TemporaryFile
{
public:
  TemporaryFile(const std::string& path, const fs::path& file)
    : path_(path)
    , file_(file)
  {
    // A part of a long name: the whole must not pass the system's limit.
    const std::string name =
      (folderOf(file) / ("." + file.filename().string().substr(0, 200) + ".morph-mesh-XXXXXX"));
    if (name.size() >= temporaryName.size())
    {
      failBySystem(path, "its path is too long", ENAMETOOLONG);
    }
    std::copy(name.begin(), name.end(), temporaryName.begin());
    temporaryName[name.size()] = '\0';
    this->descriptor_ = mkstemp(temporaryName.data());
    if (this->descriptor_ < 0)
    {
      const int error = errno;
      temporaryName[0] = '\0';
      failBySystem(path, "no temporary file can be made beside it", error);
    }
    this->takeMode();
  }
  ~TemporaryFile()
  {
    this->close();
    if (temporaryName[0] != '\0')
    {
      unlink(temporaryName.data());
      temporaryName[0] = '\0';
    }
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
    if (fsync(this->descriptor_) != 0 || this->close() != 0)
    {
      failBySystem(this->path_, "the old file, if any, stays", errno);
    }
  }

  void rename()
  {
    if (std::rename(temporaryName.data(), this->file_.c_str()) != 0)
    {
      failBySystem(this->path_, "the temporary file cannot be renamed", errno);
    }
    temporaryName[0] = '\0';
  }

private:
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

  const std::string& path_;
  const fs::path file_;
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

void requireReplaceable(const std::string& path)
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
  if (access(folderOf(file).c_str(), W_OK | X_OK) != 0)
  {
    failBySystem(path, "no file can be made in its folder", errno);
  }
}

void replaceFile(const std::string& path, std::string_view content)
{
  requireReplaceable(path);
  const fs::path file = target(path);
  const SignalGuard guard;
  TemporaryFile temporary(path, file);
  temporary.write(content);
  temporary.rename();
  flushFolder(folderOf(file));
}
}
