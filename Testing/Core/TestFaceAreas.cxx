// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/FaceQuality.h"
#include "BoundaryShapes.h"
#include "Support/Error.h"

#include <gtest/gtest.h>

using namespace morph;
using shapes::Row;

namespace
{
struct Case
{
  explicit Case(const Mesh& m)
    : mesh(m)
  {
    Monitor monitor;
    this->faces = boundaryFaces(this->mesh, monitor);
    this->areas = faceAreas(this->mesh.points, this->faces);
  }

  /// At all boundary nodes, over the faces whose area points along `towards`.
  Points normals(const Row& towards) const
  {
    std::vector<std::uint8_t> isChosen;
    for (Index f = 0; f < this->areas.rows(); ++f)
    {
      isChosen.push_back(this->areas.row(f).dot(towards) > 0.99 * this->areas.row(f).norm());
    }
    return nodeNormals(this->areas, this->faces, isChosen, this->faces.nodes);
  }

  Mesh mesh;
  BoundaryFaces faces;
  Points areas;
};
}

TEST(FaceAreas, SumToZeroAndHaveTheSizeOfTheSides)
{
  for (const auto& [name, mesh] : meshes::all(3, 4, 2))
  {
    SCOPED_TRACE(name);
    const Case box(mesh);
    EXPECT_LE(box.areas.colwise().sum().norm(), 1e-12);
    EXPECT_NEAR(box.areas.rowwise().norm().sum(), 2 * (12 + 8 + 6), 1e-12);
  }
}

TEST(FaceAreas, NormalsOfABox)
{
  for (const auto& [name, mesh] : meshes::all(2, 2, 2))
  {
    SCOPED_TRACE(name);
    const Case box(mesh);
    const Points top = box.normals(Row(0, 0, 1));
    for (std::size_t i = 0; i < box.faces.nodes.size(); ++i)
    {
      const Row x = box.mesh.points.row(box.faces.nodes[i]), n = top.row(static_cast<Index>(i));
      EXPECT_NEAR(n.norm(), 1, 1e-14);
      if (x[2] == 2)
      {
        EXPECT_LE((n - Row(0, 0, 1)).norm(), 1e-14); // also at its edges
      }
      else if (x[0] == 0 && x[1] > 0 && x[1] < 2 && x[2] > 0.5 && x[2] < 1.5)
      {
        EXPECT_LE((n - Row(-1, 0, 0)).norm(), 1e-14); // no chosen face there: all of them
      }
    }
  }
}

TEST(FaceAreas, NormalsOfABallPointOutwards)
{
  const Case ball(shapes::ball(8));
  const Points normals = ball.normals(Row(0, 0, 0));
  double worst = 1;
  for (std::size_t i = 0; i < ball.faces.nodes.size(); ++i)
  {
    worst = std::min(
      worst, normals.row(static_cast<Index>(i)).dot(ball.mesh.points.row(ball.faces.nodes[i])));
  }
  EXPECT_GT(worst, 0.98);
}

TEST(FaceAreas, NodesWithoutANormalAreNamed)
{
  Mesh mesh = meshes::hexes(1, 1, 1);
  meshes::transform(mesh, [](const Row& x) { return Row(x[0], 0, 0); });
  const Case line(mesh);
  try
  {
    line.normals(Row(1, 0, 0));
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("0, 1, 2"), std::string::npos) << error.what();
  }
}
