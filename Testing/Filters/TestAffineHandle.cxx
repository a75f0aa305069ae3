// SPDX-License-Identifier: BSD-3-Clause
// Morphs that use what a boundary says of its own affine motion.
#include "DisplacedBoundaries.h"
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkFEMWarpMorph.h"

#include <vtkBox.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkTransform.h>

#include <gtest/gtest.h>

#include <limits>

using grids::Row;

namespace
{
constexpr const char* Fields = "AffineFields";
constexpr const char* Motion = "AffineMotion";

/// The top of a cube is lifted and turned; its sides fade.
struct Drag
{
  vtkSmartPointer<vtkUnstructuredGrid> Grid = grids::hexes(4);
  vtkNew<vtkTransform> Transform;
  vtkNew<vtkBoundaryDisplacement> Displaced;

  explicit Drag(int surroundings = vtkBoundaryDisplacement::SURROUNDINGS_FADE)
  {
    vtkNew<vtkBox> top;
    top->SetBounds(-1, 2, -1, 2, 0.9, 2);
    this->Displaced->SetInputData(this->Grid);
    this->Displaced->SetMovingToRegion();
    this->Displaced->SetRegion(top);
    this->Displaced->SetTransform(this->Transform);
    this->Displaced->SetSurroundings(surroundings);
    this->Displaced->SetFalloffRadius(0.4);
    this->Move(1);
  }

  void Move(double size)
  {
    this->Transform->Identity();
    this->Transform->Translate(0.02 * size, 0.01 * size, 0.1 * size);
    this->Transform->RotateZ(5 * size);
    this->Transform->Scale(1 + 0.05 * size, 1, 1);
  }

  /// A copy of the displaced boundary, with the arrays that describe its motion or without.
  vtkSmartPointer<vtkPolyData> Boundary(bool described)
  {
    this->Displaced->Update();
    auto copy = vtkSmartPointer<vtkPolyData>::New();
    copy->ShallowCopy(this->Displaced->GetOutput());
    EXPECT_NE(copy->GetPointData()->GetArray(Fields), nullptr);
    EXPECT_NE(copy->GetFieldData()->GetArray(Motion), nullptr);
    if (!described)
    {
      copy->GetPointData()->RemoveArray(Fields);
      copy->GetFieldData()->RemoveArray(Motion);
    }
    return copy;
  }
};

morph::Points morphed(vtkMorphAlgorithm* filter, vtkUnstructuredGrid* grid, vtkPolyData* boundary)
{
  filter->SetInputData(grid);
  filter->SetBoundaryData(boundary);
  filter->Update();
  return grids::points(filter->GetOutput());
}

class AffineHandle : public testing::TestWithParam<grids::MorphFilter>
{
};
}

TEST_P(AffineHandle, GivesTheMeshOfTheDirectEvaluation)
{
  Drag drag;
  auto described = GetParam().make(), direct = GetParam().make();
  for (const double size : { 1., -0.5, 2., 1.5 })
  {
    drag.Move(size);
    drag.Displaced->SetTransformAboutCenter(size == 1.5);
    const morph::Points a = morphed(described, drag.Grid, drag.Boundary(true));
    const morph::Points b = morphed(direct, drag.Grid, drag.Boundary(false));
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), GetParam().linear ? 1e-8 : 1e-300) << size;
    // The same bits where nothing ran before.
    const morph::Points fresh = morphed(GetParam().make(), drag.Grid, drag.Boundary(true));
    EXPECT_EQ((a - fresh).cwiseAbs().maxCoeff(), 0) << size;
  }
  EXPECT_EQ(described->GetPrepareCount(), 1);
}

TEST_P(AffineHandle, ThatIsStaleDoesNoHarm)
{
  Drag drag;
  vtkSmartPointer<vtkPolyData> boundary = drag.Boundary(true);
  const morph::Points expected = morphed(GetParam().make(), drag.Grid, drag.Boundary(false));
  // Points that a filter in between has moved, after which the arrays say something else.
  vtkNew<vtkPoints> moved;
  moved->DeepCopy(boundary->GetPoints());
  for (vtkIdType i = 0; i < moved->GetNumberOfPoints(); ++i)
  {
    Row x;
    moved->GetPoint(i, x.data());
    x[0] += 0.01 * x[2];
    moved->SetPoint(i, x.data());
  }
  boundary->SetPoints(moved);
  auto bare = vtkSmartPointer<vtkPolyData>::New();
  bare->ShallowCopy(boundary);
  bare->GetPointData()->RemoveArray(Fields);
  EXPECT_EQ(
    (morphed(GetParam().make(), drag.Grid, boundary) - morphed(GetParam().make(), drag.Grid, bare))
      .cwiseAbs()
      .maxCoeff(),
    0);
  // Arrays of another length, and numbers that are none.
  vtkSmartPointer<vtkPolyData> wrong = drag.Boundary(true);
  vtkNew<vtkDoubleArray> shorter;
  shorter->SetName(Motion);
  shorter->SetNumberOfComponents(4);
  shorter->SetNumberOfTuples(2);
  wrong->GetFieldData()->AddArray(shorter);
  EXPECT_EQ((morphed(GetParam().make(), drag.Grid, wrong) - expected).cwiseAbs().maxCoeff(), 0);
  wrong = drag.Boundary(true);
  vtkNew<vtkDoubleArray> nan;
  nan->DeepCopy(wrong->GetPointData()->GetArray(Fields));
  nan->SetComponent(3, 1, std::numeric_limits<double>::quiet_NaN());
  wrong->GetPointData()->AddArray(nan);
  EXPECT_EQ((morphed(GetParam().make(), drag.Grid, wrong) - expected).cwiseAbs().maxCoeff(), 0);
}

INSTANTIATE_TEST_SUITE_P(Linear, AffineHandle,
  testing::ValuesIn(
    []
    {
      std::vector<grids::MorphFilter> linear;
      for (const grids::MorphFilter& filter : grids::morphFilters())
      {
        if (filter.linear)
        {
          linear.push_back(filter);
        }
      }
      return linear;
    }()),
  [](const auto& info) { return info.param.name; });

TEST(AffineHandleOf, IsExactWithATightTolerance)
{
  Drag drag;
  vtkNew<vtkFEMWarpMorph> described, direct;
  described->SetTolerance(1e-13);
  direct->SetTolerance(1e-13);
  const morph::Points a = morphed(described, drag.Grid, drag.Boundary(true));
  const morph::Points b = morphed(direct, drag.Grid, drag.Boundary(false));
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-10);
  // Another tolerance makes other modes.
  described->SetTolerance(1e-2);
  vtkNew<vtkFEMWarpMorph> fresh;
  fresh->SetTolerance(1e-2);
  const morph::Points loose = morphed(described, drag.Grid, drag.Boundary(true));
  EXPECT_EQ((loose - morphed(fresh, drag.Grid, drag.Boundary(true))).cwiseAbs().maxCoeff(), 0);
  EXPECT_GT((loose - a).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(AffineHandleOf, StaysTheSameArrayWhileTheMotionChanges)
{
  Drag drag;
  drag.Displaced->Update();
  const vtkSmartPointer<vtkDataArray> first =
    drag.Displaced->GetOutput()->GetPointData()->GetArray(Fields);
  ASSERT_NE(first, nullptr);
  drag.Move(2);
  drag.Displaced->Update();
  EXPECT_EQ(drag.Displaced->GetOutput()->GetPointData()->GetArray(Fields), first);
  drag.Displaced->SetFalloffRadius(0.2);
  drag.Displaced->Update();
  EXPECT_NE(drag.Displaced->GetOutput()->GetPointData()->GetArray(Fields), first);
}

TEST(AffineHandleOf, IsThereForEveryAffineMotionAndNoOther)
{
  Drag drag(vtkBoundaryDisplacement::SURROUNDINGS_STAY);
  vtkBoundaryDisplacement* filter = drag.Displaced;
  const auto described = [&]
  {
    filter->Update();
    return filter->GetOutput()->GetPointData()->HasArray(Fields) == 1;
  };
  // Whether the morph takes them, which it does where they reproduce the points.
  const auto reproduces = [&]
  {
    vtkPolyData* output = filter->GetOutput();
    vtkDataArray *fields = output->GetPointData()->GetArray(Fields),
                 *motion = output->GetFieldData()->GetArray(Motion),
                 *rest = output->GetPointData()->GetArray("RestPosition");
    double worst = 0;
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        double place = rest->GetComponent(i, j);
        for (int k = 0; k < 4; ++k)
        {
          place += fields->GetComponent(i, k) * motion->GetComponent(j, k);
        }
        worst = std::max(worst, std::abs(place - output->GetPoint(i)[j]));
      }
    }
    return worst < 1e-14;
  };
  EXPECT_TRUE(described() && reproduces());
  filter->SetScaleFactor(-0.7);
  EXPECT_TRUE(described() && reproduces());
  grids::moveBy(filter, 0, 0, 0.2);
  EXPECT_TRUE(described() && reproduces());
  filter->SetDisplacementToTranslateRotateScale();
  filter->SetTranslation(0.1, 0, 0.1);
  filter->SetRotation(10, 20, 30);
  filter->SetScale(1.1, 1, 0.9);
  EXPECT_TRUE(described() && reproduces());
  filter->SetSurroundingsToFade();
  EXPECT_TRUE(described() && reproduces());
  filter->SetMovingToEverything();
  EXPECT_TRUE(described() && reproduces());
  filter->SetSurroundingsToFollow(); // nothing is left to follow
  EXPECT_TRUE(described() && reproduces());
  filter->SetMovingToRegion(); // the cube's sides are plane
  EXPECT_TRUE(described() && reproduces());
  filter->SetUnattachedMotionToStay();
  EXPECT_TRUE(described() && reproduces());
  filter->SetSurfaceMethodToSmoothing(); // solved to a tolerance
  EXPECT_FALSE(described());
  filter->SetSurroundingsToStay();
  filter->SetDisplacementToAlongNormals();
  filter->SetDistance(0.1);
  EXPECT_FALSE(described());
}

TEST(AffineHandleOf, PlanesThatFollowIsUsedUnlessTheyAreMadeToSlide)
{
  // Two planes that touch the lid follow it, and two slide.
  auto grid = grids::hexes(5);
  auto filter = displaced::make(grid);
  const auto name = [&](int axis, double at)
  {
    return displaced::surfaceName(
      filter, [&](const Row& x) { return std::abs(x[axis] - at) < 1e-9; });
  };
  filter->SetMovingToSurfaces();
  filter->AddSurface(name(2, 5).c_str());
  filter->AddSlidingSurface(name(0, 0).c_str());
  filter->AddSlidingSurface(name(0, 5).c_str());
  filter->SetDisplacementToTranslateRotateScale();
  vtkNew<vtkFEMWarpMorph> morph, direct;
  const auto compare = [&]
  {
    filter->Update();
    auto bare = vtkSmartPointer<vtkPolyData>::New();
    bare->ShallowCopy(filter->GetOutput());
    bare->GetPointData()->RemoveArray(Fields);
    bare->GetFieldData()->RemoveArray(Motion);
    const morph::Points a = morphed(morph, grid, filter->GetOutput());
    const morph::Points b = morphed(direct, grid, bare);
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-10);
    return filter->GetOutput()->GetPointData()->HasArray(Fields) == 1;
  };
  morph->SetTolerance(1e-13);
  direct->SetTolerance(1e-13);
  filter->SetTranslation(0, 0, 0.2);
  filter->SetScale(1, 1.2, 1);
  EXPECT_TRUE(compare());
  filter->SetTranslation(0, 0.3, -0.1);
  EXPECT_TRUE(compare());
  filter->SetTranslation(0.1, 0, 0.2); // off the two that slide
  EXPECT_FALSE(compare());
  filter->SetTranslation(0, 0.2, 0.2);
  EXPECT_TRUE(compare());
  EXPECT_EQ(morph->GetPrepareCount(), 1);
}

TEST(AffineHandleOf, CurvedWallsIsUsedForMotionsThatTheyFollowLinearly)
{
  // The end of a ring moves along its axis, which its walls follow along themselves; and turns
  // about it, which the walls follow along circles.
  auto grid = grids::make(meshes::ring(24, 3, 0.2));
  auto filter = displaced::moving(grid, [](const Row& x) { return std::abs(x[2] - 0.8) < 1e-9; });
  const auto described = [&]
  {
    filter->Update();
    return filter->GetOutput()->GetPointData()->HasArray(Fields) == 1;
  };
  grids::moveBy(filter, 0, 0, 0.2);
  EXPECT_TRUE(described());
  filter->SetDisplacementToTranslateRotateScale();
  filter->SetRotation(0, 0, 20);
  EXPECT_FALSE(described());
  filter->SetRotation(0, 0, 0);
  filter->SetTranslation(0, 0, -0.2);
  EXPECT_TRUE(described());
}

TEST(AffineHandleOf, FloatsIsTakenWhereTheOutputIsRoundedLikeIt)
{
  Drag drag;
  vtkNew<vtkPoints> single;
  single->SetDataType(VTK_FLOAT);
  single->DeepCopy(drag.Grid->GetPoints());
  drag.Grid->SetPoints(single);
  vtkNew<vtkFEMWarpMorph> described, direct;
  const morph::Points a = morphed(described, drag.Grid, drag.Boundary(true));
  const morph::Points b = morphed(direct, drag.Grid, drag.Boundary(false));
  EXPECT_EQ(described->GetOutput()->GetPoints()->GetDataType(), VTK_FLOAT);
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-6);
  // Modes answer to a motion that is not rounded: the two differ by the rounding.
  drag.Move(3);
  morphed(described, drag.Grid, drag.Boundary(true));
  EXPECT_EQ(described->GetPrepareCount(), 1);
}
