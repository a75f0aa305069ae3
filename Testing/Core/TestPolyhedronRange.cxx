// SPDX-License-Identifier: BSD-3-Clause
// Valid ranges of polyhedra against bisection, on random motions: their tetrahedra, with
// centers whose weights are those at s = 0, found here by themselves; and against the measure.
#include "Mesh/Polyhedra.h"
#include "Mesh/Topology.h"
#include "Motions.h"
#include "PolyhedralMeshes.h"
#include "Quality/ScaledJacobian.h"
#include "Quality/ValidRange.h"
#include "RandomMeshes.h"
#include "ValidRangeCases.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <random>

using namespace morph;

namespace
{
constexpr int Cases = 200;
using Vector = Eigen::Vector3d;
using Weights = std::map<Index, double>; // of nodes

Vector at(const Points& x, const Weights& weights)
{
  Vector sum = Vector::Zero();
  for (const auto& [node, weight] : weights)
  {
    sum += weight * x.row(node).transpose();
  }
  return sum;
}

/// A face's center: the mean of the centers of its triangles, weighted by their areas.
Weights faceCenter(const Points& x, const Index* nodes, Index size)
{
  Weights mean, center;
  for (Index k = 0; k < size; ++k)
  {
    mean[nodes[k]] += 1. / static_cast<double>(size);
  }
  if (size == 3)
  {
    return mean;
  }
  const Vector middle = at(x, mean);
  double sum = 0;
  for (Index k = 0; k < size; ++k)
  {
    const Index ends[] = { nodes[k], nodes[(k + 1) % size] };
    const Vector a = x.row(ends[0]).transpose(), b = x.row(ends[1]).transpose();
    const double area = (a - middle).cross(b - middle).norm() / 2;
    sum += area;
    for (const Index end : ends)
    {
      center[end] += area / 3;
    }
    for (const auto& [node, weight] : mean)
    {
      center[node] += area * weight / 3;
    }
  }
  for (auto& [node, weight] : center)
  {
    weight /= sum;
  }
  return center;
}

struct Cell
{
  std::vector<std::vector<Index>> faces;
  std::vector<Weights> centers; ///< of the faces
  Weights middle;
};

Cell cellOf(const Mesh& mesh, Index c)
{
  Cell cell;
  forEachFace(
    mesh, c, [&](const Index* nodes, Index size) { cell.faces.emplace_back(nodes, nodes + size); });
  Vector estimate = Vector::Zero();
  for (const auto& face : cell.faces)
  {
    cell.centers.push_back(faceCenter(mesh.points, face.data(), static_cast<Index>(face.size())));
    estimate += at(mesh.points, cell.centers.back()) / static_cast<double>(cell.faces.size());
  }
  std::vector<double> pyramids;
  double volume = 0;
  for (std::size_t f = 0; f < cell.faces.size(); ++f)
  {
    Vector mean = Vector::Zero(), area = Vector::Zero();
    const auto& face = cell.faces[f];
    for (const Index node : face)
    {
      mean += mesh.points.row(node).transpose() / static_cast<double>(face.size());
    }
    for (std::size_t k = 0; k < face.size(); ++k)
    {
      const Vector a = mesh.points.row(face[k]).transpose() - mean;
      area += a.cross(mesh.points.row(face[(k + 1) % face.size()]).transpose() - mean) / 2;
    }
    pyramids.push_back(area.dot(at(mesh.points, cell.centers[f]) - estimate) / 3);
    volume += pyramids.back();
  }
  for (std::size_t f = 0; f < cell.faces.size(); ++f)
  {
    // The center of a pyramid is at three quarters of the way from its apex.
    const double share = .75 * pyramids[f] / volume + .25 / static_cast<double>(cell.faces.size());
    for (const auto& [node, weight] : cell.centers[f])
    {
      cell.middle[node] += share * weight;
    }
  }
  return cell;
}

bool isPositive(const Cell& cell, const Points& x, double sign)
{
  const auto determinant = [&](const Vector& a, const Vector& b, const Vector& c)
  { return sign * a.dot(b.cross(c)); };
  const auto row = [&x](Index node) -> Vector { return x.row(node).transpose(); };
  const Vector middle = at(x, cell.middle);
  for (std::size_t f = 0; f < cell.faces.size(); ++f)
  {
    const auto& face = cell.faces[f];
    const Vector center = at(x, cell.centers[f]);
    for (std::size_t k = 0; k < face.size(); ++k)
    {
      const Vector a = row(face[k]), b = row(face[(k + 1) % face.size()]);
      if (!(determinant(a - middle, b - middle, center - middle) > 0))
      {
        return false;
      }
    }
  }
  return true;
}

struct Case : RangeCase
{
  std::vector<Cell> cells;

  /// By fixed centers, and not by those of the measure.
  bool isValidByCenters(double s) const
  {
    const Points x = this->at(s);
    for (std::size_t c = 0; c < this->cells.size(); ++c)
    {
      if (!isPositive(this->cells[c], x, this->orientation[c]))
      {
        return false;
      }
    }
    return true;
  }
  double bisected(double sign) const
  {
    return bisectedEnd([this](double s) { return this->isValidByCenters(s); }, sign, 0.01, 4);
  }
};

Mesh polyhedra(const std::string& kind)
{
  return kind == "hexes"      ? meshes::asPolyhedra(meshes::hexes(2, 1, 1))
         : kind == "tets"     ? meshes::asPolyhedra(meshes::tets(1, 1, 1))
         : kind == "pyramids" ? meshes::asPolyhedra(meshes::hexesAndPyramids(2, 1, 1))
                              : meshes::honeycomb(1);
}

void makeCase(Case& result, const std::string& kind, bool isRotation, int number)
{
  std::mt19937 random(meshes::seed() + 1000 * number);
  Mesh& mesh = result.mesh;
  mesh = polyhedra(kind);
  mesh.points += meshes::noise(mesh.points.rows(), .05, random);
  if (number % 3 == 0)
  {
    mesh.points.col(1) *= -1;
  }
  result.moveAtRandom(isRotation, random);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    result.cells.push_back(cellOf(mesh, c));
  }
}

class PolyhedronRanges : public testing::TestWithParam<std::tuple<std::string, bool>>
{
};
}

TEST_P(PolyhedronRanges, AreThoseOfBisection)
{
  const auto& [kind, isRotation] = GetParam();
  int bothFinite = 0, made = 0, ends = 0, measured = 0;
  for (int number = 0; made < Cases && number < 4 * Cases; ++number)
  {
    SCOPED_TRACE("case " + std::to_string(number) + ", seed " + std::to_string(meshes::seed()));
    Case problem;
    makeCase(problem, kind, isRotation, number);
    // Both agree at 0.
    ASSERT_EQ(problem.isValidByCenters(0), problem.isValid(0));
    const ValidRange range = problem.range();
    ASSERT_EQ(range.isEmpty, !problem.isValidByCenters(0));
    if (range.isEmpty)
    {
      continue;
    }
    ++made;
    const double low = problem.bisected(-1), high = problem.bisected(1);
    bothFinite += std::isfinite(range.lowest) && std::isfinite(range.highest);
    for (const auto& [found, expected, sign] :
      { std::make_tuple(-range.lowest, low, -1.), std::make_tuple(range.highest, high, 1.) })
    {
      if (std::isinf(expected))
      {
        EXPECT_GT(found, 3.98);
        continue;
      }
      EXPECT_LE(found, expected + 2e-9 * (1 + expected));
      // A step of the search may pass over a short interval of inversion.
      if (found < expected - 1e-8)
      {
        EXPECT_FALSE(problem.isValidByCenters(sign * (found + 1e-7))) << found;
      }
      ++ends;
      measured += problem.isValid(sign * .9 * found) && !problem.isValid(sign * 1.1 * found);
    }
    EXPECT_EQ(range.lowestCell >= 0, std::isfinite(range.lowest));
    EXPECT_EQ(range.highestCell >= 0, std::isfinite(range.highest));
    problem.expectRangeInThreads(range, 3);
  }
  EXPECT_EQ(made, Cases);
  EXPECT_GE(bothFinite, Cases / 2);
  RecordProperty("measured", measured);
  RecordProperty("ends", ends);
  // The measure's own centers change on the way: its ends are near, not the same. So many random
  // ends may miss the share of all by three standard deviations.
  const double share = .88, chance = 3 * std::sqrt(share * (1 - share) / ends);
  EXPECT_GE(measured, (share - chance) * ends) << measured << " of " << ends;
}

INSTANTIATE_TEST_SUITE_P(Kinds, PolyhedronRanges,
  testing::Combine(testing::Values("hexes", "tets", "pyramids", "honeycomb"), testing::Bool()),
  [](const auto& info)
  { return std::get<0>(info.param) + (std::get<1>(info.param) ? "Turned" : "Shifted"); });

TEST(PolyhedronRange, OfAnAffineMotionIsThatOfTheMeasure)
{
  for (auto& [name, mesh] : meshes::polyhedral())
  {
    SCOPED_TRACE(name);
    const auto orientation = cellSigns(mesh, connectedComponents(mesh));
    Points first = Points::Zero(mesh.points.rows(), 3);
    first.col(2) = -.25 * mesh.points.col(2);
    Monitor monitor;
    const NodeMotion motion = { &mesh.points, &first, {} };
    const ValidRange range = validRange(mesh, motion, orientation, {}, monitor);
    EXPECT_NEAR(range.highest, 4, 1e-9);
    EXPECT_EQ(range.lowest, -HUGE_VAL);
    for (const double s : { -10., 1., 3.99 })
    {
      EXPECT_TRUE(invertedCells(mesh, mesh.points + s * first, orientation, monitor).empty());
    }
  }
}
