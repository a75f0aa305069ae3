// SPDX-License-Identifier: BSD-3-Clause
// The boundary's filters on random partitions, against the same filters on the whole mesh.
#include "Meshes.h"
#include "Pieces.h"
#include "PolyhedralMeshes.h"
#include "Private/Displace/Zones.h"
#include "Private/Distributed/WholeSurface.h"
#include "RankGrids.h"
#include "RankParts.h"
#include "TestGrids.h"

#include <vtkBoundaryDisplacement.h>
#include <vtkCellData.h>
#include <vtkClassifyBoundary.h>
#include <vtkDataArray.h>
#include <vtkDataArraySelection.h>
#include <vtkDoubleArray.h>
#include <vtkFEMWarpMorph.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkMorphBoundary.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkSphereSource.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <iostream>
#include <map>
#include <set>

namespace
{
using morph::Index;
using morph::distributed::Ranks;

std::vector<std::pair<std::string, morph::Mesh>> shapes()
{
  auto all = meshes::all(4, 3, 3);
  for (auto& polyhedral : meshes::polyhedral())
  {
    all.push_back(std::move(polyhedral));
  }
  return all;
}

/// A mesh whose sides are bent, so that its surfaces are not planes.
void bend(morph::Mesh& mesh)
{
  meshes::transform(mesh, [](const grids::Row& x)
    { return grids::Row(x[0] + 0.1 * x[1] * x[1], x[1] - 0.05 * x[0] * x[2], x[2] + 0.1 * x[0]); });
}

/// Rows of an array by global id; `ids`: "MorphPointId", or null for global point ids.
void expectSameRows(vtkDataSetAttributes* mine, vtkDataSetAttributes* whole, const char* name,
  const std::vector<vtkIdType>& numbers)
{
  vtkDataArray* a = mine->GetArray(name);
  vtkDataArray* b = whole->GetArray(name);
  EXPECT_TRUE(a && b) << name;
  for (vtkIdType i = 0; a && b && i < a->GetNumberOfTuples(); ++i)
  {
    for (int j = 0; j < a->GetNumberOfComponents(); ++j)
    {
      EXPECT_EQ(a->GetComponent(i, j), b->GetComponent(numbers[i], j)) << name << ' ' << i;
    }
  }
}

std::vector<vtkIdType> values(vtkDataArray* array)
{
  std::vector<vtkIdType> result;
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    result.push_back(static_cast<vtkIdType>(array->GetComponent(i, 0)));
  }
  return result;
}

/// For each point of `mine` the point of `whole` with the same MorphPointId.
std::vector<vtkIdType> samePoints(vtkPolyData* mine, vtkPolyData* whole)
{
  std::map<vtkIdType, vtkIdType> place;
  const auto ids = values(whole->GetPointData()->GetArray("MorphPointId"));
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    place[ids[i]] = static_cast<vtkIdType>(i);
  }
  std::vector<vtkIdType> result;
  for (const vtkIdType id : values(mine->GetPointData()->GetArray("MorphPointId")))
  {
    EXPECT_TRUE(place.count(id)) << id;
    result.push_back(place[id]);
  }
  return result;
}

/// The polygons by their points' ids, and the value of a cell array.
std::multimap<std::vector<vtkIdType>, double> cells(vtkPolyData* surface, const char* name)
{
  std::multimap<std::vector<vtkIdType>, double> result;
  const auto ids = values(surface->GetPointData()->GetArray("MorphPointId"));
  vtkDataArray* array = surface->GetCellData()->GetArray(name);
  vtkNew<vtkIdList> points;
  for (vtkIdType c = 0; array && c < surface->GetNumberOfCells(); ++c)
  {
    surface->GetCellPoints(c, points);
    std::vector<vtkIdType> key;
    for (vtkIdType k = 0; k < points->GetNumberOfIds(); ++k)
    {
      key.push_back(ids[points->GetId(k)]);
    }
    result.emplace(key, array->GetComponent(c, 0));
  }
  return result;
}

/// Points, polygons and arrays of all ranks' parts are those of the whole.
void expectSameSurface(const Ranks& ranks, vtkPolyData* mine, vtkPolyData* whole,
  const std::vector<const char*>& ofPoints, const std::vector<const char*>& ofCells)
{
  const std::vector<vtkIdType> numbers = samePoints(mine, whole);
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    double a[3], b[3];
    mine->GetPoint(static_cast<vtkIdType>(i), a);
    whole->GetPoint(numbers[i], b);
    EXPECT_EQ(std::vector<double>(a, a + 3), std::vector<double>(b, b + 3));
  }
  for (const char* name : ofPoints)
  {
    expectSameRows(mine->GetPointData(), whole->GetPointData(), name, numbers);
  }
  for (const char* name : ofCells)
  {
    const auto all = cells(whole, name);
    for (const auto& [points, value] : cells(mine, name))
    {
      const auto found = all.equal_range(points);
      EXPECT_TRUE(std::any_of(found.first, found.second,
        [value = value](const auto& cell) { return cell.second == value; }))
        << name;
    }
  }
  EXPECT_EQ(ranks.sum(static_cast<Index>(mine->GetNumberOfCells())), whole->GetNumberOfCells());
  const auto all = ranks.gather(numbers);
  EXPECT_EQ(static_cast<vtkIdType>(std::set<vtkIdType>(all.begin(), all.end()).size()),
    whole->GetNumberOfPoints());
}

void expectNoErrors(const grids::Listener& listener)
{
  EXPECT_TRUE(listener.Errors.empty()) << listener.Errors.front();
}
}

TEST(RankBoundary, ClassifyHasTheSerialSurfacesAndCurves)
{
  const Ranks ranks = pieces::world();
  unsigned seed = meshes::seed();
  for (auto& [name, mesh] : shapes())
  {
    SCOPED_TRACE(name);
    bend(mesh);
    vtkNew<vtkClassifyBoundary> serial, filter;
    const auto whole = grids::make(mesh);
    serial->SetInputData(whole);
    rank_grids::alone([&] { serial->Update(); });
    filter->SetInputData(rank_grids::part(ranks, whole, mesh, ++seed));
    const grids::Run listener(filter);
    expectNoErrors(listener);
    EXPECT_EQ(filter->GetNumberOfVertices(), serial->GetNumberOfVertices());
    EXPECT_EQ(filter->GetNumberOfCurves(), serial->GetNumberOfCurves());
    EXPECT_EQ(filter->GetNumberOfSurfaces(), serial->GetNumberOfSurfaces());
    vtkUnstructuredGrid* output = filter->GetOutput();
    const auto ids = values(output->GetPointData()->GetGlobalIds());
    EXPECT_EQ(static_cast<vtkIdType>(ids.size()), output->GetNumberOfPoints());
    const std::vector<const char*> arrays = { "GeometryDimension", "GeometryId", "CurveParameter",
      "Number" };
    for (const char* array : arrays)
    {
      expectSameRows(output->GetPointData(), serial->GetOutput()->GetPointData(), array, ids);
    }
    expectSameSurface(ranks, filter->GetSurfaces(), serial->GetSurfaces(), arrays,
      { "GeometryId", "MorphCellId", "Cell" });
    expectSameSurface(ranks, filter->GetCurves(), serial->GetCurves(),
      { "GeometryDimension", "GeometryId", "CurveParameter" },
      { "GeometryDimension", "GeometryId" });
  }
}

TEST(RankBoundary, DisplacementMovesWhatItMovesOnOneRank)
{
  const Ranks ranks = pieces::world();
  unsigned seed = meshes::seed();
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(1.2, 0, 0);
  vtkNew<vtkSphereSource> ball;
  ball->SetCenter(2, 1.5, 1.5);
  ball->SetRadius(2.4);
  ball->SetThetaResolution(40);
  ball->SetPhiResolution(40);
  ball->Update();
  morph::Points places(2, 3), by(2, 3);
  places << 1, 1, 1, 3, 3, 3;
  by << 0, 0, 0.1, 0.2, 0, 0;
  const auto handles = grids::cloud(places);
  grids::addVectors(handles, "Displacement", by);
  vtkNew<vtkImageData> field;
  field->SetDimensions(7, 7, 7);
  vtkNew<vtkDoubleArray> values;
  values->SetName("U");
  values->SetNumberOfComponents(3);
  for (vtkIdType i = 0; i < field->GetNumberOfPoints(); ++i)
  {
    const double* x = field->GetPoint(i);
    values->InsertNextTuple3(0.01 * x[1] * x[2], 0, 0.02 * x[0]);
  }
  field->GetPointData()->AddArray(values);
  using Filter = vtkBoundaryDisplacement;
  const std::vector<std::pair<std::string, std::function<void(Filter*)>>> cases = {
    { "surface",
      [](Filter* filter)
      {
        filter->SetMovingToSurfaces();
        filter->AddSurface("Surface 1");
        filter->AddFixedSurface("Surface 2");
        filter->SetDisplacementToTranslateRotateScale();
        filter->SetTranslation(0.1, 0.2, -0.1);
        filter->SetRotation(5, 0, 10);
      } },
    { "region along normals",
      [&](Filter* filter)
      {
        filter->SetMovingToRegion();
        filter->SetRegion(plane);
        filter->SetDisplacementToAlongNormals();
        filter->SetDistance(0.1);
        filter->SetSurroundingsToStay();
      } },
    { "array, fading",
      [](Filter* filter)
      {
        filter->SetMovingToArray();
        filter->SetMovingArray("Marked");
        grids::moveBy(filter, 0.1, 0.1, 0.2);
        filter->SetSurroundingsToFade();
      } },
    { "target",
      [&](Filter* filter)
      {
        filter->SetMovingToSurfaces();
        filter->AddSurface("Surface 0");
        filter->SetDisplacementToTarget();
        filter->SetTargetData(ball->GetOutput());
        filter->SetTargetReach(1);
        filter->SetTargetAngle(180);
      } },
    { "handles",
      [&](Filter* filter)
      {
        filter->SetDisplacementToHandles();
        filter->AddHandle(0, 0, 0, 0.1, 0, 0.2, 1.5);
        filter->SetControlPointsData(handles);
      } },
    { "lattice",
      [&](Filter* filter)
      {
        filter->SetDisplacementToLattice();
        filter->SetLatticeSize(3, 4, 2);
        filter->SetLatticeBasisToBSpline();
        filter->AddLatticeDisplacement(1, 2, 1, 0.1, 0.2, -0.1);
      } },
    { "field",
      [&](Filter* filter)
      {
        filter->SetDisplacementToField();
        filter->SetFieldData(field);
        filter->SetFieldArray("U");
        filter->SetFieldDistance(0.1);
      } },
    { "points",
      [&](Filter* filter)
      {
        filter->SetDisplacementToField();
        filter->SetFieldData(handles);
        filter->SetFieldArray("Displacement");
        filter->SetFieldDistance(10);
      } },
  };
  const auto all = shapes();
  for (const std::size_t shape : { 0u, 1u, 3u, 6u, 7u, 9u })
  {
    auto [name, mesh] = all.at(shape);
    bend(mesh);
    const auto whole = grids::make(mesh);
    vtkNew<vtkIdTypeArray> marked;
    marked->SetName("Marked");
    for (vtkIdType i = 0; i < whole->GetNumberOfPoints(); ++i)
    {
      marked->InsertNextValue(whole->GetPoint(i)[2] > 2);
    }
    whole->GetPointData()->AddArray(marked);
    for (const auto& [what, configure] : cases)
    {
      SCOPED_TRACE(name + ", " + what);
      vtkNew<Filter> serial, filter;
      configure(serial);
      serial->SetInputData(whole);
      grids::Listener serialListener(serial);
      rank_grids::alone([&] { serial->Update(); });
      configure(filter);
      if (what == "target" && ranks.rank() > 0)
      {
        filter->SetTargetData(vtkNew<vtkPolyData>()); // as a reader of one file does
      }
      if (what == "handles" && ranks.rank() > 0)
      {
        filter->SetControlPointsData(vtkNew<vtkPolyData>());
      }
      if ((what == "field" || what == "points") && ranks.rank() != ranks.count() / 2)
      {
        filter->SetFieldData(vtkNew<vtkPolyData>());
      }
      filter->SetInputData(rank_grids::part(ranks, whole, mesh, ++seed));
      const grids::Run listener(filter);
      expectNoErrors(listener);
      // One rank speaks for all.
      EXPECT_EQ(listener.Warnings.size(), ranks.rank() == 0 ? serialListener.Warnings.size() : 0);
      EXPECT_EQ(filter->GetMovingPoints(), serial->GetMovingPoints());
      EXPECT_GT(filter->GetMovingPoints(), 0);
      EXPECT_EQ(filter->GetFixedPoints(), serial->GetFixedPoints());
      EXPECT_EQ(filter->GetFollowingPoints(), serial->GetFollowingPoints());
      expectSameSurface(ranks, filter->GetOutput(), serial->GetOutput(),
        { "BoundaryDisplacement", "Role", "RestPosition", "GeometryId", "Number" },
        { "Role", "GeometryId", "MorphCellId" });
      const auto names = [](Filter* of)
      {
        std::vector<std::string> all;
        for (int i = 0; i < of->GetSurfaceList()->GetNumberOfArrays(); ++i)
        {
          all.emplace_back(of->GetSurfaceList()->GetArrayName(i));
        }
        return all;
      };
      EXPECT_EQ(names(filter), names(serial));
    }
  }
}

TEST(RankBoundary, EachRankSelectsInItsPiece)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = meshes::hexes(4, 3, 3);
  const auto whole = grids::make(mesh);
  const auto piece = rank_grids::part(ranks, whole, mesh, meshes::seed());
  const auto select = [](vtkUnstructuredGrid* grid, bool all)
  {
    vtkNew<vtkIdTypeArray> ids;
    for (vtkIdType i = 0; all && i < grid->GetNumberOfPoints(); ++i)
    {
      if (grid->GetPoint(i)[2] > 2.5)
      {
        ids->InsertNextValue(i);
      }
    }
    vtkNew<vtkSelectionNode> node;
    node->SetFieldType(vtkSelectionNode::POINT);
    node->SetContentType(vtkSelectionNode::INDICES);
    node->SetSelectionList(ids);
    auto selection = vtkSmartPointer<vtkSelection>::New();
    selection->AddNode(node);
    return selection;
  };
  const auto configure = [](vtkBoundaryDisplacement* filter)
  {
    filter->SetMovingToSelection();
    grids::moveBy(filter, 0, 0, 1);
  };
  vtkNew<vtkBoundaryDisplacement> serial, filter;
  configure(serial);
  serial->SetInputData(whole);
  serial->SetSelectionData(select(whole, true));
  rank_grids::alone([&] { serial->Update(); });
  configure(filter);
  filter->SetInputData(piece);
  filter->SetSelectionData(select(piece, true));
  const grids::Run listener(filter);
  expectNoErrors(listener);
  EXPECT_EQ(filter->GetMovingPoints(), 5 * 4);
  expectSameSurface(
    ranks, filter->GetOutput(), serial->GetOutput(), { "Role" }, { "Role", "MorphCellId" });

  // Nothing selected anywhere is one error for all.
  filter->SetSelectionData(select(piece, false));
  filter->Update();
  EXPECT_EQ(ranks.sum(static_cast<Index>(listener.Errors.size())), 1);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(RankBoundary, TellsAMorphItsAffineMotionAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  morph::Mesh mesh = meshes::hexes(5, 4, 3);
  bend(mesh);
  const auto whole = grids::make(mesh),
             piece = rank_grids::part(ranks, whole, mesh, meshes::seed());
  const auto morphed = [](vtkUnstructuredGrid* grid, double tolerance, bool isTold)
  {
    auto displace = grids::of<vtkBoundaryDisplacement>(grid);
    displace->SetMovingToSurfaces();
    displace->AddSurface("Surface 1");
    displace->SetDisplacementToTranslateRotateScale();
    displace->SetSurroundingsToFade();
    auto morph = grids::of<vtkFEMWarpMorph>(grid);
    morph->SetTolerance(tolerance);
    for (const double size : { 2, 1 }) // drags it back
    {
      displace->SetTranslation(0.1 * size, 0, 0.1 * size);
      displace->SetRotation(5 * size, 0, 10 * size);
      displace->Update();
      vtkNew<vtkPolyData> boundary;
      boundary->ShallowCopy(displace->GetOutput());
      if (!isTold)
      {
        boundary->GetPointData()->RemoveArray("AffineFields");
      }
      morph->SetBoundaryData(boundary);
      grids::update(morph);
    }
    return vtkSmartPointer<vtkUnstructuredGrid>(morph->GetOutput());
  };
  vtkSmartPointer<vtkUnstructuredGrid> serial;
  rank_grids::alone([&] { serial = morphed(whole, 1e-12, true); });

  EXPECT_LT(rank_grids::distance(ranks, morphed(piece, 1e-12, true), serial), 1e-9);

  // Four fields are solved for, so that another part of the tolerance is left.
  const morph::Points told = grids::points(morphed(piece, 1e-2, true)),
                      untold = grids::points(morphed(piece, 1e-2, false));
  EXPECT_GT(ranks.maximum(told.rows() > 0 ? (told - untold).norm() : 0.), 1e-9);
}

TEST(RankBoundary, MorphBoundaryMovesTheRestAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  unsigned seed = meshes::seed();
  const auto moved = [](vtkUnstructuredGrid* grid)
  {
    // Surface 1 alone is told where to go.
    auto displace = grids::of<vtkBoundaryDisplacement>(grid);
    displace->SetMovingToSurfaces();
    displace->AddSurface("Surface 1");
    displace->SetDisplacementToTranslateRotateScale();
    displace->SetTranslation(0.1, 0.2, -0.1);
    displace->SetRotation(5, 0, 10);
    displace->SetSurroundingsToStay();
    displace->Update();
    vtkPolyData* output = displace->GetOutput();
    vtkDataArray* ofPoints = output->GetPointData()->GetArray("MorphPointId");
    std::vector<Index> places, ids;
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      if (output->GetPointData()->GetArray("Role")->GetComponent(i, 0) == 1)
      {
        places.push_back(static_cast<Index>(i));
        ids.push_back(static_cast<Index>(ofPoints->GetComponent(i, 0)));
      }
    }
    const auto result = grids::cloud(grids::points(output)(places, morph::allColumns));
    grids::addIds(result, "MorphPointId", ids);
    return result;
  };
  vtkNew<vtkSphereSource> ball;
  ball->SetCenter(2, 1.5, 1.5);
  ball->SetRadius(2.4);
  ball->Update();
  for (auto& [name, mesh] : { std::pair("hexes", meshes::hexes(5, 4, 3)),
         std::pair("quadratic", meshes::quadraticTets(3, 2, 2)) })
  {
    for (const int method : { 0, 1, 2 })
    {
      for (const bool projects : { false, true })
      {
        SCOPED_TRACE(std::string(name) + " " + std::to_string(method));
        const auto whole = grids::make(mesh);
        const auto piece = rank_grids::part(ranks, whole, mesh, ++seed);
        vtkNew<vtkMorphBoundary> serial, filter;
        const auto run = [&](vtkMorphBoundary* of, vtkUnstructuredGrid* grid)
        {
          of->SetInputData(grid);
          of->SetBoundaryData(moved(grid));
          of->SetPrescribedDimension(2);
          of->SetSurfaceMethod(method);
          if (projects)
          {
            of->SetTargetData(ball->GetOutput());
          }
          const grids::Run listener(of);
          expectNoErrors(listener);
          return listener.Warnings.size();
        };
        std::size_t warnings = 0;
        rank_grids::alone([&] { warnings = run(serial, whole); });
        EXPECT_EQ(run(filter, piece), ranks.rank() == 0 ? warnings : 0);
        EXPECT_GT(serial->GetGivenPoints(), 0);
        EXPECT_EQ(filter->GetGivenPoints(), serial->GetGivenPoints());
        EXPECT_EQ(filter->GetFixedVertices(), serial->GetFixedVertices());
        EXPECT_EQ(filter->GetProjectedPoints(), serial->GetProjectedPoints());
        EXPECT_EQ(filter->GetMinScaledJacobian(), serial->GetMinScaledJacobian());
        EXPECT_EQ(filter->GetFoldedFaces(), serial->GetFoldedFaces());
        expectSameSurface(ranks, filter->GetOutput(), serial->GetOutput(),
          { "MorphDisplacement", "GeometryId" }, { "ScaledJacobian", "MorphCellId" });
      }
    }
  }
}

TEST(RankBoundary, MorphBoundaryTakesCopiesAndPositionsAndNamesUnknownIds)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = meshes::hexes(4, 3, 3);
  const auto piece = rank_grids::piece(ranks, mesh);
  const auto run = [&](vtkPointSet* boundary, bool byPosition)
  {
    auto filter = vtkSmartPointer<vtkMorphBoundary>::New();
    filter->SetInputData(piece);
    filter->SetBoundaryData(boundary);
    filter->SetPrescribedDimension(2);
    filter->SetDisplacementArray(byPosition ? "Move" : nullptr);
    filter->Update();
    return filter;
  };
  const auto moved = grids::copy(piece);
  const morph::Points rest = grids::points(piece), to = grids::mapped(rest, grids::affine);
  for (Index i = 0; i < to.rows(); ++i)
  {
    moved->GetPoints()->SetPoint(static_cast<vtkIdType>(i), to.row(i).data());
  }
  const auto cloud = grids::cloud(rest);
  grids::addVectors(cloud, "Move", to - rest);
  for (const auto& filter : { run(moved, false), run(cloud, true) })
  {
    vtkPolyData* output = filter->GetOutput();
    EXPECT_EQ(filter->GetGivenPoints(), 5 * 4 * 4 - 3 * 2 * 2);
    EXPECT_GT(ranks.sum(static_cast<Index>(output->GetNumberOfPoints())), 0);
    const morph::Points x = grids::points(output);
    vtkDataArray* before = output->GetPointData()->GetArray("RestPosition");
    for (Index i = 0; i < x.rows(); ++i)
    {
      const double* at = before->GetTuple(static_cast<vtkIdType>(i));
      EXPECT_LT((x.row(i) - grids::affine(grids::Row(at[0], at[1], at[2]))).norm(), 1e-12);
    }
  }
  auto strange = grids::cloud(rest);
  grids::addIds(
    strange, "MorphPointId", std::vector<Index>(static_cast<std::size_t>(rest.rows()), 12345));
  auto filter = grids::of<vtkMorphBoundary>(piece);
  filter->SetBoundaryData(strange);
  const grids::Run listener(filter);
  EXPECT_EQ(ranks.sum(static_cast<Index>(listener.Errors.size())), 1);
  if (!listener.Errors.empty())
  {
    EXPECT_NE(listener.Errors.front().find("12345"), std::string::npos);
  }
}

TEST(RankBoundary, WhatNeedsOneRankSaysSoOnce)
{
  const Ranks ranks = pieces::world();
  if (ranks.count() < 2)
  {
    GTEST_SKIP() << "needs several ranks";
  }
  const auto piece = rank_grids::piece(ranks, meshes::hexes(4, 3, 3));
  auto filter = grids::of<vtkBoundaryDisplacement>(grids::boundary(piece, grids::affine));
  rank_grids::expectOneError(ranks, filter, "takes the volume mesh there");
}

TEST(RankBoundary, GathersTheSurfaceAndNotTheVolume)
{
  const Ranks ranks = pieces::world();
  morph::Monitor monitor;
  const auto bytes = [&](int n)
  {
    const auto grid = rank_grids::piece(ranks, meshes::hexes(n, n, n));
    for (vtkDataSetAttributes* data : { static_cast<vtkDataSetAttributes*>(grid->GetPointData()),
           static_cast<vtkDataSetAttributes*>(grid->GetCellData()) })
    {
      data->RemoveArray("Number");
      data->RemoveArray("Cell");
    }
    const auto surface = morph::filters::WholeSurface::Make();
    surface->Take(grid, monitor);
    const int boundary = (n + 1) * (n + 1) * (n + 1) - (n - 1) * (n - 1) * (n - 1);
    return static_cast<double>(surface->Boundary().Bytes) / boundary;
  };
  const double small = bytes(8), large = bytes(16);
  if (ranks.rank() == 0)
  {
    std::cout << "bytes a boundary node: " << small << ", " << large << '\n';
  }
  EXPECT_LT(large, 1.2 * small);
  EXPECT_LT(large, 400);
}

TEST(RankBoundary, OfTheInteriorCellsAtInnerSurfacesAloneAreGathered)
{
  const Ranks ranks = pieces::world();
  morph::Monitor monitor;
  const auto grid = rank_grids::piece(ranks, meshes::hexes(12, 12, 12));
  grids::markCells(grid, "left", [](const grids::Row& x) { return x[0] < 6; });
  grids::markCells(grid, "right", [](const grids::Row& x) { return x[0] > 6; });
  const auto surface = morph::filters::WholeSurface::Make();
  surface->Take(grid, monitor,
    [&] {
      return morph::filters::Zones::List(grid, surface->piece(), nullptr, *surface->processes());
    });
  // Those at the boundary, and ten by ten on each side.
  EXPECT_EQ(surface->Boundary().CellIds.size(), 12 * 12 * 12 - 10 * 10 * 10 + 2 * 10 * 10);
  ASSERT_EQ(surface->Boundary().Zones.size(), 2u);
  EXPECT_EQ(surface->Boundary().Zones[0].CellCount, 6 * 12 * 12);
}
