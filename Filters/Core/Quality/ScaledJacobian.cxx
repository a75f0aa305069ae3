// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/ScaledJacobian.h"

#include "Mesh/CellShape.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/StandingCells.h"
#include "Quality/Certificate.h"
#include "Quality/MeasuredPlaces.h"
#include "Quality/PolyhedronQuality.h"
#include "Support/Simd.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

namespace morph
{
namespace
{
constexpr double NotMeasured = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr unsigned HexCenter = 1u << 8; // of the samples of a hexahedron, after its corners

// The formulas, for one cell where T is double, or for as many as SimdDouble4 has numbers.

template <typename T>
using Mask = decltype(T{} < T{});

template <typename T>
struct Vector3
{
  T x, y, z;
};

template <typename T>
MORPH_SIMD_INLINE Vector3<T> operator-(const Vector3<T>& a, const Vector3<T>& b)
{
  return { a.x - b.x, a.y - b.y, a.z - b.z };
}

template <typename T>
MORPH_SIMD_INLINE Vector3<T> operator+(const Vector3<T>& a, const Vector3<T>& b)
{
  return { a.x + b.x, a.y + b.y, a.z + b.z };
}

template <typename T>
MORPH_SIMD_INLINE Vector3<T> operator*(const T& factor, const Vector3<T>& a)
{
  return { factor * a.x, factor * a.y, factor * a.z };
}

template <typename T>
MORPH_SIMD_INLINE Vector3<T> operator/(const Vector3<T>& a, const T& divisor)
{
  return { a.x / divisor, a.y / divisor, a.z / divisor };
}

template <typename T>
MORPH_SIMD_INLINE T dot(const Vector3<T>& a, const Vector3<T>& b)
{
  return a.x * b.x + (a.y * b.y + a.z * b.z);
}

template <typename T>
MORPH_SIMD_INLINE Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b)
{
  return { a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
}

template <typename T>
MORPH_SIMD_INLINE T least(const T& a, const T& b)
{
  return select(b < a, b, a);
}

template <typename T>
MORPH_SIMD_INLINE T greatest(const T& a, const T& b)
{
  return select(a < b, b, a);
}

/// In two steps: libc++'s std::hypot of three numbers squares them.
MORPH_SIMD_INLINE double lengthWithoutUnderflow(const Vector3<double>& v)
{
  return std::hypot(std::hypot(v.x, v.y), v.z);
}

MORPH_SIMD_INLINE SimdDouble4 lengthWithoutUnderflow(const Vector3<SimdDouble4>& v)
{
  const auto lane = [&v](int i) {
    return lengthWithoutUnderflow(Vector3<double>{ v.x[i], v.y[i], v.z[i] });
  };
  return SimdDouble4{ lane(0), lane(1), lane(2), lane(3) };
}

/// Computes lengths, correct also where a square underflows. Returns the shortest.
template <typename T, int N>
MORPH_SIMD_INLINE T lengthsOf(const Vector3<T> (&v)[N], T (&length)[N])
{
  T shortest = T{} + Infinity;
  for (int i = 0; i < N; ++i)
  {
    length[i] = squareRoot(dot(v[i], v[i]));
    shortest = least(shortest, length[i]);
  }
  if (any(!(shortest > T{} + 1e-150)))
  {
    shortest = T{} + Infinity;
    for (int i = 0; i < N; ++i)
    {
      length[i] = select(length[i] > T{} + 1e-150, length[i], lengthWithoutUnderflow(v[i]));
      shortest = least(shortest, length[i]);
    }
  }
  return shortest;
}

/// Returns the determinant of three edges scaled to length 1; NaN where one has no length.
template <typename T>
MORPH_SIMD_INLINE T normalizedDeterminant(
  const Vector3<T>& a, const Vector3<T>& b, const Vector3<T>& c)
{
  const Vector3<T> edges[3] = { a, b, c };
  T length[3];
  lengthsOf(edges, length);
  return dot(a / length[0], cross(b / length[1], c / length[2]));
}

/// The minimum over samples, and whether one of them has an edge without length.
template <typename T>
struct Minimum
{
  T value = T{} + Infinity;
  Mask<T> isCollapsed = Mask<T>{};

  /// Passes over NaN, which comes from lengths whose products are 0 or infinite.
  MORPH_SIMD_INLINE void add(const T& sample, const T& shortest)
  {
    this->isCollapsed = this->isCollapsed | (shortest == T{});
    this->value = least(this->value, sample);
  }
  /// `sample`: of normalizedDeterminant().
  MORPH_SIMD_INLINE void add(const T& sample)
  {
    this->add(sample, select(sample == sample, T{} + 1., T{}));
  }
};

MORPH_SIMD_INLINE bool isChosen(unsigned samples, int sample)
{
  return (samples >> sample & 1u) != 0;
}

template <typename T, int N>
MORPH_SIMD_INLINE void addCorners(
  const Vector3<T>* x, const int (&corners)[N][4], unsigned samples, Minimum<T>& minimum)
{
  for (int k = 0; k < N; ++k)
  {
    const int(&c)[4] = corners[k];
    if (isChosen(samples, k))
    {
      minimum.add(normalizedDeterminant(x[c[1]] - x[c[0]], x[c[2]] - x[c[0]], x[c[3]] - x[c[0]]));
    }
  }
}

template <typename T>
MORPH_SIMD_INLINE void addTet(const Vector3<T>& x0, const Vector3<T>& x1, const Vector3<T>& x2,
  const Vector3<T>& x3, Minimum<T>& minimum)
{
  const Vector3<T> edges[6] = { x1 - x0, x2 - x0, x3 - x0, x2 - x1, x3 - x1, x3 - x2 };
  T l[6];
  const T shortest = lengthsOf(edges, l);
  // Products of three lengths would underflow in tiny cells: all are in units of one.
  const T unit = greatest(greatest(l[0], l[1]), l[2]);
  for (T& length : l)
  {
    length = length / unit;
  }
  const T longest = greatest(greatest(l[0] * l[1] * l[2], l[0] * l[3] * l[4]),
    greatest(l[1] * l[3] * l[5], l[2] * l[4] * l[5]));
  const T value =
    std::sqrt(2.) * T(dot(edges[0] / unit, cross(edges[1] / unit, edges[2] / unit))) / longest;
  minimum.add(value, shortest);
}

template <typename T>
MORPH_SIMD_INLINE void addHex(const Vector3<T>* x, unsigned samples, Minimum<T>& minimum)
{
  if ((samples & HexCenter) != 0)
  {
    // The mean edges may vanish while every edge has a length: such a cell is inverted, not
    // collapsed.
    const T center = normalizedDeterminant(x[1] - x[0] + x[2] - x[3] + x[5] - x[4] + x[6] - x[7],
      x[3] - x[0] + x[2] - x[1] + x[7] - x[4] + x[6] - x[5],
      x[4] - x[0] + x[5] - x[1] + x[6] - x[2] + x[7] - x[3]);
    minimum.add(select(center == center, center, T{}));
  }
  // Each edge is at two corners: roots and divisions, which take most of the time, are made once.
  Vector3<T> edge[12];
  T length[12];
  for (int e = 0; e < 12; ++e)
  {
    const int(&ends)[2] = HexAxisEdges[e / 4][e % 4];
    edge[e] = x[ends[1]] - x[ends[0]];
  }
  lengthsOf(edge, length);
  for (int e = 0; e < 12; ++e)
  {
    edge[e] = edge[e] / length[e];
  }
  for (int k = 0; k < 8; ++k)
  {
    if (isChosen(samples, k))
    {
      Vector3<T> outgoing[3];
      for (int d = 0; d < 3; ++d)
      {
        const int which = HexCornerEdges[k][d];
        outgoing[d] = which > 0 ? edge[which - 1] : Vector3<T>{} - edge[-which - 1];
      }
      minimum.add(dot(outgoing[0], cross(outgoing[1], outgoing[2])));
    }
  }
}

template <typename T>
MORPH_SIMD_INLINE void addTriangle(const Vector3<T>* x, Minimum<T>& minimum)
{
  const Vector3<T> sides[3] = { x[1] - x[0], x[2] - x[1], x[2] - x[0] };
  const Vector3<T> area[1] = { cross(sides[0], sides[2]) };
  T l[3], twiceArea[1];
  const T shortest = lengthsOf(sides, l);
  lengthsOf(area, twiceArea);
  const T value =
    2 / std::sqrt(3.) * twiceArea[0] / greatest(greatest(l[0] * l[1], l[1] * l[2]), l[2] * l[0]);
  minimum.add(value, shortest);
}

template <typename T>
MORPH_SIMD_INLINE void addQuadrilateral(const Vector3<T>* x, Minimum<T>& minimum)
{
  const Vector3<T> normal[1] = { cross(x[1] + x[2] - x[0] - x[3], x[2] + x[3] - x[0] - x[1]) };
  T size[1];
  lengthsOf(normal, size);
  const Vector3<T> direction = normal[0] / select(size[0] > T{}, size[0], T{} + 1.);
  for (int k = 0; k < 4; ++k)
  {
    const Vector3<T> sides[2] = { x[(k + 1) % 4] - x[k], x[(k + 3) % 4] - x[k] };
    T l[2];
    const T shortest = lengthsOf(sides, l);
    const T value = dot(direction, cross(sides[0], sides[1])) / (l[0] * l[1]);
    minimum.add(value, shortest);
  }
}

/// `x`: eight, 0 beyond the cell's corners. `samples`: of a volume cell, see samplesOf().
template <typename T>
MORPH_SIMD_INLINE void measure(
  Shape shape, const Vector3<T>* x, unsigned samples, T& scaledJacobian, Mask<T>& isCollapsed)
{
  Minimum<T> minimum;
  double factor = 1;
  switch (shape)
  {
    case Shape::Tri:
      addTriangle(x, minimum);
      break;
    case Shape::Quadrilateral:
      addQuadrilateral(x, minimum);
      break;
    case Shape::Tet:
      addTet(x[0], x[1], x[2], x[3], minimum);
      break;
    case Shape::Hex:
      addHex(x, samples, minimum);
      break;
    case Shape::Wedge:
      addCorners(x, WedgeCornerNodes, samples, minimum);
      factor = 2 / std::sqrt(3.);
      break;
    case Shape::Pyramid:
      for (int k = 0; k < 4; ++k)
      {
        const int(&c)[4] = PyramidCornerNodes[k];
        if (isChosen(samples, k))
        {
          addTet(x[c[0]], x[c[1]], x[c[2]], x[c[3]], minimum);
        }
      }
      factor = std::sqrt(2.);
      break;
    case Shape::Polyhedron: // has no corners in a table: see PolyhedronPlaces
    case Shape::Other:
      break;
  }
  scaledJacobian = factor * minimum.value;
  if (shape == Shape::Pyramid)
  {
    // Pyramids higher than the ideal one exceed 1; the excess counts as a defect, as in Verdict.
    scaledJacobian = select(scaledJacobian > T{} + 1., 2. - scaledJacobian, scaledJacobian);
  }
  // A comparison with NaN is false, so the minimum over the corners would pass over it.
  Vector3<T> zero = { T{}, T{}, T{} };
  for (int k = 0; k < 8; ++k)
  {
    zero = zero + T{} * x[k];
  }
  const Mask<T> isFinite = zero.x + zero.y + zero.z == T{};
  isCollapsed = minimum.isCollapsed & isFinite;
  const Mask<T> isKnown = isFinite & (minimum.value < T{} + Infinity);
  scaledJacobian = select(isCollapsed, T{}, select(isKnown, scaledJacobian, T{} + NotMeasured));
}

/// Cells of one shape that wait until they fill a vector.
struct Waiting
{
  double x[8][3][SimdWidth] = {}; ///< corner, coordinate, cell
  Index id[SimdWidth];
  int count = 0;
};

struct MeasureWaiting
{
  static MORPH_SIMD_INLINE void run(
    Shape shape, const Waiting& cells, double* scaledJacobian, bool* isCollapsed)
  {
    Vector3<SimdDouble4> x[8];
    for (int k = 0; k < 8; ++k)
    {
      x[k] = { load(cells.x[k][0]), load(cells.x[k][1]), load(cells.x[k][2]) };
    }
    SimdDouble4 values;
    SimdMask4 collapsed;
    measure(shape, x, ~0u, values, collapsed);
    store(values, scaledJacobian);
    for (int lane = 0; lane < SimdWidth; ++lane)
    {
      isCollapsed[lane] = collapsed[lane] != 0;
    }
  }
};

/// Returns the scaled Jacobian of a cell including its inside; its corners have `ofCorners`.
double measureInside(
  const Mesh& mesh, const ConstPoints& points, Index cell, double sign, double ofCorners)
{
  const CellShape& shape = *cellShape(mesh, cell);
  const std::uint8_t type = mesh.types[cell];
  Eigen::Vector3d x[MostNodesOfVolume];
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
  int dimension = 0;
  for (const std::uint8_t type : mesh.types)
  {
    const CellShape* shape = cellShape(type);
    dimension = std::max(dimension, shape ? shape->dimension : 0);
  }
  return dimension;
}

Quality measureCells(const Mesh& mesh, const ConstPoints& points,
  const std::vector<std::int8_t>& orientation, const std::vector<std::uint8_t>& skip,
  bool cornersOnly, Monitor& monitor)
{
  if (mesh.layer.nodes > 0)
  {
    const Mesh cells = standing(mesh, points);
    return measureCells(cells, cells.points, orientation, skip, cornersOnly, monitor);
  }
  monitor.check();
  const Index cells = mesh.numberOfCells();
  const int dimension = dimensionOf(mesh);

  Quality quality;
  std::vector<double>& values = quality.scaledJacobian;
  values.assign(cells, NotMeasured);
  std::vector<std::uint8_t> isCollapsed(cells, 0);
  const auto measureAll = [&](Shape shape, Waiting& waiting)
  {
    double value[SimdWidth];
    bool collapsed[SimdWidth];
    dispatched<MeasureWaiting>(shape, waiting, value, collapsed);
    for (int lane = 0; lane < waiting.count; ++lane)
    {
      values[waiting.id[lane]] = value[lane];
      isCollapsed[waiting.id[lane]] = collapsed[lane];
    }
    waiting.count = 0;
  };
  monitor.parallelFor(cells, 4096,
    [&](Index first, Index last)
    {
      PolyhedronPlaces polyhedra;
      Waiting waiting[static_cast<int>(Shape::Polyhedron)];
      std::vector<Index> curved;
      const auto signOf = [&](Index c) { return orientation.empty() ? 1. : orientation[c]; };
      for (Index c = first; c < last; ++c)
      {
        const CellShape* shape = cellShape(mesh, c);
        if (!shape || shape->shape == Shape::Other || shape->dimension != dimension ||
            (!skip.empty() && skip[c]))
        {
          continue;
        }
        // Measures a cell in mirrored order as its mirror image.
        const double sign = signOf(c);
        if (hasFaces(mesh, c))
        {
          bool isFlat = false;
          values[c] = polyhedra.scaledJacobian(mesh, c, points, sign, isFlat);
          isCollapsed[c] = isFlat;
          continue;
        }
        Waiting& group = waiting[static_cast<int>(shape->shape)];
        const int lane = group.count++;
        group.id[lane] = c;
        for (int k = 0; k < shape->numberOfCorners; ++k)
        {
          const Index node = mesh.cell(c)[shape->cornerNode[k]];
          group.x[k][0][lane] = points(node, 0);
          group.x[k][1][lane] = points(node, 1);
          group.x[k][2][lane] = sign * points(node, 2);
        }
        if (group.count == SimdWidth)
        {
          measureAll(shape->shape, group);
        }
        if (!cornersOnly && isQuadraticVolume(*shape))
        {
          curved.push_back(c);
        }
      }
      for (int shape = 0; shape < static_cast<int>(Shape::Polyhedron); ++shape)
      {
        if (waiting[shape].count > 0)
        {
          measureAll(static_cast<Shape>(shape), waiting[shape]);
        }
      }
      for (const Index c : curved)
      {
        if (!isCollapsed[c])
        {
          values[c] = measureInside(mesh, points, c, signOf(c), values[c]);
        }
      }
    });
  monitor.check();

  double sum = 0;
  for (Index c = 0; c < cells; ++c)
  {
    const double value = values[c];
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

double scaledJacobian(const CellShape& shape, const double (*corners)[3], unsigned samples)
{
  if (shape.shape == Shape::Other || shape.numberOfCorners == 0 || samples == 0)
  {
    return NotMeasured;
  }
  Vector3<double> x[8] = {};
  for (int k = 0; k < shape.numberOfCorners; ++k)
  {
    x[k] = { corners[k][0], corners[k][1], corners[k][2] };
  }
  double value = NotMeasured;
  bool isCollapsed = false;
  measure(shape.shape, x, samples, value, isCollapsed);
  return value;
}

namespace
{
/// The corners of a volume cell, each with its neighbors along edges: of a tetrahedron all four.
struct CornerTable
{
  const int (*corner)[4];
  int size;
  double factor; ///< of the sine of an angle, in scaledJacobianBound()
};

CornerTable cornersOf(Shape shape)
{
  static constexpr int TetCorners[4][4] = { { 0, 1, 2, 3 }, { 1, 2, 0, 3 }, { 2, 0, 1, 3 },
    { 3, 0, 2, 1 } };
  switch (shape)
  {
    case Shape::Tet:
      return { TetCorners, 4, std::sqrt(2.) };
    case Shape::Hex:
      return { HexCornerNodes, 8, 1 };
    case Shape::Wedge:
      return { WedgeCornerNodes, 6, 2 / std::sqrt(3.) };
    case Shape::Pyramid:
      return { PyramidCornerNodes, 4, 2 };
    default:
      return { nullptr, 0, 1 };
  }
}
}

unsigned samplesOf(Shape shape, unsigned nodes)
{
  if (shape == Shape::Tet)
  {
    return nodes != 0 ? 1u : 0u;
  }
  const CornerTable table = cornersOf(shape);
  unsigned samples = shape == Shape::Hex && nodes != 0 ? HexCenter : 0u;
  for (int k = 0; k < table.size; ++k)
  {
    const int(&c)[4] = table.corner[k];
    if ((nodes & (1u << c[0] | 1u << c[1] | 1u << c[2] | 1u << c[3])) != 0)
    {
      samples |= 1u << k;
    }
  }
  return samples;
}

double scaledJacobianBound(Shape shape, const double (*corners)[3], unsigned nodes)
{
  const auto edge = [corners](int from, int to) -> Vector3<double>
  {
    const double *a = corners[from], *b = corners[to];
    return { b[0] - a[0], b[1] - a[1], b[2] - a[2] };
  };
  // The angle between two edges at a corner, all three nodes in `nodes` and the fourth not.
  double sine = Infinity;
  const CornerTable table = cornersOf(shape);
  for (int k = 0; k < table.size; ++k)
  {
    const int(&c)[4] = table.corner[k];
    for (int d = 0; d < 3; ++d)
    {
      const int a = c[1 + d], b = c[1 + (d + 1) % 3], other = c[1 + (d + 2) % 3];
      const unsigned three = 1u << c[0] | 1u << a | 1u << b, four = three | 1u << other;
      if ((nodes & four) == three)
      {
        const Vector3<double> edges[2] = { edge(c[0], a), edge(c[0], b) };
        const Vector3<double> area[1] = { cross(edges[0], edges[1]) };
        double length[2], size[1];
        const bool hasLengths = lengthsOf(edges, length) > 0;
        lengthsOf(area, size);
        sine = std::min(sine, hasLengths ? size[0] / (length[0] * length[1]) : 0.);
      }
    }
  }
  return table.factor * sine;
}

Quality measureQuality(const Mesh& mesh, const ConstPoints& points,
  const std::vector<std::int8_t>& orientation, const std::vector<std::uint8_t>& skip,
  Monitor& monitor)
{
  return measureCells(mesh, points, orientation, skip, false, monitor);
}

Quality measureCorners(const Mesh& mesh, const ConstPoints& points,
  const std::vector<std::int8_t>& orientation, const std::vector<std::uint8_t>& skip,
  Monitor& monitor)
{
  return measureCells(mesh, points, orientation, skip, true, monitor);
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

double minimumOfAll(const Quality& mine, const Communicator& processes)
{
  return processes.minimum(mine.measured > 0 ? mine.minimum : Infinity);
}

Quality ofAll(const Quality& mine, const Communicator& processes)
{
  Quality whole;
  const auto measured = static_cast<double>(mine.measured);
  const bool any = mine.measured > 0;
  double counts[] = { measured, static_cast<double>(mine.inverted),
    static_cast<double>(mine.degenerate) };
  processes.sum(counts, 3);
  whole.measured = static_cast<Index>(counts[0]);
  whole.inverted = static_cast<Index>(counts[1]);
  whole.degenerate = static_cast<Index>(counts[2]);
  whole.minimum = minimumOfAll(mine, processes);
  std::vector<Index> worst;
  for (std::size_t c = 0; any && c < mine.scaledJacobian.size(); ++c)
  {
    if (mine.scaledJacobian[c] == whole.minimum)
    {
      worst.push_back(static_cast<Index>(c));
    }
  }
  worst = processes.idsOfCells(worst);
  const double lowest = processes.minimum(
    worst.empty() ? Infinity : static_cast<double>(*std::min_element(worst.begin(), worst.end())));
  whole.mean = processes.sum(any ? mine.mean * (measured / counts[0]) : 0.);
  if (whole.measured == 0)
  {
    whole.minimum = whole.mean = NotMeasured;
  }
  whole.worstCell = whole.measured == 0 ? -1 : static_cast<Index>(lowest);
  return whole;
}

double worstMean(const Quality& mine, double share, const Communicator& processes)
{
  std::vector<double> values;
  std::copy_if(mine.scaledJacobian.begin(), mine.scaledJacobian.end(), std::back_inserter(values),
    [](double value) { return !std::isnan(value); });
  const Index all = processes.sum(static_cast<Index>(values.size()));
  if (all == 0)
  {
    return NotMeasured;
  }
  const Index count =
    std::clamp<Index>(static_cast<Index>(std::ceil(share * static_cast<double>(all))), 1, all);
  const auto end = values.begin() + std::min(count, static_cast<Index>(values.size()));
  std::partial_sort(values.begin(), end, values.end());
  const auto upTo = [&](double limit)
  { return static_cast<Index>(std::upper_bound(values.begin(), end, limit) - values.begin()); };
  // The last value that counts is above `low`, and not above `high`.
  double low = processes.minimum(values.empty() ? Infinity : values.front()) - 1;
  double high = processes.maximum(values.empty() ? -Infinity : *(end - 1));
  for (int bit = 0; bit < 64; ++bit)
  {
    const double middle = (low + high) / 2;
    (processes.sum(upTo(middle)) < count ? low : high) = middle;
  }
  const Index own = upTo(low);
  const double sum = processes.sum(std::accumulate(values.begin(), values.begin() + own, 0.));
  return (sum + static_cast<double>(count - processes.sum(own)) * high) /
         static_cast<double>(count);
}
}
