// SPDX-License-Identifier: BSD-3-Clause
// Filters/Morphing/Results.txt against the filters: getters, field data, PrintSelf and reset.
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
#include <vtkVariant.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

namespace
{
struct Row
{
  std::string Name, Kind, None, Field;
  bool IsField() const { return this->Field != "-"; }
  bool IsAlways() const { return this->Field.back() == '*'; }
  int Place() const { return std::stoi(this->Field); }
};

/// The rows of a section, read with other means than CMake's.
std::vector<Row> rowsOf(const std::string& section)
{
  std::ifstream table(MESHMORPHING_RESULTS);
  std::vector<Row> rows;
  std::string line, current;
  while (std::getline(table, line))
  {
    if (!line.empty() && line[0] == '[')
    {
      current = line.substr(1, line.size() - 2);
    }
    else if (!line.empty() && line[0] != '#' && current == section)
    {
      Row row;
      std::istringstream(line) >> row.Name >> row.Kind >> row.None >> row.Field;
      rows.push_back(row);
    }
  }
  EXPECT_FALSE(rows.empty()) << section;
  return rows;
}

using Getters = std::map<std::string, std::function<vtkVariant()>>;

Getters gettersOf(vtkMorphAlgorithm* f)
{
  return { { "MorphStatus", [f] { return f->GetMorphStatus(); } },
    { "MinScaledJacobian", [f] { return f->GetMinScaledJacobian(); } },
    { "MeanScaledJacobian", [f] { return f->GetMeanScaledJacobian(); } },
    { "WorstMeanScaledJacobian", [f] { return f->GetWorstMeanScaledJacobian(); } },
    { "BoundaryMinimum", [f] { return f->GetBoundaryMinimum(); } },
    { "InvertedCells", [f] { return f->GetInvertedCells(); } },
    { "DegenerateCells", [f] { return f->GetDegenerateCells(); } },
    { "InvertedBefore", [f] { return f->GetInvertedBefore(); } },
    { "NewInvertedCells", [f] { return f->GetNewInvertedCells(); } },
    { "CrossingFaces", [f] { return f->GetCrossingFaces(); } },
    { "WorstCellId", [f] { return f->GetWorstCellId(); } },
    { "SurfaceInvertedCells", [f] { return f->GetSurfaceInvertedCells(); } },
    { "BoundaryInvertedCells", [f] { return f->GetBoundaryInvertedCells(); } },
    { "MirroredBodies", [f] { return f->GetMirroredBodies(); } },
    { "CertifiedCells", [f] { return f->GetCertifiedCells(); } },
    { "UncertifiedCells", [f] { return f->GetUncertifiedCells(); } },
    { "UndecidedCells", [f] { return f->GetUndecidedCells(); } },
    { "LargestValidStep", [f] { return f->GetLargestValidStep(); } },
    { "PrepareSeconds", [f] { return f->GetPrepareSeconds(); } },
    { "EvaluateSeconds", [f] { return f->GetEvaluateSeconds(); } },
    { "SubSteps", [f] { return f->GetSubSteps(); } },
    { "PrepareCount", [f] { return f->GetPrepareCount(); } },
    { "PrescribedPoints", [f] { return f->GetPrescribedPoints(); } },
    { "UnmatchedPoints", [f] { return f->GetUnmatchedPoints(); } },
    { "AttachedPoints", [f] { return f->GetAttachedPoints(); } },
    { "SolverIterations", [f] { return f->GetSolverIterations(); } } };
}

Getters gettersOf(vtkMorphBoundary* f)
{
  return { { "MinScaledJacobian", [f] { return f->GetMinScaledJacobian(); } },
    { "MeanScaledJacobian", [f] { return f->GetMeanScaledJacobian(); } },
    { "FoldedFaces", [f] { return f->GetFoldedFaces(); } },
    { "GivenPoints", [f] { return f->GetGivenPoints(); } },
    { "FixedVertices", [f] { return f->GetFixedVertices(); } },
    { "ProjectedPoints", [f] { return f->GetProjectedPoints(); } },
    { "UnprojectedPoints", [f] { return f->GetUnprojectedPoints(); } },
    { "SmoothedSurfaces", [f] { return f->GetSmoothedSurfaces(); } },
    { "KeptSurfaces", [f] { return f->GetKeptSurfaces(); } } };
}

Getters gettersOf(vtkMorphShapes* f)
{
  return { { "MorphStatus", [f] { return f->GetMorphStatus(); } },
    { "MinScaledJacobian", [f] { return f->GetMinScaledJacobian(); } },
    { "MeanScaledJacobian", [f] { return f->GetMeanScaledJacobian(); } },
    { "InvertedCells", [f] { return f->GetInvertedCells(); } },
    { "DegenerateCells", [f] { return f->GetDegenerateCells(); } },
    { "InvertedBefore", [f] { return f->GetInvertedBefore(); } },
    { "CrossingFaces", [f] { return f->GetCrossingFaces(); } },
    { "NewInvertedCells", [f] { return f->GetNewInvertedCells(); } },
    { "WorstCellId", [f] { return f->GetWorstCellId(); } },
    { "MirroredBodies", [f] { return f->GetMirroredBodies(); } },
    { "SurfaceInvertedCells", [f] { return f->GetSurfaceInvertedCells(); } },
    { "ValidRanges", [f] { return f->GetValidRanges(); } },
    { "LargestFactor", [f] { return f->GetLargestFactor(); } },
    { "InvertingDesigns", [f] { return f->GetInvertingDesigns(); } },
    { "PrepareSeconds", [f] { return f->GetPrepareSeconds(); } },
    { "EvaluateSeconds", [f] { return f->GetEvaluateSeconds(); } },
    { "PrepareCount", [f] { return f->GetPrepareCount(); } },
    { "SolveCount", [f] { return f->GetSolveCount(); } },
    { "PrescribedPoints", [f] { return f->GetPrescribedPoints(); } },
    { "SolverIterations", [f] { return f->GetSolverIterations(); } } };
}

Getters gettersOf(vtkScaledJacobian* f)
{
  return { { "MinScaledJacobian", [f] { return f->GetMinScaledJacobian(); } },
    { "MeanScaledJacobian", [f] { return f->GetMeanScaledJacobian(); } },
    { "MeasuredCells", [f] { return f->GetMeasuredCells(); } },
    { "InvertedCells", [f] { return f->GetInvertedCells(); } },
    { "DegenerateCells", [f] { return f->GetDegenerateCells(); } },
    { "WorstCellId", [f] { return f->GetWorstCellId(); } },
    { "UnmeasuredCells", [f] { return f->GetUnmeasuredCells(); } },
    { "MirroredBodies", [f] { return f->GetMirroredBodies(); } },
    { "CertifiedCells", [f] { return f->GetCertifiedCells(); } },
    { "UncertifiedCells", [f] { return f->GetUncertifiedCells(); } },
    { "UndecidedCells", [f] { return f->GetUndecidedCells(); } } };
}

Getters countsOf(vtkInversionFreeMorph* f)
{
  return { { "NewtonSteps", [f] { return f->GetNewtonSteps(); } },
    { "BoundaryDeterminedCells", [f] { return f->GetBoundaryDeterminedCells(); } },
    { "FoldedBoundaryCells", [f] { return f->GetFoldedBoundaryCells(); } },
    { "LinearIterations", [f] { return f->GetLinearIterations(); } },
    { "EnergyEvaluations", [f] { return f->GetEnergyEvaluations(); } } };
}

Getters countsOf(vtkLBWarpMorph* f)
{
  return { { "OutsideHullNodes", [f] { return f->GetOutsideHullNodes(); } },
    { "TwoRingNodes", [f] { return f->GetTwoRingNodes(); } },
    { "AffineNodes", [f] { return f->GetAffineNodes(); } },
    { "StiffnessNodes", [f] { return f->GetStiffnessNodes(); } } };
}

Getters countsOf(vtkRadialBasisMorph* f)
{
  return { { "Centers", [f] { return f->GetCenters(); } },
    { "CorrectedSites", [f] { return f->GetCorrectedSites(); } },
    { "LargestResidualPPM", [f] { return f->GetLargestResidualPPM(); } } };
}

Getters countsOf(vtkSimplexLinearMorph* f)
{
  return { { "FoldedTetrahedra", [f] { return f->GetFoldedTetrahedra(); } },
    { "ExtrapolatedNodes", [f] { return f->GetExtrapolatedNodes(); } },
    { "AffineNodes", [f] { return f->GetAffineNodes(); } } };
}

Getters countsOf(vtkSimplexNaturalNeighborMorph* f)
{
  return { { "BarycentricNodes", [f] { return f->GetBarycentricNodes(); } },
    { "ExtrapolatedNodes", [f] { return f->GetExtrapolatedNodes(); } },
    { "WeightsStored", [f] { return f->GetWeightsStored(); } } };
}

Getters countsOf(vtkSmoothingMorph* f)
{
  return { { "UntangleSteps", [f] { return f->GetUntangleSteps(); } },
    { "NewtonSteps", [f] { return f->GetNewtonSteps(); } },
    { "BoundaryDeterminedCells", [f] { return f->GetBoundaryDeterminedCells(); } },
    { "SmoothingPatches", [f] { return f->GetSmoothingPatches(); } },
    { "ConditionSteps", [f] { return f->GetConditionSteps(); } },
    { "NodesTakenBack", [f] { return f->GetNodesTakenBack(); } },
    { "LinearIterations", [f] { return f->GetLinearIterations(); } },
    { "EnergyEvaluations", [f] { return f->GetEnergyEvaluations(); } } };
}

void expectSameNames(const std::vector<Row>& rows, const Getters& getters)
{
  std::vector<std::string> named, got;
  for (const Row& row : rows)
  {
    if (row.Kind != "counts")
    {
      named.push_back(row.Name);
    }
  }
  for (const auto& getter : getters)
  {
    got.push_back(getter.first);
  }
  std::sort(named.begin(), named.end());
  EXPECT_EQ(named, got);
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
void expectOneValue(
  vtkAlgorithm* filter, const std::vector<Row>& rows, const Getters& getters, bool hasResult)
{
  vtkFieldData* fields = filter->GetOutputDataObject(0)->GetFieldData();
  std::map<int, int> arrayAt; // of the places
  for (const Row& row : rows)
  {
    if (row.Kind == "counts")
    {
      continue;
    }
    SCOPED_TRACE(row.Name);
    const vtkVariant got = getters.at(row.Name)();
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

void expectReset(const std::vector<Row>& rows, const Getters& getters)
{
  for (const Row& row : rows)
  {
    if (row.Kind != "counts" && row.None != "kept" && row.Name != "MorphStatus")
    {
      EXPECT_EQ(getters.at(row.Name)().ToString(), row.None) << row.Name;
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
  const Getters getters = gettersOf(filter.Get());
  expectSameNames(rows, getters);
  expectReset(rows, getters);
  EXPECT_STREQ(filter->GetMorphStatus(), "None");
  filter->SetInputData(grid);
  filter->SetBoundaryData(grids::boundary(grid, grids::twist));
  filter->CertifyOn();
  filter->PostSmoothOn();
  filter->Update();
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
  expectOneValue(filter, rows, getters, true);
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
  expectReset(rows, getters);
  expectOneValue(filter, rows, getters, false);
  EXPECT_EQ(filter->GetPrepareCount(), 1) << "kept";
}

TEST(Results, OfABoundaryAreGetterFieldAndLine)
{
  const std::vector<Row> rows = rowsOf("vtkMorphBoundary");
  auto grid = grids::hexes(4);
  vtkNew<vtkMorphBoundary> filter;
  const Getters getters = gettersOf(filter.Get());
  expectSameNames(rows, getters);
  expectReset(rows, getters);
  filter->SetInputData(grid);
  filter->SetBoundaryData(grids::boundary(grid, grids::twist));
  filter->Update();
  EXPECT_GT(filter->GetGivenPoints(), 0);
  expectOneValue(filter, rows, getters, true);

  const grids::Listener quiet(filter);
  filter->SetBoundaryData(nullptr);
  filter->Update();
  expectReset(rows, getters);
  expectOneValue(filter, rows, getters, false);
}

TEST(Results, OfShapesAreGetterFieldAndLine)
{
  const std::vector<Row> rows = rowsOf("vtkMorphShapes");
  auto grid = grids::hexes(4);
  vtkNew<vtkMorphShapes> filter;
  const Getters getters = gettersOf(filter.Get());
  expectSameNames(rows, getters);
  expectReset(rows, getters);
  filter->SetInputDataObject(grid);
  filter->AddShapeData(grids::boundary(grid, grids::twist));
  filter->SetWeight(0, .5);
  filter->Update();
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
  EXPECT_GT(filter->GetSolverIterations(), 0);
  expectOneValue(filter, rows, getters, true);

  const grids::Listener quiet(filter);
  filter->RemoveAllShapes();
  filter->Update();
  expectReset(rows, getters);
  expectOneValue(filter, rows, getters, false);
  EXPECT_EQ(filter->GetSolveCount(), 1) << "kept";
}

TEST(Results, OfScaledJacobiansAreGetterFieldAndLine)
{
  const std::vector<Row> rows = rowsOf("vtkScaledJacobian");
  vtkNew<vtkScaledJacobian> filter;
  const Getters getters = gettersOf(filter.Get());
  expectSameNames(rows, getters);
  filter->SetInputData(grids::hexes(4));
  filter->CertifyOn();
  filter->Update();
  EXPECT_EQ(filter->GetMeasuredCells(), 64);
  expectOneValue(filter, rows, getters, true);

  const grids::Listener quiet(filter);
  filter->SetInputData(0, grids::cloud(morph::Points::Zero(1, 3)));
  filter->Update();
  expectReset(rows, getters);
  expectOneValue(filter, rows, getters, false);
}

TYPED_TEST(MethodCounts, AreGetterFieldAndLine)
{
  auto grid = grids::hexes(4);
  vtkNew<TypeParam> filter;
  const std::vector<Row> rows = rowsOf(filter->GetClassName());
  const Getters getters = countsOf(filter.Get());
  expectSameNames(rows, getters);
  filter->SetInputData(grid);
  filter->SetBoundaryData(grids::boundary(grid, grids::twist));
  filter->Update();
  expectOneValue(filter, rows, getters, true);
}
