// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>

#include <functional>
#include <string>

class vtkPolyData;

namespace morph_mesh
{
/// Runs `read` in a process of its own and returns its surface. A reader that writes beyond its
/// arrays, as VTK's PLY reader does on some damaged files, then harms no other memory.
/// Throws Reported after an exception of `read`, which that process has printed, and Failure after
/// a crash. Calls fork(), so that no other thread may hold a lock.
vtkSmartPointer<vtkPolyData> readApart(
  const std::string& path, const std::function<vtkSmartPointer<vtkPolyData>()>& read);
}
