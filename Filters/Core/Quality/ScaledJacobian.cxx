// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/ScaledJacobian.h"

#include "Mesh/CellShape.h"
#include "Quality/CellsByFours.h"
#include "Quality/CornerNodes.h"
#include "Quality/PartialQuality.h"
#include "Quality/PolyhedronQuality.h"
#include "Quality/QuadraticJacobian.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace morph
{
namespace
{
using Vector = Eigen::Vector3d;

constexpr double NotMeasured = std::numeric_limits<double>::quiet_NaN();

// Sums are written out, as the order of Eigen's depends on whether it uses vectors. FourCells.cxx
// has the same order.

double dot(const Vector& a, const Vector& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Returns the length of an edge, correct also if its square underflows.
double lengthOf(const Vector& edge)
{
  const double length = std::sqrt(dot(edge, edge));
  return length > 1e-150 ? length : std::hypot(edge.x(), edge.y(), edge.z());
}

/// Returns the determinant of three edges scaled to length 1. If an edge has no length, sets
/// `collapsed` and returns 0.
double normalizedDeterminant(const Vector& a, const Vector& b, const Vector& c, bool& collapsed)
{
  const double la = lengthOf(a), lb = lengthOf(b), lc = lengthOf(c);
  if (la == 0 || lb == 0 || lc == 0)
  {
    collapsed = true;
    return 0;
  }
  return dot(a / la, (b / lb).cross(c / lc));
}

constexpr unsigned AllSamples = ~0u;
constexpr unsigned HexCenter = 1u << 8; // of the samples of a hexahedron, after its corners

bool isChosen(unsigned samples, int corner)
{
  return (samples >> corner & 1u) != 0;
}

template <int N>
double leastCorner(const Vector* x, const int (&corners)[N][4], unsigned samples, bool& collapsed)
{
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < N; ++k)
  {
    const int(&c)[4] = corners[k];
    if (isChosen(samples, k))
    {
      least = std::min(least,
        normalizedDeterminant(x[c[1]] - x[c[0]], x[c[2]] - x[c[0]], x[c[3]] - x[c[0]], collapsed));
    }
  }
  return least;
}

double tet(const Vector& x0, const Vector& x1, const Vector& x2, const Vector& x3, bool& collapsed)
{
  const Vector e01 = x1 - x0, e02 = x2 - x0, e03 = x3 - x0;
  const double l01 = lengthOf(e01), l02 = lengthOf(e02), l03 = lengthOf(e03);
  const double l12 = lengthOf(x2 - x1), l13 = lengthOf(x3 - x1), l23 = lengthOf(x3 - x2);
  if (l01 == 0 || l02 == 0 || l03 == 0 || l12 == 0 || l13 == 0 || l23 == 0)
  {
    collapsed = true;
    return 0;
  }
  const double longest =
    std::max({ l01 * l02 * l03, l01 * l12 * l13, l02 * l12 * l23, l03 * l13 * l23 });
  return std::sqrt(2.0) * dot(e01, e02.cross(e03)) / longest;
}

double hex(const Vector* x, unsigned samples, bool& collapsed)
{
  double least = std::numeric_limits<double>::infinity();
  if ((samples & HexCenter) != 0)
  {
    const Vector r = x[1] - x[0] + x[2] - x[3] + x[5] - x[4] + x[6] - x[7];
    const Vector s = x[3] - x[0] + x[2] - x[1] + x[7] - x[4] + x[6] - x[5];
    const Vector t = x[4] - x[0] + x[5] - x[1] + x[6] - x[2] + x[7] - x[3];
    // The mean edges may vanish while every edge has a length: such a cell is inverted, not
    // collapsed.
    bool noMeanEdge = false;
    least = normalizedDeterminant(r, s, t, noMeanEdge);
  }
  // Each edge is at two corners. Roots and divisions, which take most of the time, are computed
  // once, and for several edges at a time.
  using Edges = Eigen::Array<double, 12, 1>;
  Edges edge[3];
  for (int e = 0; e < 12; ++e)
  {
    const int* ends = HexAxisEdges[e / 4][e % 4];
    for (int j = 0; j < 3; ++j)
    {
      edge[j][e] = x[ends[1]][j] - x[ends[0]][j];
    }
  }
  Edges length = (edge[0].square() + (edge[1].square() + edge[2].square())).sqrt();
  unsigned withoutLength = 0;
  for (int e = 0; e < 12; ++e)
  {
    if (!(length[e] > 1e-150))
    {
      length[e] = std::hypot(edge[0][e], edge[1][e], edge[2][e]); // the square may have vanished
      withoutLength |= length[e] == 0 ? 1u << e : 0u;
    }
  }
  for (Edges& component : edge)
  {
    component /= length;
  }
  using Corners = Eigen::Array<double, 8, 1>;
  Corners at[3][3]; // of the three edges at each corner
  for (int k = 0; k < 8; ++k)
  {
    for (int d = 0; d < 3; ++d)
    {
      const int which = HexCornerEdges[k][d];
      const int e = std::abs(which) - 1;
      for (int j = 0; j < 3; ++j)
      {
        at[d][j][k] = which > 0 ? edge[j][e] : -edge[j][e];
      }
      collapsed =
        collapsed || (isChosen(samples, k) && withoutLength != 0 && (withoutLength >> e & 1u) != 0);
    }
  }
  const Corners(&a)[3] = at[0], (&b)[3] = at[1], (&c)[3] = at[2];
  const Corners determinant =
    a[0] * (b[1] * c[2] - b[2] * c[1]) +
    (a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]));
  for (int k = 0; k < 8; ++k)
  {
    if (isChosen(samples, k))
    {
      least = std::min(least, determinant[k]);
    }
  }
  return least;
}

double pyramid(const Vector* x, unsigned samples, bool& collapsed)
{
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 4; ++k)
  {
    const int(&c)[4] = PyramidCornerNodes[k];
    if (isChosen(samples, k))
    {
      least = std::min(least, tet(x[c[0]], x[c[1]], x[c[2]], x[c[3]], collapsed));
    }
  }
  // Pyramids higher than the ideal one exceed 1; the excess counts as a defect, as in Verdict.
  const double value = std::sqrt(2.0) * least;
  return value > 1 ? 2 - value : value;
}

double triangle(const Vector* x, bool& collapsed)
{
  const double a = lengthOf(x[1] - x[0]), b = lengthOf(x[2] - x[1]), c = lengthOf(x[0] - x[2]);
  if (a == 0 || b == 0 || c == 0)
  {
    collapsed = true;
    return 0;
  }
  const double twiceArea = lengthOf((x[1] - x[0]).cross(x[2] - x[0]));
  return 2 / std::sqrt(3.0) * twiceArea / std::max({ a * b, b * c, c * a });
}

double quad(const Vector* x, bool& collapsed)
{
  const Vector normal = (x[1] + x[2] - x[0] - x[3]).cross(x[2] + x[3] - x[0] - x[1]).normalized();
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 4; ++k)
  {
    const Vector next = x[(k + 1) % 4] - x[k], last = x[(k + 3) % 4] - x[k];
    const double product = lengthOf(next) * lengthOf(last);
    if (product == 0)
    {
      collapsed = true;
      return 0;
    }
    least = std::min(least, normal.dot(next.cross(last)) / product);
  }
  return least;
}

/// `samples`: of a volume cell, see samplesOf().
double measure(Shape shape, const Vector* x, int corners, unsigned samples, bool& collapsed)
{
  collapsed = false;
  // A comparison with NaN is false, so the minimum over the corners would ignore it.
  for (int k = 0; k < corners; ++k)
  {
    if (!x[k].allFinite())
    {
      return NotMeasured;
    }
  }
  double value = NotMeasured;
  switch (shape)
  {
    case Shape::Tri:
      value = triangle(x, collapsed);
      break;
    case Shape::Quadrilateral:
      value = quad(x, collapsed);
      break;
    case Shape::Tet:
      value = tet(x[0], x[1], x[2], x[3], collapsed);
      break;
    case Shape::Hex:
      value = hex(x, samples, collapsed);
      break;
    case Shape::Wedge:
      value = 2 / std::sqrt(3.0) * leastCorner(x, WedgeCornerNodes, samples, collapsed);
      break;
    case Shape::Pyramid:
      value = pyramid(x, samples, collapsed);
      break;
    case Shape::Polyhedron: // has no corners in a table: see PolyhedronMeasure
    case Shape::Other:
      break;
  }
  return collapsed ? 0 : value;
}

/// Returns the scaled Jacobian of a cell including its inside; its corners have `ofCorners`.
double measureInside(std::uint8_t type, const CellShape& shape, const Mesh& mesh,
  const ConstPoints& points, Index cell, double sign, double ofCorners)
{
  Vector x[MostNodesOfVolume];
  for (int k = 0; k < shape.numberOfNodes; ++k)
  {
    x[k] = points.row(mesh.cell(cell)[k]).transpose();
    x[k].z() *= sign;
  }
  // The corners of straight-sided tetrahedra and pyramids determine their inside.
  const bool hasInside = shape.shape == Shape::Hex || shape.shape == Shape::Wedge;
  return hasInside || !isStraightSided(type, x) ? quadraticScaledJacobian(type, x, ofCorners)
                                                : ofCorners;
}

/// The highest dimension of the mesh's cells.
int dimensionOf(const Mesh& mesh)
{
  bool has[256] = {};
  for (const std::uint8_t type : mesh.types)
  {
    has[type] = true;
  }
  int dimension = 0;
  for (int type = 0; type < 256; ++type)
  {
    const CellShape* shape = has[type] ? cellShape(static_cast<std::uint8_t>(type)) : nullptr;
    dimension = std::max(dimension, shape ? shape->dimension : 0);
  }
  return dimension;
}

/// `chosen`: the cells to measure, ascending; null for all.
Quality measureCells(const Mesh& mesh, const ConstPoints& points,
  const std::vector<std::int8_t>& orientation, const std::vector<std::uint8_t>& skip,
  const std::vector<Index>* chosen, bool cornersOnly, Monitor& monitor)
{
  monitor.check();
  const Index cells = mesh.numberOfCells();
  const Index count = chosen ? static_cast<Index>(chosen->size()) : cells;
  const int dimension = dimensionOf(mesh);

  Quality quality;
  quality.scaledJacobian.assign(cells, NotMeasured);
  std::vector<std::uint8_t> isCollapsed(cells, 0);
  monitor.parallelFor(count, 4096,
    [&](Index first, Index last)
    {
      PolyhedronMeasure polyhedra;
      const auto measureOne = [&](Index c, Shape shape, const Vector* x, int corners)
      {
        bool collapsed = false;
        quality.scaledJacobian[c] = measure(shape, x, corners, AllSamples, collapsed);
        isCollapsed[c] = collapsed;
      };
      std::vector<double>& values = quality.scaledJacobian;
      CellsByFours hexes(Shape::Hex, 8, measureHexes, values, measureOne),
        tets(Shape::Tet, 4, measureTets, values, measureOne);
      for (Index i = first; i < last; ++i)
      {
        const Index c = chosen ? (*chosen)[i] : i;
        const CellShape* shape = cellShape(mesh.types[c]);
        if (!shape || shape->shape == Shape::Other || shape->dimension != dimension ||
            (!skip.empty() && skip[c]))
        {
          continue;
        }
        // Measures a cell in mirrored order as its mirror image.
        const double sign = orientation.empty() ? 1 : orientation[c];
        if (shape->shape == Shape::Polyhedron)
        {
          bool isFlat = false;
          quality.scaledJacobian[c] = polyhedra.scaledJacobian(mesh, c, points, sign, isFlat);
          isCollapsed[c] = isFlat;
          continue;
        }
        Vector x[8];
        copyCorners(mesh, c, *shape, points, x[0].data());
        for (int k = 0; k < shape->numberOfCorners; ++k)
        {
          x[k].z() *= sign;
        }
        const bool hasInside = !cornersOnly && isQuadraticVolume(*shape);
        if (!hasInside && (shape->shape == Shape::Hex || shape->shape == Shape::Tet))
        {
          (shape->shape == Shape::Hex ? hexes : tets).add(c, x);
          continue;
        }
        measureOne(c, shape->shape, x, shape->numberOfCorners);
        if (hasInside && !isCollapsed[c])
        {
          values[c] = measureInside(mesh.types[c], *shape, mesh, points, c, sign, values[c]);
        }
      }
      hexes.finish();
      tets.finish();
    });
  monitor.check();

  double sum = 0;
  for (Index i = 0; i < count; ++i)
  {
    const Index c = chosen ? (*chosen)[i] : i;
    const double value = quality.scaledJacobian[c];
    if (std::isnan(value))
    {
      continue;
    }
    ++quality.measured;
    sum += value;
    if (quality.worstCell < 0 || value < quality.minimum)
    {
      quality.minimum = value;
      quality.worstCell = c;
    }
    if (isCollapsed[c])
    {
      ++quality.degenerate;
    }
    else if (value <= 0)
    {
      ++quality.inverted;
    }
  }
  if (quality.measured == 0)
  {
    quality.minimum = NotMeasured;
    quality.mean = NotMeasured;
  }
  else
  {
    quality.mean = sum / static_cast<double>(quality.measured);
  }
  return quality;
}
}

double scaledJacobian(std::uint8_t type, const double (*corners)[3])
{
  return scaledJacobian(type, corners, AllSamples);
}

unsigned samplesOf(Shape shape, unsigned nodes)
{
  const auto has = [nodes](int k) { return (nodes >> k & 1u) != 0; };
  unsigned samples = 0;
  const auto add = [&](int sample, const int* corner)
  {
    if (has(corner[0]) || has(corner[1]) || has(corner[2]) || has(corner[3]))
    {
      samples |= 1u << sample;
    }
  };
  switch (shape)
  {
    case Shape::Tet:
      return nodes != 0 ? 1u : 0u;
    case Shape::Hex:
      for (int k = 0; k < 8; ++k)
      {
        add(k, HexCornerNodes[k]);
      }
      return nodes != 0 ? samples | HexCenter : 0u;
    case Shape::Wedge:
      for (int k = 0; k < 6; ++k)
      {
        add(k, WedgeCornerNodes[k]);
      }
      return samples;
    case Shape::Pyramid:
      for (int k = 0; k < 4; ++k)
      {
        add(k, PyramidCornerNodes[k]);
      }
      return samples;
    default:
      return 0;
  }
}

namespace
{
/// The four corners of a tetrahedron with its other corners.
constexpr int TetCorners[4][4] = { { 0, 1, 2, 3 }, { 1, 2, 0, 3 }, { 2, 0, 1, 3 }, { 3, 0, 2, 1 } };

/// The minimum of the sine of the angle between two edges at a corner, all three nodes in `nodes`
/// and the fourth not.
template <int N>
double leastSine(const Vector* x, const int (&corners)[N][4], unsigned nodes)
{
  double least = std::numeric_limits<double>::infinity();
  for (const int(&c)[4] : corners)
  {
    for (int d = 0; d < 3; ++d)
    {
      const int a = c[1 + d], b = c[1 + (d + 1) % 3], other = c[1 + (d + 2) % 3];
      const unsigned three = 1u << c[0] | 1u << a | 1u << b, four = three | 1u << other;
      if ((nodes & four) == three)
      {
        const Vector u = x[a] - x[c[0]], v = x[b] - x[c[0]];
        const double lengths = lengthOf(u) * lengthOf(v);
        least = std::min(least, lengths > 0 ? u.cross(v).norm() / lengths : 0.);
      }
    }
  }
  return least;
}
}

double scaledJacobianBound(std::uint8_t type, const double (*corners)[3], unsigned nodes)
{
  Vector x[8];
  const CellShape* shape = cellShape(type);
  for (int k = 0; k < shape->numberOfCorners; ++k)
  {
    x[k] = Vector(corners[k][0], corners[k][1], corners[k][2]);
  }
  switch (shape->shape)
  {
    case Shape::Tet:
      return std::sqrt(2.) * leastSine(x, TetCorners, nodes);
    case Shape::Hex:
      return leastSine(x, HexCornerNodes, nodes);
    case Shape::Wedge:
      return 2 / std::sqrt(3.) * leastSine(x, WedgeCornerNodes, nodes);
    case Shape::Pyramid:
      return 2 * leastSine(x, PyramidCornerNodes, nodes);
    default:
      return std::numeric_limits<double>::infinity();
  }
}

double scaledJacobian(std::uint8_t type, const double (*corners)[3], unsigned samples)
{
  const CellShape* shape = cellShape(type);
  if (!shape || shape->shape == Shape::Other || samples == 0)
  {
    return NotMeasured;
  }
  Vector x[8];
  for (int k = 0; k < shape->numberOfCorners; ++k)
  {
    x[k] = Vector(corners[k][0], corners[k][1], corners[k][2]);
  }
  bool collapsed = false;
  return measure(shape->shape, x, shape->numberOfCorners, samples, collapsed);
}

bool areCornersSurelyPositive(Shape shape, const double (*corners)[3])
{
  constexpr double Beyond = 1e-13; // of the longest edge's cube; rounding is about 1e-15
  double longest2 = 0;
  const auto edge = [&](int from, int to, double* e)
  {
    for (int j = 0; j < 3; ++j)
    {
      e[j] = corners[to][j] - corners[from][j];
    }
    longest2 = std::max(longest2, e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
  };
  const auto determinant = [](const double* a, const double* b, const double* c)
  {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  };
  double determinants[9];
  int count = 0;
  if (shape == Shape::Hex)
  {
    double e[3][4][3], sum[3][3]; // sum: four times the edges at the centre
    for (int d = 0; d < 3; ++d)
    {
      for (int k = 0; k < 4; ++k)
      {
        edge(HexAxisEdges[d][k][0], HexAxisEdges[d][k][1], e[d][k]);
      }
      for (int j = 0; j < 3; ++j)
      {
        sum[d][j] = e[d][0][j] + e[d][1][j] + e[d][2][j] + e[d][3][j];
      }
    }
    for (; count < 8; ++count)
    {
      const int u = count & 1, v = (count >> 1) & 1, w = count >> 2;
      determinants[count] = determinant(e[0][v + 2 * w], e[1][u + 2 * w], e[2][u + 2 * v]);
    }
    determinants[count++] = determinant(sum[0], sum[1], sum[2]) / 64;
  }
  else if (shape == Shape::Wedge)
  {
    for (const int(&c)[4] : WedgeCornerNodes)
    {
      double e[3][3];
      for (int k = 0; k < 3; ++k)
      {
        edge(c[0], c[k + 1], e[k]);
      }
      determinants[count++] = determinant(e[0], e[1], e[2]);
    }
  }
  const double bound =
    std::max(Beyond * longest2 * std::sqrt(longest2), std::numeric_limits<double>::min());
  bool positive = count > 0;
  for (int k = 0; k < count; ++k)
  {
    positive = positive && determinants[k] > bound; // false for NaN
  }
  return positive;
}

Quality measureQuality(const Mesh& mesh, const ConstPoints& points,
  const std::vector<std::int8_t>& orientation, const std::vector<std::uint8_t>& skip,
  Monitor& monitor)
{
  return measureCells(mesh, points, orientation, skip, nullptr, false, monitor);
}

Quality measureQualityOf(const Mesh& mesh, const ConstPoints& points,
  const std::vector<std::int8_t>& orientation, const std::vector<Index>& cells,
  const std::vector<std::uint8_t>& skip, Monitor& monitor)
{
  return measureCells(mesh, points, orientation, skip, &cells, false, monitor);
}

Quality measureCorners(const Mesh& mesh, const ConstPoints& points,
  const std::vector<std::int8_t>& orientation, const std::vector<std::uint8_t>& skip,
  Monitor& monitor)
{
  return measureCells(mesh, points, orientation, skip, nullptr, true, monitor);
}

std::vector<Index> invertedCells(const Quality& quality)
{
  std::vector<Index> result;
  for (std::size_t c = 0; c < quality.scaledJacobian.size(); ++c)
  {
    if (quality.scaledJacobian[c] <= 0)
    {
      result.push_back(static_cast<Index>(c));
    }
  }
  return result;
}

std::vector<Index> invertedCells(const Mesh& mesh, const Points& points,
  const std::vector<std::int8_t>& orientation, Monitor& monitor)
{
  return invertedCells(measureQuality(mesh, points, orientation, {}, monitor));
}
}
