// SPDX-License-Identifier: BSD-3-Clause
// The progress of every filter as a window shows it.
#include "DisplacedBoundaries.h"
#include "TestGrids.h"

#include "vtkClassifyBoundary.h"
#include "vtkCompareMorphMethods.h"
#include "vtkExtractMorphBoundary.h"
#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkLBWarpMorph.h"
#include "vtkMorphAdjoint.h"
#include "vtkMorphBoundary.h"
#include "vtkRadialBasisMorph.h"
#include "vtkScaledJacobian.h"
#include "vtkSimplexLinearMorph.h"
#include "vtkSimplexNaturalNeighborMorph.h"
#include "vtkSmoothingMorph.h"
#include "vtkWeightedResidualMorph.h"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkNew.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
/// The progress that observers are told in one update.
std::vector<double> progressOf(vtkAlgorithm* filter)
{
  std::vector<double> told;
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(&told);
  observer->SetCallback([](vtkObject*, unsigned long, void* list, void* value)
    { static_cast<std::vector<double>*>(list)->push_back(*static_cast<double*>(value)); });
  const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, observer);
  filter->Modified();
  filter->Update();
  filter->RemoveObserver(tag);
  return told;
}

void expectRise(vtkAlgorithm* filter)
{
  SCOPED_TRACE(filter->GetClassName());
  const std::vector<double> told = progressOf(filter);
  ASSERT_FALSE(told.empty());
  double last = 0;
  for (double value : told)
  {
    EXPECT_GE(value, last);
    EXPECT_LE(value, 1);
    last = value;
  }
  EXPECT_EQ(last, 1);
}

/// Steep enough for inverted cells, so that their repair reports its progress, too.
grids::Row waves(const grids::Row& x)
{
  return { x[0], x[1], x[2] + 1.6 * std::sin(M_PI / 2 * x[0]) };
}

template <typename Filter>
void expectRiseOfMorph()
{
  auto grid = grids::hexes(4);
  for (const grids::Map& map : { grids::Map(grids::twist), grids::Map(waves) })
  {
    for (int validity : { vtkMorphAlgorithm::VALIDITY_NONE, vtkMorphAlgorithm::VALIDITY_SUB_STEP,
           vtkMorphAlgorithm::VALIDITY_REPAIR })
    {
      auto filter = grids::of<Filter>(grid);
      filter->SetBoundaryData(grids::boundary(grid, map));
      filter->SetValidity(validity);
      filter->PostSmoothOn();
      filter->CertifyOn();
      grids::Listener quiet(filter);
      expectRise(filter);
      filter->SetNumberOfSteps(3);
      filter->SetSteppingToRelative();
      expectRise(filter);
    }
  }
}
}

TEST(MorphProgress, OfEveryMorphRises)
{
  expectRiseOfMorph<vtkFEMWarpMorph>();
  expectRiseOfMorph<vtkInversionFreeMorph>();
  expectRiseOfMorph<vtkLBWarpMorph>();
  expectRiseOfMorph<vtkSimplexLinearMorph>();
  expectRiseOfMorph<vtkRadialBasisMorph>();
  expectRiseOfMorph<vtkSimplexNaturalNeighborMorph>();
  expectRiseOfMorph<vtkSmoothingMorph>();
  expectRiseOfMorph<vtkWeightedResidualMorph>();
}

TEST(MorphProgress, OfEveryOtherFilterRises)
{
  auto grid = grids::hexes(4);
  auto moved = grids::boundary(grid, waves);
  auto extract = grids::of<vtkExtractMorphBoundary>(grid);
  expectRise(extract);
  auto classify = grids::of<vtkClassifyBoundary>(grid);
  expectRise(classify);
  auto quality = grids::of<vtkScaledJacobian>(grid);
  quality->CertifyOn();
  expectRise(quality);
  auto boundary = grids::of<vtkMorphBoundary>(grid);
  boundary->SetBoundaryData(moved);
  expectRise(boundary);
  expectRise(displaced::make(grid));
  auto compare = grids::of<vtkCompareMorphMethods>(grid);
  compare->SetBoundaryData(moved);
  compare->SetNumberOfSteps(2);
  expectRise(compare);
  vtkNew<vtkFEMWarpMorph> morph;
  auto carrier = grids::copy(grid);
  grids::addVectors(carrier, "Gradient", morph::Points::Ones(grid->GetNumberOfPoints(), 3));
  auto adjoint = grids::of<vtkMorphAdjoint>(grid);
  adjoint->SetBoundaryData(moved);
  adjoint->SetGradientData(carrier);
  adjoint->SetGradientArray("Gradient");
  adjoint->SetMorph(morph);
  expectRise(adjoint);
}
