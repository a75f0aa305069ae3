// SPDX-License-Identifier: BSD-3-Clause
// What becomes of inverted cells: vtkMorphAlgorithm's Validity, for linear methods and the
// inversion-free one.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkMorphMesh.h"
#include "vtkMorphShapes.h"
#include "vtkSimplexLinearMorph.h"

#include <vtkBox.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
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

/// One corner of the cube goes through the opposite face of its cell: all its neighbors are
/// prescribed.
grids::Row cornerPushedIn(const grids::Row& x)
{
  return x.norm() == 0 ? grids::Row(1.5, 1.5, 1.5) : x;
}

/// The top goes below the bottom: no valid mesh, and none with prescribed corners alone at fault up
/// to then.
grids::Row turnedOver(const grids::Row& x)
{
  return { x[0], x[1], x[2] == 6 ? -1. : x[2] };
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
  auto filter = grids::morphed<vtkFEMWarpMorph>(this->Grid, waves);
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
  auto filter = grids::morphed<vtkFEMWarpMorph>(this->Grid, waves);
  filter->SetValidityToRefuse();
  grids::expectError(filter, "refused");
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
    auto filter = grids::morphed<vtkFEMWarpMorph>(this->Grid, waves);
    filter->SetValidityToNone();
    filter->Update();
    EXPECT_GT(filter->GetInvertedCells(), 0);
    filter->SetValidity(mode);
    grids::update(filter);
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
  auto plain = grids::morphed<vtkSimplexLinearMorph>(this->Grid, grids::affine);
  auto checked = grids::morphed<vtkSimplexLinearMorph>(this->Grid, grids::affine);
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
    auto filter = grids::morphed<vtkInversionFreeMorph>(this->Grid, cornerPushedIn);
    filter->SetValidity(mode);
    const grids::Run listener(filter);
    listener.ExpectError("boundary itself inverts 1 cells");
    listener.ExpectError("cell ids 0.");
    EXPECT_TRUE(grids::points(filter->GetOutput()) == grids::points(this->Grid));
    EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
    EXPECT_EQ(filter->GetPrepareCount(), 0);
  }
  // With Report the others are morphed.
  auto filter = grids::morphed<vtkInversionFreeMorph>(this->Grid, cornerPushedIn);
  filter->SetValidityToReport();
  grids::update(filter);
  EXPECT_EQ(filter->GetBoundaryDeterminedCells(), 1);
  EXPECT_EQ(filter->GetFoldedBoundaryCells(), 0); // none is named twice
  EXPECT_EQ(filter->GetInvertedCells(), 1);
  EXPECT_EQ(filter->GetWorstCellId(), 0);
}

TEST_F(MorphValidity, TheLargestValidStepIsTheResultWhereThereIsNoMore)
{
  auto filter = grids::morphed<vtkFEMWarpMorph>(this->Grid, turnedOver);
  // Top and bottom alone are prescribed, so no corner is all prescribed, and yet the volume is
  // negative in the end.
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
  filter->FixUnnamedBoundaryOff();
  filter->SetValidityToSubStep();
  grids::expectError(filter, "No valid mesh was found");
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

TEST_F(MorphValidity, WhatTheBoundaryInvertsIsCountedWhereNoResultIs)
{
  auto filter = grids::morphed<vtkInversionFreeMorph>(this->Grid, cornerPushedIn);
  for (int steps : { 0, 1 })
  {
    filter->SetNumberOfSteps(steps);
    filter->SetSteppingToRelative();
    const grids::Run listener(filter);
    ASSERT_EQ(listener.Errors.size(), 1u);
    EXPECT_EQ(filter->GetBoundaryInvertedCells(), 1);
    EXPECT_EQ(filter->GetBoundaryDeterminedCells(), 1);
    EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
  }
  // The next run does not depend on the last one.
  filter->SetBoundaryData(grids::boundary(this->Grid, grids::affine));
  filter->Update();
  EXPECT_EQ(filter->GetBoundaryInvertedCells(), 0);
  EXPECT_EQ(filter->GetBoundaryDeterminedCells(), 0);
}

TEST_F(MorphValidity, ATangledMeshThatCannotBeUntangledGivesTheBestMeshAndAnError)
{
  // Interior nodes thrown about, and a node of the top past its neighbor: no valid mesh, neither
  // before the motion nor after it. All is to be repaired.
  morph::Mesh mesh = meshes::hexes(6, 6, 6);
  meshes::jitterInterior(mesh, 0.9, meshes::seed());
  auto grid = grids::make(mesh);
  const auto folded = [](const grids::Row& x)
  { return x == grids::Row(3, 3, 6) ? grids::Row(3, 4.4, 6) : x; };
  for (const bool linear : { false, true })
  {
    SCOPED_TRACE(linear);
    vtkSmartPointer<vtkMorphAlgorithm> filter;
    if (linear)
    {
      filter = grids::morphed<vtkSimplexLinearMorph>(grid, folded);
    }
    else
    {
      filter = grids::morphed<vtkInversionFreeMorph>(grid, folded);
    }
    filter->SetValidityToReport();
    {
      const grids::Run listener(filter);
      ASSERT_FALSE(listener.Warnings.empty());
      // The method does not advise itself.
      const std::string& last = listener.Warnings.back();
      EXPECT_EQ(last.find("Morph Inversion Free") != std::string::npos, linear) << last;
    }
    const vtkIdType bad = filter->GetInvertedCells() + filter->GetDegenerateCells();
    ASSERT_GT(bad, 0);
    {
      filter->SetValidityToRepairAll();
      const grids::Run listener(filter);
      ASSERT_EQ(listener.Errors.size(), 1u);
      const std::string& error = listener.Errors[0];
      EXPECT_NE(error.find("the result is the best that was"), std::string::npos) << error;
      EXPECT_NE(
        error.find("cell " + std::to_string(filter->GetWorstCellId()) + " at ("), std::string::npos)
        << error;
      EXPECT_EQ(error.find("Inversion Free"), std::string::npos) << error;
      EXPECT_EQ(error.find("inversion-free"), std::string::npos) << error;
      EXPECT_STREQ(filter->GetMorphStatus(), "Inverted");
      EXPECT_EQ(status(filter), "Inverted");
      EXPECT_TRUE(std::isnan(filter->GetLargestValidStep()));
      EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), grid->GetNumberOfPoints());
      EXPECT_LE(filter->GetInvertedCells() + filter->GetDegenerateCells(), bad);
      EXPECT_GT(filter->GetInvertedCells() + filter->GetDegenerateCells(), 0);
      EXPECT_EQ(filter->GetOutput(1)->GetNumberOfCells(),
        filter->GetInvertedCells() + filter->GetDegenerateCells());
    }
    if (linear)
    {
      // What the minimization has made better is kept.
      EXPECT_LT(filter->GetInvertedCells() + filter->GetDegenerateCells(), bad / 4);
    }
  }
}

TEST_F(MorphValidity, CellsThatWereInvertedBeforeRefuseNothing)
{
  auto grid = grids::copy(this->Grid);
  grid->GetPoints()->SetPoint(0, 1.5, 1.5, 1.5); // no method can mend that
  const auto slightly = [](const grids::Row& x)
  { return x[2] == 6 ? grids::Row(x[0] + 1e-4 * x[1], x[1], x[2]) : x; };
  auto filter = grids::morphed<vtkFEMWarpMorph>(grid, slightly);
  for (int mode : { vtkMorphAlgorithm::VALIDITY_REPORT, vtkMorphAlgorithm::VALIDITY_SUB_STEP,
         vtkMorphAlgorithm::VALIDITY_REPAIR, vtkMorphAlgorithm::VALIDITY_REFUSE })
  {
    SCOPED_TRACE(mode);
    filter->SetValidity(mode);
    const grids::Run listener(filter);
    EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
    ASSERT_FALSE(listener.Warnings.empty());
    EXPECT_NE(listener.Warnings[0].find("Repair all"), std::string::npos) << listener.Warnings[0];
    for (std::size_t i = 1; i < listener.Warnings.size(); ++i) // where the method prepares
    {
      EXPECT_NE(listener.Warnings[i].find("The reference mesh has"), std::string::npos);
    }
    EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
    EXPECT_GT(filter->GetInvertedBefore(), 0);
    EXPECT_EQ(filter->GetInvertedBefore(), filter->GetInvertedCells());
    EXPECT_EQ(filter->GetNewInvertedCells(), 0);
    EXPECT_EQ(filter->GetBoundaryInvertedCells(), 0);
    EXPECT_EQ(filter->GetLargestValidStep(), 1);
  }
  filter->SetValidityToRepairAll();
  grids::expectError(filter, "The boundary itself inverts");
  EXPECT_STREQ(filter->GetMorphStatus(), "Failed");

  auto other = grids::morphed<vtkFEMWarpMorph>(grid, waves); // which inverts others
  other->SetValidityToRefuse();
  grids::expectError(other, " cells are inverted or degenerate by the motion.");
}

TEST_F(MorphValidity, RepairMendsWhatTheMotionMadeAndRepairAllTheRest)
{
  auto grid = grids::make(meshes::hexes(6, 6, 6));
  const vtkIdType inside = 1 + 7 + 49;
  grid->GetPoints()->SetPoint(inside, 2.2, 2.2, 2.2);
  const auto same = [](const grids::Row& x) { return x; };
  auto still = grids::morphed<vtkFEMWarpMorph>(grid, same);
  still->SetValidityToRepair();
  still->Update();
  EXPECT_STREQ(still->GetMorphStatus(), "Valid");
  const vtkIdType before = still->GetInvertedBefore();
  EXPECT_GT(before, 0);
  EXPECT_EQ(grids::points(still->GetOutput()), grids::points(grid));
  still->SetValidityToRepairAll();
  still->Update();
  EXPECT_STREQ(still->GetMorphStatus(), "Repaired");
  EXPECT_EQ(still->GetInvertedCells(), 0);
  EXPECT_EQ(still->GetInvertedBefore(), before);

  auto filter = grids::morphed<vtkFEMWarpMorph>(grid, waves);
  filter->SetValidityToNone();
  filter->Update();
  EXPECT_STREQ(filter->GetMorphStatus(), "Inverted");
  EXPECT_GT(filter->GetNewInvertedCells(), 0);
  for (int mode : { vtkMorphAlgorithm::VALIDITY_REPAIR, vtkMorphAlgorithm::VALIDITY_REPAIR_ALL })
  {
    SCOPED_TRACE(mode);
    filter->SetValidity(mode);
    grids::update(filter);
    EXPECT_STREQ(filter->GetMorphStatus(), "Repaired");
    EXPECT_EQ(filter->GetNewInvertedCells(), 0);
    EXPECT_LE(filter->GetInvertedCells() + filter->GetDegenerateCells(),
      mode == vtkMorphAlgorithm::VALIDITY_REPAIR ? before : 0);
  }
}

TEST_F(MorphValidity, CellsThatAreThereTwiceAndNodesWhereBodiesTouchAreNamed)
{
  morph::Mesh mesh = meshes::hexes(2, 2, 2);
  const std::vector<morph::Index> first(mesh.cell(0), mesh.cell(0) + 8);
  meshes::add(mesh, mesh.types[0], first);
  // One more box, at the highest corner.
  const morph::Mesh box = meshes::hexes(1, 1, 1);
  mesh.points.conservativeResize(27 + 7, 3);
  std::vector<morph::Index> nodes;
  for (morph::Index k = 0; k < 8; ++k)
  {
    nodes.push_back(box.cell(0)[k] == 0 ? 26 : 26 + box.cell(0)[k]);
    mesh.points.row(nodes.back()) = box.points.row(box.cell(0)[k]) + grids::Row(2, 2, 2);
  }
  meshes::add(mesh, mesh.types[0], nodes);
  auto filter = grids::morphed<vtkFEMWarpMorph>(grids::make(mesh), grids::affine);
  const grids::Run listener(filter);
  ASSERT_EQ(listener.Warnings.size(), 2u);
  EXPECT_NE(listener.Warnings[0].find("Cells are there twice"), std::string::npos);
  EXPECT_NE(listener.Warnings[0].find("cell ids 0, 8."), std::string::npos);
  EXPECT_NE(listener.Warnings[1].find("point ids 26."), std::string::npos) << listener.Warnings[1];
}

TEST_F(MorphValidity, SubStepsEndBeforeTheBoundaryFolds)
{
  auto grid = grids::make(meshes::hexes(6, 6, 6));
  const auto folded = [](const grids::Row& x)
  { return x == grids::Row(3, 3, 6) ? grids::Row(3, 4.4, 6) : x; };
  auto filter = grids::morphed<vtkInversionFreeMorph>(grid, folded);
  grids::expectError(filter, "The boundary then folds");
  EXPECT_STREQ(filter->GetMorphStatus(), "Partial");
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  // The node reaches its neighbor at 1 / 1.4 of its way.
  EXPECT_GT(filter->GetLargestValidStep(), 0.5);
  EXPECT_LT(filter->GetLargestValidStep(), 1 / 1.4);
  EXPECT_LE(filter->GetSubSteps(), 3);
}

TEST_F(MorphValidity, SubStepsThatStopPartwayPointToRepairWhereItMaySucceed)
{
  auto filter = grids::morphed<vtkFEMWarpMorph>(this->Grid, waves);
  filter->SetValidityToSubStep();
  filter->SetMaximumSubSteps(1);
  grids::expectError(filter, "`Validity` set to Repair");
  EXPECT_STREQ(filter->GetMorphStatus(), "Partial");
}

TEST_F(MorphValidity, WhereEveryNodeIsPrescribedTheMovedMeshIsTheResult)
{
  auto grid = grids::make(meshes::hexes(1, 1, 1));
  const morph::Points rest = grids::points(grid);
  auto filter = grids::morphed<vtkInversionFreeMorph>(grid, grids::affine);
  filter->Update();
  EXPECT_EQ(status(filter), "Valid");
  EXPECT_TRUE(grids::points(filter->GetOutput()) == grids::mapped(rest, grids::affine));
  EXPECT_EQ(filter->GetCertifiedCells(), 1);

  // All corners right and the middle inside out: a twist of the top by half a turn and a stretch.
  const auto twisted = [](const grids::Row& x)
  { return x[2] > 0 ? grids::Row(1 - 1.2 * (x[1] - .5) - .5, .5 + 1.2 * (x[0] - .5), 1) : x; };
  for (int mode : { vtkMorphAlgorithm::VALIDITY_REPORT, vtkMorphAlgorithm::VALIDITY_SUB_STEP,
         vtkMorphAlgorithm::VALIDITY_REPAIR })
  {
    filter->SetBoundaryData(grids::boundary(grid, twisted));
    filter->SetValidity(mode);
    const grids::Run listener(filter);
    if (mode == vtkMorphAlgorithm::VALIDITY_REPORT)
    {
      EXPECT_TRUE(listener.Errors.empty());
      EXPECT_TRUE(grids::points(filter->GetOutput()) == grids::mapped(rest, twisted));
    }
    EXPECT_EQ(
      filter->GetInvertedCells() > 0, !listener.Errors.empty() || !listener.Warnings.empty());
  }
}

TEST_F(MorphValidity, CertifiesOnRequest)
{
  auto warp = grids::morphed<vtkFEMWarpMorph>(this->Grid, grids::twist);
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
  auto again = grids::morphed<vtkFEMWarpMorph>(
    warp->GetOutput(), grids::boundary(warp->GetOutput(), grids::twist));
  again->Update();
  EXPECT_FALSE(again->GetOutput()->GetCellData()->HasArray("JacobianCertificate"));
  EXPECT_FALSE(again->GetOutput()->GetFieldData()->HasArray("CertifiedCells"));

  auto inverted = grids::morphed<vtkFEMWarpMorph>(this->Grid, waves);
  inverted->CertifyOn();
  inverted->SetValidityToNone();
  inverted->Update();
  EXPECT_GE(inverted->GetUncertifiedCells(), inverted->GetInvertedCells());
  EXPECT_GT(inverted->GetInvertedCells(), 0);

  auto valid = grids::morphed<vtkInversionFreeMorph>(this->Grid, waves);
  valid->Update();
  EXPECT_EQ(valid->GetCertifiedCells(), 216);
}

namespace
{
/// A U of 12 x 2 x 8 cells: the gap between its prongs is 2 wide. They are named Left and Right.
vtkSmartPointer<vtkUnstructuredGrid> twoProngs()
{
  const morph::Mesh block = meshes::hexes(12, 2, 8);
  morph::Mesh u;
  u.points = block.points;
  for (morph::Index c = 0; c < block.numberOfCells(); ++c)
  {
    const grids::Row low = block.points.row(block.cell(c)[0]);
    if (low[0] < 5 || low[0] > 6 || low[2] < 2)
    {
      meshes::add(u, block.types[c], { block.cell(c), block.cell(c) + block.cellSize(c) });
    }
  }
  auto grid = grids::make(u);
  for (const auto& [name, side] : { std::pair("Left", 5.), std::pair("Right", 7.) })
  {
    grids::mark(grid, name, [at = side](const grids::Row& x) { return x[0] == at && x[2] > 2; });
    grids::addTexts(grid, "SurfaceNames", { name });
  }
  return grid;
}

/// The inner side of the left prong moves towards the right one.
grids::Map intoTheGap(double way)
{
  return [way](const grids::Row& x)
  { return x[0] == 5 && x[2] > 2 ? grids::Row(x + grids::Row(way, 0, 0)) : x; };
}
}

TEST(Crossings, AreCountedAndNamedAndAStatus)
{
  auto filter = grids::morphed<vtkFEMWarpMorph>(twoProngs(), intoTheGap(3));
  const grids::Run listener(filter);
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  EXPECT_GT(filter->GetCrossingFaces(), 1);
  EXPECT_EQ(filter->GetOutput()->GetFieldData()->GetArray("CrossingFaces")->GetComponent(0, 0),
    filter->GetCrossingFaces());
  EXPECT_STREQ(filter->GetMorphStatus(), "CrossesItself");
  EXPECT_EQ(status(filter), "CrossesItself");
  EXPECT_TRUE(std::isnan(filter->GetLargestValidStep()));
  listener.ExpectWarning("Right");
  listener.ExpectWarning("Left");
}

TEST(Crossings, AreMarkedOnTheSurface)
{
  auto filter = grids::morphed<vtkFEMWarpMorph>(twoProngs(), intoTheGap(3));
  filter->Update();
  auto* surface = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(2));
  vtkDataArray* crosses = surface->GetCellData()->GetArray("CrossesItself");
  ASSERT_TRUE(crosses);
  ASSERT_EQ(crosses->GetNumberOfTuples(), surface->GetNumberOfCells());
  vtkIdType count = 0;
  for (vtkIdType i = 0; i < crosses->GetNumberOfTuples(); ++i)
  {
    count += crosses->GetComponent(i, 0) != 0;
    double box[6];
    surface->GetCellBounds(i, box);
    EXPECT_TRUE(crosses->GetComponent(i, 0) == 0 || (box[1] >= 7 && box[0] <= 8)) << i;
  }
  EXPECT_EQ(count, filter->GetCrossingFaces());
}

TEST(Crossings, OfShapesAreCountedAndEndTheirRanges)
{
  auto grid = twoProngs();
  auto filter = grids::of<vtkMorphShapes>(grid);
  filter->AddShapeData(grids::boundary(grid, intoTheGap(1)));
  filter->SetWeight(0, 3);
  filter->FindValidRangesOn();
  const grids::Run listener(filter);
  EXPECT_STREQ(filter->GetMorphStatus(), "CrossesItself");
  EXPECT_GT(filter->GetCrossingFaces(), 1);
  listener.ExpectWarning("Right");
  EXPECT_LT(filter->GetHighestWeight(0), 2 + 1e-2); // the gap is 2 wide
  EXPECT_GT(filter->GetHighestWeight(0), 2 - 1e-2);
  EXPECT_NEAR(filter->GetLargestFactor(), filter->GetHighestWeight(0) / 3, 1e-3);
  filter->SetWeight(0, filter->GetHighestWeight(0));
  filter->Update();
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
}

TEST(Crossings, SubStepsEndBeforeThem)
{
  auto filter = grids::morphed<vtkFEMWarpMorph>(twoProngs(), intoTheGap(3));
  filter->SetValidityToSubStep();
  const grids::Run listener(filter);
  EXPECT_STREQ(filter->GetMorphStatus(), "Partial");
  EXPECT_EQ(filter->GetCrossingFaces(), 0);
  EXPECT_LE(filter->GetLargestValidStep(), 2. / 3 + 1e-3);
  EXPECT_GT(filter->GetLargestValidStep(), 2. / 3 - 1. / 128);
  listener.ExpectError("runs into itself");
}

TEST(Crossings, AreNoneWhereTheGapStaysOrCloses)
{
  for (const double way : { 1., 1.9, 2. })
  {
    auto filter = grids::morphed<vtkFEMWarpMorph>(twoProngs(), intoTheGap(way));
    const grids::Run listener(filter);
    EXPECT_EQ(filter->GetCrossingFaces(), 0) << way;
    EXPECT_STREQ(filter->GetMorphStatus(), "Valid") << way;
    EXPECT_TRUE(listener.Warnings.empty()) << listener.Warnings[0];
  }
}

TEST(Crossings, AreNotLookedForWhileABoundaryIsDragged)
{
  auto filter = grids::morphed<vtkFEMWarpMorph>(twoProngs(), intoTheGap(3));
  grids::Listener listener(filter);
  filter->SetValidityToNone();
  filter->Update();
  EXPECT_EQ(filter->GetCrossingFaces(), -1);
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
  filter->SetValidityToReport();
  filter->SetQualityToSurface();
  filter->Update();
  EXPECT_EQ(filter->GetCrossingFaces(), -1);
  EXPECT_TRUE(listener.Warnings.empty());
}

TEST(Crossings, HaveTheNamesOfTheSurfaceListWithoutSets)
{
  auto grid = twoProngs();
  grid->GetFieldData()->RemoveArray("SurfaceNames");
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->SetMovingToRegion();
  vtkNew<vtkBox> prong;
  prong->SetBounds(-1, 5.5, -1, 3, 2.5, 9);
  filter->SetRegion(prong);
  grids::moveBy(filter, 3, 0, 0);
  const grids::Run listener(filter);
  EXPECT_STREQ(filter->GetMorphStatus(), "CrossesItself");
  EXPECT_GT(filter->GetCrossingFaces(), 1);
  ASSERT_FALSE(listener.Warnings.empty());
  const std::string& last = listener.Warnings.back();
  EXPECT_NE(last.find("\n  Surface "), std::string::npos) << last;
}
