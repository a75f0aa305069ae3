// SPDX-License-Identifier: BSD-3-Clause
// Composite data in, the same composite data out: the blocks of a mesh come out as the mesh does.
#include "AllFilters.h"
#include "BlockGrids.h"
#include "MorphFilters.h"

#include "vtkExtractMorphBoundary.h"
#include "vtkFEMWarpMorph.h"
#include "vtkMorphAdjoint.h"

#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataAssembly.h>
#include <vtkDataObjectTree.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

#include <gtest/gtest.h>

#include <cmath>
#include <set>

using grids::Row;

namespace
{
/// A ring around the z axis, not a box, with a point array.
vtkSmartPointer<vtkUnstructuredGrid> ring(int pointType = VTK_DOUBLE)
{
  morph::Mesh mesh = meshes::ring(12, 3, 0.25);
  auto grid = grids::make(mesh, pointType);
  grids::addVectors(grid, "Gradient", mesh.points.array().sin().matrix());
  return grid;
}

/// Moves the outer wall.
Row wave(const Row& x)
{
  return x + Row(0, 0, 0.05 * std::hypot(x[0], x[1]) * std::sin(3 * x[0]));
}

vtkSmartPointer<vtkPolyData> movedBoundary(vtkDataObject* mesh)
{
  auto extract = grids::of<vtkExtractMorphBoundary>(mesh);
  extract->Update();
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->ShallowCopy(extract->GetOutput());
  result->SetPoints(grids::cloud(grids::mapped(grids::points(result), wave))->GetPoints());
  return result;
}

std::map<vtkIdType, Row> pointsOf(vtkPointSet* data)
{
  std::map<vtkIdType, Row> result;
  vtkDataArray* numbers = data->GetPointData()->GetArray("Number");
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    result[static_cast<vtkIdType>(numbers->GetComponent(i, 0))] =
      Eigen::Map<const Row>(data->GetPoint(i));
  }
  return result;
}

std::map<vtkIdType, double> cellsOf(vtkDataSet* data, const char* name)
{
  std::map<vtkIdType, double> result;
  vtkDataArray* numbers = data->GetCellData()->GetArray("Cell");
  vtkDataArray* values = data->GetCellData()->GetArray(name);
  for (vtkIdType c = 0; values && c < data->GetNumberOfCells(); ++c)
  {
    result[static_cast<vtkIdType>(numbers->GetComponent(c, 0))] = values->GetComponent(c, 0);
  }
  return result;
}

double field(vtkDataObject* data, const char* name)
{
  vtkDataArray* array = data->GetFieldData()->GetArray(name);
  return array ? array->GetComponent(0, 0) : NAN;
}

/// Which arrays, of which types and lengths, data sets have.
void expectSameArrays(
  vtkFieldData* found, vtkFieldData* expected, const std::set<std::string>& more)
{
  for (int i = 0; i < expected->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = expected->GetAbstractArray(i);
    vtkAbstractArray* other = found->GetAbstractArray(array->GetName());
    ASSERT_NE(other, nullptr) << array->GetName();
    EXPECT_EQ(other->GetDataType(), array->GetDataType()) << array->GetName();
    ASSERT_EQ(other->GetNumberOfValues(), array->GetNumberOfValues()) << array->GetName();
    for (vtkIdType v = 0; v < array->GetNumberOfValues(); ++v)
    {
      EXPECT_EQ(other->GetVariantValue(v), array->GetVariantValue(v)) << array->GetName();
    }
  }
  for (int i = 0; i < found->GetNumberOfArrays(); ++i)
  {
    const std::string name = found->GetArrayName(i);
    EXPECT_TRUE(expected->HasArray(name.c_str()) || more.count(name)) << name;
  }
}

enum Tree
{
  MultiBlock,
  Collection
};

vtkSmartPointer<vtkDataObject> make(Tree tree, const blocks::Pieces& pieces)
{
  if (tree == MultiBlock)
  {
    return blocks::multiBlock(pieces);
  }
  return blocks::collection(pieces);
}
}

TEST(CompositeData, AllMethodsMoveBlocksAsTheWholeMesh)
{
  auto whole = ring();
  auto boundary = movedBoundary(whole);
  for (const grids::MorphFilter& method : grids::morphFilters())
  {
    auto expected = method.of(whole, boundary);
    expected->Update();
    ASSERT_STREQ(expected->GetMorphStatus(), "Valid") << method.name;
    for (const Tree tree : { MultiBlock, Collection })
    {
      SCOPED_TRACE(method.name + (tree == MultiBlock ? ", multi-block" : ", collection"));
      auto data = make(tree, blocks::quarters(whole, true));
      auto filter = method.make();
      filter->SetInputDataObject(data);
      filter->SetBoundaryData(boundary);
      grids::updateQuietly(filter);
      vtkDataObject* output = filter->GetOutputDataObject(0);
      EXPECT_STREQ(output->GetClassName(), data->GetClassName());
      EXPECT_EQ(filter->GetOutput(), nullptr);
      EXPECT_EQ(blocks::pointsByNumber(output), pointsOf(expected->GetOutput()));
      EXPECT_EQ(blocks::cellsByNumber(output, "ScaledJacobian"),
        cellsOf(expected->GetOutput(), "ScaledJacobian"));
      EXPECT_EQ(filter->GetMinScaledJacobian(), expected->GetMinScaledJacobian());
      EXPECT_EQ(field(output, "MinScaledJacobian"), filter->GetMinScaledJacobian());
      EXPECT_EQ(field(output, "WorstCellId"), expected->GetWorstCellId());
      // The input is not touched.
      EXPECT_EQ(blocks::pointsByNumber(data), pointsOf(whole));
    }
  }
}

TEST(CompositeData, WithoutIdsTheBlocksAreTheMeshInTheirOrder)
{
  auto whole = ring();
  const blocks::Pieces pieces = blocks::quarters(whole, false);
  auto joined = blocks::joined(pieces);
  for (const Tree tree : { MultiBlock, Collection })
  {
    auto data = make(tree, pieces);
    auto boundary = movedBoundary(data);
    auto same = movedBoundary(joined);
    ASSERT_EQ(grids::points(boundary), grids::points(same));
    vtkNew<vtkFEMWarpMorph> filter, expected, original;
    filter->SetInputDataObject(data);
    filter->SetBoundaryData(boundary);
    filter->Update();
    expected->SetInputData(joined);
    expected->SetBoundaryData(same);
    expected->Update();
    EXPECT_EQ(
      blocks::pointsByNumber(filter->GetOutputDataObject(0)), pointsOf(expected->GetOutput()));
    original->SetInputData(whole);
    original->SetBoundaryData(movedBoundary(whole));
    original->Update();
    const auto points = pointsOf(original->GetOutput());
    for (const auto& [number, x] : blocks::pointsByNumber(filter->GetOutputDataObject(0)))
    {
      EXPECT_LE((x - points.at(number)).norm(), 1e-8) << number;
    }
  }
}

TEST(CompositeData, EveryFilterGivesTheResultOfTheWholeMesh)
{
  auto whole = ring();
  // Ids in the mesh itself, too, so that the arrays that filters pass on are the same.
  whole = blocks::cut(
    whole, 1, [](const Row&) { return 0; }, true)[0];
  auto data = make(Collection, blocks::quarters(whole, true));
  auto boundary = movedBoundary(whole);
  for (const grids::AnyFilter& filter : grids::allFilters())
  {
    SCOPED_TRACE(filter.name);
    auto expected = filter.connected(whole, boundary);
    auto found = filter.connected(data, boundary);
    grids::Listener listener(found);
    expected->Update();
    found->Update();
    EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
    for (int port = 0; port < expected->GetNumberOfOutputPorts(); ++port)
    {
      vtkDataObject* one = expected->GetOutputDataObject(port);
      vtkDataObject* other = found->GetOutputDataObject(port);
      if (vtkDataObjectTree::SafeDownCast(other))
      {
        auto* grid = vtkUnstructuredGrid::SafeDownCast(one);
        ASSERT_NE(grid, nullptr);
        EXPECT_EQ(blocks::pointsByNumber(other), pointsOf(grid));
        for (int i = 0; i < grid->GetCellData()->GetNumberOfArrays(); ++i)
        {
          const char* name = grid->GetCellData()->GetArrayName(i);
          EXPECT_EQ(blocks::cellsByNumber(other, name), cellsOf(grid, name)) << name;
        }
        for (int i = 0; i < grid->GetPointData()->GetNumberOfArrays(); ++i)
        {
          const char* name = grid->GetPointData()->GetArrayName(i);
          EXPECT_TRUE(blocks::grid(other, 0)->GetPointData()->HasArray(name)) << name;
        }
        continue;
      }
      ASSERT_STREQ(one->GetClassName(), other->GetClassName());
      if (auto* points = vtkPointSet::SafeDownCast(one))
      {
        EXPECT_EQ(grids::points(vtkPointSet::SafeDownCast(other)), grids::points(points));
        expectSameArrays(
          vtkPointSet::SafeDownCast(other)->GetPointData(), points->GetPointData(), {});
        expectSameArrays(vtkPointSet::SafeDownCast(other)->GetCellData(), points->GetCellData(),
          { "MorphBlockId" });
      }
      else if (auto* table = vtkTable::SafeDownCast(one))
      {
        auto* second = vtkTable::SafeDownCast(other);
        ASSERT_EQ(second->GetNumberOfRows(), table->GetNumberOfRows());
        for (const char* name : { "MinScaledJacobian", "MeanScaledJacobian" })
        {
          for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
          {
            if (table->GetColumnByName(name))
            {
              EXPECT_EQ(second->GetValueByName(row, name), table->GetValueByName(row, name));
            }
          }
        }
      }
    }
  }
}

TEST(CompositeData, NamesMetadataAndArraysStay)
{
  auto whole = ring();
  const blocks::Pieces pieces = blocks::quarters(whole, false);
  vtkNew<vtkStringArray> title;
  title->SetName("Title");
  title->InsertNextValue("a part");
  vtkNew<vtkDoubleArray> own;
  own->SetName("Only in A");
  own->SetNumberOfTuples(pieces[0]->GetNumberOfCells());
  own->Fill(7);
  pieces[0]->GetCellData()->AddArray(own);
  vtkNew<vtkIntArray> inBlock;
  inBlock->SetName("Material");
  inBlock->InsertNextValue(42);
  pieces[1]->GetFieldData()->AddArray(inBlock);
  for (const Tree tree : { MultiBlock, Collection })
  {
    auto data = make(tree, pieces);
    data->GetFieldData()->AddArray(title);
    if (auto* parts = vtkPartitionedDataSetCollection::SafeDownCast(data))
    {
      vtkNew<vtkDataAssembly> assembly;
      assembly->AddDataSetIndex(assembly->AddNode("solids"), 1);
      parts->SetDataAssembly(assembly);
    }
    auto boundary = movedBoundary(data);
    auto filter = grids::morphed<vtkFEMWarpMorph>(data, boundary);
    filter->Update();
    vtkDataObject* output = filter->GetOutputDataObject(0);
    EXPECT_EQ(
      vtkStringArray::SafeDownCast(output->GetFieldData()->GetAbstractArray("Title"))->GetValue(0),
      "a part");
    EXPECT_EQ(data->GetFieldData()->GetNumberOfArrays(), 1);
    if (auto* multi = vtkMultiBlockDataSet::SafeDownCast(output))
    {
      EXPECT_STREQ(multi->GetMetaData(0u)->Get(vtkCompositeDataSet::NAME()), "Solid");
      auto* inner = vtkMultiBlockDataSet::SafeDownCast(multi->GetBlock(0));
      ASSERT_NE(inner, nullptr);
      ASSERT_EQ(inner->GetNumberOfBlocks(), 3u);
      EXPECT_EQ(inner->GetBlock(1), nullptr);
      EXPECT_STREQ(inner->GetMetaData(2u)->Get(vtkCompositeDataSet::NAME()), "B");
      EXPECT_EQ(multi->GetNumberOfBlocks(), 3u);
    }
    else
    {
      auto* parts = vtkPartitionedDataSetCollection::SafeDownCast(output);
      ASSERT_NE(parts, nullptr);
      EXPECT_STREQ(parts->GetMetaData(1u)->Get(vtkCompositeDataSet::NAME()), "B");
      EXPECT_EQ(parts->GetPartitionedDataSet(0)->GetNumberOfPartitions(), 2u);
      ASSERT_NE(parts->GetDataAssembly(), nullptr);
      EXPECT_NE(parts->GetDataAssembly()->FindFirstNodeWithName("solids"), -1);
    }
    const std::set<std::string> results = { "MorphDisplacement", "ScaledJacobian", "MorphPointId",
      "MorphCellId" };
    for (std::size_t i = 0; i < pieces.size(); ++i)
    {
      auto* leaf = blocks::grid(output, i);
      ASSERT_NE(leaf, nullptr);
      expectSameArrays(leaf->GetPointData(), pieces[i]->GetPointData(), results);
      expectSameArrays(leaf->GetCellData(), pieces[i]->GetCellData(), results);
      EXPECT_STREQ(leaf->GetCellData()->GetScalars()->GetName(), "ScaledJacobian");
      EXPECT_STREQ(leaf->GetPointData()->GetVectors()->GetName(), "MorphDisplacement");
      const morph::Points shift = grids::points(leaf) - grids::points(pieces[i]);
      for (vtkIdType n = 0; n < leaf->GetNumberOfPoints(); ++n)
      {
        EXPECT_EQ(Row(Eigen::Map<const Row>(leaf->GetPointData()->GetVectors()->GetTuple3(n))),
          Row(shift.row(n)));
      }
    }
    EXPECT_EQ(field(blocks::grid(output, 1), "Material"), 42);
  }
}

TEST(CompositeData, MorphPointIdNumbersTheMergedMesh)
{
  auto whole = ring();
  auto data = make(MultiBlock, blocks::quarters(whole, true));
  auto filter = grids::morphed<vtkFEMWarpMorph>(data, movedBoundary(data));
  filter->Update();
  // With global ids: in their order, which is that of the whole mesh.
  for (const auto& leaf : blocks::leaves(filter->GetOutputDataObject(0)))
  {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(leaf);
    vtkDataArray* ids = grid->GetPointData()->GetArray("MorphPointId");
    vtkDataArray* cells = grid->GetCellData()->GetArray("MorphCellId");
    for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
    {
      EXPECT_EQ(ids->GetComponent(i, 0) + 1000,
        grid->GetPointData()->GetArray("Number")->GetComponent(i, 0));
    }
    for (vtkIdType i = 0; i < grid->GetNumberOfCells(); ++i)
    {
      EXPECT_EQ(cells->GetComponent(i, 0) + 2000,
        grid->GetCellData()->GetArray("Cell")->GetComponent(i, 0));
    }
  }
}

TEST(CompositeData, WhatIsPreparedIsKeptWhileTheBlocksAreTheSame)
{
  auto whole = ring();
  const blocks::Pieces pieces = blocks::quarters(whole, false);
  vtkNew<vtkFEMWarpMorph> filter;
  auto boundary = movedBoundary(make(Collection, pieces));
  filter->SetBoundaryData(boundary);
  for (int i = 0; i < 3; ++i)
  {
    auto again = make(Collection, pieces); // as a reader that executes again
    if (i == 2)
    {
      for (const auto& piece : pieces)
      {
        piece->GetPoints()->Modified();
        piece->GetPoints()->GetData()->Modified();
      }
    }
    filter->SetInputDataObject(again);
    filter->Update();
  }
  EXPECT_EQ(filter->GetPrepareCount(), 1);
  const auto before = blocks::pointsByNumber(filter->GetOutputDataObject(0));
  for (const auto& piece : pieces)
  {
    piece->SetPoints(grids::cloud(2 * grids::points(piece))->GetPoints());
  }
  auto changed = make(Collection, pieces);
  filter->SetInputDataObject(changed);
  filter->SetBoundaryData(movedBoundary(changed));
  filter->Update();
  EXPECT_EQ(filter->GetPrepareCount(), 2);
  EXPECT_NE(blocks::pointsByNumber(filter->GetOutputDataObject(0)), before);
}

TEST(CompositeData, StepsOfBlocksAreThoseOfTheWholeMesh)
{
  auto whole = ring();
  auto data = make(MultiBlock, blocks::quarters(whole, true));
  auto boundary = movedBoundary(whole);
  for (const int stepping :
    { vtkMorphAlgorithm::STEPPING_ABSOLUTE, vtkMorphAlgorithm::STEPPING_RELATIVE })
  {
    vtkNew<vtkFEMWarpMorph> filter, expected;
    filter->SetInputDataObject(data);
    expected->SetInputDataObject(whole);
    for (vtkFEMWarpMorph* one : { filter.Get(), expected.Get() })
    {
      one->SetBoundaryData(boundary);
      one->SetNumberOfSteps(3);
      one->SetStepping(stepping);
    }
    for (const double time : { 2., 1., 3. })
    {
      filter->UpdateTimeStep(time);
      expected->UpdateTimeStep(time);
      vtkDataObject* output = filter->GetOutputDataObject(0);
      EXPECT_EQ(blocks::pointsByNumber(output), pointsOf(expected->GetOutput()));
      EXPECT_EQ(output->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), time);
    }
  }
}

TEST(CompositeData, TypesOfOneFilterMayAlternate)
{
  auto whole = ring();
  auto data = make(Collection, blocks::quarters(whole, true));
  auto boundary = movedBoundary(whole);
  vtkNew<vtkFEMWarpMorph> filter;
  EXPECT_NE(filter->GetOutput(), nullptr); // as before the first execution of any VTK filter
  filter->SetBoundaryData(boundary);
  filter->SetInputData(whole);
  filter->Update();
  const auto expected = pointsOf(filter->GetOutput());
  filter->SetInputDataObject(data);
  filter->Update();
  EXPECT_EQ(blocks::pointsByNumber(filter->GetOutputDataObject(0)), expected);
  filter->SetInputData(whole);
  filter->Update();
  ASSERT_NE(filter->GetOutput(), nullptr);
  EXPECT_EQ(pointsOf(filter->GetOutput()), expected);
  EXPECT_FALSE(filter->GetOutput()->GetPointData()->HasArray("MorphPointId"));
}

TEST(CompositeData, AMovedCopyOfTheBlocksIsABoundary)
{
  auto whole = ring();
  const blocks::Pieces pieces = blocks::quarters(whole, true);
  auto data = make(MultiBlock, pieces);
  vtkNew<vtkFEMWarpMorph> expected, filter;
  expected->SetInputData(whole);
  expected->SetBoundaryData(movedBoundary(whole));
  expected->Update();
  filter->SetInputDataObject(data);
  const auto moved = [&](const grids::Map& map)
  {
    blocks::Pieces copies;
    for (const auto& piece : pieces)
    {
      copies.push_back(grids::copy(piece));
      copies.back()->SetPoints(grids::cloud(grids::mapped(grids::points(piece), map))->GetPoints());
    }
    return copies;
  };
  filter->SetBoundaryData(make(Collection, moved(wave)));
  filter->Update();
  EXPECT_EQ(
    blocks::pointsByNumber(filter->GetOutputDataObject(0)), pointsOf(expected->GetOutput()));

  // A block that moves alone tears the mesh.
  blocks::Pieces torn = moved(wave);
  torn[1] = moved([](const Row& x) { return Row(x + Row(0, 0, 1)); })[1];
  filter->SetBoundaryData(make(Collection, torn));
  grids::expectError(filter, "several positions for one node");
  EXPECT_EQ(blocks::pointsByNumber(filter->GetOutputDataObject(0)), pointsOf(whole));

  // Pieces of a boundary with MorphPointId.
  auto boundary = movedBoundary(data);
  vtkNew<vtkMultiBlockDataSet> parts;
  parts->SetBlock(0, boundary);
  filter->SetBoundaryData(parts);
  filter->Update();
  EXPECT_EQ(
    blocks::pointsByNumber(filter->GetOutputDataObject(0)), pointsOf(expected->GetOutput()));
}

TEST(CompositeData, GradientsOfBlocksHaveTheAdjointOfTheWholeMesh)
{
  auto whole = ring();
  const blocks::Pieces pieces = blocks::quarters(whole, true);
  auto data = make(MultiBlock, pieces);
  auto boundary = movedBoundary(whole);
  const auto adjoint = [&](vtkDataObject* mesh, vtkDataObject* gradient)
  {
    vtkNew<vtkFEMWarpMorph> method;
    auto filter = vtkSmartPointer<vtkMorphAdjoint>::New();
    filter->SetMorph(method);
    filter->SetInputDataObject(0, mesh);
    filter->SetBoundaryData(boundary);
    filter->SetGradientData(gradient);
    filter->SetGradientArray("Gradient");
    return filter;
  };
  const auto gradientOf = [](vtkMorphAdjoint* filter)
  {
    filter->Update();
    vtkDataArray* array = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0))
                            ->GetPointData()
                            ->GetArray("MorphGradient");
    std::vector<double> values;
    for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        values.push_back(array->GetComponent(i, j));
      }
    }
    return values;
  };
  auto expected = adjoint(whole, whole);
  auto filter = adjoint(data, data);
  const std::vector<double> values = gradientOf(expected);
  ASSERT_FALSE(values.empty());
  EXPECT_EQ(gradientOf(filter), values);

  blocks::Pieces apart;
  for (const auto& piece : pieces)
  {
    apart.push_back(grids::copy(piece));
  }
  apart[2]->GetPointData()->GetArray("Gradient")->Fill(5);
  auto contradictory = adjoint(data, make(MultiBlock, apart));
  grids::expectError(contradictory, "several values of 'Gradient' for one node");
}
