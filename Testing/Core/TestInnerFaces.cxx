// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/FaceTable.h"
#include "Mesh/InnerFaces.h"
#include "Meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

namespace
{
using morph::Index;
using morph::Mesh;

void addWall(Mesh& mesh, std::vector<Index> corners)
{
  std::rotate(corners.begin(), corners.begin() + 1, corners.end());
  meshes::add(mesh, corners.size() == 3 ? 5 : 9, corners); // VTK_TRIANGLE, VTK_QUAD
}

TEST(InnerFaces, AreThoseInsideUnderOneWallOrTwo)
{
  std::mt19937 random(meshes::seed());
  for (const auto& [name, solid] : meshes::all(3, 3, 3))
  {
    meshes::ThreadedMonitor monitor;
    const morph::FaceTable table = morph::faceTable(solid, monitor);
    Mesh mesh = solid;
    morph::InnerFaces wanted;
    for (Index cell = 0; cell < solid.numberOfCells(); ++cell)
    {
      for (Index f = table.start[cell]; f < table.start[cell + 1]; ++f)
      {
        // Faces inside, and on the boundary, under none, one or two walls.
        const auto walls = table.first[f] == f ? random() % 5 : 0;
        for (unsigned w = 0; w < walls && w < 2; ++w)
        {
          addWall(mesh, { table.corners.begin(f), table.corners.end(f) });
        }
        if (walls >= 1 && table.uses[f] == 2)
        {
          auto& places = walls >= 2 ? wanted.baffles : wanted.sheets;
          places.emplace_back(cell, static_cast<int>(f - table.start[cell]));
        }
      }
    }
    const std::vector<std::uint8_t> all(mesh.numberOfCells(), 1), none(mesh.numberOfCells(), 0);
    EXPECT_FALSE(wanted.baffles.empty() || wanted.sheets.empty()) << name;
    const morph::BoundaryFaces outer = morph::boundaryFaces(mesh, monitor);
    const morph::InnerFaces found = morph::innerFaces(mesh, outer, all, monitor);
    EXPECT_EQ(found.baffles, wanted.baffles) << name;
    EXPECT_EQ(found.sheets, wanted.sheets) << name;
    EXPECT_TRUE(morph::innerFaces(mesh, outer, none, monitor).baffles.empty()) << name;
  }
}

TEST(InnerFaces, InterfacesAreBetweenPartsWithoutACommonCell)
{
  for (const auto& [name, mesh] : meshes::all(4, 3, 2))
  {
    meshes::ThreadedMonitor monitor;
    std::vector<morph::NamedCells> parts = { { "all", {} }, { "left", {} }, { "right", {} } };
    std::vector<bool> isLeft;
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      double x = 0;
      for (Index k = 0; k < mesh.cellSize(c); ++k)
      {
        x += mesh.points(mesh.cell(c)[k], 0) / static_cast<double>(mesh.cellSize(c));
      }
      isLeft.push_back(x < 2);
      parts[0].cells.push_back(c);
      parts[isLeft[c] ? 1 : 2].cells.push_back(c);
    }
    morph::InnerFaces::Places wanted;
    const morph::FaceTable table = morph::faceTable(mesh, monitor);
    std::vector<Index> cellOf;
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      for (Index f = table.start[c]; f < table.start[c + 1]; ++f)
      {
        cellOf.push_back(c);
        const Index other = cellOf[table.first[f]];
        if (isLeft[other] != isLeft[c])
        {
          wanted.emplace_back(other, static_cast<int>(table.first[f] - table.start[other]));
        }
      }
    }
    std::sort(wanted.begin(), wanted.end());
    ASSERT_FALSE(wanted.empty()) << name;
    const std::vector<morph::InnerSurface> found = morph::innerSurfaces(mesh, parts, {}, monitor);
    ASSERT_EQ(found.size(), 1u) << name;
    EXPECT_EQ(found[0].name, "left | right");
    EXPECT_EQ(found[0].places, wanted) << name;
  }
}

TEST(InnerFaces, ASetOfNodesInsideIsASurfaceUnlessItHasAWholeCell)
{
  meshes::ThreadedMonitor monitor;
  const Mesh mesh = meshes::hexes(4, 4, 4);
  const auto set = [&](const std::function<bool(const Eigen::RowVector3d&)>& has)
  {
    morph::NamedNodes nodes{ "set", std::vector<std::uint8_t>(mesh.numberOfNodes(), 0) };
    for (Index n = 0; n < mesh.numberOfNodes(); ++n)
    {
      nodes.isNode[n] = has(mesh.points.row(n));
    }
    const auto found = morph::innerSurfaces(mesh, {}, { nodes }, monitor);
    return found.empty() ? std::size_t(0) : found[0].places.size();
  };
  EXPECT_EQ(set([](const auto& x) { return x[0] == 2; }), 16u);
  EXPECT_EQ(set([](const auto& x) { return x[0] == 2 && x[1] > 1 && x[2] > 0 && x[2] < 4; }), 4u);
  EXPECT_EQ(set([](const auto& x) { return x[0] == 2 && x[1] > 2; }), 4u);
  EXPECT_EQ(set([](const auto& x) { return x[0] == 0; }), 0u);
  EXPECT_EQ(set([](const auto& x) { return x[0] == 0 || x[1] == 2; }), 0u);
  EXPECT_EQ(set([](const auto& x) { return x[0] >= 2 && x[0] <= 3; }), 0u);
  EXPECT_EQ(set([](const auto& x) { return x[0] == 2 && x[1] == 2; }), 0u);
  EXPECT_EQ(set([](const auto& x) { return x[0] == 2 || (x == Eigen::RowVector3d(1, 1, 1)); }), 0u);
}

TEST(InnerFaces, CellsAtThemTellThemAll)
{
  for (const auto& [name, solid] : meshes::all(7, 5, 5))
  {
    meshes::ThreadedMonitor monitor;
    Mesh mesh = solid;
    const morph::FaceTable table = morph::faceTable(solid, monitor);
    std::vector<morph::NamedCells> parts = { { "left", {} }, { "right", {} }, { "over", {} } };
    std::vector<morph::NamedNodes> sets = { { "face", {} }, { "cells", {} } };
    for (Index c = 0; c < solid.numberOfCells(); ++c)
    {
      const double x = solid.points(solid.cell(c)[0], 0), last = solid.points(solid.cell(c)[2], 0);
      parts[x + last < 5 ? 0 : 1].cells.push_back(c);
      if (c % 97 == 50) // here and there, across nothing
      {
        parts[2].cells.push_back(c);
        addWall(mesh, { table.corners.begin(table.start[c]), table.corners.end(table.start[c]) });
      }
    }
    for (Index n = 0; n < solid.numberOfNodes(); ++n)
    {
      sets[0].isNode.push_back(solid.points(n, 0) == 4);
      sets[1].isNode.push_back(solid.points(n, 0) >= 5);
    }
    const std::vector<std::uint8_t> all(mesh.numberOfCells(), 1);
    const morph::BoundaryFaces outer = morph::boundaryFaces(mesh, monitor);
    std::vector<Index> kept = morph::cellsAtInnerFaces(
      mesh, outer, parts, sets, all, morph::Communicator::alone(), monitor);
    EXPECT_LT(kept.size(), 0.9 * static_cast<double>(solid.numberOfCells())) << name;
    kept.insert(kept.end(), outer.cells.begin(), outer.cells.end());
    Mesh some = mesh; // the other cells become vertices
    for (Index c = 0; c < solid.numberOfCells(); ++c)
    {
      const bool isKept = std::find(kept.begin(), kept.end(), c) != kept.end();
      some.types[c] = isKept ? some.types[c] : 1;
    }
    const auto found = morph::innerSurfaces(some, parts, sets, monitor),
               wanted = morph::innerSurfaces(mesh, parts, sets, monitor);
    ASSERT_EQ(found.size(), wanted.size()) << name;
    EXPECT_FALSE(wanted.empty()) << name;
    for (std::size_t i = 0; i < wanted.size(); ++i)
    {
      EXPECT_EQ(found[i].name, wanted[i].name) << name;
      EXPECT_EQ(found[i].places, wanted[i].places) << name;
    }
    EXPECT_EQ(morph::innerFaces(some, outer, all, monitor).sheets,
      morph::innerFaces(mesh, outer, all, monitor).sheets)
      << name;
  }
}
}
