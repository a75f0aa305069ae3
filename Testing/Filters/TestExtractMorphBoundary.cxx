// SPDX-License-Identifier: BSD-3-Clause
#include "TestGrids.h"

#include "Mesh/Topology.h"
#include "vtkExtractMorphBoundary.h"

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <map>

namespace
{
vtkSmartPointer<vtkPolyData> extract(vtkUnstructuredGrid* grid)
{
  auto filter = grids::of<vtkExtractMorphBoundary>(grid);
  filter->Update();
  return filter->GetOutput();
}

/// By the divergence theorem, each polygon as a fan of triangles: positive where normals point
/// outwards.
double enclosedVolume(vtkPolyData* surface)
{
  const morph::Points x = grids::points(surface);
  double volume = 0;
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    surface->GetCellPoints(c, ids);
    for (vtkIdType k = 2; k < ids->GetNumberOfIds(); ++k)
    {
      const Eigen::RowVector3d a = x.row(ids->GetId(0)), b = x.row(ids->GetId(k - 1)),
                               d = x.row(ids->GetId(k));
      volume += a.dot(b.cross(d)) / 6;
    }
  }
  return volume;
}

/// Each edge of a closed, consistently wound surface is used once in each direction.
bool isClosed(vtkPolyData* surface)
{
  std::map<std::pair<vtkIdType, vtkIdType>, int> edges;
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    surface->GetCellPoints(c, ids);
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
    {
      ++edges[{ ids->GetId(k), ids->GetId((k + 1) % ids->GetNumberOfIds()) }];
    }
  }
  for (const auto& edge : edges)
  {
    const auto back = edges.find({ edge.first.second, edge.first.first });
    if (edge.second != 1 || back == edges.end())
    {
      return false;
    }
  }
  return !edges.empty();
}
}

TEST(ExtractMorphBoundary, ClosedOutwardSurfaceThroughAllBoundaryNodes)
{
  for (auto& [name, mesh] : meshes::all(3, 2, 4))
  {
    SCOPED_TRACE(name);
    meshes::jitterInterior(mesh, 0.1, meshes::seed());
    auto surface = extract(grids::make(mesh));
    EXPECT_TRUE(isClosed(surface));
    EXPECT_NEAR(enclosedVolume(surface), 24, 1e-12);

    morph::Monitor serial;
    const std::vector<morph::Index> nodes = morph::boundaryFaces(mesh, serial).nodes;
    auto* ids = vtkIdTypeArray::SafeDownCast(surface->GetPointData()->GetArray("MorphPointId"));
    ASSERT_NE(ids, nullptr);
    ASSERT_EQ(ids->GetNumberOfValues(), static_cast<vtkIdType>(nodes.size()));
    auto* rest = vtkDoubleArray::SafeDownCast(surface->GetPointData()->GetArray("RestPosition"));
    ASSERT_NE(rest, nullptr);
    ASSERT_EQ(rest->GetNumberOfComponents(), 4);
    std::vector<bool> used(nodes.size(), false);
    vtkNew<vtkIdList> corners;
    for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
    {
      surface->GetCellPoints(c, corners);
      for (vtkIdType k = 0; k < corners->GetNumberOfIds(); ++k)
      {
        used[corners->GetId(k)] = true;
      }
    }
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      const vtkIdType p = static_cast<vtkIdType>(i);
      EXPECT_TRUE(used[i]) << "no polygon uses node " << nodes[i];
      EXPECT_EQ(ids->GetValue(p), nodes[i]);
      EXPECT_EQ(surface->GetPointData()->GetArray("Number")->GetComponent(p, 0), 1000 + nodes[i]);
      for (int j = 0; j < 3; ++j)
      {
        EXPECT_EQ(rest->GetComponent(p, j), mesh.points(nodes[i], j));
        EXPECT_EQ(surface->GetPoint(p)[j], mesh.points(nodes[i], j));
      }
      EXPECT_EQ(rest->GetComponent(p, 3), 1);
    }
  }
}

TEST(ExtractMorphBoundary, PiecesOfFaces)
{
  // One cell each: how many polygons its faces become.
  const auto count = [](const morph::Mesh& mesh)
  { return extract(grids::make(mesh))->GetNumberOfCells(); };
  EXPECT_EQ(count(meshes::hexes(1, 1, 1)), 6);
  EXPECT_EQ(count(meshes::quadraticHexes(1, 1, 1, false)), 6 * 5);
  EXPECT_EQ(count(meshes::quadraticHexes(1, 1, 1, true)), 6 * 4);
  EXPECT_EQ(count(meshes::tets(1, 1, 1)), 12);
  EXPECT_EQ(count(meshes::quadraticTets(1, 1, 1)), 12 * 4);
}

TEST(ExtractMorphBoundary, QuadraticWedgesCloseUp)
{
  for (const int type :
    { VTK_QUADRATIC_WEDGE, VTK_QUADRATIC_LINEAR_WEDGE, VTK_BIQUADRATIC_QUADRATIC_WEDGE,
      VTK_QUADRATIC_PYRAMID, VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON })
  {
    SCOPED_TRACE(type);
    const morph::CellShape& shape = *morph::cellShape(static_cast<std::uint8_t>(type));
    static const double wedge[6][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
      { 1, 0, 1 }, { 0, 1, 1 } };
    static const double pyramid[5][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
      { .5, .5, 1 } };
    static const double hexahedron[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
      { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };
    const auto* corners = shape.shape == morph::Shape::Wedge     ? wedge
                          : shape.shape == morph::Shape::Pyramid ? pyramid
                                                                 : hexahedron;
    morph::Mesh mesh;
    mesh.points.resize(shape.numberOfNodes, 3);
    std::vector<morph::Index> nodes;
    for (int k = 0; k < shape.numberOfNodes; ++k)
    {
      nodes.push_back(k);
      double N[8] = {};
      if (k < shape.numberOfCorners)
      {
        N[k] = 1;
      }
      else
      {
        morph::shapeFunctions(shape.shape, shape.extraNodes[k - shape.numberOfCorners], N, nullptr);
      }
      mesh.points.row(k).setZero();
      for (int a = 0; a < shape.numberOfCorners; ++a)
      {
        mesh.points.row(k) +=
          N[a] * Eigen::RowVector3d(corners[a][0], corners[a][1], corners[a][2]);
      }
    }
    meshes::add(mesh, static_cast<std::uint8_t>(type), nodes);
    auto surface = extract(grids::make(mesh));
    EXPECT_TRUE(isClosed(surface));
    EXPECT_EQ(surface->GetNumberOfPoints(), shape.numberOfNodes);
    const double volume = shape.shape == morph::Shape::Wedge     ? 0.5
                          : shape.shape == morph::Shape::Pyramid ? 1. / 3
                                                                 : 1;
    EXPECT_NEAR(enclosedVolume(surface), volume, 1e-14);
  }
}

TEST(ExtractMorphBoundary, CollapsedHexahedraCloseUp)
{
  // A hexahedron whose nodes make a wedge: two quads are triangles, one is an edge.
  morph::Mesh mesh;
  mesh.points.resize(6, 3);
  mesh.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1;
  meshes::add(mesh, VTK_HEXAHEDRON, { 0, 1, 2, 2, 3, 4, 5, 5 });
  auto surface = extract(grids::make(mesh));
  EXPECT_EQ(surface->GetNumberOfCells(), 5);
  EXPECT_EQ(surface->GetPolys()->GetNumberOfConnectivityIds(), 2 * 3 + 3 * 4);
  EXPECT_TRUE(isClosed(surface));
  EXPECT_NEAR(enclosedVolume(surface), 0.5, 1e-14);
}

TEST(ExtractMorphBoundary, PassesTheOwnersArrays)
{
  auto surface = extract(grids::hexes(3));
  auto* owner = surface->GetCellData()->GetArray("MorphCellId");
  auto* passed = surface->GetCellData()->GetArray("Cell");
  ASSERT_NE(owner, nullptr);
  ASSERT_NE(passed, nullptr);
  ASSERT_EQ(owner->GetNumberOfTuples(), 54);
  for (vtkIdType c = 0; c < 54; ++c)
  {
    EXPECT_EQ(passed->GetComponent(c, 0), 2000 + owner->GetComponent(c, 0));
  }
}

TEST(ExtractMorphBoundary, MirroredBodyStillPointsOutwards)
{
  morph::Mesh mesh = meshes::hexes(2, 2, 2);
  meshes::transform(mesh, [](const grids::Row& x) { return grids::Row(-x[0], x[1], x[2]); });
  EXPECT_NEAR(enclosedVolume(extract(grids::make(mesh))), 8, 1e-12);
}

TEST(ExtractMorphBoundary, KeepsFloatPoints)
{
  auto grid = grids::make(meshes::hexes(2, 2, 2), VTK_FLOAT);
  EXPECT_EQ(extract(grid)->GetPoints()->GetDataType(), VTK_FLOAT);
}

TEST(ExtractMorphBoundary, LowerDimensionAndUnusedPointsAreLeftOut)
{
  morph::Mesh mesh = meshes::hexes(2, 2, 2);
  meshes::add(mesh, VTK_TRIANGLE, { 0, 1, 13 });
  mesh.points.conservativeResize(28, 3);
  mesh.points.row(27) << 9, 9, 9;
  auto surface = extract(grids::make(mesh));
  EXPECT_EQ(surface->GetNumberOfPoints(), 26);
  EXPECT_EQ(surface->GetNumberOfCells(), 24);
}

TEST(ExtractMorphBoundary, OneErrorAndNoOutput)
{
  vtkNew<vtkUnstructuredGrid> empty;
  morph::Mesh line;
  line.points.resize(3, 3);
  line.points << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  meshes::add(line, VTK_LINE, { 0, 1 });
  vtkNew<vtkMultiBlockDataSet> blocks;
  const std::vector<std::pair<vtkSmartPointer<vtkDataObject>, std::string>> cases = {
    { empty.Get(), "no cells" }, { grids::make(line), "volume cell" }, { blocks.Get(), "no cells" },
    { grids::cloud(line.points), "vtkPolyData" }
  };
  for (const auto& [input, telling] : cases)
  {
    SCOPED_TRACE(telling);
    auto filter = grids::of<vtkExtractMorphBoundary>(grids::hexes(2));
    filter->Update();
    grids::Listener listener(filter);
    filter->SetInputDataObject(input);
    filter->Update();
    listener.ExpectError(telling);
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
    filter->SetInputData(grids::hexes(2));
    filter->Update();
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 26);
    EXPECT_EQ(listener.Errors.size(), 1u);
  }
}
