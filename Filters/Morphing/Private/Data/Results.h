// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/Morpher.h"
#include "Private/Data/Quality.h"
#include "Quality/Certificate.h"
#include "Quality/ScaledJacobian.h"

#include <vtkIndent.h>
#include <vtkType.h>

#include <string>
#include <variant>
#include <vector>

class vtkDataObject;

namespace morph::filters
{
/// The type of a result in the field data.
enum class ResultKind
{
  Double, ///< vtkDoubleArray
  Int,    ///< vtkIntArray
  Id,     ///< vtkIdTypeArray
  Text,   ///< vtkStringArray
  Counts  ///< stands for all of SetCounts(): vtkIdTypeArrays
};

/// One result of a filter: a row of Filters/Morphing/Results.txt, which explains the columns.
struct ResultRow
{
  const char* Name;
  ResultKind Kind;
  const char* None; ///< the value without a result; null: it stays from execution to execution
  int Place;        ///< in the field data, 0 where it is not there
  bool Always;      ///< it is in the field data without a result, too
};

/// The tables of the filters, in the order of the text. CMake makes the rows.
namespace ResultTables
{
std::vector<ResultRow> vtkMorphAlgorithm();
std::vector<ResultRow> vtkMorphBoundary();
std::vector<ResultRow> vtkMorphMesh();
std::vector<ResultRow> vtkMorphShapes();
std::vector<ResultRow> vtkScaledJacobian();
}

/// The results of a filter's last execution: a value for each row of its table. Functions that take
/// a name throw std::logic_error where the table has no row of that name and type.
class Results
{
public:
  explicit Results(const std::vector<ResultRow>& rows);

  /// Gives each row its value without a result.
  void Reset();

  void SetNumber(const char* name, double value);
  void SetInteger(const char* name, vtkIdType value);
  void SetText(const char* name, std::string value);
  /// Sets the method's own counts, under their names.
  void SetCounts(std::vector<morph::Statistic> counts);
  /// Minimum, mean, inverted and degenerate cells, worst cell.
  void Set(const morph::Quality& quality);
  /// Cells that were inverted before, and that the motion has inverted.
  void Set(const Quality::Judged& judged);
  /// Certified, uncertified and undecided cells.
  void Set(const morph::CertificateReport& report);

  double Number(const char* name) const;
  vtkIdType Integer(const char* name) const;
  const std::string& Text(const char* name) const;
  /// One of the counts; 0 where there is none of that name.
  vtkIdType Count(const char* name) const;

  /// Adds the results set since the last Reset() to the field data, and the rows that are always
  /// there, each at its place. Arrays of these names are replaced.
  void Write(vtkDataObject* output) const;
  /// A line for each row, and for each of the counts.
  void Print(std::ostream& os, vtkIndent indent) const;

private:
  using Value = std::variant<vtkIdType, double, std::string>;
  struct Entry
  {
    ResultRow Row;
    Value Result;
    bool IsSet = false;
  };
  std::vector<Entry> Entries;
  std::vector<morph::Statistic> Counts; ///< what the row of that kind stands for

  static Value Without(const ResultRow& row);
  std::size_t IndexOf(const char* name) const;
  void Keep(const char* name, Value value);
  template <typename Type>
  const Type& Get(const char* name) const;
};
}
