// SPDX-License-Identifier: BSD-3-Clause
#include "Report.h"

#include "Messages.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkMorphAlgorithm.h>
#include <vtkScaledJacobian.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>

namespace morph_mesh
{
namespace
{
/// A line of the table, with a value in each column.
template <typename... Values>
void row(const std::string& what, const Values&... values)
{
  std::cout << std::left << std::setw(24) << what << std::right;
  ((std::cout << std::setw(12) << values), ...);
  std::cout << "\n";
}

/// A row for the worst value, the cells beyond the limit and the worst cell of each criterion, with
/// a column for each of the data.
template <typename... Data>
void printCriteria(vtkFieldData* first, Data*... others)
{
  auto* names = vtkStringArray::SafeDownCast(first->GetAbstractArray("Criterion"));
  for (vtkIdType i = 0; names && i < names->GetNumberOfValues(); ++i)
  {
    const auto number = [i](vtkFieldData* data, const char* column)
    { return data->GetArray(column)->GetComponent(i, 0); };
    const auto whole = [&](vtkFieldData* data, const char* column)
    { return static_cast<vtkIdType>(number(data, column)); };
    std::ostringstream limit;
    limit << "  cells beyond " << number(first, "CriterionLimit");
    row(names->GetValue(i), number(first, "CriterionWorst"), number(others, "CriterionWorst")...);
    row(
      limit.str(), whole(first, "CriterionCellsBeyond"), whole(others, "CriterionCellsBeyond")...);
    row("  worst cell", whole(first, "CriterionWorstCellId"),
      whole(others, "CriterionWorstCellId")...);
  }
}
}

vtkSmartPointer<vtkScaledJacobian> measure(vtkUnstructuredGrid* grid, const Arguments& arguments)
{
  auto filter = vtkSmartPointer<vtkScaledJacobian>::New();
  filter->SetInputData(grid);
  filter->SetNumberOfThreads(arguments.threads);
  filter->SetCriteria(arguments.criteria.c_str());
  Messages messages(filter);
  messages.update("Cannot measure " + arguments.grid);
  for (const std::string& warning : messages.warnings())
  {
    std::cerr << "morph-mesh: warning: " << warning << "\n";
  }
  return filter;
}

void printQuality(vtkScaledJacobian* measured)
{
  vtkUnstructuredGrid* grid = measured->GetOutput();
  std::cout << grid->GetNumberOfPoints() << " nodes, " << grid->GetNumberOfCells() << " cells\n"
            << std::fixed << std::setprecision(4);
  row("minimum scaled Jacobian", measured->GetMinScaledJacobian());
  row("mean scaled Jacobian", measured->GetMeanScaledJacobian());
  row("inverted cells", measured->GetInvertedCells());
  row("collapsed cells", measured->GetDegenerateCells());
  row("worst cell", measured->GetWorstCellId());
  printCriteria(grid->GetFieldData());
}

void printReport(vtkScaledJacobian* before, vtkMorphAlgorithm* morph, vtkScaledJacobian* after)
{
  vtkUnstructuredGrid* grid = morph->GetOutput();
  std::cout << grid->GetNumberOfPoints() << " nodes, " << morph->GetPrescribedPoints()
            << " of them prescribed; " << grid->GetNumberOfCells() << " cells\n";
  std::cout << std::fixed << std::setprecision(4);
  row("", "before", "after");
  row("minimum scaled Jacobian", before->GetMinScaledJacobian(), morph->GetMinScaledJacobian());
  row("mean scaled Jacobian", before->GetMeanScaledJacobian(), morph->GetMeanScaledJacobian());
  row("inverted cells", before->GetInvertedCells(), morph->GetInvertedCells());
  row("collapsed cells", before->GetDegenerateCells(), morph->GetDegenerateCells());
  row("inverted by the motion", std::string(), std::to_string(morph->GetNewInvertedCells()));
  if (morph->GetCrossingFaces() > 0)
  {
    row("crossing faces", std::string(), std::to_string(morph->GetCrossingFaces()));
  }
  row("worst cell", before->GetWorstCellId(), morph->GetWorstCellId());
  if (after)
  {
    printCriteria(before->GetOutput()->GetFieldData(), after->GetOutput()->GetFieldData());
  }
  std::cout << "prepared in " << morph->GetPrepareSeconds() << " s, evaluated in "
            << morph->GetEvaluateSeconds() << " s, " << morph->GetSolverIterations()
            << " iterations\n";
}
}
