// SPDX-License-Identifier: BSD-3-Clause
// Named parts of a boundary move, others follow or slide: the engine of the filters without VTK.
#include "BoundaryMover/BoundaryMover.h"
#include "BoundaryMover/FitToTarget.h"
#include "BoundaryMover/Patches.h"
#include "BoundaryMover/PrescribedMotion.h"
#include "BoundaryMover/Surroundings.h"
#include "BoundaryShapes.h"
#include "LinearMethods/FemWarp.h"
#include "Meshes.h"
#include "Session/Session.h"
#include "Support/Error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace
{
using namespace morph;
using Row = Eigen::RowVector3d;

/// With a node set TOP where z is largest.
BoundaryModel modelOf(const morph::Mesh& mesh)
{
  morph::Monitor monitor;
  BoundaryModel model;
  model.mesh = mesh;
  model.findFaces(std::vector<std::uint8_t>(mesh.numberOfCells(), 0), monitor);
  model.geometry = morph::classify(model.mesh, model.faces, {}, monitor);
  std::vector<std::uint8_t> isTop(mesh.numberOfNodes(), 0);
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    isTop[n] = mesh.points(n, 2) > mesh.points.col(2).maxCoeff() - 1e-9;
  }
  model.takeSets(
    { morph::boundarySet("TOP", model.mesh, model.faces, model.inner.size(), isTop, {}) });
  model.inputVersion = model.motionVersion = 1;
  return model;
}

/// The number of the surface whose nodes all have that coordinate.
Index surfaceAt(const BoundaryModel& model, int axis, double value)
{
  const auto& surfaces = model.geometry.surfaces;
  const auto found = std::find_if(surfaces.begin(), surfaces.end(),
    [&](const morph::GeometrySurface& surface)
    {
      return std::all_of(surface.nodes.begin(), surface.nodes.end(),
        [&](Index n) { return std::abs(model.points()(n, axis) - value) < 1e-9; });
    });
  return found - surfaces.begin();
}
}

TEST(BoundaryMover, ASetOfNodesIsListedFirstWithItsArea)
{
  const BoundaryModel model = modelOf(meshes::hexes(4, 3, 2));
  const std::vector<morph::PatchSize> sizes = morph::patchSizes(model);
  ASSERT_EQ(sizes.size(), 1u + 6u + 12u); // surfaces and edges of a box
  EXPECT_EQ(sizes[0].name, "TOP");
  EXPECT_EQ(sizes[0].count, 12);
  EXPECT_NEAR(sizes[0].measure, sizes[0].box.sizes()[0] * sizes[0].box.sizes()[1], 1e-12);
  EXPECT_FALSE(sizes[0].isInner);
  EXPECT_THROW(morph::choosePatches(model, { "BOTTOM" }, {}), morph::Error);
}

TEST(BoundaryMover, BothSidesOfABaffleMoveUnlessOneIsHeld)
{
  morph::Monitor monitor;
  morph::Mesh mesh = meshes::hexes(4, 3, 3);
  const Index old = mesh.numberOfNodes(); // a slit in the middle, open at y = 0, gets new ones
  mesh.points.conservativeResize(2 * old, 3);
  mesh.points.bottomRows(old) = mesh.points.topRows(old);
  for (Index& node : mesh.connectivity)
  {
    const Index i = node % 5, j = node / 5 % 4, k = node / 20;
    const Index cell = (&node - mesh.connectivity.data()) / 8;
    node += i == 2 && j < 3 && k > 0 && k < 3 && cell % 4 >= 2 ? old : 0;
  }
  const BoundaryModel model = modelOf(mesh);
  Choice choice;
  choice.moving = { 2 + 20 }; // a node of the slit
  choice.isMovingFace.resize(model.faces.cells.size(), 0);
  const Points targets = model.points().row(22) + Row(0.1, 0, 0);
  BoundaryMover mover;
  const Points both = mover.move(model, choice, targets, {}, nullptr, monitor).moved;
  EXPECT_TRUE(mover.movesOtherSides());
  EXPECT_EQ(both.row(22 + old), targets.row(0));
  choice.held = { 22 + old };
  const Points one = mover.move(model, choice, targets, {}, nullptr, monitor).moved;
  EXPECT_EQ(one.row(22), targets.row(0));
  EXPECT_EQ(one.row(22 + old), model.points().row(22));
}

TEST(BoundaryMover, AllSidesAtAPlaceMoveWhateverTheirNumbersAre)
{
  // Three columns of cells around an edge with nodes of their own: two baffles that meet.
  morph::Monitor monitor;
  for (int held = 1; held < 3; ++held)
  {
    morph::Mesh mesh = meshes::hexes(2, 2, 3);
    const Index old = mesh.numberOfNodes(), edge = 4 + 9; // the middle of the box, one layer up
    mesh.points.conservativeResize(old + 2, 3);
    mesh.points.bottomRows(2).rowwise() = mesh.points.row(edge);
    for (Index& node : mesh.connectivity)
    {
      const Index cell = (&node - mesh.connectivity.data()) / 8 % 4;
      node = node == edge && cell > 1 ? old + cell - 2 : node;
    }
    const BoundaryModel model = modelOf(mesh);
    Choice choice;
    choice.moving = { edge };
    choice.held = { old + held - 1 };
    choice.isMovingFace.resize(model.faces.cells.size(), 0);
    const Points targets = model.points().row(edge) + Row(0.1, 0, 0);
    BoundaryMover mover;
    const Points moved = mover.move(model, choice, targets, {}, nullptr, monitor).moved;
    EXPECT_EQ(moved.row(old + 2 - held), targets.row(0)) << held;
    EXPECT_EQ(moved.row(old + held - 1), model.points().row(edge)) << held;
  }
}

TEST(BoundaryMover, NodesOfACracksFrontFollowTogether)
{
  // Six wedges around the z axis as hexahedra, each of which has nodes of its own there.
  morph::Monitor monitor;
  morph::Mesh mesh;
  mesh.points.resize(48, 3);
  for (Index i = 0; i < 6; ++i)
  {
    for (Index k = 0; k < 4; ++k)
    {
      const double phi = M_PI / 3 * static_cast<double>(i), z = static_cast<double>(k);
      mesh.points.row(8 * i + 2 * k) << 0, 0, z;
      mesh.points.row(8 * i + 2 * k + 1) << std::cos(phi), std::sin(phi), z;
    }
    for (Index k = 0; k < 3; ++k)
    {
      const Index a = 8 * i + 2 * k, b = 8 * ((i + 1) % 6) + 2 * k;
      mesh.add(morph::Hexahedron, { a, a + 1, b + 1, b, a + 2, a + 3, b + 3, b + 2 });
    }
  }
  const BoundaryModel model = modelOf(mesh);
  Choice choice;
  choice.moving = { 7 }; // on the rim of the top
  choice.isMovingFace.resize(model.faces.cells.size(), 0);
  const Points targets = model.points().row(7) + Row(0.1, 0.2, 0.1);
  BoundaryMover mover;
  const Points moved = mover.move(model, choice, targets, {}, nullptr, monitor).moved;
  EXPECT_GT((moved.row(6) - model.points().row(6)).norm(), 1e-3);
  for (Index i = 1; i < 6; ++i)
  {
    EXPECT_LT((moved.row(8 * i + 6) - moved.row(6)).norm(), 1e-12) << i;
  }
}

TEST(BoundaryMover, OuterSurfacesAreTheSameWhereAnInterfaceIsAskedFor)
{
  morph::Monitor monitor;
  for (const auto& [name, mesh] : meshes::all(4, 4, 4))
  {
    BoundaryModel with;
    with.mesh = mesh;
    std::vector<morph::NamedCells> parts = { { "a", {} }, { "b", {} } };
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      parts[c % 3 == 0].cells.push_back(c); // a ragged interface
    }
    with.innerSurfaces = morph::innerSurfaces(mesh, parts, {}, monitor);
    const std::vector<std::uint8_t> none(mesh.numberOfCells(), 0);
    with.findFaces(none, monitor);
    const morph::Classification without =
      morph::classify(mesh, with.faces, morph::ClassificationOptions(), monitor);
    with.asked = { "a | b" };
    with.findFaces(none, monitor);
    morph::ClassificationOptions options;
    options.sheets = with.sheetNumbers();
    ASSERT_EQ(options.sheets.size(), with.innerSurfaces[0].places.size()) << name;
    const morph::Classification all = morph::classify(mesh, with.faces, options, monitor);
    ASSERT_GT(all.surfaces.size(), without.surfaces.size()) << name;
    for (std::size_t s = 0; s < without.surfaces.size(); ++s)
    {
      EXPECT_EQ(all.surfaces[s].id, without.surfaces[s].id) << name;
      EXPECT_EQ(all.surfaces[s].faces, without.surfaces[s].faces) << name;
      EXPECT_EQ(all.surfaces[s].nodes, without.surfaces[s].nodes) << name;
      EXPECT_EQ(all.surfaces[s].curves, without.surfaces[s].curves) << name;
    }
    ASSERT_EQ(all.curves.size(), without.curves.size()) << name;
    for (std::size_t c = 0; c < without.curves.size(); ++c)
    {
      EXPECT_EQ(all.curves[c].nodes, without.curves[c].nodes) << name;
      EXPECT_EQ(all.curves[c].surfaces, without.curves[c].surfaces) << name;
    }
    for (Index n = 0; n < mesh.numberOfNodes(); ++n)
    {
      if (without.dimension[n] < 3)
      {
        EXPECT_EQ(all.dimension[n], without.dimension[n]) << name << n;
        EXPECT_EQ(all.entity[n], without.entity[n]) << name << n;
      }
    }
  }
}

TEST(BoundaryMover, AnInterfaceTakesNoIdOfTheCellsBehindIt)
{
  morph::Monitor monitor;
  BoundaryModel model;
  model.mesh = meshes::hexes(4, 4, 4);
  std::vector<morph::NamedCells> parts = { { "a", {} }, { "b", {} } };
  for (Index c = 0; c < model.mesh.numberOfCells(); ++c)
  {
    parts[c >= 32].cells.push_back(c);
  }
  model.innerSurfaces = morph::innerSurfaces(model.mesh, parts, {}, monitor);
  model.asked = { "a | b" };
  model.findFaces(std::vector<std::uint8_t>(64, 0), monitor);
  morph::ClassificationOptions options;
  options.sheets = model.sheetNumbers();
  for (const Index cell : model.faces.cells)
  {
    options.given.surface.push_back(cell % 2); // in stripes: two parts of the interface, too
  }
  const morph::Classification geometry = morph::classify(model.mesh, model.faces, options, monitor);
  EXPECT_EQ(geometry.surfaces.back().faces.size(), 16u);
  for (std::size_t s = 0; s + 1 < geometry.surfaces.size(); ++s)
  {
    EXPECT_LT(geometry.surfaces[s].id, geometry.surfaces.back().id);
  }
}

TEST(BoundaryMover, SidesFollowATopThatTurnsWithinTheirPlanes)
{
  const BoundaryModel model = modelOf(meshes::hexes(4, 4, 4));
  const morph::Choice choice = morph::choosePatches(model, { "TOP" }, {});
  morph::Placement shift;
  shift.translation = { 0.1, 0, 0 };
  const Points targets = model.points()(choice.moving, morph::allColumns).rowwise() +
                         morph::affineMotion(shift).col(0).transpose();
  morph::Monitor monitor;
  morph::Surroundings surroundings;
  const auto result = surroundings.spread(model, choice, targets, {}, monitor);
  EXPECT_EQ(Points(result.moved(choice.moving, morph::allColumns)), targets);
  for (const double y : { model.points().col(1).minCoeff(), model.points().col(1).maxCoeff() })
  {
    for (const Index n : model.geometry.surfaces[surfaceAt(model, 1, y)].nodes)
    {
      EXPECT_NEAR(result.moved(n, 1), y, 1e-12);
    }
  }
}

namespace
{
/// Linear hexahedra beside quadratic ones.
morph::Mesh halfLinear()
{
  morph::Mesh mesh;
  const morph::Mesh all = meshes::quadraticHexes(4, 2, 2, false);
  mesh.points = all.points;
  for (Index c = 0; c < all.numberOfCells(); ++c)
  {
    const bool isLinear = all.points(all.cell(c)[1], 0) <= 2;
    meshes::add(mesh, isLinear ? std::uint8_t(morph::Hexahedron) : all.types[c],
      { all.cell(c), all.cell(c) + (isLinear ? 8 : 20) });
  }
  return mesh;
}
}

TEST(BoundaryMover, NodesBetweenCornersStayOnEdgesOfLinearCells)
{
  const BoundaryModel model = modelOf(halfLinear());
  ASSERT_EQ(model.onLinearEdges.size(), 8u); // around the box, where the cells meet
  const morph::Choice choice = morph::choosePatches(model, { "TOP" }, {});
  Points targets = model.points()(choice.moving, morph::allColumns);
  targets.col(2).array() += 0.1 * targets.col(1).array().square() + 0.1 * targets.col(0).array();
  meshes::ThreadedMonitor monitor;
  morph::Surroundings surroundings;

  const auto result = surroundings.spread(model, choice, targets, {}, monitor);

  for (const Index k : model.onLinearEdges)
  {
    const Index *ends = model.faces.between.begin(k), node = model.faces.nodes[k];
    const Row middle = (result.moved.row(ends[0]) + result.moved.row(ends[1])) / 2;
    const bool moves = result.roles[node] == morph::Surroundings::Moves;
    EXPECT_TRUE(moves || (Row(result.moved.row(node)) - middle).norm() < 1e-12) << node;
  }
}

TEST(BoundaryMover, NodesThatABoundaryTakesOffEdgesOfLinearCellsAreNamed)
{
  const morph::Mesh mesh = halfLinear();
  const std::vector<Index> ids = modelOf(mesh).faces.nodes;
  morph::Points targets = mesh.points(ids, morph::allColumns);
  morph::Session session;
  morph::Session::Options options;
  options.createMorpher = [] { return std::make_unique<morph::FemWarp>(); };
  meshes::ThreadedMonitor monitor;
  session.setMesh(mesh, monitor);
  targets.col(0).array() += 0.1 * targets.col(2).array(); // edges stay straight
  session.morph({ ids, targets }, options, monitor);
  EXPECT_TRUE(monitor.warnings.empty());

  targets.col(0).array() += 0.1 * targets.col(2).array().square();
  session.morph({ ids, targets }, options, monitor);

  ASSERT_EQ(monitor.warnings.size(), 1u);
  EXPECT_NE(monitor.warnings[0].find("part from linear ones beside them by up to 0.025:"),
    std::string::npos);
}

TEST(BoundaryMover, APlacementScalesThenTurnsThenShifts)
{
  morph::Placement placement;
  placement.scale = { 2, 1, 1 };
  placement.rotation = { 0, 0, 90 };
  placement.translation = { 0, 0, 5 };
  const morph::AffineMotion motion = morph::affineMotion(placement);
  const Row x(1, 3, 0);
  const Row to = x + morph::affineDisplacement(motion, { 1, x[0], x[1], x[2] });
  EXPECT_NEAR((to - Row(-3, 2, 5)).norm(), 0, 1e-14);
}

TEST(BoundaryMover, ATopGoesToATargetAndItsRimStaysInTheSlidingSides)
{
  const BoundaryModel model = modelOf(meshes::hexes(5, 5, 3));
  const morph::Choice choice = morph::choosePatches(model, { "TOP" }, {});
  // A roof over the box: z = top + 0.1 x.
  const double top = model.points().col(2).maxCoeff();
  Points corners(4, 3);
  corners << -9, -9, top - 0.9, 9, -9, top + 0.9, 9, 9, top + 0.9, -9, 9, top - 0.9;
  morph::Monitor monitor;
  morph::Target::Options options;
  options.reach = 5;
  morph::Target target(corners, { { 0, 1, 2 }, { 0, 2, 3 } }, model.points(), options, monitor);
  std::vector<Index> sides;
  for (int axis = 0; axis < 2; ++axis)
  {
    sides.push_back(surfaceAt(model, axis, model.points().col(axis).minCoeff()));
    sides.push_back(surfaceAt(model, axis, model.points().col(axis).maxCoeff()));
  }
  std::sort(sides.begin(), sides.end());
  morph::Surroundings surroundings;
  const Points fitted = morph::fittedTo(target, model, choice, sides, {}, surroundings, monitor);
  for (std::size_t i = 0; i < choice.moving.size(); ++i)
  {
    const Row from = model.points().row(choice.moving[i]), to = fitted.row(static_cast<Index>(i));
    EXPECT_NEAR(to[2], top + 0.1 * to[0], 1e-12);
    for (int axis = 0; axis < 2; ++axis)
    {
      const bool isOnSide = from[axis] < model.points().col(axis).minCoeff() + 1e-9 ||
                            from[axis] > model.points().col(axis).maxCoeff() - 1e-9;
      EXPECT_NEAR(isOnSide ? to[axis] - from[axis] : 0, 0, 1e-12);
    }
  }
}
