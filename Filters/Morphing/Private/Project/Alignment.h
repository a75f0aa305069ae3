// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>

class vtkPolyData;

namespace morph
{
class Monitor;
}

/// Rigid alignment of one surface with another.
namespace morph::filters::Alignment
{
/// Returns `surface`, rotated and shifted so that it lies on `onto`, with points in double
/// precision; cells and arrays are shared. Both have triangles or other polygons, and finite
/// points. Iterative closest points, each by Umeyama's least squares (IEEE Trans. PAMI 13 (1991)
/// 376-380), run from six starts: the current place, equal centers, and the four rotations that
/// turn principal axes into each other. The start that ends with the least mean distance is taken;
/// of nearly equal ones the first, which turns it less. A symmetric surface may so be turned about
/// its symmetry. Cost: some 70,000 searches at most.
vtkSmartPointer<vtkPolyData> Onto(vtkPolyData* surface, vtkPolyData* onto, morph::Monitor& monitor);
}
