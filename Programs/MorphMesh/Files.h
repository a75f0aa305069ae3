// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>

#include <string>

class vtkPointSet;
class vtkUnstructuredGrid;

/// Files in VTK's formats, told by their extension. Each throws Failure.
namespace morph_mesh
{
/// Composite files (Exodus II) become one grid, coincident points merged.
vtkSmartPointer<vtkUnstructuredGrid> readGrid(const std::string& path);
vtkSmartPointer<vtkPointSet> readPoints(const std::string& path);

/// Throws Failure where writeGrid() or writeBoundary() would for the extension, or for what stands
/// at the path: to be told before the work.
void requireGridFormat(const std::string& path);
void requireBoundaryFormat(const std::string& path);

/// Both replace a file as a whole, or leave it as it was.
void writeGrid(vtkUnstructuredGrid* grid, const std::string& path);
void writeBoundary(vtkPointSet* boundary, const std::string& path);
}
