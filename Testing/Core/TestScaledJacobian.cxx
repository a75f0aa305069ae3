// SPDX-License-Identifier: BSD-3-Clause
#include "InThreads.h"
#include "Mesh/CellShape.h"
#include "Meshes.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace
{
using namespace morph;
using Corners = std::vector<std::array<double, 3>>;

const double Sqrt3 = std::sqrt(3.0);
const Corners Triangle1 = { { 0, 0, 0 }, { 1, 0, 0 }, { .5, Sqrt3 / 2, 0 } };
const Corners Square = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
const Corners RegularTet = { { 1, 1, 1 }, { -1, 1, -1 }, { 1, -1, -1 }, { -1, -1, 1 } };
const Corners Cube = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
  { 1, 1, 1 }, { 0, 1, 1 } };
const Corners RegularWedge = { { 0, 0, 0 }, { 1, 0, 0 }, { .5, Sqrt3 / 2, 0 }, { 0, 0, 1 },
  { 1, 0, 1 }, { .5, Sqrt3 / 2, 1 } };
const Corners RegularPyramid = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
  { .5, .5, std::sqrt(.5) } };

struct Ideal
{
  std::uint8_t type;
  const Corners* corners;
};
const Ideal Ideals[] = { { Triangle, &Triangle1 }, { Quad, &Square }, { Tetra, &RegularTet },
  { Hexahedron, &Cube }, { Wedge, &RegularWedge }, { Pyramid, &RegularPyramid } };
const Ideal* const Volumes = Ideals + 2;
constexpr int NumberOfVolumes = 4;

double sj(std::uint8_t type, const Corners& corners)
{
  double x[8][3];
  for (std::size_t k = 0; k < corners.size(); ++k)
  {
    std::copy(corners[k].begin(), corners[k].end(), x[k]);
  }
  return scaledJacobian(*cellShape(type), x);
}

Corners permuted(const Corners& corners, const std::vector<int>& order)
{
  Corners result;
  for (int k : order)
  {
    result.push_back(corners[k]);
  }
  return result;
}

template <typename Map>
Corners mapped(Corners corners, Map&& map)
{
  for (auto& c : corners)
  {
    const Eigen::Vector3d y = map(Eigen::Vector3d(c[0], c[1], c[2]));
    c = { y[0], y[1], y[2] };
  }
  return corners;
}

Corners jittered(Corners corners, double size, std::mt19937& random)
{
  std::uniform_real_distribution<double> jitter(-size, size);
  return mapped(corners,
    [&](const Eigen::Vector3d& x) {
      return Eigen::Vector3d(x[0] + jitter(random), x[1] + jitter(random), x[2] + jitter(random));
    });
}

/// Cells one after another, each with its own nodes.
Mesh separateCells(const std::vector<std::pair<std::uint8_t, Corners>>& cells)
{
  Mesh mesh;
  std::size_t nodes = 0;
  for (const auto& cell : cells)
  {
    nodes += cell.second.size();
  }
  mesh.points.resize(nodes, 3);
  for (const auto& cell : cells)
  {
    mesh.types.push_back(cell.first);
    for (const auto& corner : cell.second)
    {
      const Index node = static_cast<Index>(mesh.connectivity.size());
      mesh.points.row(node) << corner[0], corner[1], corner[2];
      mesh.connectivity.push_back(node);
    }
    mesh.offsets.push_back(static_cast<Index>(mesh.connectivity.size()));
  }
  return mesh;
}

Quality measured(const Mesh& mesh)
{
  Monitor monitor;
  return measureQuality(mesh, mesh.points, {}, {}, monitor);
}
}

TEST(ScaledJacobian, IdealCellsHaveOne)
{
  for (const Ideal& ideal : Ideals)
  {
    EXPECT_NEAR(sj(ideal.type, *ideal.corners), 1, 1e-14) << cellShape(ideal.type)->name;
  }
}

TEST(ScaledJacobian, KnownValues)
{
  // Right-angled tet: J = 1, the largest product is 1 * sqrt(2) * sqrt(2).
  const Corners right = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  EXPECT_NEAR(sj(Tetra, right), std::sqrt(.5), 1e-15);
  // Boxes are ideal whatever their lengths; a shear to 45 degrees leaves sin(45).
  const auto box = mapped(
    Cube, [](const Eigen::Vector3d& x) { return Eigen::Vector3d(3 * x[0], .01 * x[1], 7 * x[2]); });
  EXPECT_NEAR(sj(Hexahedron, box), 1, 1e-14);
  const auto shear = [](const Eigen::Vector3d& x)
  { return Eigen::Vector3d(x[0] + x[2], x[1], x[2]); };
  EXPECT_NEAR(sj(Hexahedron, mapped(Cube, shear)), std::sqrt(.5), 1e-15);
  EXPECT_NEAR(sj(Wedge, mapped(RegularWedge, shear)), std::sqrt(.5), 1e-15);
  // Right-angled triangle and wedge on it: 45 degrees at the worst corner.
  EXPECT_NEAR(sj(Triangle, { { 0, 0, 0 }, { 2, 0, 0 }, { 0, 2, 0 } }), std::sqrt(2.0 / 3), 1e-15);
  EXPECT_NEAR(
    sj(Wedge, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 }, { 0, 1, 1 } }),
    std::sqrt(2.0 / 3), 1e-15);
  // Pyramid of unit base and apex height h = 1/4: edges to the apex 3/4; the worst tet has
  // J = h, largest product 1 * sqrt(2) * 3/4.
  Corners low = RegularPyramid;
  low[4] = { .5, .5, .25 };
  EXPECT_NEAR(
    sj(Pyramid, low), std::sqrt(2.0) * std::sqrt(2.0) * .25 / (std::sqrt(2.0) * .75), 1e-15);
}

TEST(ScaledJacobian, CenterOfAHexCounts)
{
  // Strongly distorted hexes: never above the center's own determinant, and sometimes equal to it.
  std::mt19937 random(meshes::seed());
  for (int trial = 0; trial < 200000; ++trial)
  {
    const Corners x = jittered(Cube, 1, random);
    Eigen::Vector3d r = Eigen::Vector3d::Zero(), s = r, t = r;
    for (int k = 0; k < 8; ++k)
    {
      const Eigen::Vector3d p(x[k][0], x[k][1], x[k][2]);
      r += (k == 1 || k == 2 || k == 5 || k == 6) ? p : -p;
      s += (k == 2 || k == 3 || k == 6 || k == 7) ? p : -p;
      t += k >= 4 ? p : -p;
    }
    const double center = r.normalized().dot(s.normalized().cross(t.normalized()));
    const double value = sj(Hexahedron, x);
    ASSERT_LE(value, center + 1e-14);
    if (std::abs(value - center) < 1e-14)
    {
      SUCCEED() << "center decides at trial " << trial;
      return;
    }
  }
  FAIL() << "the center never decided";
}

TEST(ScaledJacobian, QuadraticCellsAndVoxelsByTheirCorners)
{
  EXPECT_NEAR(sj(QuadraticTetra, RegularTet), 1, 1e-14);
  EXPECT_NEAR(sj(QuadraticHexahedron, Cube), 1, 1e-14);
  EXPECT_NEAR(sj(TriquadraticHexahedron, Cube), 1, 1e-14);
  EXPECT_NEAR(sj(BiquadraticQuad, Square), 1, 1e-14);
  // In a mesh the voxel's own node order is read.
  const Mesh mesh = separateCells({ { Voxel, permuted(Cube, { 0, 1, 3, 2, 4, 5, 7, 6 }) } });
  EXPECT_NEAR(measured(mesh).minimum, 1, 1e-14);
}

TEST(ScaledJacobian, InvertedVolumesAreNegative)
{
  EXPECT_NEAR(sj(Tetra, permuted(RegularTet, { 1, 0, 2, 3 })), -1, 1e-14);
  EXPECT_NEAR(sj(Hexahedron, permuted(Cube, { 4, 5, 6, 7, 0, 1, 2, 3 })), -1, 1e-14);
  EXPECT_NEAR(sj(Wedge, permuted(RegularWedge, { 3, 4, 5, 0, 1, 2 })), -1, 1e-14);
  EXPECT_NEAR(sj(Pyramid, permuted(RegularPyramid, { 0, 3, 2, 1, 4 })), -1, 1e-14);
  // One corner pushed through the opposite face is enough.
  for (int v = 0; v < NumberOfVolumes; ++v)
  {
    Corners x = *Volumes[v].corners;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& c : x)
    {
      mean += Eigen::Vector3d(c[0], c[1], c[2]) / static_cast<double>(x.size());
    }
    for (int j = 0; j < 3; ++j)
    {
      x.back()[j] += 4 * (mean[j] - x.back()[j]);
    }
    EXPECT_LT(sj(Volumes[v].type, x), -.1) << cellShape(Volumes[v].type)->name;
  }
}

TEST(ScaledJacobian, ConcaveAndCrossedQuadsAreNegative)
{
  EXPECT_NEAR(sj(Quad, { { 0, 0, 0 }, { 1, 0, 0 }, { .2, .2, 0 }, { 0, 1, 0 } }), -15. / 17, 1e-14);
  EXPECT_LT(sj(Quad, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { .9, 1, 0 } }), -.5);
}

TEST(ScaledJacobian, CollapsedEdgesGiveZero)
{
  for (const Ideal& ideal : Ideals)
  {
    for (std::size_t k = 1; k < ideal.corners->size(); ++k)
    {
      // Corners k - 1 and k share an edge in every shape here but across the hex's and wedge's two
      // ends.
      if ((ideal.type == Hexahedron && k == 4) || (ideal.type == Wedge && k == 3))
      {
        continue;
      }
      Corners x = *ideal.corners;
      x[k] = x[k - 1];
      EXPECT_EQ(sj(ideal.type, x), 0) << cellShape(ideal.type)->name << " corner " << k;
      const Quality quality = measured(separateCells({ { ideal.type, x } }));
      EXPECT_EQ(quality.minimum, 0);
      EXPECT_EQ(quality.degenerate, 1);
      EXPECT_EQ(quality.inverted, 0);
    }
  }
  // All corners in one point
  EXPECT_EQ(sj(Hexahedron, Corners(8, { 1, 2, 3 })), 0);
}

TEST(ScaledJacobian, EdgesWhoseSquareUnderflowsHaveALength)
{
  const Corners corner = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  for (const Ideal& ideal : Ideals)
  {
    // The edge from corner 0 along an axis gets short; of a wedge it is the one between its ends.
    Corners x = ideal.type == Tetra ? corner : *ideal.corners;
    double& length = ideal.type == Wedge ? x[3][2] : x[1][0];
    length = 1e-200;
    const double value = sj(ideal.type, x);
    EXPECT_GT(value, 0) << cellShape(ideal.type)->name;
    const Quality quality = measured(separateCells({ { ideal.type, x } }));
    EXPECT_EQ(quality.minimum, value);
    EXPECT_EQ(quality.degenerate + quality.inverted, 0) << cellShape(ideal.type)->name;
    // A longer edge in the same direction gives the same to rounding.
    length = 1e-20;
    EXPECT_NEAR(sj(ideal.type, x), value, 1e-15) << cellShape(ideal.type)->name;
    length = 0;
    EXPECT_EQ(sj(ideal.type, x), 0) << cellShape(ideal.type)->name;
  }
}

TEST(ScaledJacobian, FlatCellsWithEdgesCountAsInverted)
{
  const Quality quality =
    measured(separateCells({ { Tetra, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } } } }));
  EXPECT_EQ(quality.minimum, 0);
  EXPECT_EQ(quality.inverted, 1);
  EXPECT_EQ(quality.degenerate, 0);
}

TEST(ScaledJacobian, UnchangedByRigidMotionAndScale)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 500; ++trial)
  {
    const Eigen::Quaterniond turn =
      Eigen::Quaterniond(uniform(random), uniform(random), uniform(random), uniform(random))
        .normalized();
    const Eigen::Vector3d shift(uniform(random), uniform(random), uniform(random));
    const double scale = std::pow(10, 6 * uniform(random));
    for (const Ideal& ideal : Ideals)
    {
      const Corners x = jittered(*ideal.corners, .5, random);
      const Corners y = mapped(
        x, [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return scale * (turn * p + shift); });
      EXPECT_NEAR(sj(ideal.type, x), sj(ideal.type, y), 1e-11) << cellShape(ideal.type)->name;
    }
  }
}

TEST(ScaledJacobian, UnchangedByEvenRenumbering)
{
  const std::vector<std::vector<int>> turns[] = { { { 1, 2, 0 } }, { { 1, 2, 3, 0 } },
    { { 1, 2, 0, 3 }, { 1, 0, 3, 2 }, { 2, 3, 0, 1 } },
    { { 1, 2, 3, 0, 5, 6, 7, 4 }, { 4, 5, 1, 0, 7, 6, 2, 3 }, { 1, 5, 6, 2, 0, 4, 7, 3 } },
    { { 1, 2, 0, 4, 5, 3 }, { 3, 5, 4, 0, 2, 1 } }, { { 1, 2, 3, 0, 4 } } };
  std::mt19937 random(meshes::seed());
  for (int trial = 0; trial < 500; ++trial)
  {
    for (int i = 0; i < 6; ++i)
    {
      const Corners x = jittered(*Ideals[i].corners, .5, random);
      for (const auto& turn : turns[i])
      {
        EXPECT_NEAR(sj(Ideals[i].type, x), sj(Ideals[i].type, permuted(x, turn)), 1e-12)
          << cellShape(Ideals[i].type)->name;
      }
    }
  }
}

TEST(ScaledJacobian, NeverAboveOne)
{
  std::mt19937 random(meshes::seed());
  for (int trial = 0; trial < 2000; ++trial)
  {
    for (const Ideal& ideal : Ideals)
    {
      const double value = sj(ideal.type, jittered(*ideal.corners, .6, random));
      EXPECT_LE(value, 1 + 1e-14) << cellShape(ideal.type)->name;
      EXPECT_GE(value, -std::sqrt(2.0) - 1e-14) << cellShape(ideal.type)->name;
    }
  }
}

TEST(ScaledJacobian, OtherTypesAndCoordinatesThatAreNotFiniteGiveNaN)
{
  EXPECT_TRUE(std::isnan(sj(Line, { { 0, 0, 0 }, { 1, 0, 0 } })));
  EXPECT_TRUE(std::isnan(sj(42, Cube)));
  for (const Ideal& ideal : Ideals)
  {
    for (std::size_t k = 0; k < ideal.corners->size(); ++k)
    {
      Corners x = *ideal.corners;
      x[k][1] = std::numeric_limits<double>::quiet_NaN();
      EXPECT_TRUE(std::isnan(sj(ideal.type, x))) << cellShape(ideal.type)->name;
    }
  }
}

TEST(MeasureQuality, CountsTheHighestDimensionOnly)
{
  Corners flat = RegularTet;
  flat[3] = flat[2];
  const Mesh mesh = separateCells({ { Triangle, Triangle1 }, { Tetra, RegularTet },
    { Tetra, permuted(RegularTet, { 1, 0, 2, 3 }) }, { Line, { { 0, 0, 0 }, { 1, 0, 0 } } },
    { Tetra, flat }, { Hexahedron, permuted(Cube, { 4, 5, 6, 7, 0, 1, 2, 3 }) },
    { Hexahedron, Cube } });
  const Quality q = measured(mesh);
  EXPECT_TRUE(std::isnan(q.scaledJacobian[0]));
  EXPECT_TRUE(std::isnan(q.scaledJacobian[3]));
  EXPECT_EQ(q.measured, 5);
  EXPECT_EQ(q.inverted, 2);
  EXPECT_EQ(q.degenerate, 1);
  EXPECT_NEAR(q.minimum, -1, 1e-14);
  EXPECT_NEAR(q.mean, 0, 1e-14);
  EXPECT_EQ(q.scaledJacobian[q.worstCell], q.minimum);

  Monitor monitor;
  const std::vector<std::uint8_t> skip = { 0, 0, 1, 0, 1, 1, 0 };
  const Quality rest = measureQuality(mesh, mesh.points, {}, skip, monitor);
  EXPECT_EQ(rest.measured, 2);
  EXPECT_EQ(rest.inverted, 0);
  EXPECT_NEAR(rest.minimum, 1, 1e-14);
  EXPECT_TRUE(std::isnan(rest.scaledJacobian[5]));
}

TEST(MeasureQuality, SurfacesAreMeasuredWhereThereIsNoVolume)
{
  const Quality q = measured(separateCells(
    { { Triangle, Triangle1 }, { Quad, Square }, { Line, { { 0, 0, 0 }, { 1, 0, 0 } } } }));
  EXPECT_EQ(q.measured, 2);
  EXPECT_NEAR(q.mean, 1, 1e-14);
}

TEST(MeasureQuality, NothingMeasuredIsNaN)
{
  for (const Mesh& mesh :
    { separateCells({}), separateCells({ { Line, { { 0, 0, 0 }, { 1, 0, 0 } } } }) })
  {
    const Quality q = measured(mesh);
    EXPECT_EQ(q.measured, 0);
    EXPECT_EQ(q.worstCell, -1);
    EXPECT_TRUE(std::isnan(q.minimum));
    EXPECT_TRUE(std::isnan(q.mean));
  }
}

TEST(MeasureQuality, TheFirstOfEqualCellsIsTheWorst)
{
  const Corners right = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  const Quality q = measured(separateCells(
    { { Tetra, RegularTet }, { Tetra, right }, { Tetra, RegularTet }, { Tetra, right } }));
  EXPECT_EQ(q.worstCell, 1);
}

TEST(MeasureQuality, AMirroredCellIsMeasuredAsItsImage)
{
  std::mt19937 random(meshes::seed());
  std::vector<std::pair<std::uint8_t, Corners>> cells, images;
  for (int trial = 0; trial < 100; ++trial)
  {
    for (int v = 0; v < NumberOfVolumes; ++v)
    {
      cells.emplace_back(Volumes[v].type, jittered(*Volumes[v].corners, .4, random));
      images.emplace_back(cells.back().first,
        mapped(cells.back().second,
          [](const Eigen::Vector3d& x) { return Eigen::Vector3d(-x[0], x[1], x[2]); }));
    }
  }
  const Mesh mesh = separateCells(images);
  Monitor monitor;
  const Quality expected = measured(separateCells(cells));
  const Quality image =
    measureQuality(mesh, mesh.points, std::vector<std::int8_t>(images.size(), -1), {}, monitor);
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    EXPECT_NEAR(image.scaledJacobian[c], expected.scaledJacobian[c], 1e-13);
  }
}

TEST(MeasureQuality, ReadsTheGivenPoints)
{
  Mesh mesh = separateCells({ { Hexahedron, Cube } });
  Points sheared = mesh.points;
  sheared.col(0) += sheared.col(2);
  mesh.points.setConstant(std::numeric_limits<double>::quiet_NaN());
  Monitor monitor;
  EXPECT_NEAR(measureQuality(mesh, sheared, {}, {}, monitor).minimum, std::sqrt(.5), 1e-15);
}

namespace
{
/// Cuts the range into uneven pieces and runs them in threads, the last piece first.
class UnevenThreads : public Monitor
{
public:
  int threads() const override { return 2; }
  void share(Index n, Index, const std::function<void(Index first, Index last)>& body) override
  {
    std::vector<Index> ends{ n };
    while (ends.back() > 0)
    {
      ends.push_back(std::max<Index>(0, ends.back() - 1 - ends.back() / 3));
    }
    meshes::inThreads(
      static_cast<int>(ends.size()) - 1, [&](int t) { body(ends[t + 1], ends[t]); });
  }
};

class Cancelled : public Monitor
{
public:
  bool cancelled() override { return true; }
};
}

TEST(MeasureQuality, TheCutIntoThreadsDoesNotShow)
{
  std::mt19937 random(meshes::seed());
  std::vector<std::pair<std::uint8_t, Corners>> cells;
  for (int trial = 0; trial < 5000; ++trial)
  {
    cells.emplace_back(Volumes[trial % 4].type, jittered(*Volumes[trial % 4].corners, .4, random));
  }
  const Mesh mesh = separateCells(cells);
  UnevenThreads threads;
  const Quality one = measured(mesh);
  const Quality many = measureQuality(mesh, mesh.points, {}, {}, threads);
  EXPECT_EQ(one.scaledJacobian, many.scaledJacobian);
  EXPECT_EQ(one.mean, many.mean);
  EXPECT_EQ(one.minimum, many.minimum);
  EXPECT_EQ(one.worstCell, many.worstCell);
  EXPECT_EQ(one.inverted, many.inverted);
}

TEST(MeasureQuality, CancelThrows)
{
  const Mesh mesh = separateCells({ { Tetra, RegularTet } });
  Cancelled monitor;
  try
  {
    measureQuality(mesh, mesh.points, {}, {}, monitor);
    FAIL() << "not cancelled";
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.kind(), Error::Kind::Cancelled);
  }
}
