// SPDX-License-Identifier: BSD-3-Clause
// Properties that are floating-point numbers: what is not finite or out of range is refused by
// name, and the old value stays.
#include "TestGrids.h"

#include "vtkBoundaryDisplacement.h"
#include "vtkClassifyBoundary.h"
#include "vtkCompareMorphMethods.h"
#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkLBWarpMorph.h"
#include "vtkMorphBoundary.h"
#include "vtkMorphMesh.h"
#include "vtkRadialBasisMorph.h"
#include "vtkSimplexLinearMorph.h"
#include "vtkSimplexNaturalNeighborMorph.h"
#include "vtkSmoothingMorph.h"
#include "vtkWeightedResidualMorph.h"

#include <vtkNew.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{
constexpr double Any = std::numeric_limits<double>::max();

/// Sets `good`, and then values outside [minimum, maximum] and some that are not numbers.
template <typename Filter, typename Base>
void expectRefused(const char* name, void (Base::*set)(double), double (Base::*get)(),
  double minimum, double maximum, double good)
{
  SCOPED_TRACE(name);
  vtkNew<Filter> filter;
  grids::Listener listener(filter);
  (filter->*set)(good);
  EXPECT_EQ((filter->*get)(), good);
  if (maximum < Any)
  {
    (filter->*set)(minimum);
    EXPECT_EQ((filter->*get)(), minimum);
    (filter->*set)(maximum);
    EXPECT_EQ((filter->*get)(), maximum);
    (filter->*set)(good);
  }
  EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  const vtkMTimeType time = filter->GetMTime();

  std::vector<double> wrong = { NAN, INFINITY, -INFINITY };
  if (maximum < Any)
  {
    wrong.push_back(minimum - 1e-3 * (maximum - minimum));
    wrong.push_back(maximum + 1e-3 * (maximum - minimum));
    wrong.push_back(1e300);
  }
  for (const double value : wrong)
  {
    listener.Errors.clear();
    (filter->*set)(value);
    EXPECT_EQ((filter->*get)(), good) << value;
    ASSERT_EQ(listener.Errors.size(), 1u) << value;
    EXPECT_NE(listener.Errors[0].find(std::string(name) + " cannot be "), std::string::npos)
      << listener.Errors[0];
    EXPECT_NE(listener.Errors[0].find(filter->GetClassName()), std::string::npos);
    EXPECT_NE(
      listener.Errors[0].find(maximum < Any ? "number in [" : "finite number"), std::string::npos)
      << listener.Errors[0];
  }
  EXPECT_EQ(filter->GetMTime(), time);
}
}

#define EXPECT_REFUSED(Filter, Name, minimum, maximum, good) \
  expectRefused<Filter>(#Name, &Filter::Set##Name, &Filter::Get##Name, minimum, maximum, good)

TEST(Properties, OfAllMorphFilters)
{
  const auto test = [](auto filter)
  {
    using Filter = std::remove_pointer_t<decltype(filter)>;
    EXPECT_REFUSED(Filter, ScaleFactor, -Any, Any, -3);
    EXPECT_REFUSED(Filter, StepMemoryLimit, 0, 1e12, 7);
    EXPECT_REFUSED(Filter, MatchTolerance, 0, 1, 0.25);
    EXPECT_REFUSED(Filter, RestTime, -Any, Any, 2);
  };
  test(static_cast<vtkFEMWarpMorph*>(nullptr));
  test(static_cast<vtkInversionFreeMorph*>(nullptr));
  test(static_cast<vtkLBWarpMorph*>(nullptr));
  test(static_cast<vtkRadialBasisMorph*>(nullptr));
  test(static_cast<vtkSimplexLinearMorph*>(nullptr));
  test(static_cast<vtkSimplexNaturalNeighborMorph*>(nullptr));
  test(static_cast<vtkSmoothingMorph*>(nullptr));
  test(static_cast<vtkWeightedResidualMorph*>(nullptr));
}

TEST(Properties, OfSingleMethods)
{
  EXPECT_REFUSED(vtkFEMWarpMorph, Tolerance, 1e-15, 0.999, 1e-3);
  EXPECT_REFUSED(vtkLBWarpMorph, Tolerance, 1e-15, 0.999, 1e-3);
  EXPECT_REFUSED(vtkRadialBasisMorph, SupportRadius, 1e-3, 1e3, 0.5);
  EXPECT_REFUSED(vtkSimplexNaturalNeighborMorph, MemoryLimit, 0, 1e12, 9);
  EXPECT_REFUSED(vtkSmoothingMorph, StopMove, 1e-12, 1, 0.5);
}

TEST(Properties, OfCompareMorphMethods)
{
  EXPECT_REFUSED(vtkCompareMorphMethods, Percentile, 0, 100, 5);
  EXPECT_REFUSED(vtkCompareMorphMethods, ScaleFactor, -Any, Any, 2);
  EXPECT_REFUSED(vtkCompareMorphMethods, MatchTolerance, 0, 1, 0.25);
  EXPECT_REFUSED(vtkCompareMorphMethods, RestTime, -Any, Any, 2);
}

TEST(Properties, OfTheBoundaryFilters)
{
  EXPECT_REFUSED(vtkClassifyBoundary, FeatureAngle, 0, 180, 30);
  EXPECT_REFUSED(vtkClassifyBoundary, CornerAngle, 0, 180, 30);
  EXPECT_REFUSED(vtkMorphBoundary, FeatureAngle, 0, 180, 30);
  EXPECT_REFUSED(vtkMorphBoundary, CornerAngle, 0, 180, 30);
  EXPECT_REFUSED(vtkMorphBoundary, ScaleFactor, -Any, Any, 2);
  EXPECT_REFUSED(vtkMorphBoundary, MatchTolerance, 0, 1, 0.25);
  EXPECT_REFUSED(vtkMorphBoundary, TargetReach, 0, 10, 0.5);
  EXPECT_REFUSED(vtkMorphBoundary, TargetAngle, 0, 180, 30);
  EXPECT_REFUSED(vtkMorphBoundary, RestTime, -Any, Any, 2);
  EXPECT_REFUSED(vtkBoundaryDisplacement, FeatureAngle, 0, 180, 30);
  EXPECT_REFUSED(vtkBoundaryDisplacement, CornerAngle, 0, 180, 30);
  EXPECT_REFUSED(vtkBoundaryDisplacement, FalloffRadius, 0, 10, 0.5);
  EXPECT_REFUSED(vtkBoundaryDisplacement, Distance, -Any, Any, 2);
  EXPECT_REFUSED(vtkBoundaryDisplacement, ScaleFactor, -Any, Any, 2);
}

TEST(Properties, OfMorphMesh)
{
  EXPECT_REFUSED(vtkMorphMesh, FeatureAngle, 0, 180, 30);
  EXPECT_REFUSED(vtkMorphMesh, CornerAngle, 0, 180, 30);
  EXPECT_REFUSED(vtkMorphMesh, FalloffRadius, 0, 10, 0.5);
  EXPECT_REFUSED(vtkMorphMesh, Distance, -Any, Any, 2);
  EXPECT_REFUSED(vtkMorphMesh, RadiusChange, -Any, Any, 2);
  EXPECT_REFUSED(vtkBoundaryDisplacement, RadiusChange, -Any, Any, 2);
  EXPECT_REFUSED(vtkMorphMesh, ScaleFactor, -Any, Any, 2);
  EXPECT_REFUSED(vtkMorphMesh, RestTime, -Any, Any, 2);
}

TEST(Properties, VectorsAreRefusedAsAWhole)
{
  vtkNew<vtkBoundaryDisplacement> filter;
  filter->SetVector(1, 2, 3);
  grids::Listener listener(filter);
  const vtkMTimeType time = filter->GetMTime();
  const double wrong[3] = { 4, 5, NAN };
  filter->SetVector(wrong);
  filter->SetVector(INFINITY, 5, 6);
  filter->SetVector(1, 2, 3);
  EXPECT_EQ(filter->GetMTime(), time);
  EXPECT_EQ(grids::Row(filter->GetVector()), grids::Row(1, 2, 3));
  ASSERT_EQ(listener.Errors.size(), 2u);
  EXPECT_NE(listener.Errors[0].find("Vector cannot be nan"), std::string::npos);
}

TEST(Properties, NumbersOfStepsEndAtAMillion)
{
  vtkNew<vtkFEMWarpMorph> morph;
  morph->SetNumberOfSteps(VTK_INT_MAX);
  EXPECT_EQ(morph->GetNumberOfSteps(), 1000000);
  vtkNew<vtkCompareMorphMethods> compare;
  compare->SetNumberOfSteps(VTK_INT_MAX);
  EXPECT_EQ(compare->GetNumberOfSteps(), 1000000);
  compare->SetNumberOfSteps(0);
  EXPECT_EQ(compare->GetNumberOfSteps(), 1);
}
