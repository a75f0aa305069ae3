// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/PolyhedronQuality.h"

#include "Mesh/Polyhedra.h"
#include "Mesh/Topology.h"
#include "Motions.h"
#include "PolyhedralMeshes.h"
#include "Quality/Certificate.h"
#include "Quality/ScaledJacobian.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace meshes;
using namespace morph;

namespace
{
Quality measured(const Mesh& mesh, const std::vector<std::int8_t>& orientation = {})
{
  Monitor monitor;
  return measureQuality(mesh, mesh.points, orientation, {}, monitor);
}

CertificateReport certified(const Mesh& mesh)
{
  Monitor monitor;
  return certify(mesh, mesh.points, {}, {}, monitor);
}
}

TEST(PolyhedronQuality, IsOneForABoxWhateverItsSides)
{
  Mesh mesh = asPolyhedra(hexes(2, 2, 2));
  mesh.points.col(0) *= 7;
  mesh.points.col(2) *= 1e-3;
  const Quality quality = measured(mesh);
  EXPECT_EQ(quality.measured, 8);
  EXPECT_NEAR(quality.minimum, 1, 1e-12);
  EXPECT_NEAR(quality.mean, 1, 1e-12);
}

TEST(PolyhedronQuality, IsTheLeastOfTheDefinition)
{
  // A sheared box, whose centers are means of corners.
  Mesh mesh = asPolyhedra(hexes(1, 1, 1));
  Eigen::Matrix3d shear;
  shear << 1, 0.5, 0.2, 0, 1, 0.3, 0, 0, 1;
  mesh.points = (mesh.points * shear.transpose()).eval();
  const auto det = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
  { return std::abs(a.normalized().dot(b.normalized().cross(c.normalized()))); };
  // Edge, apothem and line of centers are parallel to its three directions.
  EXPECT_NEAR(measured(mesh).minimum, det(shear.col(0), shear.col(1), shear.col(2)), 1e-14);

  // In a regular hexagonal prism the three are perpendicular.
  EXPECT_NEAR(measured(honeycomb(1)).minimum, 1, 1e-14);
}

TEST(PolyhedronQuality, HasNodesInAFlatFaceAndOnAnEdge)
{
  const Quality quality = measured(refinedLayer(2));
  EXPECT_EQ(quality.inverted + quality.degenerate, 0);
  // The quarter of the top: its center lies beside the cell's by half a side each way.
  EXPECT_NEAR(quality.minimum, 1 / std::sqrt(1.5), 0.01);
}

TEST(PolyhedronQuality, ACornerThatIsPushedInMakesAConcaveCell)
{
  Monitor monitor;
  const Mesh mesh = asPolyhedra(hexes(1, 1, 1));
  Points moved = mesh.points;
  moved.row(7) = Eigen::RowVector3d(0.6, 0.6, 0.6); // the opposite corner of the origin
  // A hexahedron is inverted there. The polyhedron's tetrahedra are positive, as OpenFOAM allows,
  // whatever it was before.
  ASSERT_LT(measureQuality(hexes(1, 1, 1), moved, {}, {}, monitor).minimum, 0);
  const double value = measureQuality(mesh, moved, {}, {}, monitor).minimum;
  EXPECT_GT(value, 0);
  EXPECT_EQ(certify(mesh, moved, {}, {}, monitor).certified, 1);
  Mesh alone = mesh;
  alone.points = moved;
  EXPECT_EQ(measured(alone).minimum, value);
}

TEST(PolyhedronQuality, PositiveMeansThatOpenFoamsPyramidsArePositive)
{
  std::mt19937 random(seed());
  std::uniform_real_distribution<double> shift(-0.45, 0.45);
  Index good = 0, bad = 0;
  auto all = polyhedral(), more = polyhedral();
  all.insert(all.end(), more.begin(), more.end());
  for (auto& [name, mesh] : all)
  {
    for (Index i = 0; i < mesh.points.size(); ++i)
    {
      mesh.points.data()[i] += shift(random);
    }
    const Quality quality = measured(mesh);
    const CertificateReport report = certified(mesh);
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      if (!isPolyhedron(mesh, c))
      {
        continue;
      }
      if (quality.scaledJacobian[c] > 0)
      {
        ++good;
        EXPECT_EQ(report.cells[c], Certificate::Certified) << name << " cell " << c;
        EXPECT_GT(polyhedronVolume(mesh, c, mesh.points), 0) << name << " cell " << c;
      }
      else
      {
        ++bad;
      }
      // What is certified is what is measured.
      if (quality.scaledJacobian[c] < -1e-12)
      {
        EXPECT_EQ(report.cells[c], Certificate::Inverted) << name << " cell " << c;
      }
    }
  }
  EXPECT_GT(good, 10);
  EXPECT_GT(bad, 10);
}

TEST(PolyhedronQuality, MirroredFlatAndCollapsedCells)
{
  Mesh mesh = honeycomb(2);
  const double minimum = measured(mesh).minimum;
  mesh.points.col(0) *= -1;
  EXPECT_EQ(measured(mesh).inverted, mesh.numberOfCells());
  const auto signs = cellSigns(mesh, connectedComponents(mesh));
  EXPECT_EQ(measured(mesh, signs).inverted, 0);
  EXPECT_NEAR(measured(mesh, signs).minimum, minimum, 1e-14);
  EXPECT_EQ(certified(mesh).inverted, mesh.numberOfCells());

  Mesh flat = asPolyhedra(hexes(2, 1, 1));
  for (Index n = 0; n < flat.numberOfNodes(); ++n)
  {
    flat.points(n, 2) = 0.25;
  }
  EXPECT_EQ(measured(flat).inverted + measured(flat).degenerate, 2);
  EXPECT_EQ(certified(flat).certified, 0);
  flat.points.setZero();
  EXPECT_EQ(measured(flat).degenerate, 2);
  flat.points(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(measured(flat).scaledJacobian[0]));
}

TEST(PolyhedronQuality, DoesNotChangeWithPositionTurnScaleThreadsAndNumbering)
{
  ThreadedMonitor threads(4);
  for (const auto& [name, mesh] : polyhedral())
  {
    const Quality expected = measured(mesh);
    Mesh moved = mesh;
    const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    moved.points = (1e3 * mesh.points * turn.transpose()).rowwise() + Eigen::RowVector3d(5, 6, 7e3);
    const Quality found = measured(moved);
    const Quality parallel = measureQuality(mesh, mesh.points, {}, {}, threads);
    const Mesh other = renumbered(mesh, motions::shuffledNumbers(mesh.numberOfNodes()));
    validate(other);
    const Quality renamed = measured(other);
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      EXPECT_NEAR(found.scaledJacobian[c], expected.scaledJacobian[c], 1e-11) << name;
      EXPECT_EQ(parallel.scaledJacobian[c], expected.scaledJacobian[c]) << name;
      EXPECT_NEAR(renamed.scaledJacobian[c], expected.scaledJacobian[c], 1e-13) << name;
    }
  }
}
