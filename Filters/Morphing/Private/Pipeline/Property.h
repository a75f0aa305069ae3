// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm> // for the macros

class vtkObject;

/// Setters of properties that are floating-point numbers. VTK's own macros, vtkSetMacro and
/// vtkSetClampMacro, accept a NaN.
namespace morph::filters::Property
{
/// Whether `value` is finite and in [minimum, maximum]. If not, it raises an error of `filter` that
/// names the property, the value, the range and `current`, the value that stays.
bool Accepts(vtkObject* filter, const char* property, double value, double current, double minimum,
  double maximum);
/// As above, for any finite value.
bool Accepts(vtkObject* filter, const char* property, double value, double current);
}

/// Defines a filter's Set`name`(double), declared in its header. After the name: the
/// minimum and the maximum, or nothing.
#define morphSetNumberMacro(filter, name, ...)                                            \
  void filter::Set##name(double value)                                                    \
  {                                                                                       \
    if (this->name != value &&                                                            \
        morph::filters::Property::Accepts(this, #name, value, this->name, ##__VA_ARGS__)) \
    {                                                                                     \
      this->name = value;                                                                 \
      this->Modified();                                                                   \
    }                                                                                     \
  }

/// Defines a filter's Set`name`(double, double, double) and Set`name`(const double[3]), declared in
/// its header, for any finite numbers. A vector is refused as a whole.
#define morphSetVectorMacro(filter, name)                                            \
  void filter::Set##name(double x, double y, double z)                               \
  {                                                                                  \
    const double values[3] = { x, y, z };                                            \
    for (int i = 0; i < 3; ++i)                                                      \
    {                                                                                \
      if (!morph::filters::Property::Accepts(this, #name, values[i], this->name[i])) \
      {                                                                              \
        return;                                                                      \
      }                                                                              \
    }                                                                                \
    if (!std::equal(values, values + 3, this->name))                                 \
    {                                                                                \
      std::copy(values, values + 3, this->name);                                     \
      this->Modified();                                                              \
    }                                                                                \
  }                                                                                  \
  void filter::Set##name(const double values[3])                                     \
  {                                                                                  \
    this->Set##name(values[0], values[1], values[2]);                                \
  }
