// SPDX-License-Identifier: BSD-3-Clause
#include "Report.h"

#include "Messages.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkMorphAlgorithm.h>
#include <vtkMorphMesh.h>
#include <vtkScaledJacobian.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include <cmath>
#include <fstream>
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

std::string json(double number)
{
  std::ostringstream text;
  text << std::setprecision(17) << number;
  return std::isfinite(number) ? text.str() : "null";
}

/// As a string of JSON.
std::string quoted(const std::string& text)
{
  std::ostringstream result;
  result << '"';
  for (const char c : text)
  {
    if (static_cast<unsigned char>(c) < 0x20)
    {
      result << "\\u" << std::hex << std::setw(4) << std::setfill('0') << int(c);
      continue;
    }
    result << (c == '"' || c == '\\' ? "\\" : "") << c;
  }
  result << '"';
  return result.str();
}

/// Adds the worst value, the cells beyond the limit and the worst cell of each criterion.
/// `measured` may be null.
void writeCriteria(vtkScaledJacobian* measured, std::ostream& file)
{
  vtkFieldData* data = measured ? measured->GetOutput()->GetFieldData() : nullptr;
  auto* names = data ? vtkStringArray::SafeDownCast(data->GetAbstractArray("Criterion")) : nullptr;
  for (vtkIdType i = 0; names && i < names->GetNumberOfValues(); ++i)
  {
    const auto number = [&](const char* column)
    { return json(data->GetArray(column)->GetComponent(i, 0)); };
    file << ", " << quoted(names->GetValue(i)) << ": {\"worst\": " << number("CriterionWorst")
         << ", \"limit\": " << number("CriterionLimit")
         << ", \"cells beyond\": " << number("CriterionCellsBeyond")
         << ", \"worst cell\": " << number("CriterionWorstCellId") << "}";
  }
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

Outcome outcomeOf(vtkAlgorithm* filter)
{
  const auto of = [](auto* morph)
  {
    return Outcome{ morph->GetOutput(), morph->GetMorphStatus(), morph->GetMinScaledJacobian(),
      morph->GetMeanScaledJacobian(), morph->GetInvertedCells(), morph->GetDegenerateCells(),
      morph->GetNewInvertedCells(), morph->GetCrossingFaces(), morph->GetWorstCellId(),
      morph->GetLargestValidStep(), morph->GetPrescribedPoints(), morph->GetPrepareSeconds(),
      morph->GetEvaluateSeconds(), morph->GetSolverIterations() };
  };
  auto* mesh = vtkMorphMesh::SafeDownCast(filter);
  return mesh ? of(mesh) : of(vtkMorphAlgorithm::SafeDownCast(filter));
}

void printReport(vtkScaledJacobian* before, const Outcome& outcome, vtkScaledJacobian* after,
  const std::string& output)
{
  std::cout << outcome.grid->GetNumberOfPoints() << " nodes, " << outcome.prescribed
            << " of them prescribed; " << outcome.grid->GetNumberOfCells() << " cells\n";
  std::cout << std::fixed << std::setprecision(4);
  row("", "before", "after");
  row("minimum scaled Jacobian", before->GetMinScaledJacobian(), outcome.minimum);
  row("mean scaled Jacobian", before->GetMeanScaledJacobian(), outcome.mean);
  row("inverted cells", before->GetInvertedCells(), outcome.inverted);
  row("collapsed cells", before->GetDegenerateCells(), outcome.collapsed);
  row("inverted by the motion", std::string(), std::to_string(outcome.added));
  if (outcome.crossing > 0)
  {
    row("crossing faces", std::string(), std::to_string(outcome.crossing));
  }
  row("worst cell", before->GetWorstCellId(), outcome.worst);
  if (vtkDataArray* gaps = outcome.grid->GetFieldData()->GetArray("ContactGaps"))
  {
    std::cout << std::defaultfloat;
    row("least gap in contact", gaps->GetComponent(0, 0), gaps->GetComponent(1, 0));
    row("largest gap in contact", gaps->GetComponent(0, 1), gaps->GetComponent(1, 1));
    std::cout << std::fixed;
  }
  if (after)
  {
    printCriteria(before->GetOutput()->GetFieldData(), after->GetOutput()->GetFieldData());
  }
  std::cout << "prepared in " << outcome.prepareSeconds << " s, evaluated in "
            << outcome.evaluateSeconds << " s, " << outcome.iterations << " iterations\n"
            << output << ": " << outcome.status << "\n";
}

void writeReport(vtkScaledJacobian* before, const Outcome& outcome, vtkScaledJacobian* after,
  const std::vector<std::string>& seen, const std::string& output, const std::string& path)
{
  std::ofstream file(path);
  file << std::setprecision(17);
  const auto side = [&](const char* name, double minimum, double mean, vtkIdType inverted,
                      vtkIdType collapsed, vtkIdType worst, vtkScaledJacobian* criteria)
  {
    file << "  " << quoted(name) << ": {\"minimum scaled Jacobian\": " << json(minimum)
         << ", \"mean scaled Jacobian\": " << json(mean) << ", \"inverted cells\": " << inverted
         << ", \"collapsed cells\": " << collapsed << ", \"worst cell\": " << worst;
    writeCriteria(criteria, file);
    file << "},\n";
  };
  file << "{\n  \"output\": " << quoted(output) << ",\n  \"status\": " << quoted(outcome.status)
       << ",\n  \"nodes\": " << outcome.grid->GetNumberOfPoints()
       << ",\n  \"cells\": " << outcome.grid->GetNumberOfCells()
       << ",\n  \"prescribed nodes\": " << outcome.prescribed << ",\n";
  side("before", before->GetMinScaledJacobian(), before->GetMeanScaledJacobian(),
    before->GetInvertedCells(), before->GetDegenerateCells(), before->GetWorstCellId(),
    after ? before : nullptr);
  side("after", outcome.minimum, outcome.mean, outcome.inverted, outcome.collapsed, outcome.worst,
    after);
  if (vtkDataArray* gaps = outcome.grid->GetFieldData()->GetArray("ContactGaps"))
  {
    const auto range = [gaps](vtkIdType time) // the least and the largest
    {
      return "[" + json(gaps->GetComponent(time, 0)) + ", " + json(gaps->GetComponent(time, 1)) +
             "]";
    };
    file << "  \"gaps in contact\": {\"before\": " << range(0) << ", \"after\": " << range(1)
         << "},\n";
  }
  file << "  \"inverted by the motion\": " << outcome.added
       << ",\n  \"crossing faces\": " << outcome.crossing
       << ",\n  \"part of the motion reached\": " << json(outcome.reached)
       << ",\n  \"seconds to prepare\": " << json(outcome.prepareSeconds)
       << ",\n  \"seconds to evaluate\": " << json(outcome.evaluateSeconds)
       << ",\n  \"iterations\": " << outcome.iterations << ",\n  \"messages\": [";
  for (std::size_t i = 0; i < seen.size(); ++i)
  {
    file << (i > 0 ? ", " : "") << quoted(seen[i]);
  }
  if (!(file << "]\n}\n" << std::flush))
  {
    throw Failure("Cannot write the report " + path + ".");
  }
}
}
