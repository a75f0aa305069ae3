// SPDX-License-Identifier: BSD-3-Clause
// Composite data whose pieces of blocks are on several ranks, against the same blocks on one.
#include "BlockGrids.h"
#include "Meshes.h"
#include "MorphFilters.h"
#include "Pieces.h"
#include "RankGrids.h"
#include "RankTrees.h"
#include "TestGrids.h"

#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkExtractMorphBoundary.h>
#include <vtkFEMWarpMorph.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkMorphAdjoint.h>
#include <vtkMorphMesh.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPointData.h>
#include <vtkScaledJacobian.h>

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

namespace
{
using grids::Row;
using morph::Index;
using morph::distributed::Ranks;
using rank_trees::distance;

using Tree = vtkSmartPointer<vtkDataObjectTree>;

/// A ring around the z axis, not a box, with a point array.
vtkSmartPointer<vtkUnstructuredGrid> ring()
{
  morph::Mesh mesh = meshes::ring(10, 3, 0.3);
  auto grid = grids::make(mesh);
  grids::addVectors(grid, "Gradient", mesh.points.array().sin().matrix());
  return grid;
}

Row wave(const Row& x)
{
  return x + Row(0, 0, 0.05 * std::hypot(x[0], x[1]) * std::sin(3 * x[0]));
}

vtkSmartPointer<vtkPolyData> moved(vtkDataObject* mesh, const grids::Map& map)
{
  auto extract = grids::of<vtkExtractMorphBoundary>(mesh);
  extract->Update();
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->ShallowCopy(extract->GetOutput());
  result->SetPoints(grids::cloud(grids::mapped(grids::points(result), map))->GetPoints());
  return result;
}

/// The faces of the ring's outer wall as a side set.
vtkSmartPointer<vtkPolyData> wallOf(vtkUnstructuredGrid* whole)
{
  auto extract = grids::of<vtkExtractMorphBoundary>(whole);
  rank_grids::alone([&] { extract->Update(); });
  vtkPolyData* all = extract->GetOutput();
  const morph::Points x = grids::points(all);
  const double most = x.leftCols(2).rowwise().norm().maxCoeff();
  vtkNew<vtkIdList> corners;
  vtkNew<vtkCellArray> faces;
  vtkNew<vtkIdTypeArray> cells;
  cells->SetName("Cell");
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkIdTypeArray> numbers;
  numbers->SetName("Number");
  std::map<vtkIdType, vtkIdType> place;
  for (vtkIdType c = 0; c < all->GetNumberOfCells(); ++c)
  {
    all->GetCellPoints(c, corners);
    const bool isWall = std::all_of(corners->begin(), corners->end(),
      [&](vtkIdType p) { return x.row(p).head(2).norm() > 0.99 * most; });
    if (isWall)
    {
      for (vtkIdType& p : *corners)
      {
        const auto [known, isNew] = place.try_emplace(p, points->GetNumberOfPoints());
        if (isNew)
        {
          points->InsertNextPoint(all->GetPoint(p));
          numbers->InsertNextValue(
            static_cast<vtkIdType>(all->GetPointData()->GetArray("Number")->GetComponent(p, 0)));
        }
        p = known->second;
      }
      faces->InsertNextCell(corners);
      cells->InsertNextValue(
        static_cast<vtkIdType>(all->GetCellData()->GetArray("MorphCellId")->GetComponent(c, 0)));
    }
  }
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPoints(points);
  result->SetPolys(faces);
  result->GetPointData()->AddArray(numbers);
  result->GetCellData()->AddArray(cells);
  return result;
}

enum class Kind
{
  MultiBlock,
  Collection
};

/// The ring's quarters as blocks and its outer wall as a set.
Tree blocksOf(vtkUnstructuredGrid* whole, Kind kind, bool withIds)
{
  const blocks::Pieces pieces = blocks::quarters(whole, withIds);
  const auto wall = wallOf(whole);
  if (kind == Kind::MultiBlock)
  {
    auto tree = blocks::multiBlock(pieces);
    tree->SetBlock(3, wall);
    tree->GetMetaData(3u)->Set(vtkCompositeDataSet::NAME(), "wall");
    return tree.Get();
  }
  auto tree = blocks::collection(pieces);
  vtkNew<vtkPartitionedDataSet> set;
  set->SetPartition(0, wall);
  tree->SetPartitionedDataSet(3, set);
  tree->GetMetaData(3u)->Set(vtkCompositeDataSet::NAME(), "wall");
  return tree.Get();
}

/// Cells of this rank whose value differs from that of the whole, NaN being equal to nothing.
Index wrongCells(vtkDataObject* mine, const std::map<vtkIdType, double>& whole, const char* name)
{
  Index wrong = 0;
  for (const auto& [number, value] : blocks::cellsByNumber(mine, name))
  {
    wrong += !(std::abs(value - whole.at(number)) < 1e-8);
  }
  return wrong;
}

double field(vtkDataObject* data, const char* name)
{
  vtkDataArray* array = data->GetFieldData()->GetArray(name);
  return array ? array->GetComponent(0, 0) : NAN;
}
}

TEST(RankComposite, AllMethodsMoveBlocksAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  unsigned seed = meshes::seed();
  const auto whole = ring();
  for (const grids::MorphFilter& method : grids::morphFilters())
  {
    for (const bool withIds : { true, false })
    {
      for (const Kind kind : { Kind::MultiBlock, Kind::Collection })
      {
        SCOPED_TRACE(method.name + (withIds ? ", ids" : ", no ids") +
                     (kind == Kind::MultiBlock ? ", multi-block" : ", collection"));
        const Tree tree = blocksOf(whole, kind, withIds);
        auto serial = method.make(), filter = method.make();
        rank_grids::alone(
          [&]
          {
            serial->SetInputDataObject(tree);
            serial->SetBoundaryData(moved(tree, wave));
            serial->Update();
          });
        ASSERT_STREQ(serial->GetMorphStatus(), "Valid");
        const Tree part = rank_trees::part(ranks, tree, ++seed);
        filter->SetInputDataObject(part);
        filter->SetBoundaryData(moved(part, wave));
        const grids::Run listener(filter);
        EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
        EXPECT_TRUE(listener.Warnings.empty()) << listener.Warnings[0];
        vtkDataObject* output = filter->GetOutputDataObject(0);
        vtkDataObject* expected = serial->GetOutputDataObject(0);
        EXPECT_STREQ(output->GetClassName(), tree->GetClassName());
        EXPECT_LT(distance(ranks, output, blocks::pointsByNumber(expected)), 1e-8);
        EXPECT_EQ(
          wrongCells(output, blocks::cellsByNumber(expected, "ScaledJacobian"), "ScaledJacobian"),
          0);
        EXPECT_EQ(filter->GetPrescribedPoints(), serial->GetPrescribedPoints());
        EXPECT_NEAR(filter->GetMinScaledJacobian(), serial->GetMinScaledJacobian(), 1e-8);
        EXPECT_NEAR(filter->GetMeanScaledJacobian(), serial->GetMeanScaledJacobian(), 1e-8);
        EXPECT_EQ(field(output, "MinScaledJacobian"), filter->GetMinScaledJacobian());
        // The input is not touched.
        EXPECT_EQ(distance(ranks, part, blocks::pointsByNumber(tree)), 0);

        filter->SetBoundaryData(moved(part, grids::affine));
        filter->Update();
        double most = 0;
        const auto rest = blocks::pointsByNumber(part);
        for (const auto& [number, x] : blocks::pointsByNumber(filter->GetOutputDataObject(0)))
        {
          most = std::max(most, (x - grids::affine(rest.at(number))).norm());
        }
        EXPECT_LT(ranks.maximum(most), 1e-12);
      }
    }
  }
}

TEST(RankComposite, AShellAndABeamOfOtherBlocksComeAlong)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh solid = meshes::hexes(4, 3, 3);
  morph::Mesh shell, beam; // the shell stands on the solid, the beam on the shell
  shell.points.resize(10, 3);
  for (Index i = 0; i < 5; ++i)
  {
    shell.points.row(i) << static_cast<double>(i), 1, 3;
    shell.points.row(5 + i) << static_cast<double>(i), 1, 4.5;
  }
  for (Index i = 0; i < 4; ++i)
  {
    shell.add(morph::Quad, { i, i + 1, i + 6, i + 5 });
  }
  beam.points.resize(2, 3);
  beam.points << 2, 1, 4.5, 2, 1, 6;
  beam.add(morph::Line, { 0, 1 });
  vtkNew<vtkMultiBlockDataSet> tree;
  Index first = 0;
  for (const morph::Mesh& mesh : { beam, shell, solid })
  {
    const auto grid = grids::make(mesh);
    std::vector<Index> numbers = morph::consecutive(mesh.numberOfNodes());
    std::for_each(numbers.begin(), numbers.end(), [&](Index& number) { number += first; });
    grids::addIds(grid, "Number", numbers);
    tree->SetBlock(tree->GetNumberOfBlocks(), grid);
    first += mesh.numberOfNodes();
  }
  const auto withIds = [&tree] // other ones at the same places
  {
    for (unsigned int block = 0; block < 3; ++block)
    {
      vtkPointData* data = vtkDataSet::SafeDownCast(tree->GetBlock(block))->GetPointData();
      data->SetGlobalIds(data->GetArray("Number"));
    }
    return tree.Get();
  };
  const grids::Map turned = [](const Row& x)
  { return Row(0.6 * x[0] - 0.8 * x[2], x[1] + 2, 0.8 * x[0] + 0.6 * x[2]); };
  std::map<vtkIdType, Row> expected = blocks::pointsByNumber(tree);
  for (auto& [number, x] : expected)
  {
    x = turned(x);
  }

  for (const Tree& part : { rank_trees::part(ranks, tree, meshes::seed()),
         rank_trees::wholeLeaves(ranks, tree), rank_trees::part(ranks, withIds(), meshes::seed()) })
  {
    auto filter = vtkSmartPointer<vtkFEMWarpMorph>::New();
    filter->SetInputDataObject(part);
    filter->SetBoundaryData(moved(part, turned));
    const grids::Run listener(filter);
    EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
    EXPECT_TRUE(listener.Warnings.empty()) << listener.Warnings[0];
    EXPECT_LT(distance(ranks, filter->GetOutputDataObject(0), expected), 1e-9);
    EXPECT_EQ(filter->GetAttachedPoints(), 6);
  }
}

TEST(RankComposite, SetsAreNamesAndFollowNodesOfOtherRanks)
{
  const Ranks ranks = pieces::world();
  const auto whole = ring();
  const Tree tree = blocksOf(whole, Kind::MultiBlock, true);
  const auto configured = [](vtkDataObject* data)
  {
    auto filter = vtkSmartPointer<vtkMorphMesh>::New();
    filter->SetSurroundings(0);
    vtkFEMWarpMorph::SafeDownCast(filter->GetMethodFilter())->SetTolerance(1e-12);
    filter->SetInputDataObject(data);
    filter->AddSurface("wall");
    grids::moveBy(filter, -0.05, 0.03, 0.02);
    return filter;
  };
  auto serial = configured(tree);
  rank_grids::alone([&] { serial->Update(); });
  ASSERT_STREQ(serial->GetMorphStatus(), "Valid");
  vtkDataObject* expected = serial->GetOutputDataObject(0);
  const auto quality = blocks::cellsByNumber(expected, "ScaledJacobian");
  // The set is whole on a rank, or cut otherwise than the mesh.
  for (const int ofSets : { -1, 0, ranks.count() - 1 })
  {
    SCOPED_TRACE(ofSets);
    const Tree part = rank_trees::part(ranks, tree, meshes::seed() + 100, ofSets);
    auto filter = configured(part);
    const grids::Run listener(filter);
    EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
    EXPECT_TRUE(listener.Warnings.empty()) << listener.Warnings[0];
    vtkDataObject* output = filter->GetOutputDataObject(0);
    EXPECT_LT(distance(ranks, output, blocks::pointsByNumber(expected)), 1e-8);
    EXPECT_EQ(wrongCells(output, quality, "ScaledJacobian"), 0);
    EXPECT_EQ(filter->GetPrescribedPoints(), serial->GetPrescribedPoints());
    for (const auto& leaf : blocks::leaves(output))
    {
      auto* set = vtkPolyData::SafeDownCast(leaf);
      const morph::Points x = set ? grids::points(set) : morph::Points(0, 3);
      const auto rest = blocks::pointsByNumber(tree);
      for (Index i = 0; i < x.rows(); ++i)
      {
        const auto number = static_cast<vtkIdType>(
          set->GetPointData()->GetArray("Number")->GetComponent(static_cast<vtkIdType>(i), 0));
        EXPECT_LT((x.row(i) - rest.at(number) - Row(-0.05, 0.03, 0.02)).norm(), 1e-12);
      }
    }
  }
}

TEST(RankComposite, ASetAloneOnARankMovesWithTheMeshOnAnother)
{
  const Ranks ranks = pieces::world();
  const auto whole = ring();
  const Tree tree = blocksOf(whole, Kind::Collection, false);
  vtkNew<vtkFEMWarpMorph> serial, filter;
  serial->SetTolerance(1e-12);
  filter->SetTolerance(1e-12);
  rank_grids::alone(
    [&]
    {
      serial->SetInputDataObject(tree);
      serial->SetBoundaryData(moved(tree, wave));
      serial->Update();
    });
  // The mesh on the first rank, the set on the last one.
  const Tree part = rank_trees::withLeaves(tree,
    [&](vtkDataObject* leaf) -> vtkSmartPointer<vtkDataObject>
    {
      const int owner = vtkPolyData::SafeDownCast(leaf) ? ranks.count() - 1 : 0;
      return ranks.rank() == owner ? leaf : nullptr;
    });
  filter->SetInputDataObject(part);
  filter->SetBoundaryData(moved(part, wave));
  grids::update(filter);
  vtkDataObject* output = filter->GetOutputDataObject(0);
  vtkDataObject* expected = serial->GetOutputDataObject(0);
  EXPECT_LT(distance(ranks, output, blocks::pointsByNumber(expected)), 1e-8);
  EXPECT_EQ(
    wrongCells(output, blocks::cellsByNumber(expected, "ScaledJacobian"), "ScaledJacobian"), 0);
}

TEST(RankComposite, WhatCoincidesIsOneNodeAsTheUserSays)
{
  const Ranks ranks = pieces::world();
  morph::Mesh right = meshes::hexes(3, 2, 2);
  right.points.col(0).array() += 3;
  const auto faces = [](vtkDataObject* data, int coincident, std::size_t warnings)
  {
    vtkNew<vtkExtractMorphBoundary> extract;
    grids::Listener listener(extract);
    extract->SetInputDataObject(data);
    extract->SetCoincidentPoints(coincident);
    extract->Update();
    EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
    EXPECT_EQ(listener.Warnings.size(), pieces::world().rank() == 0 ? warnings : 0);
    return static_cast<Index>(extract->GetOutput()->GetNumberOfCells());
  };
  using Morph = vtkMorphAlgorithm;
  for (const Kind kind : { Kind::MultiBlock, Kind::Collection })
  {
    blocks::Pieces boxes = { grids::make(meshes::hexes(3, 2, 2)), grids::make(right) };
    const auto treeOf = [&]
    {
      // Blocks of their own: partitions of one are one body.
      auto multi = vtkSmartPointer<vtkMultiBlockDataSet>::New();
      auto collection = vtkSmartPointer<vtkPartitionedDataSetCollection>::New();
      for (unsigned int i = 0; i < 2; ++i)
      {
        multi->SetBlock(i, boxes[i]);
        vtkNew<vtkPartitionedDataSet> parts;
        parts->SetPartition(0, boxes[i]);
        collection->SetPartitionedDataSet(i, parts);
      }
      return kind == Kind::MultiBlock ? Tree(multi.Get()) : Tree(collection.Get());
    };
    const auto onRanks = [&](int coincident, std::size_t warnings)
    {
      return ranks.sum(
        faces(rank_trees::part(ranks, treeOf(), meshes::seed() + 7), coincident, warnings));
    };
    EXPECT_EQ(onRanks(Morph::COINCIDENT_POINTS_MERGE, 0), 56);
    EXPECT_EQ(onRanks(Morph::COINCIDENT_POINTS_KEEP_APART, 0), 64);
    const auto setIds = [&](int block, vtkIdType first)
    {
      vtkNew<vtkIdTypeArray> ids;
      ids->SetName("Id");
      for (vtkIdType i = 0; i < boxes[block]->GetNumberOfPoints(); ++i)
      {
        ids->InsertNextValue(first + i);
      }
      boxes[block]->GetPointData()->SetGlobalIds(ids);
    };
    // One block has ids, and positions say where the other joins it.
    setIds(0, 0);
    EXPECT_EQ(onRanks(Morph::COINCIDENT_POINTS_MERGE, 0), 56);
    // Ids of their own keep bodies apart.
    setIds(1, 100);
    EXPECT_EQ(onRanks(Morph::COINCIDENT_POINTS_MERGE, 1), 64);
    EXPECT_EQ(onRanks(Morph::COINCIDENT_POINTS_MERGE_BY_POSITION, 0), 56);
    // Both files began with 0: positions count.
    setIds(1, 0);
    EXPECT_EQ(onRanks(Morph::COINCIDENT_POINTS_MERGE, 1), 56);
  }
}

TEST(RankComposite, CellsThatTwoRanksHaveCountOnce)
{
  const auto whole = ring();
  const Tree tree = blocksOf(whole, Kind::MultiBlock, true);
  vtkNew<vtkScaledJacobian> serial, filter;
  serial->SetInputDataObject(tree);
  rank_grids::alone([&] { serial->Update(); });
  // Each rank has all blocks.
  filter->SetInputDataObject(tree);
  grids::update(filter);
  EXPECT_EQ(filter->GetMeasuredCells(), whole->GetNumberOfCells());
  EXPECT_EQ(filter->GetMinScaledJacobian(), serial->GetMinScaledJacobian());
  EXPECT_NEAR(filter->GetMeanScaledJacobian(), serial->GetMeanScaledJacobian(), 1e-12);
}

TEST(RankComposite, ABoundaryAndAGradientMayBeCompositeToo)
{
  const Ranks ranks = pieces::world();
  const auto whole = ring();
  const Tree tree = blocksOf(whole, Kind::MultiBlock, true);
  const auto copyOf = [](vtkDataObjectTree* data)
  {
    return rank_trees::withLeaves(data,
      [](vtkDataObject* leaf) -> vtkSmartPointer<vtkDataObject>
      {
        auto* set = vtkPointSet::SafeDownCast(leaf);
        auto one = vtkSmartPointer<vtkPointSet>::Take(set->NewInstance());
        one->ShallowCopy(set);
        one->SetPoints(grids::cloud(grids::mapped(grids::points(set), wave))->GetPoints());
        return one;
      });
  };
  const auto results = [&](vtkDataObjectTree* data)
  {
    vtkNew<vtkFEMWarpMorph> filter;
    filter->SetTolerance(1e-12);
    filter->SetInputDataObject(data);
    filter->SetInputDataObject(1, copyOf(data));
    const grids::Run listener(filter);
    EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
    vtkNew<vtkMorphAdjoint> adjoint;
    vtkNew<vtkFEMWarpMorph> method;
    method->SetTolerance(1e-12);
    adjoint->SetMorph(method);
    adjoint->SetInputDataObject(0, data);
    adjoint->SetInputDataObject(1, moved(data, wave));
    adjoint->SetGradientArray("Gradient");
    grids::update(adjoint);
    std::map<vtkIdType, Row> gradients;
    auto* points = vtkPointSet::SafeDownCast(adjoint->GetOutputDataObject(0));
    vtkDataArray* array = points ? points->GetPointData()->GetArray("MorphGradient") : nullptr;
    for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
    {
      const double* g = array->GetTuple(i);
      gradients[static_cast<vtkIdType>(
        points->GetPointData()->GetArray("Number")->GetComponent(i, 0))] = Row(g[0], g[1], g[2]);
    }
    return std::pair(blocks::pointsByNumber(filter->GetOutputDataObject(0)), gradients);
  };
  std::pair<std::map<vtkIdType, Row>, std::map<vtkIdType, Row>> expected;
  rank_grids::alone([&] { expected = results(tree); });
  const auto found = results(rank_trees::part(ranks, tree, meshes::seed() + 31));
  ASSERT_FALSE(expected.second.empty());
  for (const auto& [number, x] : found.first)
  {
    EXPECT_LT((x - expected.first.at(number)).norm(), 1e-8);
  }
  EXPECT_GT(ranks.sum(static_cast<Index>(found.second.size())), 0);
  for (const auto& [number, g] : found.second)
  {
    EXPECT_LT((g - expected.second.at(number)).norm(), 1e-8);
  }
}

TEST(RankComposite, OneRanksBadBlockEndsAllWithOneErrorThatNamesIt)
{
  const Ranks ranks = pieces::world();
  const Tree tree = blocksOf(ring(), Kind::MultiBlock, true);
  const auto errorOf = [&](vtkAlgorithm* filter, vtkDataObject* data)
  {
    filter->SetInputDataObject(0, data);
    const grids::Run listener(filter);
    EXPECT_EQ(ranks.sum(static_cast<Index>(listener.Errors.size())), 1);
    // The rank that tells is the first.
    return listener.Errors.empty() ? std::string() : listener.Errors.front();
  };
  const auto expectOnOneRank = [&](const std::string& error, const std::string& text)
  { EXPECT_EQ(ranks.sum(static_cast<Index>(error.find(text) != std::string::npos)), 1) << error; };
  const Tree broken = rank_trees::part(ranks, tree, meshes::seed() + 1);
  const Tree sound = rank_trees::part(ranks, tree, meshes::seed() + 1);
  if (ranks.rank() == ranks.count() - 1)
  {
    const auto block = grids::copy(blocks::grid(broken, 1));
    block->GetPoints()->SetPoint(0, NAN, 0, 0);
    vtkMultiBlockDataSet::SafeDownCast(
      vtkMultiBlockDataSet::SafeDownCast(broken.Get())->GetBlock(0))
      ->SetBlock(2, block);
  }
  vtkNew<vtkExtractMorphBoundary> extract;
  expectOnOneRank(errorOf(extract, broken), "Block 'Solid/B': ");
  EXPECT_EQ(extract->GetOutput()->GetNumberOfCells(), 0);
  // The next input is taken as if nothing had been.
  extract->SetInputDataObject(sound);
  extract->Update();
  EXPECT_GT(ranks.sum(static_cast<Index>(extract->GetOutput()->GetNumberOfCells())), 0);

  vtkSmartPointer<vtkDataObject> mixed = sound.Get();
  if (ranks.rank() == 0)
  {
    mixed = blocks::grid(sound, 0);
  }
  if (ranks.count() > 1)
  {
    expectOnOneRank(
      errorOf(vtkNew<vtkExtractMorphBoundary>(), mixed), "composite data on some MPI ranks");
  }
}
