// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Arguments.h"

#include <vtkScaledJacobian.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <string>
#include <vector>

class vtkAlgorithm;
class vtkUnstructuredGrid;

namespace morph_mesh
{
/// Measures a mesh, also by the criteria of the command line. Throws Failure.
vtkSmartPointer<vtkScaledJacobian> measure(vtkUnstructuredGrid* grid, const Arguments& arguments);

/// Prints the mesh's size and its quality, to standard output.
void printQuality(vtkScaledJacobian* measured);

/// What a morph filter says of its last execution; see vtkMorphAlgorithm.
struct Outcome
{
  vtkUnstructuredGrid* grid;
  std::string status;
  double minimum, mean;
  vtkIdType inverted, collapsed, added, crossing, worst; ///< added: inverted by the motion
  double reached;                                        ///< the part of the motion, or NaN
  vtkIdType prescribed;
  double prepareSeconds, evaluateSeconds;
  int iterations;

  bool isValid() const { return this->added == 0 && this->crossing <= 0; }
};
/// Of a vtkMorphMesh or vtkMorphAlgorithm.
Outcome outcomeOf(vtkAlgorithm* filter);

/// Prints the mesh's size, its quality before and after, the time taken, and the output with its
/// status, to standard output. `after`: null without criteria.
void printReport(vtkScaledJacobian* before, const Outcome& outcome, vtkScaledJacobian* after,
  const std::string& output);

/// Writes the same as JSON, numbers that are not finite as null. `seen`: messages, an error that
/// comes with a result among them. Throws Failure.
void writeReport(vtkScaledJacobian* before, const Outcome& outcome, vtkScaledJacobian* after,
  const std::vector<std::string>& seen, const std::string& output, const std::string& path);
}
