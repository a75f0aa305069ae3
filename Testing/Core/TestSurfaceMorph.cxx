// SPDX-License-Identifier: BSD-3-Clause
#include "ClassifiedShape.h"
#include "Motions.h"

#include "Boundary/FaceQuality.h"
#include "BoundaryMorphing/SurfaceMorph.h"
#include "Support/Error.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

using namespace morph;
using shapes::Row;

namespace
{
using Map = std::function<Row(const Row&)>;
using Method = SurfaceMorphOptions::Method;

constexpr Method Methods[] = { Method::WeightedResidual, Method::HarmonicExtension };

SurfaceMorphOptions by(Method method)
{
  SurfaceMorphOptions options;
  options.method = method;
  return options;
}

SurfaceMorphOptions leaving(UnattachedMotion how)
{
  SurfaceMorphOptions options;
  options.unattached = how;
  return options;
}

struct Case : shapes::ClassifiedShape
{
  using ClassifiedShape::ClassifiedShape;

  Points morph(const std::vector<Index>& ids, const Map& map,
    const SurfaceMorphOptions& options = {}, int threads = 1,
    SurfaceMorphReport* report = nullptr) const
  {
    meshes::ThreadedMonitor monitor(threads);
    BoundaryMotion motion = this->begin(ids, map);
    morphCurves(this->geometry, options.unattached, motion, monitor);
    const SurfaceMorphReport done =
      morphSurfaces(this->faces, this->geometry, options, motion, monitor);
    if (report)
    {
      *report = done;
    }
    return motion.moved();
  }

  double worst(const Points& moved, const Map& map) const
  {
    double worst = 0;
    for (Index node : this->faces.nodes)
    {
      worst = std::max(worst, (moved.row(node) - map(this->mesh.points.row(node))).norm());
    }
    return worst / meshes::size(moved);
  }
};

Map randomAffine(unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  Eigen::Matrix3d A;
  do
  {
    A = Eigen::Matrix3d::NullaryExpr([&] { return number(random); });
  } while (A.determinant() < 0.2);
  const Row shift(5 * number(random), 5 * number(random), 5 * number(random));
  return [A, shift](const Row& x) { return Row(x * A.transpose() + shift); };
}

Row twist(const Row& x)
{
  const double a = 0.2 * x[2];
  return Row(x[0] * std::cos(a) - x[1] * std::sin(a) + 0.05 * x[1] * x[1],
    x[0] * std::sin(a) + x[1] * std::cos(a), x[2] + 0.03 * x[0] * x[0]);
}

Row same(const Row& x)
{
  return x;
}

std::vector<std::pair<std::string, Mesh>> solids()
{
  return { { "box", meshes::hexes(4, 3, 2) }, { "tets", meshes::tets(3, 3, 3) },
    { "tet10", meshes::quadraticTets(2, 2, 2) }, { "hex27", meshes::quadraticHexes(3, 2, 2, true) },
    { "hole", shapes::boxWithHole(32, 4, 3) }, { "cylinder", shapes::cylinder(8, 4) },
    { "hollow ball", shapes::hollowBall(8) }, { "creased", shapes::creasedPlate() },
    { "two bodies", shapes::together(shapes::boxWithHole(16, 2, 2), meshes::tets(2, 2, 2)) } };
}
}

TEST(SurfaceMorph, SymmetriesUnitAndOriginGoThrough)
{
  // One face turns in its plane, and its sides follow. Many edge nodes are equally far from theirs.
  Mesh cube = meshes::hexes(6, 6, 6);
  cube.points.array() -= 3;
  const auto turn = [](const Row& x)
  {
    const double c = std::cos(.5), s = std::sin(.5);
    return Row(c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]);
  };
  const auto top = [](const Case& c, const Row& normal, double at)
  {
    std::vector<Index> ids;
    for (Index node : c.faces.nodes)
    {
      if (std::abs(c.mesh.points.row(node).dot(normal) - at) < .1 * at)
      {
        ids.push_back(node);
      }
    }
    return ids;
  };
  const Case here(cube);
  const Points expected = here.morph(top(here, Row(0, 0, 1), 3), turn) - cube.points;
  for (const Eigen::Matrix3d& S : motions::symmetries())
  {
    const Points result = here.morph(top(here, Row(0, 0, 1) * S, 3),
      [&](const Row& x) { return Row(turn(x * S.transpose()) * S); });
    const std::vector<Index> images = motions::images(cube.points, S);
    EXPECT_LT(motions::difference(meshes::rows(result - cube.points, images), expected * S), 6e-9)
      << S;
  }
  for (const double unit : { 1e-9, 1e-3, 1e6 })
  {
    Mesh scaled = cube;
    scaled.points *= unit;
    const Case other(scaled);
    const Points moved = other.morph(top(other, Row(0, 0, unit), 3 * unit * unit),
      [&](const Row& x) { return Row(unit * turn(x / unit)); });
    EXPECT_LT(motions::difference((moved - scaled.points) / unit, expected), 6e-9) << unit;
  }
  Mesh shifted = cube;
  shifted.points.array() += 6e6;
  const Case far(shifted);
  std::vector<Index> ids = top(here, Row(0, 0, 1), 3);
  const Row origin = Row::Constant(6e6);
  const Points moved = far.morph(ids, [&](const Row& x) { return Row(origin + turn(x - origin)); });
  EXPECT_LT(motions::difference(moved - shifted.points, expected), 1e-7);
}

TEST(SurfaceMorph, NoMotionIsTheIdentityBitForBit)
{
  for (const auto& [name, mesh] : solids())
  {
    const Case c(mesh);
    for (const Method method : Methods)
    {
      for (int highest = 0; highest <= 2; ++highest)
      {
        const std::vector<Index> ids = c.upTo(highest);
        if (!ids.empty())
        {
          const Points moved = c.morph(ids, same, by(method));
          EXPECT_EQ(moved, mesh.points) << name;
        }
      }
    }
  }
}

TEST(SurfaceMorph, AffineMotionOfTheVerticesMovesEverything)
{
  // Closed curves without a vertex too; on the cylinder and the ball no vertex says anything.
  for (unsigned k = 0; k < 3; ++k)
  {
    const Map map = randomAffine(meshes::seed() + k);
    for (const auto& [name, mesh] : solids())
    {
      const Case c(mesh);
      for (const Method method : Methods)
      {
        for (int highest = 0; highest <= 1; ++highest)
        {
          const std::vector<Index> ids = c.upTo(highest);
          if (!ids.empty())
          {
            EXPECT_LE(c.worst(c.morph(ids, map, by(method)), map), 1e-10) << name;
          }
        }
      }
    }
  }
}

TEST(SurfaceMorph, CurvedCurvesFollowAffineMotions)
{
  // A quarter of a disc: each arc's ends alone do not tell how its bulge moves, the other vertices
  // do.
  Mesh mesh = meshes::hexes(4, 6, 3);
  meshes::transform(mesh,
    [](const Row& x)
    {
      const double a = x[1] * std::acos(0.) / 6, r = 1 + 0.25 * x[0];
      return Row(r * std::cos(a), r * std::sin(a), 0.3 * x[2]);
    });
  const Case c(mesh);
  ASSERT_EQ(c.geometry.vertices.size(), 8u);
  const Map map = randomAffine(meshes::seed());
  BoundaryMotion motion = c.begin(c.upTo(0), map);
  Monitor monitor;
  morphCurves(c.geometry, UnattachedMotion::FollowAffinely, motion, monitor);
  const Points moved = motion.moved();
  for (Index node : c.upTo(1))
  {
    EXPECT_LE((moved.row(node) - map(mesh.points.row(node))).norm(), 1e-12);
  }
}

TEST(SurfaceMorph, GivenNodesAreExactAndTheOthersBlend)
{
  const Case c(meshes::hexes(4, 3, 2));
  // One vertex moves, the others are held: displacements fall off linearly along its curves.
  const std::vector<Index> one = { 0 };
  const Row to(-0.3, -0.2, 0.1);
  BoundaryMotion motion = c.begin(one, [&](const Row&) { return to; });
  EXPECT_EQ(motion.count(BoundaryMotion::Held), 7);
  Monitor monitor;
  morphCurves(c.geometry, UnattachedMotion::FollowAffinely, motion, monitor);
  for (Index i = 0; i <= 4; ++i)
  {
    EXPECT_LE((motion.displacement.row(i) - (1 - i / 4.) * to).norm(), 1e-15);
  }
  // A node given on a curve splits it.
  BoundaryMotion split = c.begin({ 2 }, [](const Row& x) { return Row(x + Row(0, 1, 0)); });
  morphCurves(c.geometry, UnattachedMotion::FollowAffinely, split, monitor);
  const double expected[] = { 0, 0.5, 1, 0.5, 0 };
  for (Index i = 0; i <= 4; ++i)
  {
    EXPECT_NEAR(split.displacement(i, 1), expected[i], 1e-14);
  }
  // All nodes given: exact, whatever the motion.
  const std::vector<Index> all = c.upTo(2);
  const Points moved = c.morph(all, twist);
  for (Index node : all)
  {
    EXPECT_EQ(moved.row(node), twist(c.mesh.points.row(node)));
  }
}

TEST(SurfaceMorph, NodesOfAClosedCurveBlendAcrossItsStart)
{
  const Case hole(shapes::boxWithHole(32, 4, 3));
  for (const GeometryCurve& curve : hole.geometry.curves)
  {
    if (!curve.loop)
    {
      continue;
    }
    const std::vector<Index> nodes(curve.nodes.begin(), curve.nodes.begin() + 32);
    // Four nodes a quarter apart go up and down in turn, so that their affine fit vanishes.
    const Index first = 3;
    std::vector<Index> given;
    for (Index k = 0; k < 4; ++k)
    {
      given.push_back(nodes[first + 8 * k]);
    }
    const Map saddle = [&](const Row& x)
    {
      const Row start = hole.mesh.points.row(given[0]);
      const bool isUp = std::abs(x.head(2).dot(start.head(2))) > 0.5;
      return Row(x + Row(0, 0, isUp ? 0.2 : -0.2));
    };
    BoundaryMotion motion = hole.begin(given, saddle);
    Monitor monitor;
    morphCurves(hole.geometry, UnattachedMotion::FollowAffinely, motion, monitor);
    for (Index i = 0; i < 32; ++i)
    {
      const Index steps = (i - first + 32) % 16; // from a node that goes up to the next one
      const double expected = 0.2 * (steps < 8 ? 1 - steps / 4. : steps / 4. - 3);
      EXPECT_LE((motion.displacement.row(nodes[i]) - Row(0, 0, expected)).norm(), 1e-13) << i;
    }
  }
}

TEST(SurfaceMorph, ClosedCurvesAndSurfacesWithoutAnythingKnown)
{
  const Case hole(shapes::boxWithHole(32, 4, 3));
  const Map stretch = [](const Row& x) { return Row(2 * x[0], x[1], x[2] + 1); };
  const auto radii = [&](UnattachedMotion how)
  {
    const Points moved = hole.morph(hole.upTo(0), stretch, leaving(how));
    std::pair<double, double> range(1e9, 0);
    double lowest = 1e9;
    for (Index node : hole.geometry.curves[0].nodes)
    {
      lowest = std::min(lowest, moved(node, 2));
    }
    for (const GeometryCurve& curve : hole.geometry.curves)
    {
      for (Index node : curve.nodes)
      {
        if (curve.loop)
        {
          const double r = moved.row(node).head(2).norm();
          range = { std::min(range.first, r), std::max(range.second, r) };
          lowest = std::min(lowest, moved(node, 2));
        }
      }
    }
    EXPECT_NEAR(lowest, how == UnattachedMotion::Stay ? 0 : 1, 1e-12);
    return range;
  };
  EXPECT_NEAR(radii(UnattachedMotion::FollowAffinely).second, 2, 1e-12);
  EXPECT_NEAR(radii(UnattachedMotion::FollowRigidly).first, 1, 1e-12);
  EXPECT_NEAR(radii(UnattachedMotion::FollowRigidly).second, 1, 1e-12);
  EXPECT_NEAR(radii(UnattachedMotion::Stay).second, 1, 1e-12);

  // A cavity: the outer surface is given and turns.
  const Case ball(shapes::hollowBall(8));
  const Eigen::Matrix3d R =
    Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Map turn = [&](const Row& x) { return Row(x * R.transpose() + Row(1, 2, 3)); };
  std::vector<Index> outer;
  for (Index node : ball.faces.nodes)
  {
    if (ball.mesh.points.row(node).norm() > 0.9)
    {
      outer.push_back(node);
    }
  }
  for (const UnattachedMotion how :
    { UnattachedMotion::FollowAffinely, UnattachedMotion::FollowRigidly, UnattachedMotion::Stay })
  {
    SurfaceMorphReport report;
    const Points moved = ball.morph(outer, turn, leaving(how), 1, &report);
    EXPECT_EQ(report.unattached.size(), 1u);
    for (Index node : ball.faces.nodes)
    {
      const bool stays = how == UnattachedMotion::Stay && ball.mesh.points.row(node).norm() < 0.9;
      const Row expected =
        stays ? Row(ball.mesh.points.row(node)) : turn(ball.mesh.points.row(node));
      EXPECT_LE((moved.row(node) - expected).norm(), 1e-12);
    }
  }
}

TEST(SurfaceMorph, BodiesDoNotPullEachOther)
{
  // The cavity of one body follows its own body, not the other.
  Mesh far = shapes::hollowBall(8);
  meshes::transform(far, [](const Row& x) { return Row(x + Row(10, 0, 0)); });
  const Case c(shapes::together(shapes::hollowBall(8), far));
  std::vector<Index> outer;
  for (Index node : c.faces.nodes)
  {
    const Row x = c.mesh.points.row(node);
    if (std::min(x.norm(), (x - Row(10, 0, 0)).norm()) > 0.9 && std::abs(x[0] - 5) > 0)
    {
      outer.push_back(node);
    }
  }
  for (const UnattachedMotion how :
    { UnattachedMotion::FollowAffinely, UnattachedMotion::FollowRigidly })
  {
    const Map map = [](const Row& x) { return x[0] < 5 ? x : Row(x + Row(0, 3, 0)); };
    EXPECT_LE(c.worst(c.morph(outer, map, leaving(how)), map), 1e-12);
  }
}

TEST(SurfaceMorph, RigidMotionScaleAndNumberingDoNotMatter)
{
  std::mt19937 random(meshes::seed());
  const Eigen::Matrix3d R =
    Eigen::AngleAxisd(0.7, Eigen::Vector3d(3, -1, 2).normalized()).toRotationMatrix();
  const Map turned = [&](const Row& x) { return Row(1e-3 * x * R.transpose() + Row(1, 2, 3)); };
  for (const Mesh& mesh : { shapes::boxWithHole(32, 4, 3), meshes::quadraticTets(2, 2, 2) })
  {
    const Case c(mesh);
    std::vector<Index> order(mesh.numberOfNodes());
    std::iota(order.begin(), order.end(), Index(0));
    std::shuffle(order.begin(), order.end(), random);
    for (const Map& place : { Map(same), turned })
    {
      Mesh placed = meshes::renumbered(mesh, order);
      meshes::transform(placed, place);
      const Case d(placed);
      const std::vector<Index> ids = c.upTo(1);
      std::vector<Index> other;
      Points targets(static_cast<Index>(ids.size()), 3);
      for (std::size_t i = 0; i < ids.size(); ++i)
      {
        other.push_back(order[ids[i]]);
        targets.row(static_cast<Index>(i)) = place(twist(mesh.points.row(ids[i])));
      }
      for (const Method method : Methods)
      {
        SurfaceMorphOptions options;
        options.method = method;
        // Which of equally near nodes are the nearest depends on the place: here all take part.
        options.neighbors = 100000;
        const Points moved = c.morph(ids, twist, options);
        meshes::ThreadedMonitor monitor;
        BoundaryMotion motion = beginMotion(d.mesh, d.faces, d.geometry, other, targets);
        morphCurves(d.geometry, options.unattached, motion, monitor);
        morphSurfaces(d.faces, d.geometry, options, motion, monitor);
        const Points there = motion.moved();
        double worst = 0;
        for (Index node : c.faces.nodes)
        {
          worst = std::max(worst, (there.row(order[node]) - place(moved.row(node))).norm());
        }
        EXPECT_LE(worst, 1e-10 * meshes::size(there));
      }
    }
  }
}

TEST(SurfaceMorph, ThreadsDoNotShow)
{
  const Case c(shapes::boxWithHole(32, 6, 6));
  for (const Method method : Methods)
  {
    EXPECT_EQ(c.morph(c.upTo(1), twist, by(method), 1), c.morph(c.upTo(1), twist, by(method), 4));
  }
}

TEST(SurfaceMorph, SmoothingStaysWithinTheResiduals)
{
  // One vertex of a box is pulled: u is affine, and what is left of the vertices' motion bounds
  // what is left inside.
  const Case c(meshes::hexes(5, 5, 5));
  const Points moved = c.morph(
    { 0 }, [](const Row& x) { return Row(x - Row(1, 1, 1)); }, by(Method::HarmonicExtension));
  for (Index node : c.faces.nodes)
  {
    const Row u = moved.row(node) - c.mesh.points.row(node);
    EXPECT_LE(u.maxCoeff(), 0.2);
    EXPECT_GE(u.minCoeff(), -1 - 1e-12);
  }
  EXPECT_TRUE(faceQuality(c.mesh.points, moved, c.faces, c.geometry).folded.empty());
}

TEST(SurfaceMorph, BadInputIsNamed)
{
  const Case c(meshes::hexes(2, 2, 2));
  const auto message = [&](const std::vector<Index>& ids, const Points& targets)
  { return motions::messageOf([&] { beginMotion(c.mesh, c.faces, c.geometry, ids, targets); }); };
  const auto has = [](const std::string& text, const char* part)
  { return text.find(part) != std::string::npos; };
  EXPECT_TRUE(has(message({}, Points(0, 3)), "No node of the boundary is given"));
  EXPECT_TRUE(has(message({ 0, 2 }, Points::Zero(1, 3)), "2 nodes with 1 new positions"));
  EXPECT_TRUE(has(message({ 0, 27, -1 }, Points::Zero(3, 3)), "ids 27, -1."));
  EXPECT_TRUE(has(message({ 13 }, Points::Zero(1, 3)), "not on the boundary"));
  EXPECT_TRUE(has(message({ 2, 2 }, Points::Zero(2, 3)), "more than once: ids 2."));
  Points nan = Points::Zero(1, 3);
  nan(0, 1) = NAN;
  EXPECT_TRUE(has(message({ 6 }, nan), "node ids 6."));
}

TEST(SurfaceMorph, CoincidentEndsAndLengthlessCurves)
{
  // The two ends of an edge of the box in one place: its curve has no length.
  Mesh mesh = meshes::hexes(3, 3, 3);
  for (Index i = 0; i <= 3; ++i)
  {
    mesh.points.row(i) = Row(0, 0, 0);
  }
  const Case c(mesh);
  for (const Method method : Methods)
  {
    const Points moved = c.morph(c.upTo(0), twist, by(method));
    EXPECT_TRUE(moved.allFinite());
    EXPECT_EQ(moved.row(1), moved.row(0));
  }
}

TEST(SurfaceMorph, Cancels)
{
  const Case c(meshes::hexes(3, 3, 3));
  meshes::ThreadedMonitor monitor;
  monitor.cancelAt = 0.5;
  BoundaryMotion motion = c.begin(c.upTo(0), twist);
  EXPECT_THROW(morphCurves(c.geometry, UnattachedMotion::Stay, motion, monitor), Error);
}

TEST(SurfaceLoops, OuterRimAndHole)
{
  const Case c(shapes::boxWithHole(16, 2, 2));
  std::size_t rims = 0;
  for (const GeometrySurface& surface : c.geometry.surfaces)
  {
    const std::vector<std::vector<Index>> loops = boundaryLoops(c.faces, surface.faces);
    rims += loops.size();
    Row area = Row::Zero(), sum = Row::Zero();
    for (const std::vector<Index>& loop : loops)
    {
      area += vectorArea(c.mesh.points, loop.data(), static_cast<Index>(loop.size()));
    }
    for (Index f : surface.faces)
    {
      sum += vectorArea(c.mesh.points, c.faces.connectivity.data() + c.faces.offsets[f],
        c.faces.offsets[f + 1] - c.faces.offsets[f]);
    }
    EXPECT_LE((area - sum).norm(), 1e-13); // by Stokes
  }
  EXPECT_EQ(rims, 2u + 2u + 2u + 4u);
  const Case ball(shapes::ball(4),
    []
    {
      ClassificationOptions options;
      options.featureAngle = 40;
      return options;
    }());
  ASSERT_EQ(ball.geometry.surfaces.size(), 1u);
  EXPECT_TRUE(boundaryLoops(ball.faces, ball.geometry.surfaces[0].faces).empty());
}

TEST(FaceQuality, IdealAndFoldedFaces)
{
  const Case box(meshes::hexes(4, 4, 4));
  FaceQuality quality = faceQuality(box.mesh.points, box.mesh.points, box.faces, box.geometry);
  EXPECT_NEAR(quality.minimum, 1, 1e-14);
  EXPECT_NEAR(quality.mean, 1, 1e-14);
  EXPECT_TRUE(quality.folded.empty());

  // A turn by any angle, and a mirror image, leave it; so does any affine map the sign.
  for (unsigned k = 0; k < 4; ++k)
  {
    Points moved = box.mesh.points;
    const Map map = randomAffine(meshes::seed() + k);
    for (Index n = 0; n < moved.rows(); ++n)
    {
      moved.row(n) = map(moved.row(n)) * (k == 3 ? -1 : 1);
    }
    EXPECT_TRUE(faceQuality(box.mesh.points, moved, box.faces, box.geometry).folded.empty());
  }

  // A node in the middle of the top is pulled over its neighbor: faces fold, in the plane, where no
  // normal flips by much less.
  Points moved = box.mesh.points;
  Index node = -1;
  for (Index n = 0; n < moved.rows(); ++n)
  {
    node = moved.row(n) == Row(2, 2, 4) ? n : node;
  }
  moved.row(node) = Row(3.5, 2, 4);
  quality = faceQuality(box.mesh.points, moved, box.faces, box.geometry);
  EXPECT_LT(quality.minimum, 0);
  EXPECT_EQ(quality.folded.size(), 2u);
  for (Index f : quality.folded)
  {
    const Index* nodes = box.faces.connectivity.data() + box.faces.offsets[f];
    EXPECT_NE(std::find(nodes, nodes + 4, node), nodes + 4);
  }

  const Case tets(meshes::tets(1, 1, 1));
  quality = faceQuality(tets.mesh.points, tets.mesh.points, tets.faces, tets.geometry);
  EXPECT_NEAR(quality.minimum, 2 / std::sqrt(3.) * std::sqrt(0.5), 1e-14);
  // An apex of the top pulled over its opposite side: the triangle's measure with the other sign.
  const Case one(meshes::tets(2, 2, 2));
  moved = one.mesh.points;
  for (Index n = 0; n < moved.rows(); ++n)
  {
    if (moved.row(n) == Row(1, 1, 2))
    {
      moved(n, 0) = 2.5;
    }
  }
  quality = faceQuality(one.mesh.points, moved, one.faces, one.geometry);
  EXPECT_FALSE(quality.folded.empty());
  EXPECT_GE(quality.minimum, -1);
}

TEST(SurfaceMorph, KeptWeightsAreUsedAgainAndDoNotShow)
{
  const Case c(shapes::boxWithHole(16, 3, 3));
  const std::vector<Index> curves = c.upTo(1), vertices = c.upTo(0);
  SurfaceWeights kept;
  const auto morph = [&](const std::vector<Index>& ids, double amount)
  {
    const Map map = [amount](const Row& x)
    { return Row(x[0] + amount * x[2] * x[2], x[1] * (1 + amount * x[0]), x[2]); };
    Monitor monitor;
    BoundaryMotion motion = c.begin(ids, map);
    morphCurves(c.geometry, UnattachedMotion::FollowAffinely, motion, monitor);
    morphSurfaces(c.faces, c.geometry, {}, motion, monitor, &kept);
    const Points moved = motion.moved();
    EXPECT_EQ(moved, c.morph(ids, map));
    return kept.prepared;
  };
  EXPECT_EQ(morph(curves, 0), 0); // where nothing moves no weights are needed
  const Index all = morph(curves, 0.1);
  EXPECT_GT(all, 0);
  EXPECT_EQ(morph(curves, -0.2), all);
  EXPECT_EQ(morph(curves, 0.3), all);
  // Curves that follow are fixed when the surfaces' turn comes, so the vertices alone fix the same
  // nodes.
  EXPECT_EQ(morph(vertices, 0.1), all);
  // One more node on a surface: its weights alone are made again.
  std::vector<Index> more = curves;
  more.push_back(*std::find_if(c.faces.nodes.begin(), c.faces.nodes.end(),
    [&](Index n) { return c.geometry.dimension[n] == 2; }));
  EXPECT_EQ(morph(more, 0.1), all + 1);
}
