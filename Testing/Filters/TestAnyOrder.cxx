// SPDX-License-Identifier: BSD-3-Clause
// Lagrange and Bezier cells of any order, whose nodes are where VTK has them.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "Mesh/CellShape.h"
#include "Mesh/Topology.h"
#include "vtkExtractMorphBoundary.h"
#include "vtkFEMWarpMorph.h"
#include "vtkMorphMesh.h"
#include "vtkScaledJacobian.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkGenericCell.h>
#include <vtkLagrangeHexahedron.h>
#include <vtkLagrangeTetra.h>
#include <vtkLagrangeWedge.h>
#include <vtkMassProperties.h>
#include <vtkNew.h>
#include <vtkTriangleFilter.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

using grids::Row;
using morph::Index;
using morph::Points;

namespace
{
/// VTK's parametric coordinates of all nodes of a Lagrange cell.
template <typename Cell>
Points placesOf(Index nodes)
{
  vtkNew<Cell> cell;
  cell->GetPoints()->SetNumberOfPoints(nodes);
  cell->GetPointIds()->SetNumberOfIds(nodes);
  if constexpr (!std::is_same_v<Cell, vtkLagrangeTetra>)
  {
    cell->SetUniformOrderFromNumPoints(nodes);
  }
  cell->Initialize();
  return Eigen::Map<const Points>(cell->GetParametricCoords(), nodes, 3);
}

Points placesOf(std::uint8_t type, Index nodes)
{
  return type == morph::LagrangeTetrahedron  ? placesOf<vtkLagrangeTetra>(nodes)
         : type == morph::LagrangeHexahedron ? placesOf<vtkLagrangeHexahedron>(nodes)
                                             : placesOf<vtkLagrangeWedge>(nodes);
}

Index nodesOf(std::uint8_t type, Index order)
{
  const Index n = order + 1;
  return type == morph::LagrangeTetrahedron  ? n * (n + 1) * (n + 2) / 6
         : type == morph::LagrangeHexahedron ? n * n * n
                                             : n * n * (n + 1) / 2;
}

/// The mesh of linear cells with nodes of an order, which cells share. `first`: the type of a
/// tetrahedron, LagrangeTetrahedron or BezierTetrahedron.
morph::Mesh ofOrder(const morph::Mesh& linear, Index order, std::uint8_t first)
{
  const std::map<std::uint8_t, int> kinds = { { morph::Tetra, 0 }, { morph::Hexahedron, 1 },
    { morph::Wedge, 2 } };
  morph::Mesh mesh;
  std::vector<Row> points;
  std::map<std::array<long, 3>, Index> numbers;
  for (Index c = 0; c < linear.numberOfCells(); ++c)
  {
    const int kind = kinds.at(linear.types[c]);
    const auto type = static_cast<std::uint8_t>(morph::LagrangeTetrahedron + kind);
    const Points places = placesOf(type, nodesOf(type, order));
    for (Index k = 0; k < places.rows(); ++k)
    {
      double N[8];
      const morph::CellShape& shape = *morph::cellShape(linear, c);
      morph::shapeFunctions(shape.shape, places.row(k).data(), N, nullptr);
      Row x = Row::Zero();
      for (int a = 0; a < shape.numberOfCorners; ++a)
      {
        x += N[a] * linear.points.row(linear.cell(c)[a]);
      }
      const std::array<long, 3> key = { std::lround(x[0] * 1e6), std::lround(x[1] * 1e6),
        std::lround(x[2] * 1e6) };
      const auto found = numbers.try_emplace(key, static_cast<Index>(points.size()));
      if (found.second)
      {
        points.push_back(x);
      }
      mesh.connectivity.push_back(found.first->second);
    }
    mesh.types.push_back(static_cast<std::uint8_t>(first + kind));
    mesh.offsets.push_back(static_cast<Index>(mesh.connectivity.size()));
  }
  mesh.points.resize(static_cast<Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    mesh.points.row(static_cast<Index>(i)) = points[i];
  }
  return mesh;
}

/// Linear meshes of each shape, jittered.
std::vector<morph::Mesh> linearMeshes()
{
  std::vector<morph::Mesh> meshes = { meshes::tets(2, 2, 2), meshes::hexes(2, 2, 2),
    meshes::hexesAndWedges(2, 2, 2) };
  for (morph::Mesh& mesh : meshes)
  {
    meshes::jitterInterior(mesh, 0.1, 5);
  }
  return meshes;
}
}

TEST(AnyOrder, NodesAreWhereVtkHasThem)
{
  for (const std::uint8_t type :
    { morph::LagrangeTetrahedron, morph::LagrangeHexahedron, morph::LagrangeWedge })
  {
    std::vector<Index> sizes;
    for (Index order = 1; order <= 7; ++order)
    {
      sizes.push_back(nodesOf(type, order));
    }
    if (type != morph::LagrangeHexahedron)
    {
      sizes.push_back(type == morph::LagrangeTetrahedron ? 15 : 21);
    }
    for (const Index size : sizes)
    {
      SCOPED_TRACE(std::to_string(type) + " of " + std::to_string(size));
      const morph::CellShape* shape = morph::shapeOfAnyOrder(type, size);
      ASSERT_TRUE(shape);
      ASSERT_EQ(shape->numberOfNodes, size);
      const Points places = placesOf(type, size);
      for (Index k = shape->numberOfCorners; k < size; ++k)
      {
        const Eigen::Map<const Row> place(shape->extraNodes[k - shape->numberOfCorners]);
        EXPECT_LT((place - places.row(k)).cwiseAbs().maxCoeff(), 1e-15) << k;
      }
    }
  }
}

TEST(AnyOrder, OtherNumbersOfNodesAreRefused)
{
  EXPECT_FALSE(morph::shapeOfAnyOrder(morph::LagrangeTetrahedron, 11));
  morph::Mesh mesh = meshes::quadraticTets(1, 1, 1);
  std::fill(mesh.types.begin(), mesh.types.end(), morph::LagrangeTetrahedron);
  mesh.connectivity.push_back(0);
  ++mesh.offsets.back();
  auto filter = grids::morphed<vtkFEMWarpMorph>(grids::make(meshes::tets(1, 1, 1)), grids::affine);
  filter->SetInputData(grids::make(mesh));
  grids::expectError(filter, "one order up to 10");
}

TEST(AnyOrder, AffineMotionsAreExact)
{
  for (const morph::Mesh& linear : linearMeshes())
  {
    for (const auto& [order, first] : { std::pair(2, morph::LagrangeTetrahedron),
           std::pair(3, morph::LagrangeTetrahedron), std::pair(4, morph::BezierTetrahedron) })
    {
      const auto grid = grids::make(ofOrder(linear, order, first));
      auto filter = grids::morphed<vtkFEMWarpMorph>(grid, grids::affine);
      filter->CertifyOn();
      grids::expectWarning(filter, "validity between them is undecided");
      const Points expected = grids::mapped(grids::points(grid), grids::affine);
      EXPECT_LT((grids::points(filter->GetOutput()) - expected).cwiseAbs().maxCoeff(), 1e-11);
      EXPECT_EQ(filter->GetUndecidedCells(), grid->GetNumberOfCells());
      EXPECT_EQ(filter->GetInvertedCells(), 0);
    }
  }
}

TEST(AnyOrder, FacesAreDividedBetweenAllNodes)
{
  for (const morph::Mesh& linear : linearMeshes())
  {
    for (const Index order : { 1, 2, 3, 5 })
    {
      const auto grid = grids::make(ofOrder(linear, order, morph::LagrangeTetrahedron));
      auto extract = grids::of<vtkExtractMorphBoundary>(grid);
      vtkNew<vtkTriangleFilter> triangles;
      triangles->SetInputConnection(extract->GetOutputPort());
      triangles->Update();
      vtkNew<vtkMassProperties> mass;
      mass->SetInputConnection(triangles->GetOutputPort());
      EXPECT_NEAR(mass->GetVolume(), 8, 1e-12) << order;
      std::vector<bool> isUsed(extract->GetOutput()->GetNumberOfPoints());
      for (vtkIdType i = 0; i < triangles->GetOutput()->GetNumberOfCells(); ++i)
      {
        for (const vtkIdType id : { 0, 1, 2 })
        {
          isUsed[triangles->GetOutput()->GetCell(i)->GetPointId(id)] = true;
        }
      }
      EXPECT_TRUE(std::all_of(isUsed.begin(), isUsed.end(), [](bool used) { return used; }));
    }
  }
}

TEST(AnyOrder, NodesBetweenCornersFollowThem)
{
  // Each edge's nodes stay at thirds of it where the boundary twists.
  const morph::Mesh mesh = ofOrder(meshes::hexes(3, 3, 3), 3, morph::LagrangeTetrahedron);
  const auto grid = grids::make(mesh);
  const Points rest = grids::points(grid);
  auto filter = grids::morphed<vtkFEMWarpMorph>(grid, grids::twist);
  filter->Update();
  const Points moved = grids::points(filter->GetOutput());
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const Index* node = mesh.cell(c);
    const Row third = moved.row(node[8]), first = moved.row(node[0]), second = moved.row(node[1]);
    const bool isInside =
      (rest.row(node[8]).array() > 1e-9).all() && (rest.row(node[8]).array() < 3 - 1e-9).all();
    if (isInside)
    {
      EXPECT_LT((third - (2 * first + second) / 3).norm(), 1e-12);
    }
  }
}

TEST(AnyOrder, NodesOfACollapsedFaceAreOnTheEdgeThatItIs)
{
  morph::Mesh linear;
  linear.points.resize(6, 3);
  linear.points << 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 1, 1, 1, 0, 1;
  meshes::add(linear, morph::Wedge, { 0, 1, 2, 3, 4, 5 });
  morph::Mesh mesh = ofOrder(linear, 3, morph::LagrangeTetrahedron);
  constexpr Index corner = 1, MiddleOfTriangle = 24, InBody = 38;
  const Index inFace = mesh.connectivity[MiddleOfTriangle];
  mesh.connectivity[corner] = mesh.connectivity[2];
  morph::Monitor silent;
  const std::vector<Index> nodes = morph::boundaryFaces(mesh, silent).nodes;
  EXPECT_EQ(std::count(nodes.begin(), nodes.end(), inFace), 1);
  EXPECT_EQ(std::count(nodes.begin(), nodes.end(), mesh.connectivity[InBody]), 0);
}

TEST(AnyOrder, AMotionOfZeroOfASurfaceMovesNothing)
{
  const auto grid = grids::make(ofOrder(meshes::tets(2, 2, 2), 3, morph::LagrangeTetrahedron));
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->AddSurface("Surface 0");
  grids::update(filter);
  EXPECT_EQ(grids::points(vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0))),
    grids::points(grid));
}
