// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/SharedHigherOrderNodes.h"

#include "Mesh/CellShape.h"

#include <algorithm>

namespace morph
{
void SharedHigherOrderNodes::prepare(
  const Mesh& rest, const NodePartition& partition, const Communicator& communicator)
{
  this->ids_ = partition.higherOrderNodes;
  this->rows_.reset();
  if (communicator.all(this->ids_.empty()))
  {
    return;
  }
  this->own_.prepare(rest, partition);
  Points cells = Points::Zero(static_cast<Index>(this->ids_.size()), 3); // in the first column
  for (Index c = 0; c < rest.numberOfCells(); ++c)
  {
    const CellShape* shape = cellShape(rest, c);
    for (int k = shape ? shape->numberOfCorners : 0; shape && k < shape->numberOfNodes; ++k)
    {
      const Index node = rest.cell(c)[k];
      const auto found = std::lower_bound(this->ids_.begin(), this->ids_.end(), node);
      if (shape->dimension == 3 && found != this->ids_.end() && *found == node)
      {
        ++cells(found - this->ids_.begin(), 0);
      }
    }
  }
  Points all = cells;
  this->rows_ = communicator.rows(this->ids_);
  this->rows_->add(all);
  this->share_.clear();
  for (Index i = 0; i < cells.rows(); ++i)
  {
    this->share_.push_back(cells(i, 0) / all(i, 0));
  }
}

void SharedHigherOrderNodes::apply(Points& displacement) const
{
  if (this->empty())
  {
    return;
  }
  // Each process has the mean over its own cells.
  this->own_.apply(displacement);
  Points moved = displacement(this->ids_, allColumns);
  for (Index i = 0; i < moved.rows(); ++i)
  {
    moved.row(i) *= this->share_[i];
  }
  this->rows_->add(moved);
  displacement(this->ids_, allColumns) = moved;
}
}
