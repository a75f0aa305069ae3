// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace morph::io
{
/// Whether signals that end the program remove temporary files first. A program may ask for that;
/// inside another one, signals are not ours.
enum class Signals
{
  Leave,
  RemoveTemporaries
};

/// Throws Error where replaceFile() would for the file at `path`, or for its folder. `makesFolder`:
/// the folder may still be missing.
void requireReplaceable(const std::string& path, bool makesFolder = false);

/// Writes a file as a whole, or leaves the old file as it was. A temporary file beside it,
/// ".<name>.morph-mesh-XXXXXX", is written, flushed to disk and renamed. It is removed after an
/// error and, with Signals::RemoveTemporaries, when the user interrupts; SIGKILL and a power
/// failure can leave it. A symbolic link stays and its target is replaced; the mode of an existing
/// file is kept, and its owner where the system allows that. Other hard links keep the old content.
/// Throws Error.
void replaceFile(
  const std::string& path, std::string_view content, Signals signals = Signals::Leave);

struct NewFile
{
  std::string path;
  std::string content;
  /// Where it is set: changes the temporary file of this name before it is renamed.
  std::function<void(const std::string& temporary)> edit = {};
  bool makeFolder = false; ///< make the folder of `path` where there is none
};

/// As replaceFile(), for several files. Each is written and flushed to disk before the first is
/// renamed, in the order given; a kill between two renames leaves the later ones old.
void replaceFiles(const std::vector<NewFile>& files, Signals signals = Signals::Leave);
}
