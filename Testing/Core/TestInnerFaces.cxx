// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/FaceTable.h"
#include "Mesh/InnerFaces.h"
#include "Meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
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
}
