// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <algorithm>
#include <string>

class vtkPoints;

namespace morph::filters
{
/// How the coordinates of a data set are rounded: to single precision, or to a number of decimal
/// digits in a text, from 6 on. It shows in the coordinates, whatever type holds them now.
struct Precision
{
  bool IsFloat = false; ///< held as float
  bool IsSingle = true; ///< no coordinate has more than single precision
  int Digits = 6;       ///< that all coordinates need; above MostDigits: all of double precision
  double Largest = 0;   ///< coordinate

  static constexpr int MostDigits = 15;

  /// `coordinates`: those of `points`, as double. Cost: a pass; most often it ends at once.
  static Precision Of(vtkPoints* points, const morph::Points& coordinates);

  /// The step between the largest coordinates; 0 of double precision.
  double Step() const { return std::max(this->SingleStep(), this->DecimalStep()); }
  /// Whether `x` is `y`, rounded. Both are finite.
  bool IsRounded(double x, double y) const;
  /// "single precision: its coordinates are rounded to steps of 0.5".
  std::string Text() const;

private:
  bool IsText() const { return this->Digits <= MostDigits && !this->IsFloat; }
  /// Of single precision and of the digits, or 0.
  double SingleStep() const;
  double DecimalStep() const;
};
}
