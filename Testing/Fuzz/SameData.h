// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkDataObject.h>
#include <vtkSmartPointer.h>

#include <set>
#include <string>
#include <vector>

namespace fuzz
{
/// Where two data objects differ in a bit: empty if nowhere. Both may be null. Arrays and columns
/// named in `except` are left out.
std::string difference(
  vtkDataObject* a, vtkDataObject* b, const std::set<std::string>& except = {});

/// Of composite data its blocks, without empty ones; else the data itself.
std::vector<vtkDataObject*> leaves(vtkDataObject* data);

/// All of it, arrays of wrong lengths included.
vtkSmartPointer<vtkDataObject> deepCopy(vtkDataObject* data);
}
