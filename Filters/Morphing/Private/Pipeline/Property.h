// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Pipeline/NameSet.h"

#include <vtkIndent.h>
#include <vtkObject.h>

#include <algorithm>
#include <array>
#include <limits>
#include <ostream>
#include <string>
#include <type_traits>

/// The setters of properties that are options (Private/Options.h), and how PrintSelf() has them.
namespace morph::filters::Property
{
constexpr double Any = std::numeric_limits<double>::max();

/// Sets an option, and marks the filter as modified if that changes it.
template <typename Value>
void Set(vtkObject* filter, Value& kept, const std::common_type_t<Value>& value)
{
  if (kept != value)
  {
    kept = value;
    filter->Modified();
  }
}

/// Sets the name of an array: empty for none, or "None", which ParaView's choice of one offers.
inline void SetArray(vtkObject* filter, std::string& kept, const std::string& name)
{
  Set(filter, kept, name == "None" ? std::string() : name);
}

/// Whether `value` is finite and in [minimum, maximum]. If not, it raises an error of `filter` that
/// names the property, the value, the range and `current`, the value that stays. VTK's own macros
/// accept a NaN.
bool Accepts(vtkObject* filter, const char* property, double value, double current, double minimum,
  double maximum);

inline void Set(vtkObject* filter, const char* property, double& kept, double value, double minimum,
  double maximum)
{
  if (Accepts(filter, property, value, kept, minimum, maximum))
  {
    Set(filter, kept, value);
  }
}

/// A whole number outside of its range becomes the nearest bound, as usual in VTK.
inline void Set(
  vtkObject* filter, const char* /*property*/, int& kept, int value, int minimum, int maximum)
{
  Set(filter, kept, std::clamp(value, minimum, maximum));
}

/// A vector is refused as a whole.
template <std::size_t Count>
void Set(vtkObject* filter, const char* property, std::array<double, Count>& kept,
  const std::array<double, Count>& values, double minimum, double maximum)
{
  for (std::size_t i = 0; i < Count; ++i)
  {
    if (!Accepts(filter, property, values[i], kept[i], minimum, maximum))
    {
      return;
    }
  }
  Set(filter, kept, values);
}

template <std::size_t Count>
void Set(vtkObject* filter, const char* /*property*/, std::array<int, Count>& kept,
  std::array<int, Count> values, int minimum, int maximum)
{
  for (int& value : values)
  {
    value = std::clamp(value, minimum, maximum);
  }
  Set(filter, kept, values);
}

/// Adds a name, or removes it where `status` is 0.
inline void SetStatus(vtkObject* filter, NameSet::Names& names, const char* name, int status)
{
  if (NameSet::SetStatus(names, name, status))
  {
    filter->Modified();
  }
}

template <typename Value>
void Print(std::ostream& os, vtkIndent indent, const char* name, const Value& value)
{
  os << indent << name << ": " << value << "\n";
}

inline void Print(std::ostream& os, vtkIndent indent, const char* name, const std::string& value)
{
  os << indent << name << ": " << (value.empty() ? "(none)" : value) << "\n";
}

inline void Print(
  std::ostream& os, vtkIndent indent, const char* name, const NameSet::Names& values)
{
  NameSet::Print(os, indent, name, values);
}

template <typename Value, std::size_t Count>
void Print(
  std::ostream& os, vtkIndent indent, const char* name, const std::array<Value, Count>& values)
{
  os << indent << name << ":";
  for (const Value value : values)
  {
    os << " " << value;
  }
  os << "\n";
}
}
