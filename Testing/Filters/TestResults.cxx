// SPDX-License-Identifier: BSD-3-Clause
// Filters/Morphing/Results.txt against the filters: getters, field data, PrintSelf and reset.
#include "ResultRows.h"
#include "TestGrids.h"

#include "vtkInversionFreeMorph.h"
#include "vtkLBWarpMorph.h"
#include "vtkMorphBoundary.h"
#include "vtkMorphShapes.h"
#include "vtkRadialBasisMorph.h"
#include "vtkScaledJacobian.h"
#include "vtkSimplexLinearMorph.h"
#include "vtkSimplexNaturalNeighborMorph.h"
#include "vtkSmoothingMorph.h"

#include <vtkDataObject.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkStringArray.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <sstream>

namespace
{
using result_rows::Row;

/// The rows of a filter.
std::vector<Row> rowsOf(const std::string& filter)
{
  std::vector<Row> rows;
  std::copy_if(result_rows::Rows.begin(), result_rows::Rows.end(), std::back_inserter(rows),
    [&](const Row& row) { return row.Filter == filter; });
  EXPECT_FALSE(rows.empty()) << filter;
  return rows;
}

int typeOf(const std::string& kind)
{
  return kind == "double" ? VTK_DOUBLE
         : kind == "int"  ? VTK_INT
         : kind == "text" ? VTK_STRING
                          : VTK_ID_TYPE;
}

/// What the filter prints for a result; empty where there is no such line.
std::string printed(vtkObject* filter, const std::string& name)
{
  std::ostringstream all;
  filter->Print(all);
  std::istringstream lines(all.str());
  std::string line, found;
  int count = 0;
  while (std::getline(lines, line))
  {
    if (line.find("  " + name + ": ") == 0)
    {
      found = line.substr(name.size() + 4);
      ++count;
    }
  }
  EXPECT_EQ(count, 1) << name;
  return found;
}

std::string asPrinted(const vtkVariant& value)
{
  std::ostringstream text;
  value.IsDouble() ? text << value.ToDouble() : text << value.ToString();
  return text.str();
}

/// Getter, field data and line of PrintSelf of each row, after an execution.
void expectOneValue(vtkAlgorithm* filter, const std::vector<Row>& rows, bool hasResult)
{
  vtkFieldData* fields = filter->GetOutputDataObject(0)->GetFieldData();
  std::map<int, int> arrayAt; // of the places
  for (const Row& row : rows)
  {
    SCOPED_TRACE(row.Name);
    const vtkVariant got = row.Get(filter);
    EXPECT_EQ(printed(filter, row.Name), asPrinted(got));
    int index = -1;
    vtkAbstractArray* array = fields->GetAbstractArray(row.Name.c_str(), index);
    ASSERT_EQ(array != nullptr, row.IsField() && (hasResult || row.IsAlways()));
    if (array)
    {
      EXPECT_EQ(array->GetDataType(), typeOf(row.Kind));
      ASSERT_EQ(array->GetNumberOfValues(), 1);
      EXPECT_EQ(array->GetVariantValue(0).ToString(), got.ToString());
      if (row.Kind != "count")
      {
        EXPECT_TRUE(arrayAt.emplace(row.Place(), index).second) << "two have this place";
      }
    }
  }
  int last = -1;
  for (const auto& [place, index] : arrayAt)
  {
    EXPECT_GT(index, last) << "place " << place;
    last = index;
  }
}

void expectReset(vtkAlgorithm* filter, const std::vector<Row>& rows)
{
  for (const Row& row : rows)
  {
    if (row.None != "kept" && row.Name != "MorphStatus")
    {
      EXPECT_EQ(row.Get(filter).ToString(), row.None) << row.Name;
    }
  }
}

template <typename Filter>
class MethodCounts : public testing::Test
{
};
using Methods = testing::Types<vtkInversionFreeMorph, vtkLBWarpMorph, vtkRadialBasisMorph,
  vtkSimplexLinearMorph, vtkSimplexNaturalNeighborMorph, vtkSmoothingMorph>;
TYPED_TEST_SUITE(MethodCounts, Methods);
}

TEST(Results, OfAMorphAreGetterFieldAndLine)
{
  const std::vector<Row> rows = rowsOf("vtkMorphAlgorithm");
  auto grid = grids::hexes(4);
  vtkNew<vtkLBWarpMorph> filter;
  expectReset(filter, rows);
  EXPECT_STREQ(filter->GetMorphStatus(), "None");
  filter->SetInputData(grid);
  filter->SetBoundaryData(grids::boundary(grid, grids::twist));
  filter->CertifyOn();
  filter->PostSmoothOn();
  filter->Update();
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
  expectOneValue(filter, rows, true);
  int counts = -1, iterations = -1, status = -1;
  vtkFieldData* fields = filter->GetOutput()->GetFieldData();
  fields->GetAbstractArray("SolverIterations", iterations);
  fields->GetAbstractArray("PostSmoothSteps", counts);
  fields->GetAbstractArray("MorphStatus", status);
  EXPECT_LT(iterations, counts);
  EXPECT_LT(counts, status);
  EXPECT_EQ(filter->GetPrepareCount(), 1);

  const grids::Listener quiet(filter);
  filter->SetBoundaryData(nullptr);
  filter->Update();
  EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
  expectReset(filter, rows);
  expectOneValue(filter, rows, false);
  EXPECT_EQ(filter->GetPrepareCount(), 1) << "kept";
}

TEST(Results, OfABoundaryAreGetterFieldAndLine)
{
  const std::vector<Row> rows = rowsOf("vtkMorphBoundary");
  auto grid = grids::hexes(4);
  vtkNew<vtkMorphBoundary> filter;
  expectReset(filter, rows);
  filter->SetInputData(grid);
  filter->SetBoundaryData(grids::boundary(grid, grids::twist));
  filter->Update();
  EXPECT_GT(filter->GetGivenPoints(), 0);
  expectOneValue(filter, rows, true);

  const grids::Listener quiet(filter);
  filter->SetBoundaryData(nullptr);
  filter->Update();
  expectReset(filter, rows);
  expectOneValue(filter, rows, false);
}

TEST(Results, OfShapesAreGetterFieldAndLine)
{
  const std::vector<Row> rows = rowsOf("vtkMorphShapes");
  auto grid = grids::hexes(4);
  vtkNew<vtkMorphShapes> filter;
  expectReset(filter, rows);
  filter->SetInputDataObject(grid);
  filter->AddShapeData(grids::boundary(grid, grids::twist));
  filter->SetWeight(0, .5);
  filter->Update();
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
  EXPECT_GT(filter->GetSolverIterations(), 0);
  expectOneValue(filter, rows, true);

  const grids::Listener quiet(filter);
  filter->RemoveAllShapes();
  filter->Update();
  expectReset(filter, rows);
  expectOneValue(filter, rows, false);
  EXPECT_EQ(filter->GetSolveCount(), 1) << "kept";
}

TEST(Results, OfScaledJacobiansAreGetterFieldAndLine)
{
  const std::vector<Row> rows = rowsOf("vtkScaledJacobian");
  auto filter = grids::of<vtkScaledJacobian>(grids::hexes(4));
  filter->CertifyOn();
  filter->Update();
  EXPECT_EQ(filter->GetMeasuredCells(), 64);
  expectOneValue(filter, rows, true);

  const grids::Listener quiet(filter);
  filter->SetInputData(0, grids::cloud(morph::Points::Zero(1, 3)));
  filter->Update();
  expectReset(filter, rows);
  expectOneValue(filter, rows, false);
}

TYPED_TEST(MethodCounts, AreGetterFieldAndLine)
{
  auto grid = grids::hexes(4);
  vtkNew<TypeParam> filter;
  const std::vector<Row> rows = rowsOf(filter->GetClassName());
  filter->SetInputData(grid);
  filter->SetBoundaryData(grids::boundary(grid, grids::twist));
  filter->Update();
  expectOneValue(filter, rows, true);
}
