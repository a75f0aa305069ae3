// SPDX-License-Identifier: BSD-3-Clause
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkFEMWarpMorph.h"
#include "vtkMorphAdjoint.h"
#include "vtkMorphShapes.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationDoubleVectorKey.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>

namespace
{
using grids::Row;
using morph::Points;

Row bulged(const Row& x)
{
  return x + Row(0, 0, .05 * x[2] * std::sin(x[0]) * std::sin(x[1]));
}

/// The top, at z = 4, turned about an axis along y; the rest of the boundary stays.
grids::Map turnedTop(double angle)
{
  const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return [=](const Row& x) -> Row
  {
    const Row center(2, 0, 4.5);
    return x[2] == 4 ? Row((x - center) * R.transpose() + center) : x;
  };
}

vtkSmartPointer<vtkMorphShapes> shapesOf(
  vtkUnstructuredGrid* grid, const std::vector<grids::Map>& maps)
{
  auto filter = vtkSmartPointer<vtkMorphShapes>::New();
  filter->SetInputDataObject(grid);
  for (const grids::Map& map : maps)
  {
    filter->AddShapeData(grids::boundary(grid, map));
  }
  return filter;
}

/// Where vtkFEMWarpMorph takes the mesh for a boundary displaced by `map`.
Points morphedBy(vtkUnstructuredGrid* grid, const grids::Map& map)
{
  auto morph = grids::morphed<vtkFEMWarpMorph>(grid, map);
  morph->SetValidityToNone();
  morph->Update();
  return grids::points(morph->GetOutput());
}

double difference(const Points& a, const Points& b)
{
  return (a - b).cwiseAbs().maxCoeff();
}
}

TEST(MorphShapes, AddTheirWeightedMotions)
{
  auto grid = grids::hexes(4);
  const Points rest = grids::points(grid);
  auto filter = shapesOf(grid, { grids::twist, bulged });
  filter->Update();
  EXPECT_EQ(grids::points(filter->GetOutput()), rest) << "no weights";
  filter->SetWeight(0, .5);
  filter->SetWeight(1, -2);
  filter->Update();
  const Points expected = morphedBy(
    grid, [](const Row& x) -> Row { return x + .5 * (grids::twist(x) - x) - 2 * (bulged(x) - x); });
  EXPECT_LT(difference(grids::points(filter->GetOutput()), expected), 1e-8);
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  EXPECT_GT(filter->GetMinScaledJacobian(), 0);
  filter->SetWeight(0, 1);
  filter->SetWeight(1, 0);
  filter->Update();
  EXPECT_LT(difference(grids::points(filter->GetOutput()), morphedBy(grid, grids::twist)), 1e-8);
}

TEST(MorphShapes, SolveOnlyNewShapes)
{
  auto grid = grids::hexes(4);
  auto filter = shapesOf(grid, { grids::twist });
  filter->SetWeight(0, 1);
  filter->Update();
  EXPECT_EQ(filter->GetPrepareCount(), 1);
  EXPECT_EQ(filter->GetSolveCount(), 1);
  EXPECT_GT(filter->GetPrepareSeconds(), 0);
  filter->AddShapeData(grids::boundary(grid, bulged));
  filter->SetWeight(1, 1);
  filter->Update();
  EXPECT_EQ(filter->GetSolveCount(), 2);
  const Points both = grids::points(filter->GetOutput());
  filter->SetWeight(1, .25);
  filter->Update();
  EXPECT_EQ(filter->GetSolveCount(), 2);
  EXPECT_EQ(filter->GetPrepareSeconds(), 0);
  filter->SetWeight(1, 1);
  filter->Update();
  EXPECT_EQ(grids::points(filter->GetOutput()), both);

  // The same content in other objects, in another order.
  auto other = grids::copy(grid);
  filter->SetInputDataObject(other);
  filter->RemoveAllShapes();
  filter->AddShapeData(grids::boundary(other, bulged));
  filter->AddShapeData(grids::boundary(other, grids::twist));
  filter->Update();
  EXPECT_EQ(filter->GetPrepareCount(), 1);
  EXPECT_EQ(filter->GetSolveCount(), 2);
  EXPECT_LT(difference(grids::points(filter->GetOutput()), both), 1e-14);

  filter->RemoveInputConnection(1, 0);
  filter->Update();
  EXPECT_EQ(filter->GetSolveCount(), 2);
  EXPECT_EQ(filter->GetPrepareCount(), 1);
  auto fresh = shapesOf(grid, { grids::twist });
  fresh->SetWeight(0, 1);
  fresh->Update();
  EXPECT_EQ(grids::points(filter->GetOutput()), grids::points(fresh->GetOutput()));
}

TEST(MorphShapes, EveryMethodFollowsItsShapes)
{
  auto grid = grids::hexes(4);
  for (int method = vtkMorphShapes::METHOD_FEMWARP;
       method <= vtkMorphShapes::METHOD_SIMPLEX_NATURAL_NEIGHBOR; ++method)
  {
    auto filter = shapesOf(grid, { grids::affine, bulged });
    filter->SetMethod(method);
    filter->SetWeight(0, .5);
    grids::update(filter);
    const Points expected = grids::mapped(
      grids::points(grid), [](const Row& x) -> Row { return x + .5 * (grids::affine(x) - x); });
    const double tolerance =
      method == vtkMorphShapes::METHOD_WEIGHTED_RESIDUAL ? .5 : 1e-8; // it fits only nearly
    EXPECT_LT(difference(grids::points(filter->GetOutput()), expected), tolerance) << method;
  }
}

TEST(MorphShapes, RotationsTurnByPartsOfTheirAngle)
{
  auto grid = grids::hexes(4);
  auto filter = shapesOf(grid, { turnedTop(1.2) });
  filter->SetMotion(0, vtkMorphShapes::MOTION_AS_ROTATION);
  for (double weight : { 1., .5, -.25, 1.5 })
  {
    filter->SetWeight(0, weight);
    filter->Update();
    const Points expected = morphedBy(grid, turnedTop(1.2 * weight));
    EXPECT_LT(difference(grids::points(filter->GetOutput()), expected), 1e-8) << weight;
  }
  EXPECT_EQ(filter->GetSolveCount(), 2);
  filter->SetMotion(0, vtkMorphShapes::MOTION_AS_DISPLACEMENT);
  filter->SetWeight(0, .5);
  filter->Update();
  EXPECT_GT(difference(grids::points(filter->GetOutput()), morphedBy(grid, turnedTop(.6))), .1);
}

TEST(MorphShapes, AreNamed)
{
  auto grid = grids::hexes(3);
  auto filter = shapesOf(grid, { grids::twist, bulged });
  filter->SetShapeName(1, "bulge");
  filter->SetWeight(1, .5);
  filter->Update();
  vtkFieldData* fields = filter->GetOutput()->GetFieldData();
  auto* names = vtkStringArray::SafeDownCast(fields->GetAbstractArray("ShapeNames"));
  auto* weights = vtkDoubleArray::SafeDownCast(fields->GetArray("ShapeWeights"));
  ASSERT_TRUE(names && weights);
  ASSERT_EQ(names->GetNumberOfValues(), 2);
  EXPECT_EQ(names->GetValue(0), "Shape 1");
  EXPECT_EQ(names->GetValue(1), "bulge");
  EXPECT_EQ(weights->GetValue(0), 0);
  EXPECT_EQ(weights->GetValue(1), .5);

  // Errors name the shape.
  grids::Listener listener(filter);
  filter->SetMotion(1, vtkMorphShapes::MOTION_AS_ROTATION);
  filter->Update();
  listener.ExpectError("Shape 'bulge': The motion is not rigid");
  EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
  EXPECT_EQ(filter->GetInvertedCells(), -1);
  EXPECT_EQ(grids::points(filter->GetOutput()), grids::points(grid));

  listener.Errors.clear();
  filter->RemoveAllShapes();
  filter->Update();
  listener.ExpectError("There is no shape");
}

TEST(MorphShapes, WeightsAreFiniteNumbers)
{
  vtkNew<vtkMorphShapes> filter;
  grids::Listener listener(filter);
  filter->SetWeight(2, 3);
  EXPECT_EQ(filter->GetNumberOfWeights(), 3);
  for (double wrong : { double(NAN), double(INFINITY) })
  {
    listener.Errors.clear();
    filter->SetWeight(2, wrong);
    EXPECT_EQ(listener.Errors.size(), 1u);
    EXPECT_EQ(filter->GetWeight(2), 3);
  }
  filter->SetNumberOfWeights(-1);
  EXPECT_EQ(filter->GetNumberOfWeights(), 0);
  EXPECT_EQ(filter->GetWeight(2), 0);
  EXPECT_EQ(filter->GetWeight(-1), 0);
  filter->SetWeight(-1, 3);
  EXPECT_EQ(filter->GetNumberOfWeights(), 0);
}

TEST(MorphShapes, AbsurdWeightsAreOneError)
{
  auto grid = grids::hexes(4);
  auto filter = shapesOf(grid, { grids::twist, bulged, turnedTop(.3) });
  const double absurd[] = { 1e150, -.2, .5 };
  for (int i = 0; i < 3; ++i)
  {
    filter->SetWeight(i, absurd[i]);
  }
  grids::Listener listener(filter);
  for (const int motion :
    { vtkMorphShapes::MOTION_AS_DISPLACEMENT, vtkMorphShapes::MOTION_AS_ROTATION })
  {
    listener.Errors.clear();
    filter->SetMotion(2, motion);
    filter->Update();
    listener.ExpectError("beyond 1e50");
    EXPECT_EQ(grids::points(filter->GetOutput()), grids::points(grid));
  }
}

TEST(MorphShapes, AShapeThatNamesFewerNodesKeepsTheOthers)
{
  auto grid = grids::hexes(4);
  auto part = grids::cloud(Points(Points::Zero(1, 3)).rowwise() + Row(4, 4, 5));
  morph::Index corner = -1;
  const Points rest = grids::points(grid);
  for (morph::Index i = 0; i < rest.rows(); ++i)
  {
    corner = rest.row(i) == Row(4, 4, 4) ? i : corner;
  }
  ASSERT_GE(corner, 0);
  grids::addIds(part, "MorphPointId", { corner });
  auto filter = shapesOf(grid, { grids::twist });
  filter->AddShapeData(part);
  filter->SetWeight(1, 1);
  filter->Update();
  const Points moved = grids::points(filter->GetOutput());
  EXPECT_EQ(Row(moved.row(corner)), Row(4, 4, 5));
  const Points expected =
    morphedBy(grid, [](const Row& x) -> Row { return x == Row(4, 4, 4) ? Row(4, 4, 5) : x; });
  EXPECT_LT(difference(moved, expected), 1e-8);
}

TEST(MorphShapes, AShapeThatChangesInPlaceIsSolvedAgain)
{
  auto grid = grids::hexes(4);
  auto shape = grids::boundary(grid, grids::twist);
  const auto filterOf = [&]
  {
    auto filter = grids::of<vtkMorphShapes>(grid);
    filter->AddShapeData(shape);
    filter->SetWeight(0, .5);
    filter->Update();
    return vtkSmartPointer<vtkMorphShapes>(filter);
  };
  auto filter = filterOf();
  const Points before = grids::points(filter->GetOutput());
  double x[3];
  shape->GetPoint(0, x);
  shape->GetPoints()->SetPoint(0, x[0] - .1, x[1], x[2]);
  shape->GetPoints()->Modified();
  filter->Update();
  EXPECT_GT(difference(grids::points(filter->GetOutput()), before), .01);
  EXPECT_EQ(grids::points(filter->GetOutput()), grids::points(filterOf()->GetOutput()));
  // A weight alone matches and solves nothing, and a setting that matters does.
  filter->SetWeight(0, .25);
  filter->Update();
  const int solved = filter->GetSolveCount();
  filter->SetWeight(0, .75);
  filter->Update();
  EXPECT_EQ(filter->GetSolveCount(), solved);
  EXPECT_GT(filter->GetPrescribedPoints(), 0);
  filter->SetTolerance(1e-6);
  filter->Update();
  EXPECT_EQ(filter->GetSolveCount(), solved + 1);
}

TEST(MorphShapes, BadCellsAreOnTheSecondOutput)
{
  auto grid = grids::hexes(4);
  auto filter = shapesOf(grid, { turnedTop(1.2) });
  filter->SetWeight(0, 3);
  filter->Update();
  EXPECT_STREQ(filter->GetMorphStatus(), "Inverted");
  EXPECT_GT(filter->GetInvertedCells(), 0);
  auto* bad = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(1));
  EXPECT_EQ(bad->GetNumberOfCells(), filter->GetInvertedCells() + filter->GetDegenerateCells());
}

namespace
{
bool isValid(vtkMorphShapes* filter)
{
  filter->Update();
  return filter->GetInvertedCells() == 0 && filter->GetDegenerateCells() == 0;
}
}

TEST(MorphShapes, ValidRangesEndWhereCellsAreInverted)
{
  auto grid = grids::hexes(4);
  auto filter = shapesOf(grid, { grids::twist, turnedTop(1.2),
                                 [](const Row& x) -> Row { return x - Row(0, 0, .25 * x[2]); } });
  filter->SetMotion(1, vtkMorphShapes::MOTION_AS_ROTATION);
  filter->SetWeight(0, .5);
  filter->SetWeight(2, .25);
  filter->Update();
  EXPECT_NE(std::string(filter->GetValidRanges()).find("Shape 2 "), std::string::npos);
  EXPECT_GT(filter->GetHighestWeight(2), 2);
  for (int shape = 0; shape < 3; ++shape)
  {
    const double before = filter->GetWeight(shape);
    const double ends[] = { filter->GetLowestWeight(shape), filter->GetHighestWeight(shape) };
    EXPECT_LT(ends[0], 0);
    EXPECT_GT(ends[1], 0);
    for (double end : ends)
    {
      filter->SetWeight(shape, std::isfinite(end) ? end * (1 - 1e-6) : std::copysign(100, end));
      EXPECT_TRUE(isValid(filter)) << shape << " at " << end;
      if (std::isfinite(end))
      {
        filter->SetWeight(shape, end * (1 + 1e-6));
        EXPECT_FALSE(isValid(filter)) << shape << " at " << end;
      }
    }
    filter->SetWeight(shape, before);
    filter->Update();
  }
  EXPECT_TRUE(std::isnan(filter->GetLowestWeight(3)));

  const double factor = filter->GetLargestFactor();
  ASSERT_TRUE(std::isfinite(factor));
  for (double near : { 1 - 1e-6, 1 + 1e-6 })
  {
    filter->SetWeight(0, .5 * factor * near);
    filter->SetWeight(2, .25 * factor * near);
    EXPECT_EQ(isValid(filter), near < 1);
  }
  // With a rotation beside them, and with the rotation alone.
  const auto expectLargestFactor = [&](double first, double turn, double third)
  {
    const double weights[] = { first, turn, third };
    const auto setWeights = [&](double by)
    {
      for (int shape = 0; shape < 3; ++shape)
      {
        filter->SetWeight(shape, by * weights[shape]);
      }
    };
    setWeights(1);
    filter->Update();
    const double largest = filter->GetLargestFactor();
    ASSERT_TRUE(std::isfinite(largest));
    for (double near : { 1 - 1e-6, 1 + 1e-6 })
    {
      setWeights(largest * near);
      EXPECT_EQ(isValid(filter), near < 1) << largest;
    }
  };
  expectLargestFactor(.5, .1, .25);
  expectLargestFactor(0, -.1, 0);
  expectLargestFactor(.5e-12, 0, .25e-12);
  filter->FindValidRangesOff();
  filter->Update();
  EXPECT_TRUE(std::isnan(filter->GetHighestWeight(0)));
  EXPECT_FALSE(filter->GetOutput()->GetFieldData()->GetArray("ShapeLowestWeight"));
}

namespace
{
/// A column for each name, given row by row.
vtkSmartPointer<vtkTable> tableOf(
  const std::vector<std::string>& names, const std::vector<std::vector<double>>& rows)
{
  auto table = vtkSmartPointer<vtkTable>::New();
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    vtkNew<vtkDoubleArray> column;
    column->SetName(names[i].c_str());
    for (const std::vector<double>& row : rows)
    {
      column->InsertNextValue(row[i]);
    }
    table->AddColumn(column);
  }
  return table;
}

double weightAt(vtkMorphShapes* filter, int shape)
{
  return filter->GetOutput()->GetFieldData()->GetArray("ShapeWeights")->GetComponent(shape, 0);
}
}

TEST(MorphShapes, ATableOfDesignsGivesTimeSteps)
{
  auto grid = grids::hexes(4);
  auto filter = shapesOf(grid, { grids::twist, bulged, turnedTop(1.2) });
  filter->SetShapeName(0, "twist");
  filter->SetShapeName(2, "turn");
  filter->SetMotion(2, vtkMorphShapes::MOTION_AS_ROTATION);
  filter->SetWeight(1, .25);
  filter->SetTableData(tableOf(
    { "turn", "other", "twist" }, { { 0, 9, 0 }, { .2, 9, .5 }, { 9, 9, 0 }, { .1, 9, .2 } }));
  filter->UpdateInformation();
  vtkInformation* information = filter->GetOutputInformation(0);
  ASSERT_EQ(information->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS()), 4);
  for (const auto& [time, row] :
    { std::make_pair(0., 0), std::make_pair(1., 1), std::make_pair(3., 3), std::make_pair(1.5, 1),
      std::make_pair(-1., 0), std::make_pair(99., 3) })
  {
    filter->UpdateTimeStep(time);
    EXPECT_EQ(weightAt(filter, 0), std::vector<double>({ 0, .5, 0, .2 })[row]) << time;
    EXPECT_EQ(weightAt(filter, 1), .25) << time;
    EXPECT_EQ(weightAt(filter, 2), std::vector<double>({ 0, .2, 9, .1 })[row]) << time;
    EXPECT_EQ(filter->GetOutput()->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), row)
      << time;
  }
  EXPECT_STREQ(filter->GetInvertingDesigns(), "2");
  EXPECT_EQ(filter->GetSolveCount(), 4);
  auto fixed = shapesOf(grid, { grids::twist, bulged, turnedTop(1.2) });
  fixed->SetMotion(2, vtkMorphShapes::MOTION_AS_ROTATION);
  fixed->SetWeight(0, .2);
  fixed->SetWeight(1, .25);
  fixed->SetWeight(2, .1);
  fixed->Update();
  EXPECT_EQ(grids::points(filter->GetOutput()), grids::points(fixed->GetOutput()));

  // Another answer for other rows; none without a table.
  filter->SetTableData(tableOf({ "turn" }, { { 0 }, { .25 } }));
  filter->UpdateTimeStep(1);
  EXPECT_STREQ(filter->GetInvertingDesigns(), "none");
  EXPECT_EQ(weightAt(filter, 2), .25);
  filter->SetTableData(nullptr);
  filter->Update();
  EXPECT_STREQ(filter->GetInvertingDesigns(), "None");
  EXPECT_EQ(weightAt(filter, 2), 0);
  EXPECT_FALSE(information->Has(vtkStreamingDemandDrivenPipeline::TIME_STEPS()));
}

TEST(MorphShapes, WrongTablesAreRefused)
{
  auto grid = grids::hexes(3);
  for (const auto& [table, message] :
    { std::make_pair(tableOf({ "a" }, { { 1 } }), "its columns are a."),
      std::make_pair(tableOf({ "Shape 1" }, { { 1 }, { NAN } }), "row 1 of the column 'Shape 1'"),
      std::make_pair(tableOf({ "Shape 1" }, {}), "has no rows") })
  {
    auto filter = shapesOf(grid, { grids::twist });
    filter->SetTableData(table);
    grids::expectError(filter, message);
    EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
  }
}

TEST(MorphShapes, AdjointIsTheDerivativeByTheWeights)
{
  auto grid = grids::hexes(4);
  auto filter = shapesOf(grid, { grids::twist, turnedTop(1.2), bulged });
  filter->SetMotion(1, vtkMorphShapes::MOTION_AS_ROTATION);
  const std::vector<double> at = { .5, .3, -1 };
  const Points target = grids::mapped(grids::points(grid), grids::affine);
  const auto objective = [&](const std::vector<double>& weights)
  {
    for (int i = 0; i < 3; ++i)
    {
      filter->SetWeight(i, weights[i]);
    }
    filter->Update();
    return .5 * (grids::points(filter->GetOutput()) - target).squaredNorm();
  };
  objective(at);
  auto carrier = grids::copy(filter->GetOutput());
  grids::addVectors(carrier, "Gradient", grids::points(carrier) - target);
  auto adjoint = grids::of<vtkMorphAdjoint>(grid);
  adjoint->SetGradientData(carrier);
  adjoint->SetGradientArray("Gradient");
  adjoint->SetMorphShapes(filter);
  adjoint->Update();
  vtkFieldData* fields = adjoint->GetOutput()->GetFieldData();
  ASSERT_TRUE(fields->GetArray("ShapeGradient"));
  EXPECT_EQ(
    vtkStringArray::SafeDownCast(fields->GetAbstractArray("ShapeNames"))->GetValue(1), "Shape 2");
  std::vector<double> derivatives;
  for (int i = 0; i < 3; ++i)
  {
    derivatives.push_back(fields->GetArray("ShapeGradient")->GetComponent(i, 0));
  }
  for (int i = 0; i < 3; ++i)
  {
    std::vector<double> low = at, high = at;
    low[i] -= 1e-4;
    high[i] += 1e-4;
    const double difference = (objective(high) - objective(low)) / 2e-4;
    EXPECT_NEAR(derivatives[i], difference, 1e-6 * std::abs(difference)) << i;
  }

  vtkNew<vtkMorphShapes> never;
  adjoint->SetMorphShapes(never);
  grids::expectError(adjoint, "has no result");
}

TEST(MorphShapes, TheSurfaceKeepsItsPolygons)
{
  auto grid = grids::hexes(4);
  auto filter = shapesOf(grid, { turnedTop(1.2) });
  filter->Update();
  auto* surface = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(2));
  vtkCellArray* polygons = surface->GetPolys();
  EXPECT_EQ(surface->GetNumberOfCells(), 6 * 16);
  filter->SetWeight(0, 3);
  for (int quality : { vtkMorphShapes::QUALITY_ALL, vtkMorphShapes::QUALITY_SURFACE })
  {
    filter->SetQuality(quality);
    filter->Update();
    EXPECT_EQ(surface->GetPolys(), polygons);
    const Points moved = grids::points(filter->GetOutput()), outer = grids::points(surface);
    vtkDataArray* nodes = surface->GetPointData()->GetArray("MorphPointId");
    for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
    {
      EXPECT_EQ(outer.row(i), moved.row(static_cast<morph::Index>(nodes->GetComponent(i, 0))));
    }
    // As the measure of all cells has it.
    auto all = shapesOf(grid, { turnedTop(1.2) });
    all->SetWeight(0, 3);
    all->Update();
    vtkDataArray* expected = all->GetOutput()->GetCellData()->GetArray("ScaledJacobian");
    vtkDataArray* owners = surface->GetCellData()->GetArray("MorphCellId");
    vtkDataArray* found = surface->GetCellData()->GetArray("ScaledJacobian");
    for (vtkIdType i = 0; i < surface->GetNumberOfCells(); ++i)
    {
      const auto owner = static_cast<vtkIdType>(owners->GetComponent(i, 0));
      EXPECT_EQ(found->GetComponent(i, 0), expected->GetComponent(owner, 0));
    }
    EXPECT_GT(filter->GetSurfaceInvertedCells(), 0);
    EXPECT_LE(filter->GetSurfaceInvertedCells(), all->GetInvertedCells());
  }
  EXPECT_STREQ(filter->GetMorphStatus(), "Unmeasured");
  EXPECT_EQ(filter->GetInvertedCells(), -1);
  EXPECT_FALSE(filter->GetOutput()->GetCellData()->GetArray("ScaledJacobian"));
  auto* bad = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(1));
  EXPECT_EQ(bad->GetNumberOfCells(), 0);

  filter->SetInputDataObject(grids::hexes(3));
  filter->RemoveAllShapes();
  filter->AddShapeData(grids::boundary(grids::hexes(3), bulged));
  filter->Update();
  EXPECT_EQ(surface->GetNumberOfCells(), 6 * 9);
}
