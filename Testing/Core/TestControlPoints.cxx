// SPDX-License-Identifier: BSD-3-Clause
// Displacement fields of handles and of lattices.
#include "Meshes.h"
#include "Motions.h"

#include "BoundaryMorphing/HandleMotion.h"
#include "BoundaryMorphing/LatticeMotion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

using namespace morph;
using motions::Row;

namespace
{
double uniform(double low, double high)
{
  static std::mt19937 random(meshes::seed());
  return std::uniform_real_distribution<double>(low, high)(random);
}

Points randomPoints(Index n, double low, double high)
{
  return Points::NullaryExpr(n, 3, [=] { return uniform(low, high); });
}

std::vector<Handle> handlesAt(
  const Points& places, const std::function<Row(const Row&)>& displacement, double radius = 0)
{
  std::vector<Handle> handles;
  for (Index i = 0; i < places.rows(); ++i)
  {
    handles.push_back({ places.row(i), displacement(places.row(i)), radius });
  }
  return handles;
}

Row wave(const Row& x)
{
  return { std::sin(2 * x[0]), std::cos(3 * x[1] + x[2]), x[0] * x[1] };
}

Row affineStep(const Row& x)
{
  return motions::affine(x) - x;
}

Points valuesAt(const Points& places, const std::function<Row(const Row&)>& f)
{
  return motions::mapped(places, f);
}

Points at(const HandleMotion& motion, const Points& places)
{
  Monitor monitor;
  return motion.displacements(places, monitor);
}

Points at(const LatticeMotion& motion, const Points& places)
{
  Monitor monitor;
  return motion.displacements(places, monitor);
}

/// The recursion of Cox and de Boor, on the knots themselves.
double coxDeBoor(const std::vector<double>& knots, int i, int degree, double t)
{
  if (degree == 0)
  {
    const bool isLast =
      t == knots.back() && knots[i + 1] == knots.back() && knots[i] < knots[i + 1];
    return (knots[i] <= t && t < knots[i + 1]) || isLast ? 1 : 0;
  }
  const auto part = [&](double numerator, double width, int of)
  { return width > 0 ? numerator / width * coxDeBoor(knots, of, degree - 1, t) : 0; };
  return part(t - knots[i], knots[i + degree] - knots[i], i) +
         part(knots[i + degree + 1] - t, knots[i + degree + 1] - knots[i + 1], i + 1);
}

double binomial(int n, int k)
{
  return std::tgamma(n + 1) / (std::tgamma(k + 1) * std::tgamma(n - k + 1));
}

double bernstein(int count, int i, double t)
{
  return binomial(count - 1, i) * std::pow(t, i) * std::pow(1 - t, count - 1 - i);
}

double cubic(int count, int i, double t)
{
  std::vector<double> knots(4, 0);
  for (int k = 1; k < count - 3; ++k)
  {
    knots.push_back(k / (count - 3.));
  }
  knots.insert(knots.end(), 4, 1);
  return coxDeBoor(knots, i, 3, t);
}

LatticeMotion latticeOf(LatticeMotion::Basis basis, std::array<int, 3> size)
{
  LatticeMotion lattice;
  lattice.basis = basis;
  lattice.size = size;
  lattice.low << -1, 2, 0;
  lattice.high << 3, 2.5, 7;
  return lattice;
}

constexpr auto Bernstein = LatticeMotion::Basis::Bernstein;
constexpr auto BSpline = LatticeMotion::Basis::BSpline;
}

TEST(HandleMotion, TakesTheDisplacementsOfItsHandles)
{
  std::vector<Handle> handles = handlesAt(randomPoints(40, -2, 2), wave);
  for (std::size_t i = 0; i < handles.size(); i += 3)
  {
    handles[i].radius = uniform(0.1, 3);
  }
  Points places(40, 3);
  for (Index i = 0; i < 40; ++i)
  {
    places.row(i) = handles[i].place;
  }
  EXPECT_LT(motions::difference(at(HandleMotion(handles), places), valuesAt(places, wave)), 1e-11);
}

TEST(HandleMotion, OfAnAffineMotionIsAffine)
{
  const Points places = 3 * randomPoints(500, -1, 1);
  Points four(4, 3); // not nearly in a plane
  four << 1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1;
  for (const Index count : { 0, 1, 30 })
  {
    Points handles(4 + count, 3);
    handles << four + randomPoints(4, -0.3, 0.3), randomPoints(count, -1, 1);
    const HandleMotion motion(handlesAt(handles, affineStep));
    EXPECT_LT(motions::difference(at(motion, places), valuesAt(places, affineStep)), 1e-10);
  }
}

TEST(HandleMotion, OfFewHandlesStaysWithinTheirSpan)
{
  const Points places = randomPoints(100, -5, 5);
  const Row shift(1, 2, 3);
  const Points one = at(HandleMotion({ { Row(4, 5, 6), shift, 0 } }), places);
  EXPECT_LT(motions::difference(one, valuesAt(places, [&](const Row&) { return shift; })), 1e-14);
  // Linear along the line through two handles, and constant across it.
  const HandleMotion two({ { Row(0, 0, 0), Row(0, 0, 0), 0 }, { Row(2, 0, 0), shift, 0 } });
  EXPECT_LT(motions::difference(at(two, places),
              valuesAt(places, [&](const Row& x) { return Row(x[0] / 2 * shift); })),
    1e-13);
}

TEST(HandleMotion, EndsAtTheRadius)
{
  const Handle handle = { Row(1, 1, 1), Row(0.5, -2, 0), 0.75 };
  const HandleMotion motion({ handle });
  Points places(3, 3);
  places << 1, 1, 1, 1.75, 1, 1, 1, 1.5, 1;
  const Points values = at(motion, places);
  EXPECT_LT((values.row(0) - handle.displacement).norm(), 1e-15);
  EXPECT_EQ(values.row(1), Row(0, 0, 0));
  const double q = 0.5 / 0.75;
  EXPECT_LT((values.row(2) - std::pow(1 - q, 4) * (4 * q + 1) * handle.displacement).norm(), 1e-15);
}

TEST(HandleMotion, DoesNotDependOnPlaceUnitOrOrder)
{
  const Points of = randomPoints(12, -1, 1), places = randomPoints(50, -2, 2);
  std::vector<Handle> handles = handlesAt(of, wave);
  handles[3].radius = handles[4].radius = 0.8;
  const Points values = at(HandleMotion(handles), places);
  const double scale = 1e-4;
  const Row shift(5, -7, 2);
  std::vector<Handle> other(handles.rbegin(), handles.rend());
  for (Handle& handle : other)
  {
    handle = { scale * (handle.place + shift), scale * handle.displacement, scale * handle.radius };
  }
  const Points moved = scale * (places.rowwise() + shift);
  EXPECT_LT(motions::difference(at(HandleMotion(other), moved) / scale, values), 1e-10);
}

TEST(HandleMotion, RefusesWhatHasNoAnswer)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Row zero(0, 0, 0), one(1, 1, 1);
  const std::pair<std::vector<Handle>, const char*> cases[] = { { {}, "no handle" },
    { { { zero, one, 0 }, { one, one, 0 }, { zero, zero, 2 } }, "`Handles` 0 and 2" },
    { { { zero, one, 0 }, { one, Row(0, nan, 0), 0 } }, "handles 1," },
    { { { zero, one, -1 } }, "negative radius" },
    { std::vector<Handle>(2001, { zero, one, 0 }), "at most 2000" } };
  for (const auto& [handles, expected] : cases)
  {
    motions::expectError([&, &h = handles] { HandleMotion{ h }; }, expected);
  }
}

TEST(LatticeMotion, OfAnAffineMotionIsAffineInside)
{
  const Points units = randomPoints(300, 0, 1);
  for (const auto basis : { Bernstein, BSpline })
  {
    for (const std::array<int, 3> size :
      { std::array<int, 3>{ 2, 3, 4 }, { 5, 2, 9 }, { 3, 3, 3 }, { 2, 2, 30 } })
    {
      LatticeMotion lattice = latticeOf(basis, size);
      lattice.controlDisplacements = valuesAt(lattice.controlPoints(), affineStep);
      Points places =
        (units.array().rowwise() * (lattice.high - lattice.low).array()).matrix().rowwise() +
        lattice.low;
      places.row(0) = lattice.low;
      places.row(1) = lattice.high;
      EXPECT_LT(motions::difference(at(lattice, places), valuesAt(places, affineStep)), 1e-10 * 7);
    }
  }
}

TEST(LatticeMotion, IsTheTensorProductOfItsBasis)
{
  const Points units = randomPoints(100, 0, 1);
  const std::array<int, 3> size = { 4, 6, 5 };
  for (const auto basis : { Bernstein, BSpline })
  {
    LatticeMotion lattice = latticeOf(basis, size);
    lattice.low.setZero();
    lattice.high.setOnes();
    lattice.controlDisplacements = randomPoints(4 * 6 * 5, -1, 1);
    Points expected = Points::Zero(units.rows(), 3);
    for (Index n = 0; n < units.rows(); ++n)
    {
      const auto value = [&](int d, int i)
      {
        return basis == Bernstein ? bernstein(size[d], i, units(n, d))
                                  : cubic(size[d], i, units(n, d));
      };
      for (int k = 0, row = 0; k < size[2]; ++k)
      {
        for (int j = 0; j < size[1]; ++j)
        {
          for (int i = 0; i < size[0]; ++i, ++row)
          {
            expected.row(n) +=
              value(0, i) * value(1, j) * value(2, k) * lattice.controlDisplacements.row(row);
          }
        }
      }
    }
    EXPECT_LT(motions::difference(at(lattice, units), expected), 1e-13);
  }
}

TEST(LatticeMotion, LeavesWhatIsOutsideOrFarFromTheControlPoint)
{
  LatticeMotion lattice = latticeOf(BSpline, { 10, 4, 4 });
  lattice.controlDisplacements = Points::Zero(160, 3);
  lattice.controlDisplacements.row(0).setOnes(); // the corner's, whose knots end at 1 / 7
  Points places(4, 3);
  places.row(0) = lattice.low;
  places.row(1) = lattice.low + Row(4 / 7., 0, 0);
  places.row(2) = lattice.low - Row(1e-3, 0, 0);
  places.row(3) = lattice.low + Row(4 / 14., 0, 0);
  const Points values = at(lattice, places);
  EXPECT_EQ(values.row(0), Row(1, 1, 1));
  EXPECT_LT(values.row(1).norm(), 1e-15);
  EXPECT_EQ(values.row(2), Row(0, 0, 0));
  EXPECT_NEAR(values(3, 0), 1 / 8., 1e-14); // (1 - t)^3 at half of the first span
}

TEST(LatticeMotion, OfAFlatBoxMovesItsPlane)
{
  LatticeMotion lattice = latticeOf(Bernstein, { 3, 3, 2 });
  lattice.high[2] = lattice.low[2] = 4;
  lattice.controlDisplacements = valuesAt(lattice.controlPoints(), affineStep);
  Points places(2, 3);
  places << 0, 2.25, 4, 0, 2.25, 4.1;
  const Points values = at(lattice, places);
  EXPECT_LT((values.row(0) - affineStep(places.row(0))).norm(), 1e-13);
  EXPECT_EQ(values.row(1), Row(0, 0, 0));
}
