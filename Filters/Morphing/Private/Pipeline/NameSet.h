// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkIndent.h>

#include <ostream>
#include <set>
#include <string>

/// Properties that are a set of names, such as the surfaces that move.
namespace morph::filters::NameSet
{
using Names = std::set<std::string>;

/// Adds the name, or removes it where `status` is 0. Returns whether that changed the names.
inline bool SetStatus(Names& names, const char* name, int status)
{
  return name && (status != 0 ? names.insert(name).second : names.erase(name) > 0);
}

inline void Print(std::ostream& os, vtkIndent indent, const char* property, const Names& names)
{
  os << indent << property << ": ";
  for (const std::string& name : names)
  {
    os << (name == *names.begin() ? "" : ", ") << name;
  }
  os << "\n";
}
}
