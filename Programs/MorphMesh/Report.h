// SPDX-License-Identifier: BSD-3-Clause
#pragma once

class vtkMorphAlgorithm;
class vtkScaledJacobian;

namespace morph_mesh
{
/// Prints the mesh's size, its quality before and after, and the time taken, to standard output.
void printReport(vtkScaledJacobian* before, vtkMorphAlgorithm* after);
}
