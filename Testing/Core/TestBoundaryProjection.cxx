// SPDX-License-Identifier: BSD-3-Clause
#include "ClassifiedShape.h"

#include "Boundary/FaceQuality.h"
#include "BoundaryMorphing/BoundaryProjection.h"
#include "BoundaryMorphing/SurfaceMorph.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

using namespace morph;
using shapes::Row;

namespace
{
/// Places by formula.
struct Formula : ProjectionTarget
{
  std::function<bool(const Row&, const Row&, Row&)> surface = [](const Row&, const Row&, Row&)
  { return false; };
  std::function<bool(const Row&, Row&)> features = [](const Row&, Row&) { return false; };

  bool closestOnSurface(Index, const Row& x, const Row& normal, Row& y) const override
  {
    return this->surface(x, normal, y);
  }
  bool closestOnFeatures(Index, const Row& x, Row& y) const override
  {
    return this->features(x, y);
  }
};

struct Case : shapes::ClassifiedShape
{
  BoundaryMotion motion;
  meshes::ThreadedMonitor monitor{ 2 };

  /// Nodes of dimension 0 and 1 stay, and so do the surfaces, which may then be projected.
  explicit Case(const Mesh& m)
    : ClassifiedShape(m)
    , motion(this->begin(this->upTo(0), [](const Row& x) { return x; }))
  {
    morphCurves(this->geometry, UnattachedMotion::Stay, this->motion, this->monitor);
  }
  void surfaces() { morphSurfaces(this->faces, this->geometry, {}, this->motion, this->monitor); }
};
}

TEST(BoundaryProjection, SurfaceNodesGoToTheTargetOthersStay)
{
  for (const Mesh& mesh : { meshes::hexes(6, 6, 2), meshes::quadraticTets(3, 3, 2) })
  {
    Case c(mesh);
    c.surfaces();
    const double width = mesh.points.col(0).maxCoeff();
    // A flat bump on the top: nothing moves far enough to fold.
    Formula target;
    const auto bump = [&](const Row& x)
    { return 2 + 0.2 * x[0] * (width - x[0]) * x[1] * (width - x[1]) / std::pow(width / 2, 4); };
    target.surface = [&](const Row& x, const Row& normal, Row& y)
    {
      y = Row(x[0], x[1], bump(x));
      return normal[2] > 0.9;
    };
    const ProjectionReport report =
      projectSurfaces(c.faces, c.geometry, target, c.motion, c.monitor);
    EXPECT_TRUE(report.kept.empty());
    const Points moved = c.motion.moved();
    for (Index node : c.faces.nodes)
    {
      const Row x = mesh.points.row(node);
      const bool isTop = c.geometry.dimension[node] == 2 && x[2] == 2;
      EXPECT_LE((moved.row(node) - (isTop ? Row(x[0], x[1], bump(x)) : x)).norm(), 1e-14);
      EXPECT_EQ(std::binary_search(report.projected.begin(), report.projected.end(), node), isTop);
      EXPECT_EQ(std::binary_search(report.missed.begin(), report.missed.end(), node),
        c.geometry.dimension[node] == 2 && !isTop);
    }
  }
}

TEST(BoundaryProjection, CurvesThatTurnBackPieceByPieceTakeLinearTime)
{
  for (const int n : { 20, 200 })
  {
    // All nodes go 1.5 cells along: the last one of a curve goes back, then the one before it, and
    // so on.
    Case c(meshes::hexes(n, 1, 1));
    Formula target;
    target.features = [](const Row& x, Row& y)
    {
      y = x + Row(1.5, 0, 0);
      return true;
    };
    const Points before = c.motion.moved();
    const ProjectionReport report = projectCurves(c.geometry, target, c.motion, c.monitor);
    EXPECT_TRUE(report.projected.empty());
    EXPECT_EQ(report.kept.size(), 4u * (n - 1));
    EXPECT_TRUE(std::is_sorted(report.kept.begin(), report.kept.end()));
    EXPECT_EQ(c.motion.moved(), before);
    EXPECT_LE(report.checkedPieces, 3 * (4 * n + 8));
  }
}

TEST(BoundaryProjection, FoldsAreSpreadOutOnTheTarget)
{
  Case c(meshes::hexes(6, 6, 2));
  c.surfaces();
  // One node of the top is sent over its neighbors at first.
  Formula target;
  target.surface = [&](const Row& x, const Row& normal, Row& y)
  {
    y = x == Row(3, 3, 2) ? Row(5.5, 3, 2.01) : Row(x[0], x[1], 2.01);
    return normal[2] > 0.9;
  };
  const ProjectionReport report = projectSurfaces(c.faces, c.geometry, target, c.motion, c.monitor);
  const Points moved = c.motion.moved();
  EXPECT_TRUE(faceQuality(c.mesh.points, moved, c.faces, c.geometry).folded.empty());
  EXPECT_TRUE(report.kept.empty());
  ASSERT_EQ(report.projected.size(), 25u);
  for (Index node : report.projected)
  {
    EXPECT_EQ(moved(node, 2), 2.01);
  }
}

TEST(BoundaryProjection, FoldsThatWereThereBeforeAreOpened)
{
  // Surfaces follow their curves so that one node of the top and one of a side lie beyond their
  // neighbors.
  Case c(meshes::hexes(6, 6, 6));
  c.surfaces();
  const auto nodeAt = [&](const Row& x)
  {
    Index node = 0;
    (c.mesh.points.rowwise() - x).rowwise().norm().minCoeff(&node);
    return node;
  };
  const Index onTop = nodeAt(Row(3, 3, 6)), onSide = nodeAt(Row(0, 3, 3));
  c.motion.displacement.row(onTop) = Row(2.5, 0.2, 0);
  c.motion.displacement.row(onSide) = Row(0, 0.1, -1.7);
  EXPECT_GT(faceQuality(c.mesh.points, c.motion.moved(), c.faces, c.geometry).folded.size(), 3u);
  Formula target;
  target.surface = [](const Row& x, const Row& normal, Row& y)
  {
    y = x;
    for (int k = 0; k < 3; ++k)
    {
      if (std::abs(normal[k]) > 0.9)
      {
        y[k] = normal[k] > 0 ? 6.01 : -0.01;
        return true;
      }
    }
    return false;
  };
  const ProjectionReport report = projectSurfaces(c.faces, c.geometry, target, c.motion, c.monitor);
  const Points moved = c.motion.moved();
  EXPECT_TRUE(faceQuality(c.mesh.points, moved, c.faces, c.geometry).folded.empty());
  EXPECT_TRUE(report.kept.empty());
  EXPECT_TRUE(report.missed.empty());
  EXPECT_EQ(report.projected.size(), 6u * 25);
  EXPECT_EQ(moved(onTop, 2), 6.01);
  EXPECT_EQ(moved(onSide, 0), -0.01);
}

TEST(BoundaryProjection, NodesOfFacesThatWouldFoldAreKept)
{
  Case c(meshes::hexes(6, 6, 2));
  c.surfaces();
  // A mirror image of the top folds along its rim, and no smoothing opens that.
  Formula target;
  target.surface = [&](const Row& x, const Row& normal, Row& y)
  {
    y = Row(6 - x[0], x[1], 2);
    return normal[2] > 0.9;
  };
  const ProjectionReport report = projectSurfaces(c.faces, c.geometry, target, c.motion, c.monitor);
  const Points moved = c.motion.moved();
  EXPECT_TRUE(faceQuality(c.mesh.points, moved, c.faces, c.geometry).folded.empty());
  ASSERT_FALSE(report.kept.empty());
  EXPECT_EQ(report.kept.size() + report.projected.size(), 25u);
  for (Index node : report.kept)
  {
    EXPECT_EQ(moved.row(node), c.mesh.points.row(node));
  }
}

TEST(BoundaryProjection, CurveNodesGoToTheFeatures)
{
  Case c(meshes::hexes(6, 4, 2));
  // Curves along x at the top bulge outwards in y; the others find nothing.
  Formula target;
  target.features = [](const Row& x, Row& y)
  {
    const double bulge = 0.1 * x[0] * (6 - x[0]) / 9;
    y = x + Row(0, x[1] == 0 ? -bulge : bulge, 0);
    return x[2] == 2 && (x[1] == 0 || x[1] == 4);
  };
  const ProjectionReport report = projectCurves(c.geometry, target, c.motion, c.monitor);
  EXPECT_EQ(report.projected.size(), 10u);
  EXPECT_EQ(report.missed.size(), 2u * 5 + 4u * 3 + 4u * 1);
  EXPECT_TRUE(report.kept.empty());
  for (Index node : report.projected)
  {
    EXPECT_GT(std::abs(c.motion.displacement(node, 1)), 0.01);
  }
  // Surfaces then follow the curves where those have gone.
  c.surfaces();
  EXPECT_GT(c.motion.displacement.col(1).maxCoeff(), 0.09);
}

TEST(BoundaryProjection, CurvesDoNotTurnBack)
{
  Case c(meshes::hexes(6, 4, 2));
  Formula target;
  target.features = [](const Row& x, Row& y)
  {
    y = x == Row(2, 0, 0) ? Row(4.5, 0, 0) : x;
    return true;
  };
  const ProjectionReport report = projectCurves(c.geometry, target, c.motion, c.monitor);
  // The two nodes of the piece that would turn, and no other.
  ASSERT_EQ(report.kept.size(), 2u);
  EXPECT_EQ(Row(c.mesh.points.row(report.kept[0])), Row(2, 0, 0));
  EXPECT_TRUE(c.motion.displacement.isZero(0));
}
