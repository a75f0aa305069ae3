// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/Target.h"

#include <vtkSmartPointer.h>

#include <memory>
#include <string>

class vtkPolyData;

/// Target surfaces as VTK's data.
namespace morph::filters::TargetData
{
/// The polygons and strips of `surface` as a target of `mesh`. `options`: without the rounding,
/// which is found here. `warning`: becomes what to warn of where the rounding shows, else empty.
/// `size`: of the mesh. Throws as morph::Target does.
std::unique_ptr<morph::Target> Make(vtkPolyData* surface, const morph::Points& mesh, double size,
  morph::Target::Options options, std::string& warning, morph::Monitor& monitor);

/// The triangles that count.
vtkSmartPointer<vtkPolyData> Surface(const morph::Target& target);
}
