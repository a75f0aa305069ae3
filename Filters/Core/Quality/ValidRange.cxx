// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/ValidRange.h"

#include "Quality/CellMap.h"
#include "Quality/Certificate.h"
#include "Quality/MeasuredPlaces.h"
#include "Quality/PolyhedronQuality.h"
#include "Quality/PolynomialRoot.h"
#include "Support/Parallel.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>

namespace morph
{
namespace
{
using Vector = Eigen::Vector3d;
constexpr Index Batch = 8192; // cells, quadratic ones some 0.1 ms each
constexpr Index Grain = 512;
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double Pi = 3.14159265358979323846;

/// A vector whose components are polynomials of degree D in t; a column for each power.
template <int D>
using Path = Eigen::Matrix<double, 3, D + 1>;
/// The coefficients of a determinant.
template <int D>
using Determinant = std::array<double, 3 * D + 1>;

template <int D>
Determinant<D> determinant(const Path<D>& a, const Path<D>& b, const Path<D>& c, double sign)
{
  Determinant<D> result;
  result.fill(0);
  for (int j = 0; j <= D; ++j)
  {
    for (int k = 0; k <= D; ++k)
    {
      const Vector cross = b.col(j).cross(c.col(k));
      for (int i = 0; i <= D; ++i)
      {
        result[i + j + k] += sign * a.col(i).dot(cross);
      }
    }
  }
  return result;
}

/// The paths of nodes in t: s itself, or tan(s angle / 2) with the factor 1 + t^2.
template <int D>
Path<D> pathOf(const NodeMotion& motion, Index node)
{
  const Vector base = motion.base->row(node).transpose();
  const Vector first = motion.first->row(node).transpose();
  Path<D> path;
  if constexpr (D == 1)
  {
    path << base, first;
  }
  else
  {
    path << base, 2 * first, base + 2 * Vector(motion.second->row(node).transpose());
  }
  return path;
}

/// One end of a range: how far the parameter goes in one direction.
struct End
{
  double distance = Infinity; ///< in s, or half the angle of a rotation
  double known = Infinity;    ///< another thread found a root there
  Index cell = -1;

  void add(double other, Index otherCell)
  {
    if (other < this->distance ||
        (other == this->distance && other < Infinity && otherCell < this->cell))
    {
      this->distance = other;
      this->cell = otherCell;
    }
  }
};

/// Both ends, and a cell that is inverted at 0 (the lowest).
struct Ends
{
  End low, high;
  Index inverted = -1;

  void addInverted(Index cell)
  {
    if (cell >= 0 && (this->inverted < 0 || cell < this->inverted))
    {
      this->inverted = cell;
    }
  }
};

template <std::size_t N>
std::array<double, N> mirrored(std::array<double, N> a)
{
  for (std::size_t k = 1; k < N; k += 2)
  {
    a[k] = -a[k];
  }
  return a;
}

/// The first root of a rotation's determinant as half the angle, from 0 up. Beyond the half angle
/// of pi / 2, t comes back from minus infinity, as -1 / v.
double firstHalfAngle(const std::array<double, 7>& a)
{
  const double t = firstPositiveRoot(a.data(), 6);
  if (t < Infinity)
  {
    return std::atan(t);
  }
  std::array<double, 7> beyond = mirrored(a);
  std::reverse(beyond.begin(), beyond.end());
  const double v = firstPositiveRoot(beyond.data(), 6);
  return v < Infinity ? Pi / 2 + std::atan(v) : Infinity;
}

template <int D>
void addEnd(const Determinant<D>& a, Index cell, End& end)
{
  // Most cells do not shorten the range: a polynomial that is positive up to its end needs no root.
  // The margin keeps the result independent of the order of the cells.
  const double last = std::min(end.distance, end.known) * (1 + 1e-9);
  if constexpr (D == 1)
  {
    if (!isPositiveUntil(a.data(), 3, last))
    {
      end.add(firstPositiveRoot(a.data(), 3), cell);
    }
  }
  else
  {
    if (!(last < 1.5 && isPositiveUntil(a.data(), 6, std::tan(last))))
    {
      end.add(firstHalfAngle(a), cell);
    }
  }
}

template <int D>
void addDeterminant(const Determinant<D>& a, Index cell, Ends& ends)
{
  addEnd<D>(a, cell, ends.high);
  addEnd<D>(mirrored(a), cell, ends.low);
}

/// The values of t at which the coefficients of a quadratic cell are evaluated, and the matrix from
/// these values to the coefficients of the polynomial in t.
template <int D>
struct Interpolation
{
  static constexpr int Count = 3 * D + 1;
  using Square = Eigen::Matrix<double, Count, Count>;
  double t[Count];
  Square toCoefficients;

  Interpolation()
  {
    Square powers;
    for (int i = 0; i < Count; ++i)
    {
      this->t[i] = D == 1 ? i - 1 : (i - 3) / 2.;
      double power = 1;
      for (int k = 0; k < Count; ++k, power *= this->t[i])
      {
        powers(i, k) = power;
      }
    }
    this->toCoefficients = powers.inverse();
  }
};

/// The unit of t in which a cell's straight motion is as large as the cell. `path`: from its first
/// node. Interpolated coefficients are as accurate as the values at |t| <= 2, so that a slow motion
/// needs a unit of its own.
template <int D>
double unitOf(const Path<D>* path, int nodes)
{
  double size = 0, speed = 0;
  for (int i = 0; i < nodes; ++i)
  {
    size = std::max(size, path[i].col(0).norm());
    speed = std::max(speed, path[i].col(1).norm());
  }
  return D == 1 && speed > 1e-90 * size ? size / speed : 1;
}

/// Adds the Bernstein coefficients of a quadratic cell as polynomials in t.
template <int D>
void addQuadratic(const Mesh& mesh, const NodeMotion& motion, Index cell, double sign, Ends& ends)
{
  static const Interpolation<D> interpolation;
  constexpr int Count = Interpolation<D>::Count;
  const CellMap& map = *CellMap::find(mesh.types[cell]);
  Path<D> path[MostNodesOfVolume];
  for (int i = 0; i < map.numberOfNodes(); ++i)
  {
    path[i] = pathOf<D>(motion, mesh.cell(cell)[i]) - pathOf<D>(motion, mesh.cell(cell)[0]);
  }
  const double unit = unitOf<D>(path, map.numberOfNodes());
  BernsteinHalving::Coefficients c[Count];
  for (int k = 0; k < Count; ++k)
  {
    Vector x[MostNodesOfVolume];
    for (int i = 0; i < map.numberOfNodes(); ++i)
    {
      x[i] = path[i].col(D);
      for (int power = D - 1; power >= 0; --power)
      {
        x[i] = x[i] * (unit * interpolation.t[k]) + path[i].col(power);
      }
    }
    c[k].fill(0);
    map.determinant(map.derivatives(x), 0, c[k]);
  }
  for (int term = 0; term < map.terms(); ++term)
  {
    Eigen::Matrix<double, Count, 1> values;
    for (int k = 0; k < Count; ++k)
    {
      values[k] = sign * c[k][term];
    }
    Determinant<D> a;
    Eigen::Map<Eigen::Matrix<double, Count, 1>>(a.data()) = interpolation.toCoefficients * values;
    double power = 1;
    for (double& coefficient : a)
    {
      coefficient /= power;
      power *= unit;
    }
    addDeterminant<D>(a, cell, ends);
  }
}

/// Adds the determinants at the places of a cell, or that it is inverted at 0; not those of places
/// that were not positive before.
template <int D>
class CellEnds
{
public:
  CellEnds(const InvertedBefore& before, Index cell, double sign, Ends& ends)
    : positive_(before.positivePlaces(cell))
    , cell_(cell)
    , sign_(sign)
    , ends_(ends)
  {
  }
  bool isValidBefore() const { return this->positive_ == nullptr; }

  void operator()(const Path<D>& a, const Path<D>& b, const Path<D>& c)
  {
    const std::size_t place = this->place_++;
    if (this->positive_ && !(*this->positive_)[place])
    {
      return;
    }
    const Determinant<D> values = determinant<D>(a, b, c, this->sign_);
    if (values[0] > 0)
    {
      addDeterminant<D>(values, this->cell_, this->ends_);
    }
    else
    {
      this->ends_.addInverted(this->cell_);
    }
  }

private:
  const std::vector<bool>* positive_;
  std::size_t place_ = 0;
  Index cell_;
  double sign_;
  Ends& ends_;
};

/// What a thread keeps from one polyhedron to the next.
template <int D>
struct PolyhedronMemory
{
  PolyhedronPlaces places;
  std::vector<Path<D>> x;
};

template <int D>
void addPolyhedron(const Mesh& mesh, const NodeMotion& motion, Index cell, double sign,
  PolyhedronMemory<D>& memory, CellEnds<D>& ends)
{
  if (!memory.places.take(mesh, cell, *motion.base, sign))
  {
    return;
  }
  memory.x.clear();
  for (Index k = 0; k < mesh.cellSize(cell); ++k)
  {
    memory.x.push_back(pathOf<D>(motion, mesh.cell(cell)[k]));
  }
  memory.places.forEach(
    memory.x.data(), [&](const Path<D>& a, const Path<D>& b, const Path<D>& c) { ends(a, b, c); });
}

template <int D>
void addCell(const Mesh& mesh, const NodeMotion& motion, Index cell, double sign,
  CellEnds<D>& places, Ends& ends)
{
  const CellShape& shape = *cellShape(mesh, cell);
  Path<D> x[8];
  for (int k = 0; k < shape.numberOfCorners; ++k)
  {
    x[k] = pathOf<D>(motion, mesh.cell(cell)[shape.cornerNode[k]]);
  }
  forEachMeasuredPlace(
    shape.shape, x, [&](const Path<D>& a, const Path<D>& b, const Path<D>& c) { places(a, b, c); });
  if (isQuadraticVolume(shape) && places.isValidBefore())
  {
    addQuadratic<D>(mesh, motion, cell, sign, ends);
  }
}

template <int D>
Ends endsOf(const Mesh& mesh, const NodeMotion& motion, const std::vector<std::int8_t>& orientation,
  const InvertedBefore& before, Monitor& monitor)
{
  Ends result;
  std::mutex mutex;
  // A range that starts with the best ends so far needs fewer roots. See addEnd() for why the
  // result does not depend on it.
  std::atomic<double> low = Infinity, high = Infinity;
  const auto lower = [](std::atomic<double>& shared, double value)
  {
    double before = shared.load();
    while (value < before && !shared.compare_exchange_weak(before, value))
    {
    }
  };
  parallelBatches(monitor, mesh.numberOfCells(), Batch, Grain,
    [&](Index first, Index last)
    {
      Ends ends;
      PolyhedronMemory<D> memory;
      for (Index c = first; c < last; ++c)
      {
        ends.low.known = low.load(std::memory_order_relaxed);
        ends.high.known = high.load(std::memory_order_relaxed);
        if (const CellShape* shape = cellShape(mesh, c); shape && shape->dimension == 3)
        {
          const double sign = orientation.empty() ? 1 : orientation[c];
          CellEnds<D> places(before, c, sign, ends);
          if (shape->shape == Shape::Polyhedron)
          {
            addPolyhedron<D>(mesh, motion, c, sign, memory, places);
          }
          else
          {
            addCell<D>(mesh, motion, c, sign, places, ends);
          }
          lower(low, ends.low.distance);
          lower(high, ends.high.distance);
        }
      }
      const std::lock_guard<std::mutex> lock(mutex);
      result.low.add(ends.low.distance, ends.low.cell);
      result.high.add(ends.high.distance, ends.high.cell);
      result.addInverted(ends.inverted);
    });
  return result;
}
}

ValidRange validRange(const Mesh& mesh, const NodeMotion& motion,
  const std::vector<std::int8_t>& orientation, const InvertedBefore& before, Monitor& monitor)
{
  const bool isRotation = motion.second != nullptr;
  const Ends ends = isRotation ? endsOf<2>(mesh, motion, orientation, before, monitor)
                               : endsOf<1>(mesh, motion, orientation, before, monitor);
  const double unit = isRotation ? 2 / motion.angle : 1;
  ValidRange range;
  if (ends.inverted >= 0)
  {
    range.lowest = range.highest = std::numeric_limits<double>::quiet_NaN();
    range.lowestCell = range.highestCell = ends.inverted;
    range.isEmpty = true;
    return range;
  }
  range.lowest = -ends.low.distance * unit;
  range.highest = ends.high.distance * unit;
  range.lowestCell = ends.low.cell;
  range.highestCell = ends.high.cell;
  return range;
}
}
