// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace morph_mesh
{
/// The task, files and options of a command line.
struct Arguments
{
  enum class Task
  {
    Morph,
    ExtractBoundary,
    WriteDesigns,
    ShowHelp,
    ShowVersion
  };
  Task task = Task::Morph;
  std::string grid, boundary, output; ///< files; ExtractBoundary takes no boundary
  std::vector<std::string> shapes;    ///< files, of WriteDesigns, whose output is a folder
  std::vector<std::string> rotations; ///< names of shapes
  std::string table;                  ///< file of WriteDesigns
  std::string method = "FEMWARP";
  std::vector<std::pair<std::string, std::string>> options; ///< of the method, by name
  std::string validity = "Report";
  std::string boundaryIdArray, displacementArray; ///< empty: none
  double scaleFactor = 1;
  bool freeUnnamedBoundary = false;
  bool postSmooth = false;
  bool requireValid = false;
  int threads = 0;
  bool quiet = false, progress = false;
  std::string help; ///< for ShowHelp
};

/// The error of a wrong command line.
struct UsageError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Parses the command line. Throws UsageError.
Arguments parseArguments(int argc, char* argv[]);
}
