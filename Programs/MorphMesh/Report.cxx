// SPDX-License-Identifier: BSD-3-Clause
#include "Report.h"

#include <vtkMorphAlgorithm.h>
#include <vtkScaledJacobian.h>
#include <vtkUnstructuredGrid.h>

#include <iomanip>
#include <iostream>
#include <string>

namespace morph_mesh
{
namespace
{
template <typename Value>
void row(const char* what, Value before, Value after)
{
  std::cout << std::left << std::setw(24) << what << std::right << std::setw(12) << before
            << std::setw(12) << after << "\n";
}
}

void printReport(vtkScaledJacobian* before, vtkMorphAlgorithm* after)
{
  vtkUnstructuredGrid* grid = after->GetOutput();
  std::cout << grid->GetNumberOfPoints() << " nodes, " << after->GetPrescribedPoints()
            << " of them prescribed; " << grid->GetNumberOfCells() << " cells\n";
  std::cout << std::fixed << std::setprecision(4);
  row("", "before", "after");
  row("minimum scaled Jacobian", before->GetMinScaledJacobian(), after->GetMinScaledJacobian());
  row("mean scaled Jacobian", before->GetMeanScaledJacobian(), after->GetMeanScaledJacobian());
  row("inverted cells", before->GetInvertedCells(), after->GetInvertedCells());
  row("collapsed cells", before->GetDegenerateCells(), after->GetDegenerateCells());
  row("inverted by the motion", std::string(), std::to_string(after->GetNewInvertedCells()));
  row("worst cell", before->GetWorstCellId(), after->GetWorstCellId());
  std::cout << "prepared in " << after->GetPrepareSeconds() << " s, evaluated in "
            << after->GetEvaluateSeconds() << " s, " << after->GetSolverIterations()
            << " iterations\n";
}
}
