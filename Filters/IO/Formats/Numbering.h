// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <string>
#include <utility>
#include <vector>

namespace morph::io
{
/// Finds the nodes or elements of a file by their numbers.
class Numbering
{
public:
  Numbering() = default;
  /// `numbers`: that of each position, below 0 where it has none. Throws Error where two positions
  /// have one number. `what`: "node"; `file`: both for the message.
  Numbering(const std::vector<Index>& numbers, const char* what, const std::string& file);
  /// The position of a number; -1: none.
  Index find(Index number) const;
  /// Adds the positions of those numbers from `first` to `last`, every `step`-th, that exist.
  void add(Index first, Index last, std::vector<Index>& positions, Index step = 1) const;

private:
  using Places = std::vector<std::pair<Index, Index>>;
  Places::const_iterator from(Index number) const;

  Places places_; ///< number and position, ascending
};
}
