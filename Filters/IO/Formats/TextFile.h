// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/CoordinateFrame.h"
#include "Formats/SolverFile.h"
#include "Text/NumberPlaces.h"

#include <array>
#include <deque>

namespace morph::io
{
/// A file of text, with those that it includes: where its coordinates are. Nodes may share their
/// place, as instances of a part do: those that do not move follow the others.
class TextFile : public SolverFile
{
public:
  std::vector<NewFile> withCoordinates(const std::vector<double>& coordinates,
    const std::string& out, double& largestRounding) const override;

protected:
  using SolverFile::SolverFile;

  static constexpr int DeepestInclude = 20;

  struct Part
  {
    std::string path;
    std::string name; ///< as the file that includes it has it; empty: the file itself
    std::string text;
  };
  struct NodePlace
  {
    std::size_t part = 0;
    std::array<NumberPlace, 3> numbers;
    NumberRules rules;
    std::size_t frame = 0; ///< the coordinate system of the numbers
  };

  /// Adds a file to be parsed; returns its number. Throws Error where it cannot be read, and for
  /// more than 1000 besides the first.
  std::size_t addPart(const std::string& path, const std::string& name);
  /// The number at a place; throws Error with its line where there is none.
  double numberAt(std::size_t part, Span span) const;
  long long integerAt(std::size_t part, Span span) const;
  /// As addPart(), for a name that the file `part` includes. A bare name lies beside that file,
  /// one with a folder begins at that of the root file. Solvers and their versions differ, so the
  /// other place is taken where the first has no file.
  std::size_t addIncluded(std::size_t part, const std::string& name);
  /// The place of a node with its coordinates in these three fields. `isSplit`: the last is on
  /// another line.
  NodePlace nodePlace(std::size_t part, const NumberField* fields, const NumberRules& rules,
    std::array<double, 3>& coordinates, bool isSplit = false) const;
  /// "FILE, line 7", for messages.
  std::string where(std::size_t part, std::size_t at) const;
  [[noreturn]] void failAt(std::size_t part, std::size_t at, const std::string& reason) const;
  /// The coordinate systems once the nodes are at `coordinates`, those of mesh(). Some are defined
  /// by nodes, and go along with them. Throws Error where one no longer exists.
  virtual std::deque<CoordinateFrame> framesAt(const std::vector<double>& coordinates) const;

  std::deque<Part> parts_;        ///< they stay where they are; the first is the file itself
  std::vector<NodePlace> places_; ///< of each node
  std::deque<CoordinateFrame> frames_ = { {} }; ///< the first is that of mesh()
  bool sharesPlaces_ = false;

private:
  /// The coordinates to be written at the place of each node, from those of mesh(). `isKept`: of
  /// each number whether it stays as it is.
  std::vector<double> atPlaces(const std::vector<double>& coordinates, const std::string& out,
    std::vector<std::uint8_t>& isKept, double& largestRounding) const;
};

/// The place of a number.
NumberPlace placeOf(Span span);
}
