// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryShapes.h"
#include "Motions.h"

#include "Boundary/Classification.h"
#include "Support/Error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>
#include <set>

using namespace morph;
using shapes::Row;

namespace
{
struct Found
{
  BoundaryFaces faces;
  Classification geometry;
  std::vector<std::string> warnings;
};

Found find(const Mesh& mesh, const ClassificationOptions& options = {})
{
  meshes::ThreadedMonitor monitor;
  Found found;
  found.faces = boundaryFaces(mesh, monitor);
  found.geometry = classify(mesh, found.faces, options, monitor);
  found.warnings = monitor.warnings;
  return found;
}

/// Vertices, curves, surfaces.
std::array<std::size_t, 3> counts(const Classification& g)
{
  return { g.vertices.size(), g.curves.size(), g.surfaces.size() };
}
using Counts = std::array<std::size_t, 3>;

std::size_t loops(const Classification& g)
{
  return std::count_if(
    g.curves.begin(), g.curves.end(), [](const GeometryCurve& c) { return c.loop; });
}

/// What holds for any mesh and any options.
void expectConsistent(const Mesh& mesh, const Found& found)
{
  const Classification& g = found.geometry;
  std::vector<int> owners(mesh.numberOfNodes(), 0);
  for (std::size_t v = 0; v < g.vertices.size(); ++v)
  {
    ++owners[g.vertices[v].node];
    EXPECT_EQ(g.dimension[g.vertices[v].node], 0);
    EXPECT_EQ(g.entity[g.vertices[v].node], static_cast<Index>(v));
  }
  for (std::size_t c = 0; c < g.curves.size(); ++c)
  {
    const GeometryCurve& curve = g.curves[c];
    ASSERT_EQ(curve.nodes.size(), curve.parameter.size());
    EXPECT_TRUE(std::is_sorted(curve.parameter.begin(), curve.parameter.end()));
    EXPECT_EQ(curve.parameter.front(), 0);
    if (!curve.loop)
    {
      EXPECT_EQ(g.dimension[curve.nodes.front()], 0);
      EXPECT_EQ(g.dimension[curve.nodes.back()], 0);
      EXPECT_EQ(curve.parameter.back(), 1);
    }
    for (std::size_t i = curve.loop ? 0 : 1; i + (curve.loop ? 0 : 1) < curve.nodes.size(); ++i)
    {
      ++owners[curve.nodes[i]];
      EXPECT_EQ(g.dimension[curve.nodes[i]], 1);
      EXPECT_EQ(g.entity[curve.nodes[i]], static_cast<Index>(c));
      EXPECT_EQ(g.parameter[curve.nodes[i]], curve.parameter[i]);
    }
    for (Index s : curve.surfaces)
    {
      const auto& curves = g.surfaces[s].curves;
      EXPECT_TRUE(std::binary_search(curves.begin(), curves.end(), static_cast<Index>(c)));
    }
  }
  std::size_t faces = 0;
  for (std::size_t s = 0; s < g.surfaces.size(); ++s)
  {
    faces += g.surfaces[s].faces.size();
    for (Index f : g.surfaces[s].faces)
    {
      EXPECT_EQ(g.surfaceOfFace[f], static_cast<Index>(s));
    }
    for (Index node : g.surfaces[s].nodes)
    {
      owners[node] += g.dimension[node] == 2;
      EXPECT_TRUE(g.dimension[node] < 2 || g.entity[node] == static_cast<Index>(s));
    }
  }
  EXPECT_EQ(faces, found.faces.cells.size());
  for (Index node = 0; node < mesh.numberOfNodes(); ++node)
  {
    const bool isOuter =
      std::binary_search(found.faces.nodes.begin(), found.faces.nodes.end(), node);
    EXPECT_EQ(owners[node], isOuter) << "node " << node;
    EXPECT_EQ(std::isnan(g.parameter[node]), g.dimension[node] != 1);
  }
}

/// Nodes in groups of one owner, whatever its number.
std::set<std::set<Index>> groups(const Classification& g, const std::vector<Index>& name)
{
  std::map<std::pair<int, Index>, std::set<Index>> byOwner;
  for (std::size_t n = 0; n < name.size(); ++n)
  {
    byOwner[{ g.dimension[n], g.entity[n] }].insert(name[n]);
  }
  std::set<std::set<Index>> result;
  for (const auto& group : byOwner)
  {
    result.insert(group.second);
  }
  return result;
}
}

TEST(Classification, BoxOfEveryCellType)
{
  for (const auto& [name, mesh] : meshes::all(3, 4, 2))
  {
    SCOPED_TRACE(name);
    const Found found = find(mesh);
    EXPECT_EQ(counts(found.geometry), (Counts{ 8, 12, 6 }));
    expectConsistent(mesh, found);
    // How many of the box's planes a node lies on tells its dimension; mid-side and face nodes too.
    const Row high(3, 4, 2);
    for (Index n = 0; n < mesh.numberOfNodes(); ++n)
    {
      const auto p = mesh.points.row(n).array();
      const auto planes = (p == 0).count() + (p == high.array()).count();
      EXPECT_EQ(found.geometry.dimension[n], 3 - planes) << "node " << n;
    }
    for (const GeometryCurve& curve : found.geometry.curves)
    {
      const Row from = mesh.points.row(curve.nodes.front()),
                to = mesh.points.row(curve.nodes.back());
      for (std::size_t i = 0; i < curve.nodes.size(); ++i)
      {
        const Row expected = from + curve.parameter[i] * (to - from);
        EXPECT_LE((mesh.points.row(curve.nodes[i]) - expected).norm(), 1e-14);
      }
      EXPECT_EQ(curve.surfaces.size(), 2u);
    }
    EXPECT_TRUE(found.warnings.empty());
  }
}

TEST(Classification, CylinderHasTwoClosedCurvesWithoutVertex)
{
  const Mesh mesh = shapes::cylinder(8, 4);
  const Found found = find(mesh);
  EXPECT_EQ(counts(found.geometry), (Counts{ 0, 2, 3 }));
  EXPECT_EQ(loops(found.geometry), 2u);
  expectConsistent(mesh, found);
  for (const GeometryCurve& circle : found.geometry.curves)
  {
    ASSERT_EQ(circle.nodes.size(), 32u);
    for (std::size_t i = 0; i < 32; ++i)
    {
      EXPECT_NEAR(circle.parameter[i], i / 32., 1e-14);
    }
    EXPECT_EQ(circle.nodes[0], *std::min_element(circle.nodes.begin(), circle.nodes.end()));
  }
}

TEST(Classification, BallHasNeitherCurveNorVertex)
{
  const Mesh mesh = shapes::ball(8);
  EXPECT_EQ(counts(find(mesh).geometry), (Counts{ 0, 0, 1 }));
  expectConsistent(mesh, find(mesh));
  const Mesh hollow = shapes::hollowBall(8);
  EXPECT_EQ(counts(find(hollow).geometry), (Counts{ 0, 0, 2 }));
  expectConsistent(hollow, find(hollow));
}

TEST(Classification, HolesAndBodies)
{
  const Mesh hole = shapes::boxWithHole(32, 4, 3);
  EXPECT_EQ(counts(find(hole).geometry), (Counts{ 8, 14, 7 }));
  EXPECT_EQ(loops(find(hole).geometry), 2u);
  expectConsistent(hole, find(hole));

  const Mesh square =
    shapes::cut(meshes::hexes(3, 3, 2), [](const Row& x) { return x[0] != 1.5 || x[1] != 1.5; });
  EXPECT_EQ(counts(find(square).geometry), (Counts{ 16, 24, 10 }));

  const Mesh two = shapes::together(shapes::cylinder(8, 4), meshes::tets(2, 2, 2));
  const Found found = find(two);
  EXPECT_EQ(counts(found.geometry), (Counts{ 8, 14, 9 }));
  expectConsistent(two, found);
  EXPECT_EQ(found.geometry.dimension[two.numberOfNodes() - 14], 3);
  EXPECT_EQ(found.geometry.id(two.numberOfNodes() - 14), 1); // the second body
}

TEST(Classification, NonManifoldEdgesAndTouchingCorners)
{
  // Two boxes that share an edge: it is one curve with four surfaces.
  const Mesh edge =
    shapes::cut(meshes::hexes(2, 2, 2), [](const Row& x) { return (x[0] < 1) == (x[1] < 1); });
  const Found found = find(edge);
  EXPECT_EQ(counts(found.geometry), (Counts{ 14, 23, 12 }));
  expectConsistent(edge, found);
  EXPECT_EQ(std::count_if(found.geometry.curves.begin(), found.geometry.curves.end(),
              [](const GeometryCurve& c) { return c.surfaces.size() == 4; }),
    1);

  const Mesh corner = shapes::cut(meshes::hexes(2, 2, 2),
    [](const Row& x) { return (x.array() < 1).all() || (x.array() > 1).all(); });
  EXPECT_EQ(counts(find(corner).geometry), (Counts{ 15, 24, 12 }));

  // Balls that touch in one node: no curve is there, but that node is on both surfaces.
  Mesh balls = shapes::ball(8);
  Mesh other = balls;
  meshes::transform(other, [](const Row& x) { return Row(x + Row(2, 0, 0)); });
  balls = shapes::together(balls, other);
  Index left = -1, right = -1;
  for (Index n = 0; n < balls.numberOfNodes(); ++n)
  {
    if ((balls.points.row(n) - Row(1, 0, 0)).norm() < 1e-12)
    {
      (left < 0 ? left : right) = n;
    }
  }
  ASSERT_GE(right, 0);
  std::replace(balls.connectivity.begin(), balls.connectivity.end(), right, left);
  const Found touching = find(balls);
  EXPECT_EQ(counts(touching.geometry), (Counts{ 1, 0, 2 }));
  EXPECT_EQ(touching.geometry.vertices[0].node, left);
  EXPECT_EQ(touching.geometry.dimension[right], -1);
}

TEST(Classification, CreaseThatEndsInsideASurface)
{
  const Mesh mesh = shapes::creasedPlate();
  const Found found = find(mesh);
  expectConsistent(mesh, found);
  const Classification& g = found.geometry;
  // The ridge turns by 2 atan(1 - x / 4) on average over an edge, its feet by half of that: more
  // than 25 degrees up to x = 3 and 2.
  std::map<double, std::size_t> length; // by y
  for (const GeometryCurve& curve : g.curves)
  {
    if (curve.surfaces.size() == 1)
    {
      length[mesh.points(curve.nodes[0], 1)] = curve.nodes.size();
      for (Index node : curve.nodes)
      {
        EXPECT_EQ(mesh.points(node, 1), mesh.points(curve.nodes[0], 1));
      }
    }
  }
  EXPECT_EQ(length, (std::map<double, std::size_t>{ { 1, 3 }, { 2, 4 }, { 3, 3 } }));
  EXPECT_EQ(g.surfaces.size(), 6u);
}

TEST(Classification, FeatureAngleDecides)
{
  const Mesh mesh = shapes::cylinder(4, 2); // faces that turn by 22.5 degrees
  ClassificationOptions options;
  EXPECT_EQ(counts(find(mesh, options).geometry), (Counts{ 0, 2, 3 }));
  options.featureAngle = 22;
  EXPECT_EQ(find(mesh, options).geometry.surfaces.size(), 2u + 16u);
  options.featureAngle = 91;
  EXPECT_EQ(counts(find(mesh, options).geometry), (Counts{ 0, 0, 1 }));
}

TEST(Classification, MeaningDoesNotDependOnNumbering)
{
  std::mt19937 random(meshes::seed());
  for (const Mesh& mesh : { meshes::quadraticTets(3, 2, 2), shapes::boxWithHole(16, 2, 2),
         shapes::creasedPlate(), shapes::hollowBall(8) })
  {
    std::vector<Index> order(mesh.numberOfNodes()), same(mesh.numberOfNodes());
    std::iota(order.begin(), order.end(), Index(0));
    std::iota(same.begin(), same.end(), Index(0));
    std::shuffle(order.begin(), order.end(), random);
    Mesh other = meshes::renumbered(mesh, order);
    const Classification g = find(mesh).geometry, h = find(other).geometry;
    std::vector<Index> back(order.size());
    for (std::size_t n = 0; n < order.size(); ++n)
    {
      back[order[n]] = static_cast<Index>(n);
      EXPECT_EQ(g.dimension[n], h.dimension[order[n]]);
    }
    EXPECT_EQ(groups(g, same), groups(h, back));
    EXPECT_EQ(counts(g), counts(h));
    // Numbers follow the lowest ids.
    EXPECT_EQ(
      h.entity[h.vertices.empty() ? 0 : h.vertices[0].node], h.vertices.empty() ? h.entity[0] : 0);
    for (std::size_t c = 1; c < h.curves.size(); ++c)
    {
      const auto lowest = [](const GeometryCurve& curve)
      { return *std::min_element(curve.nodes.begin(), curve.nodes.end()); };
      EXPECT_LE(lowest(h.curves[c - 1]), lowest(h.curves[c]));
    }
  }
}

TEST(Classification, WindingAndScaleDoNotMatter)
{
  Mesh mesh = shapes::boxWithHole(16, 2, 2);
  const Counts expected = counts(find(mesh).geometry);
  meshes::transform(mesh, [](const Row& x) { return Row(-1e-7 * x[0], 1e-7 * x[1], 1e-7 * x[2]); });
  EXPECT_EQ(counts(find(mesh).geometry), expected);
  const Found both = find(shapes::together(meshes::wedges(2, 2, 2), mesh));
  EXPECT_EQ(counts(both.geometry), (Counts{ 8 + expected[0], 12 + expected[1], 6 + expected[2] }));
}

TEST(Classification, GivenSurfaceIds)
{
  const Mesh mesh = meshes::hexes(4, 4, 2);
  ClassificationOptions options;
  Monitor monitor;
  const BoundaryFaces faces = boundaryFaces(mesh, monitor);
  const auto center = [&](std::size_t f)
  {
    Row sum = Row::Zero();
    for (Index k = faces.offsets[f]; k < faces.offsets[f + 1]; ++k)
    {
      sum += mesh.points.row(faces.connectivity[k]) / 4;
    }
    return sum;
  };
  // A square in the middle of the top; bottom and sides in one; the rest of the top is not named.
  for (std::size_t f = 0; f < faces.cells.size(); ++f)
  {
    const Row c = center(f);
    const bool middle = std::abs(c[0] - 2) < 1 && std::abs(c[1] - 2) < 1;
    options.given.surface.push_back(c[2] < 2 ? 70 : middle ? 40 : NoGeometry);
  }
  Found found = find(mesh, options);
  expectConsistent(mesh, found);
  // The square has corners; the rim of the top too.
  EXPECT_EQ(counts(found.geometry), (Counts{ 8, 8, 3 }));
  std::set<Index> ids;
  for (const GeometrySurface& surface : found.geometry.surfaces)
  {
    ids.insert(surface.id);
  }
  EXPECT_EQ(ids, (std::set<Index>{ 40, 70, 71 }));

  options.featuresInside = true;
  found = find(mesh, options);
  EXPECT_EQ(counts(found.geometry), (Counts{ 12, 16, 7 }));
  EXPECT_EQ(std::count_if(found.geometry.surfaces.begin(), found.geometry.surfaces.end(),
              [](const GeometrySurface& s) { return s.id == 70; }),
    5);
}

TEST(Classification, GivenNodesComeBack)
{
  // What classify() found, given to it again under other ids, comes back; parameters to the last
  // bit.
  for (const Mesh& mesh : { meshes::hexes(1, 1, 1), meshes::tets(3, 2, 2),
         meshes::quadraticTets(2, 2, 2), shapes::boxWithHole(16, 2, 2), shapes::creasedPlate() })
  {
    const Classification g = find(mesh).geometry;
    ClassificationOptions options;
    options.given.dimension = g.dimension;
    options.given.parameter = g.parameter;
    for (Index n = 0; n < mesh.numberOfNodes(); ++n)
    {
      options.given.id.push_back(100 + 7 * g.id(n));
      double& t = options.given.parameter[n];
      t = t * t; // not by arc length
    }
    const Found found = find(mesh, options);
    expectConsistent(mesh, found);
    EXPECT_TRUE(found.warnings.empty()) << found.warnings[0];
    EXPECT_EQ(found.geometry.dimension, g.dimension);
    for (Index n = 0; n < mesh.numberOfNodes(); ++n)
    {
      if (g.dimension[n] == 0 || g.dimension[n] == 1 || g.dimension[n] == 2)
      {
        EXPECT_EQ(found.geometry.id(n), options.given.id[n]) << n;
      }
      if (g.dimension[n] == 1)
      {
        EXPECT_EQ(found.geometry.parameter[n], options.given.parameter[n]);
      }
    }
  }
}

TEST(Classification, GivenVerticesAndSeams)
{
  // A cylinder as a modeller has it: one vertex on each circle, and a seam between them.
  const Mesh mesh = shapes::cylinder(8, 4);
  Classification g = find(mesh).geometry;
  ClassificationOptions options;
  options.given.dimension = g.dimension;
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    options.given.id.push_back(g.id(n));
    const Row x = mesh.points.row(n);
    if ((x.head(2) - Eigen::RowVector2d(1, 0)).norm() < 1e-12)
    {
      const bool isEnd = x[2] == 0 || x[2] == 2;
      options.given.dimension[n] = isEnd ? 0 : 1;
      options.given.id[n] = isEnd ? static_cast<Index>(x[2]) : 9;
    }
  }
  const Found found = find(mesh, options);
  expectConsistent(mesh, found);
  EXPECT_TRUE(found.warnings.empty()) << found.warnings[0];
  EXPECT_EQ(counts(found.geometry), (Counts{ 2, 3, 3 }));
  EXPECT_EQ(loops(found.geometry), 0u);
  for (const GeometryCurve& curve : found.geometry.curves)
  {
    const bool isSeam = curve.surfaces.size() == 1;
    EXPECT_EQ(curve.id == 9, isSeam);
    EXPECT_EQ(
      curve.nodes.front() == curve.nodes.back(), !isSeam); // circles start and end at their vertex
  }
}

TEST(Classification, FaceWithoutAreaSeparatesNothing)
{
  // The middle of the top face is pulled onto its rim: two triangles lose their area, and part the
  // top face.
  Mesh mesh = meshes::tets(2, 2, 1);
  const Counts expected = counts(find(mesh).geometry);
  Index center = -1, side = -1;
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    center = mesh.points.row(n) == Row(1, 1, 1) ? n : center;
    side = mesh.points.row(n) == Row(1, 0, 1) ? n : side;
  }
  mesh.points.row(center) = mesh.points.row(side);
  const Found found = find(mesh);
  EXPECT_EQ(counts(found.geometry), expected);
}

TEST(Classification, OpenSurface)
{
  // The top of a box without one of its faces: rim and gap are curves.
  Mesh mesh = meshes::hexes(4, 4, 1);
  meshes::ThreadedMonitor monitor;
  const BoundaryFaces all = boundaryFaces(mesh, monitor);
  BoundaryFaces open;
  for (std::size_t f = 0; f < all.cells.size(); ++f)
  {
    const auto first = all.connectivity.begin() + all.offsets[f];
    const std::vector<Index> nodes(first, first + 4);
    const Row center = meshes::rows(mesh.points, nodes).colwise().mean();
    if (center[2] == 1 && center != Row(1.5, 1.5, 1))
    {
      open.add(nodes.begin(), nodes.end());
    }
  }
  open.takeNodes();
  const Classification g = classify(mesh.points, open, {}, monitor);
  EXPECT_EQ(counts(g), (Counts{ 8, 8, 1 }));
  EXPECT_EQ(g.dimension[0], -1); // on no face
}

TEST(Classification, WrongInputIsNamed)
{
  const Mesh mesh = meshes::hexes(2, 2, 2);
  const auto message = [&](const std::function<void(ClassificationOptions&)>& change)
  {
    ClassificationOptions options;
    change(options);
    return motions::messageOf([&] { find(mesh, options); });
  };
  const auto has = [](const std::string& text, const char* part)
  { return text.find(part) != std::string::npos; };
  EXPECT_TRUE(has(message([](auto& o) { o.featureAngle = -1; }), "feature angle"));
  EXPECT_TRUE(has(message([](auto& o) { o.cornerAngle = NAN; }), "corner angle"));
  EXPECT_TRUE(has(message([](auto& o) { o.given.surface = { 1, 2 }; }), "24 are needed"));
  EXPECT_TRUE(has(message([](auto& o) { o.given.dimension.assign(27, 2); }), "without its ids"));
  EXPECT_TRUE(has(message(
                    [](auto& o)
                    {
                      o.given.dimension.assign(27, 2);
                      o.given.dimension[5] = 3;
                      o.given.id.assign(27, 0);
                    }),
    "node ids 5."));
  EXPECT_TRUE(has(message(
                    [](auto& o)
                    {
                      o.given.dimension.assign(27, 2);
                      o.given.id.assign(27, 0);
                      o.given.id[8] = 1;
                    }),
    "another surface: node ids"));

  // A node said to be on a curve in the middle of a face.
  ClassificationOptions options;
  const Classification g = find(mesh).geometry;
  options.given.dimension = g.dimension;
  for (Index n = 0; n < 27; ++n)
  {
    options.given.id.push_back(g.id(n));
  }
  options.given.dimension[4] = 1;
  options.given.id[4] = 77;
  const Found found = find(mesh, options);
  ASSERT_EQ(found.warnings.size(), 1u);
  EXPECT_NE(found.warnings[0].find("node ids 4:"), std::string::npos) << found.warnings[0];
}

TEST(Classification, CancelsAndTakesAnEmptyMesh)
{
  Mesh none;
  none.points.resize(0, 3);
  EXPECT_EQ(counts(find(none).geometry), (Counts{ 0, 0, 0 }));

  const Mesh mesh = meshes::hexes(2, 2, 2);
  meshes::ThreadedMonitor monitor;
  const BoundaryFaces faces = boundaryFaces(mesh, monitor);
  monitor.cancelAt = 0.5;
  EXPECT_THROW(classify(mesh, faces, {}, monitor), Error);
}
