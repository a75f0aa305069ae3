// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Quality/FourCells.h"
#include "Support/Types.h"

#include <Eigen/Core>

#include <vector>

namespace morph
{
/// Collects cells of one shape, and measures each four of them at once (FourCells.h).
/// Those that need care, and those left over, are measured by measureOne(c, shape, x, corners).
/// Cell c has the corners x, as many as `corners`.
template <typename MeasureOne>
class CellsByFours
{
public:
  using MeasureFour = bool (*)(const FourCells&, double (&)[SimdWidth]);

  /// `values`: of all cells, receives results; it must outlive this object.
  CellsByFours(Shape shape, int corners, MeasureFour measureFour, std::vector<double>& values,
    MeasureOne measureOne)
    : shape_(shape)
    , corners_(corners)
    , measureFour_(measureFour)
    , values_(values)
    , measureOne_(measureOne)
  {
  }

  /// Adds cell c with its corners x.
  void add(Index c, const Eigen::Vector3d* x)
  {
    for (int k = 0; k < this->corners_; ++k)
    {
      for (int j = 0; j < 3; ++j)
      {
        this->cells_.x[k][j][this->count_] = x[k][j];
      }
    }
    this->id_[this->count_++] = c;
    double four[SimdWidth];
    if (this->count_ == SimdWidth && this->measureFour_(this->cells_, four))
    {
      for (int lane = 0; lane < SimdWidth; ++lane)
      {
        this->values_[this->id_[lane]] = four[lane];
      }
      this->count_ = 0;
    }
    else if (this->count_ == SimdWidth)
    {
      this->finish();
    }
  }

  /// Measures the cells that wait, one by one.
  void finish()
  {
    for (int lane = 0; lane < this->count_; ++lane)
    {
      Eigen::Vector3d x[8];
      for (int k = 0; k < this->corners_; ++k)
      {
        const auto& corner = this->cells_.x[k];
        x[k] = Eigen::Vector3d(corner[0][lane], corner[1][lane], corner[2][lane]);
      }
      this->measureOne_(this->id_[lane], this->shape_, x, this->corners_);
    }
    this->count_ = 0;
  }

private:
  Shape shape_;
  int corners_;
  MeasureFour measureFour_;
  std::vector<double>& values_;
  MeasureOne measureOne_;
  FourCells cells_;
  Index id_[SimdWidth];
  int count_ = 0;
};
}
