// SPDX-License-Identifier: BSD-3-Clause
#ifndef SurfaceColors_h
#define SurfaceColors_h

#include <array>
#include <cstddef>

class vtkSMProxy;

/// The colors of the array SurfaceId: a category for each surface, with its name in the legend.
namespace SurfaceColors
{
/// The first 24 can be told apart.
std::array<double, 3> ColorOf(std::size_t place);

/// Gives `table`, the array's colors, the surfaces that the filter's property SurfaceSizes lists.
/// Does nothing where there are more than a legend can hold (24), and to categories of the user.
void Name(vtkSMProxy* table, vtkSMProxy* filter);
}

#endif
