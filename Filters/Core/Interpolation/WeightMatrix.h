// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// A sparse matrix of interpolation weights, #free x #sites, in compressed rows. It takes 12 bytes
/// an entry and 8 a row. After open(), several threads may write rows, each its own.
class WeightMatrix
{
public:
  /// Allocates row i at offsets[i] to offsets[i + 1] - 1 without initializing it. `offsets`: #rows
  /// + 1, ascending from 0. Throws Error if there are more than 2^31 - 1 columns or memory does not
  /// suffice.
  void open(Index columns, std::vector<Index> offsets);
  /// Allocates `entries` in each row.
  void open(Index rows, Index columns, Index entries);

  Index rows() const { return static_cast<Index>(this->offsets_.size()) - 1; }
  Index columns() const { return this->columns_; }
  Index entries() const { return this->offsets_.back(); }
  Index entries(Index row) const { return this->offsets_[row + 1] - this->offsets_[row]; }

  /// The columns and weights of one row. Products add in the order of the entries: ascending
  /// columns make the result independent of the search.
  ///@{
  std::int32_t* column(Index row) { return this->column_.data() + this->offsets_[row]; }
  const std::int32_t* column(Index row) const { return this->column_.data() + this->offsets_[row]; }
  double* weight(Index row) { return this->weight_.data() + this->offsets_[row]; }
  const double* weight(Index row) const { return this->weight_.data() + this->offsets_[row]; }
  ///@}

  /// Sets `free` to W sites; `sites`: #columns x 3, `free`: #rows x 3. The result does not depend
  /// on threads. Cost: one pass over the entries.
  void multiply(const Points& sites, Points& free, Monitor& monitor) const;
  /// Sites with a fourth number, 0, which fill vector registers.
  using PaddedPoints = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;
  static PaddedPoints padded(const Points& sites, Monitor& monitor);
  /// As multiply(), for many products with the same sites.
  void multiplyPadded(const PaddedPoints& sites, Points& free, Monitor& monitor) const;
  /// Sets `sites` to W^T free. Rows are cut into at most 32 fixed blocks whose sums are added in
  /// order, so the result does not depend on threads. Cost: one pass over the entries, and
  /// temporarily 24 bytes a column and block.
  void multiplyTranspose(const Points& free, Points& sites, Monitor& monitor) const;

private:
  Index columns_ = 0;
  std::vector<Index> offsets_{ 0 };
  // Resizing does not initialize them: each thread is the first to touch its part.
  Eigen::Array<std::int32_t, Eigen::Dynamic, 1> column_;
  Eigen::ArrayXd weight_;
};
}
