// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Files/ReplaceFile.h"
#include "Formats/SolverMesh.h"

#include <memory>
#include <string>
#include <vector>

namespace morph::io
{
/// A solver's file that was read, and that can be written again with other coordinates.
class SolverFile
{
public:
  virtual ~SolverFile() = default;

  const SolverMesh& mesh() const { return this->mesh_; }
  const std::string& path() const { return this->path_; }
  /// The displacements of a time step, from 0 on, as those of mesh(); none where it is not there.
  virtual std::vector<double> displacementsAt(Index) const { return {}; }
  /// The number of time steps that have displacements.
  virtual Index steps() const { return 0; }
  /// Gives mesh() the displacements of a time step. Throws Error where it is not there.
  void takeStep(Index step);

  /// The files to write so that `out` is a copy with these coordinates (3 x #nodes, in the order of
  /// mesh()), the one of `out` last. Nothing else differs. Sets the largest difference between a
  /// coordinate and what the file can hold. Throws Error where `out` cannot be written.
  virtual std::vector<NewFile> withCoordinates(const std::vector<double>& coordinates,
    const std::string& out, double& largestRounding) const = 0;

protected:
  explicit SolverFile(std::string path)
    : path_(std::move(path))
  {
  }
  [[noreturn]] void fail(const std::string& reason) const;

  SolverMesh mesh_;

private:
  std::string path_;
};

/// The name of the format of a file, by its extension and its first bytes: "Abaqus or CalculiX".
/// Empty where it is none of these formats (README.md of this folder), or where VTK reads it.
std::string solverFormat(const std::string& path);

/// The command that converts a file of another format: " Gmsh converts it: gmsh m.unv -save -o
/// model.msh". Empty where none is known.
std::string converterOf(const std::string& path);

/// Reads a file. Throws Error naming what is missing, wrong or not supported, with file and line.
std::unique_ptr<SolverFile> readSolverFile(const std::string& path);

/// What a copy of a file with other coordinates is.
struct Copied
{
  double largestRounding = 0; ///< between a coordinate and what is written
  Index changed = 0;          ///< coordinates that are not those of the original
};

/// Writes `out`, a copy of `original` with other coordinates, as replaceFiles() does. `numbers`:
/// the node numbers of the file, in any order; `coordinates`: 3 for each. Throws Error, and writes
/// nothing, where they are not all nodes of the file, or a coordinate is not finite, or does not
/// fit.
Copied writeSolverFile(const std::string& original, const std::vector<Index>& numbers,
  const std::vector<double>& coordinates, const std::string& out, Signals signals = Signals::Leave);

/// Throws Error where `original` has displacements, and `coordinates`, which another reader gave,
/// are not its own: that reader or a filter has added them. `precision`: what rounding may have
/// changed. `isMorphed`: a morph follows. Without one, the displacements of a time step may have
/// been added: returns the exact sums then, else nothing.
std::vector<double> requireOwnCoordinates(const std::string& original,
  const std::vector<Index>& numbers, const std::vector<double>& coordinates, double precision,
  bool isMorphed);

/// Throws Error unless a copy of `original` can be written to `out`, so that the error comes before
/// the work.
void requireWritable(const std::string& original, const std::string& out);
}
