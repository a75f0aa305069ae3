// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/Precision.h"

#include <vtkPoints.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

namespace morph::filters
{
namespace
{
/// Of the shortest text that gives the number.
int digitsOf(double x)
{
  std::array<char, 40> text = {};
  char* end =
    std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::scientific).ptr;
  return static_cast<int>(std::count_if(
    text.data(), std::find(text.data(), end, 'e'), [](char c) { return c >= '0' && c <= '9'; }));
}

double withDigits(double x, int digits)
{
  std::array<char, 40> text = {};
  *std::to_chars(
    text.data(), text.data() + text.size() - 1, x, std::chars_format::scientific, digits - 1)
     .ptr = '\0';
  return std::strtod(text.data(), nullptr);
}

bool isSingle(double x)
{
  return !(std::abs(x) > std::numeric_limits<float>::max()) &&
         static_cast<double>(static_cast<float>(x)) == x;
}
}

Precision Precision::Of(vtkPoints* points, const morph::Points& coordinates)
{
  Precision result;
  result.IsFloat = points && points->GetDataType() == VTK_FLOAT;
  for (morph::Index i = 0; i < coordinates.size(); ++i)
  {
    const double x = coordinates.data()[i];
    result.Largest = std::isfinite(x) ? std::max(result.Largest, std::abs(x)) : result.Largest;
    result.IsSingle = result.IsSingle && isSingle(x);
    if (result.IsText())
    {
      result.Digits = std::max(result.Digits, digitsOf(x));
    }
  }
  return result;
}

double Precision::SingleStep() const
{
  using Single = std::numeric_limits<float>;
  // Below 1e-38 floats are multiples of one number.
  const int exponent = std::max(std::ilogb(this->Largest) + 1, Single::min_exponent);
  return this->IsSingle && this->Largest > 0 ? std::ldexp(1, exponent - Single::digits) : 0;
}

double Precision::DecimalStep() const
{
  return this->IsText() && this->Largest > 0
           ? std::pow(10, std::floor(std::log10(this->Largest)) + 1 - this->Digits)
           : 0;
}

bool Precision::IsRounded(double x, double y) const
{
  // Six digits change no number by more than that, so that a motion is seldom looked at closely.
  if (std::abs(x - y) >
      std::max<double>(1e-5 * std::abs(y), std::numeric_limits<float>::denorm_min()))
  {
    return false;
  }
  const double single = std::abs(y) > std::numeric_limits<float>::max() ? y : static_cast<float>(y);
  return x == y || (this->IsSingle && x == single) ||
         (this->IsText() &&
           (x == withDigits(y, this->Digits) || x == withDigits(single, this->Digits)));
}

std::string Precision::Text() const
{
  std::ostringstream text;
  text << (this->SingleStep() > this->DecimalStep() ? "single precision"
                                                    : std::to_string(this->Digits) + " digits")
       << ": its coordinates are rounded to steps of " << this->Step();
  return text.str();
}
}
