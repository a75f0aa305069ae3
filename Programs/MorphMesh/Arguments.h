// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace morph_mesh
{
/// How the boundary moves where it is not read from a file.
struct Motion
{
  std::vector<std::string> moving, fixed, sliding, free; ///< names of surfaces and curves
  std::vector<std::string> frozen, rigid;                ///< names of arrays or blocks
  int keepLayers = 0;
  int slideRounds = 0;
  std::string surfaceMethod; ///< how surfaces follow; empty: by weighted residual
  /// Of a placement; empty: not given. A motion of zero is a motion.
  std::optional<std::array<double, 3>> translation, scale;
  std::optional<std::array<double, 3>> rotation; ///< degrees about x, y and z
  std::array<double, 3> center = { 0, 0, 0 };
  bool hasCenter = false;                         ///< else the centre of what moves
  std::optional<double> radius;                   ///< change of the radius of cylinders
  std::string target, displacements;              ///< files; empty: none
  bool align = false;                             ///< the target first
  std::optional<double> targetReach, targetAngle; ///< as of vtkDisplacementAlgorithm
  int projectAlong = 0;                           ///< as of vtkDisplacementAlgorithm
  std::array<double, 3> projectVector = { 0, 0, 1 };
  std::string handles, lattice; ///< files of control points; empty: none
  std::array<int, 3> latticeSize = { 3, 3, 3 };
  std::array<double, 6> latticeBox = {}; ///< as VTK's bounds
  bool hasLatticeBox = false;            ///< else the box around what moves
  bool bSplines = false;                 ///< of the lattice, else Bernstein
  bool nodeNumbers = false;

  bool isPlaced() const { return this->translation || this->rotation || this->scale; }
  bool byControlPoints() const { return !this->handles.empty() || !this->lattice.empty(); }
  /// Whether vtkBoundaryDisplacement makes it.
  bool isMade() const
  {
    return !this->moving.empty() || !this->target.empty() || this->byControlPoints();
  }
  bool any() const { return this->isMade() || !this->displacements.empty(); }
};

/// The task, files and options of a command line.
struct Arguments
{
  enum class Task
  {
    Morph,
    ExtractBoundary,
    ListSurfaces,
    WriteDesigns,
    ShowHelp,
    ShowVersion
  };
  Task task = Task::Morph;
  std::string grid, boundary, output; ///< files; boundary: empty unless it is read
  Motion motion;
  int steps = 0;                      ///< 0: the whole motion alone
  std::vector<std::string> shapes;    ///< files, of WriteDesigns, whose output is a folder
  std::vector<std::string> rotations; ///< names of shapes
  std::string table;                  ///< file of WriteDesigns
  std::string method = "FEMWARP";
  std::vector<std::pair<std::string, std::string>> options; ///< of the method, by name
  std::string validity = "Report";
  std::string boundaryIdArray, displacementArray; ///< empty: none
  std::string criteria;                           ///< as of vtkScaledJacobian
  double scaleFactor = 1;
  bool freeUnnamedBoundary = false;
  bool postSmooth = false;
  bool requireValid = false;
  int threads = 0;
  bool quiet = false, progress = false;
  bool results = false; ///< write the arrays that the morph adds, too
  std::string help;     ///< for ShowHelp
};

/// The error of a wrong command line.
struct UsageError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Parses the command line. Throws UsageError.
Arguments parseArguments(int argc, char* argv[]);
}
