// SPDX-License-Identifier: BSD-3-Clause
// Zones and selections of blocks that other ranks have, against the same blocks on one rank.
#include "BlockGrids.h"
#include "Meshes.h"
#include "Pieces.h"
#include "RankGrids.h"
#include "RankTrees.h"
#include "TestGrids.h"

#include <vtkBoundaryDisplacement.h>
#include <vtkDataObjectTreeIterator.h>
#include <vtkFEMWarpMorph.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationIntegerKey.h>
#include <vtkMorphMesh.h>
#include <vtkNew.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkStringArray.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

namespace
{
using grids::Row;
using morph::distributed::Ranks;
using Tree = vtkSmartPointer<vtkDataObjectTree>;

/// The quarters of a ring around the z axis: blocks A, B, C and D.
Tree quarters()
{
  return blocks::multiBlock(blocks::quarters(grids::make(meshes::ring(10, 3, 0.3)), true)).Get();
}

constexpr int FlatIndexOfB = 4;

/// The points of the upper half of block B, by their ids in this rank's part of the block.
vtkSmartPointer<vtkSelection> upperPointsOfB(vtkDataObjectTree* tree)
{
  vtkNew<vtkIdTypeArray> ids;
  const auto item = vtkSmartPointer<vtkDataObjectTreeIterator>::Take(tree->NewTreeIterator());
  for (item->InitTraversal(); !item->IsDoneWithTraversal(); item->GoToNextItem())
  {
    if (item->GetCurrentFlatIndex() == FlatIndexOfB)
    {
      const morph::Points x =
        grids::points(vtkPointSet::SafeDownCast(item->GetCurrentDataObject()));
      for (morph::Index i = 0; i < x.rows(); ++i)
      {
        if (x(i, 2) > 0.4)
        {
          ids->InsertNextValue(i);
        }
      }
    }
  }
  auto selection = vtkSmartPointer<vtkSelection>::New();
  if (ids->GetNumberOfValues() > 0)
  {
    vtkNew<vtkSelectionNode> node;
    node->SetContentType(vtkSelectionNode::INDICES);
    node->SetFieldType(vtkSelectionNode::POINT);
    node->SetSelectionList(ids);
    node->GetProperties()->Set(vtkSelectionNode::COMPOSITE_INDEX(), FlatIndexOfB);
    selection->AddNode(node);
  }
  return selection;
}

/// Calls `check` with this rank's part of each block, and with whole blocks on some rank each.
void onParts(vtkDataObjectTree* whole, const std::function<void(vtkDataObjectTree*)>& check)
{
  const Ranks ranks = pieces::world();
  check(rank_trees::part(ranks, whole, meshes::seed()));
  check(rank_trees::wholeLeaves(ranks, whole));
}

/// Updates `filter`, and expects the points of `serial`. `first`: where errors would be.
void expectPoints(vtkAlgorithm* filter, vtkAlgorithm* serial, vtkAlgorithm* first)
{
  grids::Listener listener(first);
  filter->Update();
  EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  EXPECT_LT(rank_trees::distance(pieces::world(), filter->GetOutputDataObject(0),
              blocks::pointsByNumber(serial->GetOutputDataObject(0))),
    1e-8);
}
}

TEST(RankBlockChoices, SurfacesBetweenBlocksAreListedAndMove)
{
  const Tree whole = quarters();
  const auto configure = [](vtkMorphMesh* filter, vtkDataObjectTree* data)
  {
    filter->SetInputDataObject(data);
    filter->AddSurface("A | C");
    grids::moveBy(filter, 0.02, -0.03, 0.05);
    vtkFEMWarpMorph::SafeDownCast(filter->GetMethodFilter())->SetTolerance(1e-12);
  };
  vtkNew<vtkMorphMesh> serial;
  configure(serial, whole);
  rank_grids::alone([&] { serial->Update(); });
  onParts(whole,
    [&](vtkDataObjectTree* data)
    {
      vtkNew<vtkMorphMesh> mine;
      configure(mine, data);
      expectPoints(mine, serial, mine);
      EXPECT_GE(mine->GetSurfaceSizes()->LookupValue("C | D"), 0);
      EXPECT_EQ(mine->GetPrescribedPoints(), serial->GetPrescribedPoints());
    });
}

TEST(RankBlockChoices, ZonesAreBlocksThatOtherRanksHave)
{
  const Tree whole = quarters();
  const auto configure = [](vtkMorphMesh* filter, vtkDataObjectTree* data, bool isFrozen)
  {
    filter->SetInputDataObject(data);
    filter->SetMovingToSelection();
    filter->SetSelectionData(upperPointsOfB(data));
    grids::moveBy(filter, 0.02, -0.03, 0.05);
    isFrozen ? filter->AddFixedZone("C") : filter->AddSoftZone("C");
    vtkFEMWarpMorph::SafeDownCast(filter->GetMethodFilter())->SetTolerance(1e-12);
  };
  for (const bool isFrozen : { true, false })
  {
    vtkNew<vtkMorphMesh> serial;
    configure(serial, whole, isFrozen);
    rank_grids::alone([&] { serial->Update(); });
    ASSERT_STREQ(serial->GetMorphStatus(), "Valid");
    ASSERT_EQ(serial->GetZonePoints() > 0, isFrozen);
    onParts(whole,
      [&](vtkDataObjectTree* mine)
      {
        vtkNew<vtkMorphMesh> filter;
        configure(filter, mine, isFrozen);
        expectPoints(filter, serial, filter);
        EXPECT_EQ(filter->GetPrescribedPoints(), serial->GetPrescribedPoints());
        EXPECT_EQ(filter->GetZonePoints(), serial->GetZonePoints());
      });
  }
}

TEST(RankBlockChoices, SurfacesOfBlocksSlideInRounds)
{
  const Tree whole = quarters();
  const auto configure = [](vtkMorphMesh* filter, vtkDataObjectTree* data)
  {
    filter->SetInputDataObject(data);
    filter->SetMovingToSelection();
    filter->SetSelectionData(upperPointsOfB(data));
    grids::moveBy(filter, 0.02, -0.03, 0);
    for (const char* name : { "Surface 1", "Surface 2", "Surface 3", "Surface 4" })
    {
      filter->AddSlidingSurface(name);
    }
    filter->SetSlideRounds(2);
    vtkFEMWarpMorph::SafeDownCast(filter->GetMethodFilter())->SetTolerance(1e-12);
  };
  vtkNew<vtkMorphMesh> serial;
  configure(serial, whole);
  grids::Listener listener(serial);
  rank_grids::alone([&] { serial->Update(); });
  ASSERT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  ASSERT_TRUE(serial->GetOutputDataObject(0)->GetFieldData()->HasArray("SlideChange"));
  onParts(whole,
    [&](vtkDataObjectTree* mine)
    {
      vtkNew<vtkMorphMesh> filter;
      configure(filter, mine);
      expectPoints(filter, serial, filter);
    });
}

TEST(RankBlockChoices, AZoneThatNoRankHasIsOneError)
{
  const Ranks ranks = pieces::world();
  vtkNew<vtkMorphMesh> filter;
  const Tree mine = rank_trees::wholeLeaves(ranks, quarters());
  filter->SetInputDataObject(mine);
  filter->SetMovingToSelection();
  filter->SetSelectionData(upperPointsOfB(mine));
  filter->AddFixedZone("Nowhere");
  const grids::Run listener(filter);
  EXPECT_EQ(ranks.sum(static_cast<morph::Index>(listener.Errors.size())), 1);
  for (const std::string& error : listener.Errors)
  {
    EXPECT_NE(error.find("'Nowhere' is neither a set, a point or cell array nor a block"),
      std::string::npos)
      << error;
  }
  EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
}

TEST(RankBlockChoices, SelectionsAreOfEachRanksPartOfABlock)
{
  const Tree whole = quarters();
  const auto configure = [](vtkBoundaryDisplacement* filter, vtkDataObjectTree* data, bool handles)
  {
    filter->SetInputDataObject(data);
    filter->SetMovingToSelection();
    filter->SetSelectionData(upperPointsOfB(data));
    grids::moveBy(filter, 0.02, -0.03, 0.05);
    if (handles)
    {
      filter->SetMovingToEverything();
      filter->SetDisplacementToHandles();
      filter->SelectedHandlesOn();
      filter->SetHandleRadius(1);
    }
  };
  const auto configureMorph =
    [](vtkFEMWarpMorph* morph, vtkDataObjectTree* data, vtkBoundaryDisplacement* displaced)
  {
    morph->SetTolerance(1e-12);
    morph->SetInputDataObject(data);
    morph->SetBoundaryConnection(displaced->GetOutputPort());
  };
  for (const bool handles : { false, true })
  {
    SCOPED_TRACE(handles ? "handles" : "selection");
    vtkNew<vtkBoundaryDisplacement> serialBoundary;
    vtkNew<vtkFEMWarpMorph> serial;
    configure(serialBoundary, whole, handles);
    configureMorph(serial, whole, serialBoundary);
    rank_grids::alone([&] { serial->Update(); });
    ASSERT_STREQ(serial->GetMorphStatus(), "Valid");
    ASSERT_GT(serialBoundary->GetMovingPoints(), 0);
    onParts(whole,
      [&](vtkDataObjectTree* mine)
      {
        vtkNew<vtkBoundaryDisplacement> boundary;
        vtkNew<vtkFEMWarpMorph> filter;
        configure(boundary, mine, handles);
        configureMorph(filter, mine, boundary);
        expectPoints(filter, serial, boundary);
        EXPECT_EQ(boundary->GetMovingPoints(), serialBoundary->GetMovingPoints());
      });
  }
}
