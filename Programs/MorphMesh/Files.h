// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>

#include <string>

class vtkPointSet;
class vtkUnstructuredGrid;

/// Reads and writes files in VTK's formats, which the extension determines. Each function throws
/// Failure.
namespace morph_mesh
{
/// Composite files (Exodus II) become one grid, coincident points merged.
vtkSmartPointer<vtkUnstructuredGrid> readGrid(const std::string& path);
vtkSmartPointer<vtkPointSet> readPoints(const std::string& path);

/// Throws Failure where writeGrid() or writeBoundary() would for the extension, or for the file at
/// the path, so that the error comes before the work.
void requireGridFormat(const std::string& path);
void requireBoundaryFormat(const std::string& path);

/// Write a file. Both replace it as a whole, or leave it as it was.
void writeGrid(vtkUnstructuredGrid* grid, const std::string& path);
void writeBoundary(vtkPointSet* boundary, const std::string& path);
}
