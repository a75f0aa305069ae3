// SPDX-License-Identifier: BSD-3-Clause
// Cells that are there twice, and nodes where bodies touch.
#include "Mesh/SharedCorners.h"
#include "Meshes.h"
#include "PolyhedralMeshes.h"
#include "Session/UndeformedMesh.h"

#include <gtest/gtest.h>

using namespace morph;
using Row = Eigen::RowVector3d;

namespace
{
std::vector<Index> touching(const Mesh& mesh)
{
  Monitor monitor;
  return UndeformedMesh(mesh, nullptr, monitor).touchingNodes();
}

/// Both meshes, nodes in one place being one.
Mesh joined(const Mesh& a, const Mesh& b)
{
  Mesh mesh = a;
  std::vector<Index> number(b.points.rows());
  for (Index i = 0; i < b.points.rows(); ++i)
  {
    Index n = 0;
    while (n < mesh.points.rows() && mesh.points.row(n) != b.points.row(i))
    {
      ++n;
    }
    number[i] = n;
    if (n == mesh.points.rows())
    {
      mesh.points.conservativeResize(n + 1, 3);
      mesh.points.row(n) = b.points.row(i);
    }
  }
  for (Index c = 0; c < b.numberOfCells(); ++c)
  {
    std::vector<Index> nodes;
    for (Index k = 0; k < b.cellSize(c); ++k)
    {
      nodes.push_back(number[b.cell(c)[k]]);
    }
    meshes::add(mesh, b.types[c], nodes);
  }
  return mesh;
}

}

TEST(SharedCorners, ProperMeshesHaveNone)
{
  Monitor monitor;
  std::vector<std::pair<std::string, Mesh>> all = meshes::all(3, 2, 2);
  for (auto& polyhedral : meshes::polyhedral())
  {
    all.push_back(std::move(polyhedral));
  }
  for (const auto& [name, mesh] : all)
  {
    SCOPED_TRACE(name);
    EXPECT_TRUE(repeatedCells(mesh, monitor).empty());
    EXPECT_TRUE(touching(mesh).empty());
  }
}

TEST(SharedCorners, BothOfEqualCellsAreNamedInAnyOrderOfNodes)
{
  Monitor monitor;
  Mesh mesh = meshes::tets(2, 2, 2);
  const Index last = mesh.numberOfCells();
  const Index* c = mesh.cell(7);
  meshes::add(mesh, mesh.types[7], { c[1], c[2], c[0], c[3] });
  EXPECT_EQ(repeatedCells(mesh, monitor), (std::vector<Index>{ 7, last }));
}

TEST(SharedCorners, BodiesThatShareANodeOrAnEdgeTouch)
{
  const Mesh box = meshes::hexes(2, 2, 2);
  Mesh both = joined(box, meshes::shifted(box, Row(2, 2, 2)));
  EXPECT_EQ(touching(both), std::vector<Index>{ 26 });
  both = joined(box, meshes::shifted(box, Row(2, 2, 0)));
  EXPECT_EQ(touching(both).size(), 3u);
  both = joined(box, meshes::shifted(meshes::tets(2, 2, 2), Row(2, 2, 2)));
  EXPECT_EQ(touching(both), std::vector<Index>{ 26 });
}

TEST(SharedCorners, BodiesThatMeetAtWholeFacesDoNotTouch)
{
  const Mesh box = meshes::hexes(2, 2, 2);
  EXPECT_TRUE(touching(joined(box, meshes::shifted(box, Row(2, 0, 0)))).empty());
  // Quadrilaterals against two triangles each.
  EXPECT_TRUE(touching(joined(box, meshes::shifted(meshes::tets(2, 2, 2), Row(2, 0, 0)))).empty());
  // A quadrilateral against four.
  Mesh large = meshes::hexes(1, 1, 1);
  large.points *= 2;
  EXPECT_TRUE(touching(joined(box, meshes::shifted(large, Row(2, 0, 0)))).empty());
}
