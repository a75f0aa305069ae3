// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>

#include <string>

class vtkAlgorithm;
class vtkDataObject;
class vtkDisplacementAlgorithm;
class vtkPointSet;
class vtkUnstructuredGrid;

/// Displaced boundaries that are made from the command line instead of being read.
namespace morph_mesh
{
struct Arguments;

/// The boundary that a file holds. Where it is a copy of the grid with node numbers (`NodeNumber`,
/// `GlobalNodeId` or global ids), points are matched by these: outer nodes alone, or, where
/// `isDisplacement`, all. Throws Failure for a file that cannot be read, and for a copy with other
/// numbers. `timeStep`: of readFile().
vtkSmartPointer<vtkPointSet> readBoundary(
  vtkUnstructuredGrid* grid, const std::string& path, bool isDisplacement, int timeStep);

/// Gives the filter the files by which the boundary moves: a target, handles, a lattice or a field.
/// Throws Failure.
void readMotion(vtkDisplacementAlgorithm* filter, const Arguments& arguments);

/// Prints the largest and the mean distance of what moves from the target, before and after.
/// `boundary`: of makeDisplacement(), with a target.
void printTargetDistances(vtkDataObject* boundary);

/// The name of the point vectors of readDisplacements().
inline constexpr const char* DisplacementName = "Displacement";

/// A source of the points that a table names, at their undeformed positions, with their ids and
/// DisplacementName. Its columns are id, dx, dy and dz, in any order. `nodeNumbers`: ids are the
/// numbers of the file that the grid was read from, not the 0-based point ids. The file may also be
/// a field of OpenFOAM, pointDisplacement: points move on the patches with a fixedValue. Throws
/// Failure with the line of what is wrong.
vtkSmartPointer<vtkAlgorithm> readDisplacements(
  vtkUnstructuredGrid* grid, const std::string& path, bool nodeNumbers);

/// Prints the name, the number of faces, the area and the center of each surface. Throws Failure.
void printSurfaces(vtkUnstructuredGrid* grid, const std::string& path, int threads);
}
