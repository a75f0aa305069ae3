// SPDX-License-Identifier: BSD-3-Clause
// Fits to the motion of points that are nearly in a plane or on a line: their unevenness is not
// multiplied out over what lies far from them, and it shows continuously.
#include "Meshes.h"
#include "Motions.h"

#include "BoundaryMorphing/HandleMotion.h"
#include "BoundaryMorphing/KnownMotion.h"
#include "BoundaryMorphing/SurfaceMorph.h"
#include "BoundaryMorphing/SurfaceResidual.h"
#include "Interpolation/AffineWeights.h"
#include "LinearMethods/BodyMotion.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/WeightedResidual.h"
#include "Mesh/Topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

using namespace morph;
using motions::Row;

namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr double Motion = 0.01; ///< of every prescribed point at most

/// A motion that is like nothing in a mesh.
Row wave(const Row& x)
{
  return Motion / 2 *
         Row(std::sin(9 * x[0]), std::cos(7 * x[1]), std::sin(8 * x[0] + 5 * x[1] + 1));
}

/// In [-1, 1], different at each place.
double roughness(double x, double y)
{
  return std::sin(1e3 * (x + 0.1) * (y + 0.3));
}

/// A unit cube whose lower wall is uneven. Its layers grow upwards.
struct Cube
{
  Mesh mesh = meshes::layered(meshes::hexes, 6, 0.1, 1.2);
  NodePartition partition;
  Points target;

  explicit Cube(double uneven)
  {
    std::vector<Index> wall;
    meshes::transform(this->mesh, [&](const Row& x)
      { return Row(x + Row(0, 0, (1 - x[2]) * uneven * roughness(x[0], x[1]))); });
    for (Index i = 0; i < 49; ++i)
    {
      wall.push_back(i);
    }
    this->partition = partitionNodes(this->mesh, wall);
    this->target =
      motions::targets(this->mesh, this->partition, [](const Row& x) { return Row(x + wave(x)); });
  }

  Points morphed(Morpher& method) const
  {
    Monitor monitor;
    Points moved = motions::morphed(method, this->mesh, this->partition, this->target, monitor);
    return moved - this->mesh.points;
  }
};

/// The displacements of a dome on an uneven rim.
Points dome(double uneven, const std::function<Row(double)>& motion)
{
  constexpr Index Around = 60;
  Points rim(Around, 3), moved(Around, 3), points(3, 3), result;
  SurfaceResidual::Loops loops(1);
  for (Index i = 0; i < Around; ++i)
  {
    const double a = 2 * Pi * static_cast<double>(i) / Around;
    rim.row(i) << std::cos(a), std::sin(a), uneven * std::cos(5 * a);
    moved.row(i) = rim.row(i) + motion(a);
    loops[0].push_back(i);
  }
  points << 0, 0, .5, .5, 0, .375, .8, 0, .18;
  Monitor monitor;
  SurfaceResidual surface;
  surface.prepare(rim, points, loops, monitor);
  surface.evaluate(moved, result, monitor);
  return result - points;
}

/// The displacements of places around uneven nodes, in a plane or on a line.
Points following(double uneven, bool onLine, UnattachedMotion how)
{
  BoundaryMotion motion;
  motion.rest.resize(27, 3);
  motion.displacement = Points::Zero(27, 3);
  std::vector<Index> known(25), others = { 25, 26 };
  std::iota(known.begin(), known.end(), Index(0));
  for (const Index i : known)
  {
    const double x = static_cast<double>(i % 5) / 4, y = static_cast<double>(i / 5) / 4;
    motion.rest.row(i) << x, onLine ? uneven * roughness(y, x) : y, uneven * roughness(x, y);
    motion.displacement.row(i) = wave(Row(x, y, 0));
  }
  motion.rest.bottomRows(2) << .5, .5, .9, .2, .9, -.7;
  const MotionSums sums(motion, known);
  MotionAround around;
  around.add(sums, sums.directions(motion.rest.bottomRows(2)), 1);
  extrapolate(around, others, how, motion);
  return motion.displacement.bottomRows(2);
}

Points handled(double uneven)
{
  std::vector<Handle> handles;
  for (int i = 0; i < 16; ++i)
  {
    const double x = i % 4 / 3., y = i / 4 / 3.;
    handles.push_back({ Row(x, y, uneven * roughness(x, y)), wave(Row(x, y, 0)), 0 });
  }
  Points places(2, 3);
  places << .5, .5, .7, .1, .9, -.5;
  Monitor monitor;
  return HandleMotion(handles).displacements(places, monitor);
}

Points started(double uneven)
{
  const Cube cube(uneven);
  Points points = cube.mesh.points;
  followAffinely(cube.mesh, connectedComponents(cube.mesh), cube.partition,
    cube.target - meshes::rows(cube.mesh.points, cube.partition.prescribed), points);
  return points - cube.mesh.points;
}

Points extended(double uneven)
{
  const Cube cube(uneven);
  Monitor monitor;
  const BoundaryFaces faces = boundaryFaces(cube.mesh, monitor);
  BoundaryMotion motion;
  motion.rest = cube.mesh.points;
  motion.displacement = Points::Zero(motion.rest.rows(), 3);
  for (const Index node : cube.partition.prescribed)
  {
    motion.displacement.row(node) = wave(motion.rest.row(node));
  }
  std::vector<Index> all(faces.offsets.size() - 1), free;
  std::iota(all.begin(), all.end(), Index(0));
  std::set_difference(faces.nodes.begin(), faces.nodes.end(), cube.partition.prescribed.begin(),
    cube.partition.prescribed.end(), std::back_inserter(free));
  extendHarmonically(faces, all, cube.partition.prescribed, free, motion, monitor);
  return motion.displacement;
}

struct Situation
{
  const char* name;
  std::function<Points(double)> displacements;
};

const std::vector<Situation> situations = {
  { "dome on a rim that moves as it is uneven", [](double e)
    { return dome(e, [](double a) { return Row(0, 0, Motion * std::cos(5 * a)); }); } },
  { "dome on a rim that moves in other ways",
    [](double e)
    {
      return dome(e, [](double a)
        { return Row(Motion / 2 * Row(std::cos(3 * a), std::sin(4 * a + 1), std::sin(2 * a))); });
    } },
  { "weighted residual",
    [](double e)
    {
      WeightedResidual method;
      return Cube(e).morphed(method);
    } },
  { "FEMWARP, stiffness by volume",
    [](double e)
    {
      FemWarp method;
      CellStiffness stiffness;
      stiffness.kind = CellStiffness::Kind::InverseVolume;
      method.setStiffness(stiffness);
      return Cube(e).morphed(method);
    } },
  { "harmonic extension", extended },
  { "nodes that follow a plane affinely",
    [](double e) { return following(e, false, UnattachedMotion::FollowAffinely); } },
  { "nodes that follow a line affinely",
    [](double e) { return following(e, true, UnattachedMotion::FollowAffinely); } },
  { "nodes that follow a line rigidly",
    [](double e) { return following(e, true, UnattachedMotion::FollowRigidly); } },
  { "handles", handled },
  { "start of the smoothing", started },
};
}

TEST(NearlyFlat, UnevennessIsNotMultipliedOut)
{
  for (const Situation& situation : situations)
  {
    double largest = 0, at = 0;
    for (double uneven = 1e-9; uneven <= 0.1; uneven *= 1.5)
    {
      const double here = situation.displacements(uneven).rowwise().norm().maxCoeff();
      at = here > largest ? uneven : at;
      largest = std::max(largest, here);
    }
    EXPECT_LE(largest, 10 * Motion) << situation.name << ", uneven by " << at;
    EXPECT_GT(largest, 0.1 * Motion) << situation.name;
  }
}

TEST(NearlyFlat, UnevennessShowsContinuously)
{
  constexpr double Ratio = 1.05;
  for (const Situation& situation : situations)
  {
    Points before = situation.displacements(1e-9);
    double largest = 0, at = 0;
    for (double uneven = 1e-9 * Ratio; uneven <= 0.1; uneven *= Ratio)
    {
      const Points now = situation.displacements(uneven);
      const double change = (now - before).rowwise().norm().maxCoeff();
      at = change > largest ? uneven : at;
      largest = std::max(largest, change);
      before = now;
    }
    // The share of a direction changes by a tenth in a step.
    EXPECT_LE(largest, 1.1 * Motion) << situation.name << ", uneven by " << at;
  }
}

TEST(NearlyFlat, AffineMotionsOfBoundariesAroundTheMeshStayExact)
{
  // The whole boundary of a slab, and that of a cube with most of its nodes in one corner.
  for (const auto& scale : { Row(1, 1, 1e-4), Row(1, 1, 1) })
  {
    Mesh mesh = meshes::hexes(6, 6, 6);
    meshes::transform(mesh, [&](const Row& x)
      { return Row((x / 6).array().pow(scale[2] < 1 ? 1 : 12) * scale.array()); });
    const NodePartition partition = motions::outerPartition(mesh);
    WeightedResidual method;
    Monitor monitor;
    Points moved = motions::morphed(
      method, mesh, partition, motions::targets(mesh, partition, motions::affine), monitor);
    EXPECT_LT(motions::difference(moved, motions::mapped(mesh.points, motions::affine)), 1e-11);
  }
}

TEST(NearlyFlat, WeightsOfFarNodesAreBounded)
{
  Points place(1, 3);
  place << .3, .4, 5;
  for (double uneven = 1e-9; uneven <= 0.1; uneven *= 3)
  {
    const Cube cube(uneven);
    Monitor monitor;
    const Points sites = meshes::rows(cube.mesh.points, cube.partition.prescribed);
    const std::vector<AffineRow> rows = affineWeights(sites, place, 10, monitor);
    for (const double weight : rows[0].weights)
    {
      EXPECT_LE(std::abs(weight), 10) << uneven;
    }
  }
}
