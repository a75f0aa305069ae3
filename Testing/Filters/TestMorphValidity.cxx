// SPDX-License-Identifier: BSD-3-Clause
// What becomes of inverted cells: vtkMorphAlgorithm's Validity, for linear methods and the inversion-free one.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkSimplexLinearMorph.h"

#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkStringArray.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
/// Steep waves along a 6 x 6 x 6 cube; they turn FEMWARP's cells over.
grids::Row waves(const grids::Row& x)
{
  return { x[0], x[1], x[2] + 2 * std::sin(M_PI / 3 * x[0]) };
}

/// One corner of the cube goes through the opposite face of its cell: all its neighbors are prescribed.
grids::Row cornerPushedIn(const grids::Row& x)
{
  return x.norm() == 0 ? grids::Row(1.5, 1.5, 1.5) : x;
}

/// The top goes below the bottom: no valid mesh, and none with prescribed corners alone at fault up to then.
grids::Row turnedOver(const grids::Row& x)
{
  return { x[0], x[1], x[2] == 6 ? -1. : x[2] };
}

template <typename Filter>
vtkSmartPointer<Filter> morphed(vtkUnstructuredGrid* grid, const grids::Map& map)
{
  auto filter = vtkSmartPointer<Filter>::New();
  filter->SetInputData(grid);
  filter->SetBoundaryData(grids::boundary(grid, map));
  return filter;
}

std::string status(vtkMorphAlgorithm* filter)
{
  auto* array = vtkStringArray::SafeDownCast(
    filter->GetOutput()->GetFieldData()->GetAbstractArray("MorphStatus"));
  return array ? array->GetValue(0) : std::string();
}

class MorphValidity : public testing::Test
{
protected:
  vtkSmartPointer<vtkUnstructuredGrid> Grid = grids::hexes(6);
};
}

TEST_F(MorphValidity, TheCaseNeedsHelp)
{
  auto filter = morphed<vtkFEMWarpMorph>(this->Grid, waves);
  grids::Listener listener(filter);
  EXPECT_EQ(filter->GetValidity(), vtkMorphAlgorithm::VALIDITY_REPORT);
  filter->Update();
  EXPECT_GT(filter->GetInvertedCells(), 0);
  EXPECT_STREQ(filter->GetMorphStatus(), "Inverted");
  EXPECT_EQ(status(filter), "Inverted");
  EXPECT_TRUE(std::isnan(filter->GetLargestValidStep()));
  ASSERT_EQ(listener.Warnings.size(), 1u);
  const std::string worst = std::to_string(filter->GetWorstCellId()) + " at (";
  EXPECT_NE(listener.Warnings[0].find(worst), std::string::npos) << listener.Warnings[0];

  filter->SetValidityToNone();
  filter->Update();
  EXPECT_EQ(listener.Warnings.size(), 1u);
  EXPECT_TRUE(listener.Errors.empty());
}

TEST_F(MorphValidity, RefuseGivesTheUndeformedMesh)
{
  auto filter = morphed<vtkFEMWarpMorph>(this->Grid, waves);
  filter->SetValidityToRefuse();
  grids::Listener listener(filter);
  filter->Update();
  ASSERT_EQ(listener.Errors.size(), 1u);
  EXPECT_NE(listener.Errors[0].find("refused"), std::string::npos) << listener.Errors[0];
  EXPECT_TRUE(grids::points(filter->GetOutput()) == grids::points(this->Grid));
  EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
  EXPECT_EQ(status(filter), "Failed");
  EXPECT_EQ(filter->GetInvertedCells(), -1);
}

TEST_F(MorphValidity, SubStepsAndRepairGiveAValidMesh)
{
  for (int mode : { vtkMorphAlgorithm::VALIDITY_SUB_STEP, vtkMorphAlgorithm::VALIDITY_REPAIR })
  {
    SCOPED_TRACE(mode);
    const bool stepped = mode == vtkMorphAlgorithm::VALIDITY_SUB_STEP;
    const morph::Points target = grids::mapped(grids::points(this->Grid), waves);
    auto filter = morphed<vtkFEMWarpMorph>(this->Grid, waves);
    filter->SetValidityToNone();
    filter->Update();
    EXPECT_GT(filter->GetInvertedCells(), 0);
    filter->SetValidity(mode);
    grids::Listener listener(filter);
    filter->Update();
    EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
    EXPECT_EQ(filter->GetInvertedCells(), 0);
    EXPECT_GT(filter->GetMinScaledJacobian(), 0);
    EXPECT_EQ(filter->GetLargestValidStep(), 1);
    EXPECT_EQ(status(filter), stepped ? "SubStepped" : "Repaired");
    EXPECT_EQ(filter->GetSubSteps() > 1, stepped);
    const morph::Points moved = grids::points(filter->GetOutput());
    const morph::Points rest = grids::points(this->Grid);
    for (morph::Index node = 0; node < rest.rows(); ++node)
    {
      if ((rest.row(node).array() == 0 || rest.row(node).array() == 6).any())
      {
        EXPECT_EQ(moved.row(node), target.row(node)) << node;
      }
    }
  }
}

TEST_F(MorphValidity, WhatIsValidIsLeftAlone)
{
  auto plain = morphed<vtkSimplexLinearMorph>(this->Grid, grids::affine);
  auto checked = morphed<vtkSimplexLinearMorph>(this->Grid, grids::affine);
  checked->SetValidityToRepair();
  plain->Update();
  checked->Update();
  EXPECT_TRUE(grids::points(plain->GetOutput()) == grids::points(checked->GetOutput()));
  EXPECT_EQ(status(checked), "Valid");
}

TEST_F(MorphValidity, BoundariesThatInvertCellsByThemselvesAreNamedAtOnce)
{
  for (int mode : { vtkMorphAlgorithm::VALIDITY_SUB_STEP, vtkMorphAlgorithm::VALIDITY_REPAIR,
         vtkMorphAlgorithm::VALIDITY_REFUSE })
  {
    auto filter = morphed<vtkInversionFreeMorph>(this->Grid, cornerPushedIn);
    filter->SetValidity(mode);
    grids::Listener listener(filter);
    filter->Update();
    ASSERT_EQ(listener.Errors.size(), 1u);
    EXPECT_NE(listener.Errors[0].find("boundary itself inverts 1 cells"), std::string::npos)
      << listener.Errors[0];
    EXPECT_NE(listener.Errors[0].find("cell ids 0."), std::string::npos) << listener.Errors[0];
    EXPECT_TRUE(grids::points(filter->GetOutput()) == grids::points(this->Grid));
    EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
    EXPECT_EQ(filter->GetPrepareCount(), 0);
  }
  // With Report the others are morphed.
  auto filter = morphed<vtkInversionFreeMorph>(this->Grid, cornerPushedIn);
  filter->SetValidityToReport();
  grids::Listener listener(filter);
  filter->Update();
  EXPECT_TRUE(listener.Errors.empty());
  EXPECT_EQ(filter->GetBoundaryDeterminedCells(), 1);
  EXPECT_EQ(filter->GetFoldedBoundaryCells(), 0); // none is named twice
  EXPECT_EQ(filter->GetInvertedCells(), 1);
  EXPECT_EQ(filter->GetWorstCellId(), 0);
}

TEST_F(MorphValidity, TheLargestValidStepIsTheResultWhereThereIsNoMore)
{
  auto filter = morphed<vtkFEMWarpMorph>(this->Grid, turnedOver);
  // Top and bottom alone are prescribed, so no corner is all prescribed, and yet the volume is negative in the end.
  morph::Points rest = grids::points(this->Grid);
  std::vector<morph::Index> ids;
  for (morph::Index i = 0; i < rest.rows(); ++i)
  {
    if (rest(i, 2) == 0 || rest(i, 2) == 6)
    {
      ids.push_back(i);
    }
  }
  auto boundary = grids::cloud(grids::mapped(meshes::rows(rest, ids), turnedOver));
  grids::addIds(boundary, "MorphPointId", ids);
  filter->SetBoundaryData(boundary);
  filter->HoldUnnamedBoundaryOff();
  filter->SetValidityToSubStep();
  grids::Listener listener(filter);
  filter->Update();
  ASSERT_EQ(listener.Errors.size(), 1u);
  EXPECT_NE(listener.Errors[0].find("No valid mesh was found"), std::string::npos)
    << listener.Errors[0];
  EXPECT_EQ(status(filter), "Partial");
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  // The plates meet at 6/7 of the motion.
  EXPECT_GT(filter->GetLargestValidStep(), 6. / 7 - 2. / 256);
  EXPECT_LT(filter->GetLargestValidStep(), 6. / 7);
  const double top = grids::points(filter->GetOutput()).col(2).maxCoeff();
  EXPECT_NEAR(top, 6 - 7 * filter->GetLargestValidStep(), 1e-12);

  filter->SetMaximumSubSteps(2);
  filter->Update();
  EXPECT_EQ(filter->GetSubSteps(), 2);
  EXPECT_LT(filter->GetLargestValidStep(), 0.8);
}

TEST_F(MorphValidity, CertifiesOnRequest)
{
  auto warp = morphed<vtkFEMWarpMorph>(this->Grid, grids::twist);
  warp->Update();
  EXPECT_FALSE(warp->GetOutput()->GetCellData()->HasArray("JacobianCertificate"));
  EXPECT_EQ(warp->GetCertifiedCells(), 0);

  warp->CertifyOn();
  warp->Update();
  EXPECT_EQ(warp->GetPrepareCount(), 1);
  EXPECT_EQ(warp->GetCertifiedCells(), 216);
  EXPECT_EQ(warp->GetUncertifiedCells(), 0);
  EXPECT_EQ(warp->GetUndecidedCells(), 0);
  vtkDataArray* certificate = warp->GetOutput()->GetCellData()->GetArray("JacobianCertificate");
  ASSERT_NE(certificate, nullptr);
  EXPECT_EQ(certificate->GetRange()[0], 1);

  // An input's certificate is not that of the morphed mesh.
  vtkNew<vtkFEMWarpMorph> again;
  again->SetInputData(warp->GetOutput());
  again->SetBoundaryData(grids::boundary(warp->GetOutput(), grids::twist));
  again->Update();
  EXPECT_FALSE(again->GetOutput()->GetCellData()->HasArray("JacobianCertificate"));
  EXPECT_FALSE(again->GetOutput()->GetFieldData()->HasArray("CertifiedCells"));

  auto inverted = morphed<vtkFEMWarpMorph>(this->Grid, waves);
  inverted->CertifyOn();
  inverted->SetValidityToNone();
  inverted->Update();
  EXPECT_GE(inverted->GetUncertifiedCells(), inverted->GetInvertedCells());
  EXPECT_GT(inverted->GetInvertedCells(), 0);

  auto valid = morphed<vtkInversionFreeMorph>(this->Grid, waves);
  valid->Update();
  EXPECT_EQ(valid->GetCertifiedCells(), 216);
}
