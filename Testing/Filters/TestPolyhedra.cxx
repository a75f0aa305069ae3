// SPDX-License-Identifier: BSD-3-Clause
// Grids with polyhedra through the filters.
#include "../Core/Meshes.h"
#include "../Core/PolyhedralMeshes.h"
#include "AllFilters.h"
#include "BlockGrids.h"
#include "DisplacedBoundaries.h"
#include "MorphFilters.h"
#include "TestGrids.h"

#include "Private/Data/Version.h"
#include "vtkExtractMorphBoundary.h"
#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkMorphShapes.h"
#include "vtkScaledJacobian.h"
#include "vtkSimplexLinearMorph.h"
#include "vtkSmoothingMorph.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataObjectTree.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

using grids::Row;

namespace
{
Row bent(const Row& x)
{
  const double angle = 0.25 * x[2];
  return { (x[0] - 2) * std::cos(angle) - (x[1] - 2) * std::sin(angle),
    (x[0] - 2) * std::sin(angle) + (x[1] - 2) * std::cos(angle), x[2] + 0.1 * x[0] * x[1] / 8 };
}

/// Updates the filter; no error and no warning.
void expectQuiet(vtkAlgorithm* filter)
{
  grids::updateQuietly(filter);
}

std::vector<vtkIdType> faceStream(vtkUnstructuredGrid* grid, vtkIdType cell)
{
  vtkNew<vtkIdList> faces;
  grid->GetFaceStream(cell, faces);
  return { faces->GetPointer(0), faces->GetPointer(0) + faces->GetNumberOfIds() };
}

void expectSameCells(vtkUnstructuredGrid* found, vtkUnstructuredGrid* expected)
{
  ASSERT_EQ(found->GetNumberOfCells(), expected->GetNumberOfCells());
  for (vtkIdType c = 0; c < found->GetNumberOfCells(); ++c)
  {
    ASSERT_EQ(found->GetCellType(c), expected->GetCellType(c));
    EXPECT_EQ(faceStream(found, c), faceStream(expected, c));
  }
}

/// The volume that a closed surface encloses, by its polygons' triangles.
double enclosed(vtkPolyData* surface)
{
  double volume = 0;
  vtkNew<vtkIdList> ids;
  const morph::Points x = grids::points(surface);
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    surface->GetCellPoints(c, ids);
    for (vtkIdType k = 2; k < ids->GetNumberOfIds(); ++k)
    {
      const Row a = x.row(ids->GetId(0)), b = x.row(ids->GetId(k - 1)), d = x.row(ids->GetId(k));
      volume += a.dot(b.cross(d)) / 6;
    }
  }
  return volume;
}

/// The faces of polyhedra as grids have them since VTK 9.4, whatever the release.
struct GridOfLaterReleases
{
  vtkSmartPointer<vtkCellArray> Places, Faces;
  vtkCellArray* GetPolyhedronFaceLocations() { return this->Places; }
  vtkCellArray* GetPolyhedronFaces() { return this->Faces; }
  void SetCells(vtkUnsignedCharArray*, vtkCellArray*) {}
  void SetPolyhedralCells(
    vtkUnsignedCharArray*, vtkCellArray*, vtkCellArray* places, vtkCellArray* faces)
  {
    this->Places = places;
    this->Faces = faces;
  }
};

class Polyhedra : public testing::TestWithParam<grids::MorphFilter>
{
};
}

TEST_P(Polyhedra, AffineMotionsAreExactAndStandingStillChangesNothing)
{
  for (const auto& [name, mesh] : meshes::polyhedral())
  {
    SCOPED_TRACE(name);
    auto grid = grids::make(mesh);
    auto filter = GetParam().of(grid, grids::affine);
    expectQuiet(filter);
    const morph::Points expected = grids::mapped(mesh.points, grids::affine);
    EXPECT_LT((grids::points(filter->GetOutput()) - expected).cwiseAbs().maxCoeff(),
      1e-10 * meshes::size(expected));
    expectSameCells(filter->GetOutput(), grid);
    EXPECT_STREQ(filter->GetMorphStatus(), "Valid");

    auto quality = grids::of<vtkScaledJacobian>(filter->GetOutput());
    expectQuiet(quality);
    EXPECT_EQ(quality->GetMeasuredCells(), mesh.numberOfCells());
    EXPECT_NEAR(quality->GetMinScaledJacobian(), filter->GetMinScaledJacobian(), 1e-14);

    filter->SetBoundaryData(grids::boundary(grid, grids::same));
    expectQuiet(filter);
    EXPECT_TRUE(grids::points(filter->GetOutput()) == mesh.points);
  }
}

INSTANTIATE_TEST_SUITE_P(Filters, Polyhedra, testing::ValuesIn(grids::morphFilters()),
  [](const auto& info) { return info.param.name; });

TEST(PolyhedraInFilters, TheBoundaryIsThatOfTheCells)
{
  for (const auto& [name, mesh] : meshes::polyhedral())
  {
    SCOPED_TRACE(name);
    auto extract = grids::of<vtkExtractMorphBoundary>(grids::make(mesh));
    expectQuiet(extract);
    vtkPolyData* surface = extract->GetOutput();
    const double box = name == "honeycomb" ? 64 * 1.5 * std::sqrt(3.) : 64;
    EXPECT_NEAR(enclosed(surface), box, 1e-10);
    vtkDataArray* ids = surface->GetPointData()->GetArray("MorphPointId");
    for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
    {
      double x[3];
      surface->GetPoint(i, x);
      const auto node = static_cast<morph::Index>(ids->GetTuple1(i));
      EXPECT_EQ(mesh.points.row(node), Row(x[0], x[1], x[2]));
    }
  }
}

TEST(PolyhedraInFilters, EveryFilterTakesThem)
{
  for (const auto& [name, mesh] : meshes::polyhedral())
  {
    auto grid = grids::make(mesh);
    grids::addVectors(grid, "Gradient", morph::Points::Ones(mesh.numberOfNodes(), 3));
    auto boundary = grids::boundary(grid, bent);
    for (const grids::AnyFilter& any : grids::allFilters())
    {
      SCOPED_TRACE(any.name + " on " + name);
      auto filter = any.connected(grid, boundary);
      grids::update(filter);
    }
  }
}

TEST(PolyhedraInFilters, ShapesBlendAsMorphsDo)
{
  const auto shifted = [](const Row& x) -> Row { return x + Row(0, 0.1 * x[2], 0); };
  for (const auto& [name, mesh] : meshes::polyhedral())
  {
    auto grid = grids::make(mesh);
    for (const int method :
      { int(vtkMorphShapes::METHOD_FEMWARP), int(vtkMorphShapes::METHOD_SIMPLEX_LINEAR) })
    {
      SCOPED_TRACE(name + ", method " + std::to_string(method));
      auto shapes = grids::of<vtkMorphShapes>(grid);
      shapes->AddShapeData(grids::boundary(grid, bent));
      shapes->AddShapeData(grids::boundary(grid, shifted));
      shapes->SetMethod(method);
      shapes->SetWeight(0, 0.25);
      shapes->SetWeight(1, -0.5);
      expectQuiet(shapes);
      const auto both = [&](const Row& x) -> Row
      { return x + 0.25 * (bent(x) - x) - 0.5 * (shifted(x) - x); };
      vtkNew<vtkFEMWarpMorph> femwarp;
      vtkNew<vtkSimplexLinearMorph> simplex;
      vtkMorphAlgorithm* morph = femwarp;
      if (method == vtkMorphShapes::METHOD_SIMPLEX_LINEAR)
      {
        morph = simplex;
      }
      morph->SetInputData(grid);
      morph->SetBoundaryData(grids::boundary(grid, both));
      expectQuiet(morph);
      EXPECT_LT((grids::points(shapes->GetOutput()) - grids::points(morph->GetOutput()))
                  .cwiseAbs()
                  .maxCoeff(),
        1e-7);
      EXPECT_NEAR(shapes->GetMinScaledJacobian(), morph->GetMinScaledJacobian(), 1e-6);
      EXPECT_STREQ(shapes->GetMorphStatus(), "Valid");
      EXPECT_GT(shapes->GetLargestFactor(), 1);
      EXPECT_GT(shapes->GetHighestWeight(0), 0.25);
      EXPECT_LT(shapes->GetLowestWeight(0), 0.25);
      EXPECT_TRUE(shapes->GetOutput()->GetFieldData()->HasArray("ShapeHighestWeight"));
      EXPECT_TRUE(shapes->GetOutput()->GetFieldData()->HasArray("ShapeWeights"));
      shapes->SetWeight(0, 0.5);
      shapes->Update();
      EXPECT_EQ(shapes->GetSolveCount(), 2);
    }
  }
}

TEST(PolyhedraInFilters, SmoothingInversionFreeAndRepairGiveValidMeshes)
{
  for (const auto& [name, mesh] : meshes::polyhedral())
  {
    SCOPED_TRACE(name);
    auto grid = grids::make(mesh);
    auto boundary = grids::boundary(grid, bent);
    std::vector<vtkSmartPointer<vtkMorphAlgorithm>> filters = {
      vtkSmartPointer<vtkInversionFreeMorph>::New(), vtkSmartPointer<vtkFEMWarpMorph>::New(),
      vtkSmartPointer<vtkSmoothingMorph>::New(), vtkSmartPointer<vtkFEMWarpMorph>::New()
    };
    filters[1]->SetValidityToRepair();
    filters[3]->PostSmoothOn();
    for (const auto& filter : filters)
    {
      filter->SetInputData(grid);
      filter->SetBoundaryData(boundary);
      grids::update(filter);
      // FEMWARP gives no guarantee, and smoothing its mesh makes it no worse.
      if (filter != filters.back())
      {
        EXPECT_EQ(filter->GetInvertedCells(), 0) << filter->GetClassName();
      }
      EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), mesh.numberOfNodes());
    }
    auto plain = grids::morphed<vtkFEMWarpMorph>(grid, boundary);
    plain->Update();
    EXPECT_LE(filters.back()->GetInvertedCells(), plain->GetInvertedCells());
  }
}

TEST(PolyhedraInFilters, InvertedCellsAreListedAndRepaired)
{
  const morph::Mesh mesh = meshes::honeycomb(4);
  auto grid = grids::make(mesh);
  auto boundary = grids::boundary(
    grid, [](const Row& x) { return Row(x[0], x[1], x[2] + 2.2 * std::sin(x[0])); });
  auto filter = grids::morphed<vtkFEMWarpMorph>(grid, boundary);
  filter->CertifyOn();
  filter->Update();
  const vtkIdType inverted = filter->GetInvertedCells();
  ASSERT_GT(inverted, 0) << "the motion tests nothing";
  EXPECT_STREQ(filter->GetMorphStatus(), "Inverted");
  EXPECT_GE(inverted, filter->GetUncertifiedCells());
  auto* bad = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(1));
  ASSERT_EQ(bad->GetNumberOfCells(), inverted);
  auto again = grids::of<vtkScaledJacobian>(bad);
  again->Update();
  EXPECT_EQ(again->GetMeasuredCells(), inverted);
  vtkDataArray* cells = bad->GetCellData()->GetArray("MorphCellId");
  vtkDataArray* nodes = bad->GetPointData()->GetArray("MorphPointId");
  for (vtkIdType i = 0; i < inverted; ++i)
  {
    const auto cell = static_cast<vtkIdType>(cells->GetTuple1(i));
    std::vector<vtkIdType> faces = faceStream(bad, i);
    for (std::size_t at = 1; at < faces.size();)
    {
      for (const std::size_t end = at + 1 + static_cast<std::size_t>(faces[at]); ++at < end;)
      {
        faces[at] = static_cast<vtkIdType>(nodes->GetTuple1(faces[at]));
      }
    }
    EXPECT_EQ(faces, faceStream(filter->GetOutput(), cell));
  }

  filter->SetValidityToRepair();
  filter->Update();
  EXPECT_LT(filter->GetInvertedCells(), inverted) << filter->GetMorphStatus();
}

TEST(PolyhedraInFilters, BlocksGiveTheMeshThatTheyMakeTogether)
{
  const morph::Mesh mesh = meshes::honeycomb(3);
  auto grid = grids::make(mesh);
  auto boundary = grids::boundary(grid, bent);
  vtkNew<vtkFEMWarpMorph> single, composite;
  single->SetInputData(grid);
  single->SetBoundaryData(boundary);
  expectQuiet(single);
  // Two layers and one, cut by their faces alone.
  std::vector<vtkSmartPointer<vtkUnstructuredGrid>> parts;
  for (const bool upper : { false, true })
  {
    morph::Mesh part;
    part.points = mesh.points;
    for (morph::Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      if ((mesh.points(mesh.cell(c)[0], 2) > 1.5) == upper)
      {
        std::vector<std::vector<morph::Index>> faces;
        morph::Index at = mesh.faceOffsets[c];
        for (; at < mesh.faceOffsets[c + 1]; at += mesh.faces[at] + 1)
        {
          faces.emplace_back(
            mesh.faces.begin() + at + 1, mesh.faces.begin() + at + 1 + mesh.faces[at]);
        }
        meshes::addPolyhedron(part, faces);
      }
    }
    parts.push_back(grids::make(part));
    vtkNew<vtkIdTypeArray> ids;
    ids->SetName("Ids");
    for (morph::Index n = 0; n < mesh.numberOfNodes(); ++n)
    {
      ids->InsertNextValue(n);
    }
    parts.back()->GetPointData()->SetGlobalIds(ids);
  }
  composite->SetInputDataObject(0, blocks::multiBlock(parts));
  composite->SetBoundaryData(boundary);
  grids::update(composite);
  auto* tree = composite->GetOutputDataObject(0);
  const auto moved = blocks::pointsByNumber(vtkDataObjectTree::SafeDownCast(tree));
  const morph::Points expected = grids::points(single->GetOutput());
  for (morph::Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    EXPECT_LT((moved.at(1000 + n) - expected.row(n)).norm(), 1e-9);
  }
}

TEST(PolyhedraInFilters, AnotherMotionOfTheSameBoundaryPreparesNothing)
{
  auto grid = grids::make(meshes::honeycomb(3));
  auto filter = grids::morphed<vtkFEMWarpMorph>(grid, bent);
  expectQuiet(filter);
  filter->SetInputData(grids::copy(grid));
  filter->SetBoundaryData(grids::boundary(grid, grids::affine));
  expectQuiet(filter);
  EXPECT_EQ(filter->GetPrepareCount(), 1);
  // Another cell, though its points are the same.
  morph::Mesh other = meshes::honeycomb(3);
  std::reverse(other.faces.begin() + 1, other.faces.begin() + 7);
  filter->SetInputData(grids::make(other));
  expectQuiet(filter);
  EXPECT_EQ(filter->GetPrepareCount(), 1) << "its faces run alike again";
}

TEST(PolyhedraInFilters, FacesThatTheGridDoesNotHoldAreAnError)
{
  const auto expectError = [](vtkUnstructuredGrid* grid, const char* words)
  {
    for (const grids::AnyFilter& any : grids::allFilters())
    {
      SCOPED_TRACE(any.name);
      auto filter = any.connected(grid, grids::boundary(grids::hexes(2), grids::same));
      grids::expectError(filter, words);
    }
  };
  morph::Mesh mesh = meshes::asPolyhedra(meshes::hexes(2, 2, 2));
  auto good = grids::make(mesh);
  vtkNew<vtkUnsignedCharArray> types;
  types->InsertNextValue(VTK_POLYHEDRON);
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkIdList> nodes;
  good->GetCellPoints(0, nodes);
  cells->InsertNextCell(nodes);
  using morph::filters::Version::SetCells;
  vtkNew<vtkUnstructuredGrid> other;
  const auto withFaces = [&](const std::vector<std::int64_t>& faces)
  {
    other->Initialize();
    other->SetPoints(good->GetPoints());
    SetCells(
      other.Get(), types.Get(), cells.Get(), { 0, static_cast<std::int64_t>(faces.size()) }, faces);
    grids::addVectors(other, "Gradient", mesh.points);
    return other.Get();
  };
  std::vector<std::int64_t> faces(
    mesh.faces.begin(), mesh.faces.begin() + static_cast<std::ptrdiff_t>(mesh.faceOffsets[1]));
  auto filter = grids::of<vtkScaledJacobian>(withFaces(faces));
  expectQuiet(filter);
  expectError(withFaces({}), "faces the grid does not hold: cell ids 0");
  auto open = faces;
  open.resize(open.size() - 5);
  expectError(withFaces(open), "not closed");
  auto wrong = faces;
  wrong[1] = 1000;
  expectError(withFaces(wrong), "other nodes");
}

TEST(PolyhedraInFilters, FacesInTwoCellArraysAreReadAndWritten)
{
  using namespace morph::filters::Version;
  static_assert(HasFaceArrays<GridOfLaterReleases>::value, "what tells the releases apart");
  const morph::Mesh mesh = meshes::refinedLayer(1);
  auto grid = grids::make(mesh);
  GridOfLaterReleases later;
  EXPECT_FALSE(AreFacesReadable(&later));
  SetCells(
    &later, vtkNew<vtkUnsignedCharArray>().Get(), grid->GetCells(), mesh.faceOffsets, mesh.faces);
  EXPECT_TRUE(AreFacesReadable(&later));
  std::vector<std::int64_t> faces;
  EXPECT_TRUE(AppendFaces(&later, 0, faces));
  EXPECT_EQ(faces, mesh.faces);
  EXPECT_FALSE(AppendFaces(&later, 1, faces)) << "a hexahedron";
  EXPECT_FALSE(AppendFaces(&later, mesh.numberOfCells(), faces)) << "no cell";
  // A face that does not exist.
  vtkNew<vtkCellArray> wrong;
  wrong->InsertNextCell({ 0, 1, 99 });
  later.Places = wrong;
  EXPECT_FALSE(AppendFaces(&later, 0, faces));

  // The same by the grid of this release.
  vtkNew<vtkUnstructuredGrid> written;
  written->SetPoints(grid->GetPoints());
  vtkNew<vtkUnsignedCharArray> types;
  for (const std::uint8_t type : mesh.types)
  {
    types->InsertNextValue(type);
  }
  SetCells(written.Get(), types.Get(), grid->GetCells(), mesh.faceOffsets, mesh.faces);
  expectSameCells(written, grid);
}
