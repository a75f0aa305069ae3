// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/BaffleFaces.h"
#include "Mesh/FaceTable.h"
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

TEST(BaffleFaces, AreThoseInsideUnderTwoWalls)
{
  std::mt19937 random(meshes::seed());
  for (const auto& [name, solid] : meshes::all(3, 3, 3))
  {
    meshes::ThreadedMonitor monitor;
    const morph::FaceTable table = morph::faceTable(solid, monitor);
    Mesh mesh = solid;
    std::vector<std::pair<Index, int>> wanted;
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
        if (walls >= 2 && table.uses[f] == 2)
        {
          wanted.emplace_back(cell, static_cast<int>(f - table.start[cell]));
        }
      }
    }
    const std::vector<std::uint8_t> all(mesh.numberOfCells(), 1), none(mesh.numberOfCells(), 0);
    EXPECT_FALSE(wanted.empty()) << name;
    EXPECT_EQ(morph::baffleFaces(mesh, all, monitor), wanted) << name;
    EXPECT_TRUE(morph::baffleFaces(mesh, none, monitor).empty()) << name;
  }
}
}
