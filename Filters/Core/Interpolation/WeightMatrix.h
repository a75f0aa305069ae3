// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// A sparse matrix of interpolation weights, #free x #sites: compressed rows, 12 bytes an entry and
/// 8 a row. Made by open(), after which the rows may be written by several threads, each its own.
class WeightMatrix
{
public:
  /// Room for the entries of row i at offsets[i] .. offsets[i + 1] - 1, not yet written. `offsets`:
  /// #rows + 1, from 0 upwards. Throws Error where there are more than 2^31 - 1 columns or the
  /// memory does not suffice.
  void open(Index columns, std::vector<Index> offsets);
  /// The same with `entries` in each row.
  void open(Index rows, Index columns, Index entries);

  Index rows() const { return static_cast<Index>(this->offsets_.size()) - 1; }
  Index columns() const { return this->columns_; }
  Index entries() const { return this->offsets_.back(); }
  Index entries(Index row) const { return this->offsets_[row + 1] - this->offsets_[row]; }

  /// The columns and weights of one row. Products add in the order they are written in: ascending
  /// columns make the result independent of how they were found.
  ///@{
  std::int32_t* column(Index row) { return this->column_.data() + this->offsets_[row]; }
  const std::int32_t* column(Index row) const { return this->column_.data() + this->offsets_[row]; }
  double* weight(Index row) { return this->weight_.data() + this->offsets_[row]; }
  const double* weight(Index row) const { return this->weight_.data() + this->offsets_[row]; }
  ///@}

  /// `free` becomes W sites; `sites`: #columns x 3, `free`: #rows x 3. Independent of the threads.
  /// Cost: one pass over the entries.
  void multiply(const Points& sites, Points& free, Monitor& monitor) const;
  /// `sites` becomes W^T free. Independent of the threads: rows are cut into at most 32 fixed
  /// blocks whose sums are added block by block. Cost: one pass over the entries, and 24 bytes a
  /// column and block meanwhile.
  void multiplyTranspose(const Points& free, Points& sites, Monitor& monitor) const;
  /// Bytes kept.
  std::size_t memory() const;

private:
  Index columns_ = 0;
  std::vector<Index> offsets_{ 0 };
  // Not initialised by resize: each thread is the first to touch its part.
  Eigen::Array<std::int32_t, Eigen::Dynamic, 1> column_;
  Eigen::ArrayXd weight_;
};
}
