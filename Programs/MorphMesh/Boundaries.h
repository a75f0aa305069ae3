// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>

#include <string>

class vtkAlgorithm;
class vtkDataObject;
class vtkUnstructuredGrid;

/// Displaced boundaries that are made from the command line instead of being read.
namespace morph_mesh
{
struct Motion;

/// The filter whose output is the grid's displaced boundary: by numbers, or onto a target. It has
/// not been executed. Throws Failure for a target that cannot be read.
vtkSmartPointer<vtkAlgorithm> makeDisplacement(
  vtkUnstructuredGrid* grid, const Motion& motion, int threads);

/// Prints the largest and the mean distance of what moves from the target, before and after.
/// `boundary`: of makeDisplacement(), with a target.
void printTargetDistances(vtkDataObject* boundary);

/// The name of the point vectors of readDisplacements().
inline constexpr const char* DisplacementName = "Displacement";

/// A source of the points that a CSV file names, at their undeformed positions, with their ids and
/// DisplacementName. Its columns are id, dx, dy and dz, in any order. `nodeNumbers`: ids are the
/// numbers of the file that the grid was read from, not the 0-based point ids. Throws Failure with
/// the line of what is wrong.
vtkSmartPointer<vtkAlgorithm> readDisplacements(
  vtkUnstructuredGrid* grid, const std::string& path, bool nodeNumbers);

/// Prints the name, the number of faces, the area and the centre of each surface. Throws Failure.
void printSurfaces(vtkUnstructuredGrid* grid, const std::string& path, int threads);
}
