// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <vector>

namespace morph
{
/// A compressed list of lists: list i is values[offsets[i]] to values[offsets[i + 1] - 1].
struct Adjacency
{
  std::vector<Index> offsets = { 0 };
  std::vector<Index> values;

  const Index* begin(Index i) const { return this->values.data() + this->offsets[i]; }
  const Index* end(Index i) const { return this->values.data() + this->offsets[i + 1]; }
  /// Appends a list.
  template <typename Iterator>
  void add(Iterator first, Iterator last)
  {
    this->values.insert(this->values.end(), first, last);
    this->offsets.push_back(static_cast<Index>(this->values.size()));
  }
};
}
