// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Arguments.h"

#include <vtkScaledJacobian.h>
#include <vtkSmartPointer.h>

class vtkMorphAlgorithm;
class vtkUnstructuredGrid;

namespace morph_mesh
{
/// Measures a mesh, also by the criteria of the command line. Throws Failure.
vtkSmartPointer<vtkScaledJacobian> measure(vtkUnstructuredGrid* grid, const Arguments& arguments);

/// Prints the mesh's size and its quality, to standard output.
void printQuality(vtkScaledJacobian* measured);

/// Prints the mesh's size, its quality before and after, and the time taken, to standard output.
/// `after`: null without criteria.
void printReport(vtkScaledJacobian* before, vtkMorphAlgorithm* morph, vtkScaledJacobian* after);
}
