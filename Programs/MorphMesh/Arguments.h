// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Properties.h"

#include <stdexcept>
#include <string>
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
    ListSurfaces,
    WriteDesigns,
    Check,
    Repair,
    ShowHelp,
    ShowVersion
  };
  Task task = Task::Morph;
  std::string grid, boundary, output; ///< files; boundary: empty unless it is read
  std::string region;                 ///< of a case of OpenFOAM, the grid; empty: the whole case
  GivenProperties properties;
  std::string target, handles, lattice, field, displacements; ///< files; empty: none
  bool nodeNumbers = false;                                   ///< of displacements
  int timeStep = -1;                  ///< of the file that has the displacements; -1: the last
  int steps = 0;                      ///< 0: the whole motion alone
  std::vector<std::string> shapes;    ///< files, of WriteDesigns, whose output is a folder
  std::vector<std::string> rotations; ///< names of shapes
  std::string table;                  ///< file of WriteDesigns
  std::string criteria;               ///< as of vtkScaledJacobian
  std::string report;                 ///< file; empty: none
  bool requireValid = false;
  int threads = 0;
  bool quiet = false, progress = false;
  bool results = false; ///< write the arrays that the morph adds, too
  std::string help;     ///< for ShowHelp

  std::string method() const
  {
    return this->properties.has("Method") ? this->properties.text("Method") : "FEMWARP";
  }
  /// Whether a mesh that the motion inverts or makes cross itself has a status of its own. Who
  /// asks for no more than a report has to ask for that, too.
  bool wantsValid() const;
};

/// The error of a wrong command line.
struct UsageError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Parses the command line. Throws UsageError.
Arguments parseArguments(int argc, char* argv[]);

/// Returns the call that shows the help of this command line's command, or of all.
std::string helpCommand(int argc, char* argv[]);
}
