// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/ValidRange.h"

#include "Mesh/Polyhedra.h"
#include "Quality/Bernstein.h"
#include "Quality/CellMap.h"
#include "Quality/Certificate.h"
#include "Quality/MeasuredPlaces.h"
#include "Quality/PolyhedronQuality.h"
#include "Support/Parallel.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <vector>

namespace morph
{
namespace
{
using Vector = Eigen::Vector3d;
constexpr Index Batch = 512; // cells, quadratic ones some 0.1 ms each
constexpr Index Grain = 32;
constexpr int MostSteps = 500; // of a cell, for slivers that shear without end
constexpr double Precision = 1e-11;
constexpr double Infinity = std::numeric_limits<double>::infinity();
/// Of a determinant, relative to the product of its edges' lengths.
constexpr double Rounding = 16 * std::numeric_limits<double>::epsilon();
constexpr double FullTurn = 6.28318530717958647692;

/// Two vectors: a position and its derivative, or the factors of a sine and a cosine.
using Pair = Eigen::Matrix<double, 3, 2>;
/// The coefficients of a bound of a determinant.
using Polynomial = std::array<double, 7>;
/// The lengths of three edges, of their derivatives, and bounds of half their second derivatives.
using Lengths = std::array<std::array<double, 3>, 3>;

/// The determinant of a + h a', b + h b', c + h c'.
Polynomial determinant(const Pair& a, const Pair& b, const Pair& c, double sign)
{
  Polynomial result = {};
  for (int j = 0; j < 2; ++j)
  {
    for (int k = 0; k < 2; ++k)
    {
      const Vector cross = b.col(j).cross(c.col(k));
      result[j + k] += sign * a.col(0).dot(cross);
      result[1 + j + k] += sign * a.col(1).dot(cross);
    }
  }
  return result;
}

/// The products of three edges' lengths or derivatives: those with a second derivative, by which a
/// determinant can change, or all others that the factor changes, to which rounding is relative.
Polynomial products(const Lengths& of, bool areSecond)
{
  const int orders = areSecond ? 3 : 2;
  Polynomial result = {};
  for (int i = 0; i < orders; ++i)
  {
    for (int j = 0; j < orders; ++j)
    {
      for (int k = 0; k < orders; ++k)
      {
        const bool isPart = areSecond ? i == 2 || j == 2 || k == 2 : i + j + k > 0;
        result[i + j + k] += isPart ? of[i][0] * of[j][1] * of[k][2] : 0;
      }
    }
  }
  return result;
}

/// A step in one direction in which no determinant can reach 0.
struct Step
{
  double sign; ///< of the direction
  int degree;  ///< of the bounds
  double most; ///< what is of interest
  std::vector<Polynomial> bounds;

  /// A bound that may reach 0 is less rounding, whatever is of interest: else the end of a cell
  /// could depend on the ends found before.
  void add(const Polynomial& determinant, const Lengths& lengths)
  {
    Polynomial value = determinant;
    for (int k = 1; k <= this->degree; k += 2)
    {
      value[k] *= this->sign;
    }
    if (this->degree > 3)
    {
      this->subtract(products(lengths, true), 1, value);
    }
    if (!this->isPositive(value, Infinity))
    {
      this->subtract(products(lengths, false), Rounding, value);
    }
    this->bounds.push_back(value);
  }
  bool isPositive(const Polynomial& bound, double last) const
  {
    return isPositiveUntil(bound.data(), this->degree, last);
  }
  /// Forgets the bounds, and returns the step; infinity if it is beyond `most`. Else it does not
  /// depend on it.
  double take()
  {
    double length = Infinity;
    const bool isBeyond = std::all_of(this->bounds.begin(), this->bounds.end(),
      [this](const Polynomial& bound) { return this->isPositive(bound, this->most); });
    for (const Polynomial& bound : this->bounds)
    {
      if (!isBeyond && !this->isPositive(bound, length))
      {
        // Other steps follow, and few where the bound is nearly the determinant.
        const double precision = this->degree == 3 ? 1e-12 : 1e-2;
        length = std::min(length, firstPositiveRoot(bound.data(), this->degree, precision));
      }
    }
    this->bounds.clear();
    return length > this->most ? Infinity : length;
  }

private:
  void subtract(const Polynomial& other, double factor, Polynomial& from) const
  {
    for (int k = 0; k <= this->degree; ++k)
    {
      from[k] -= factor * other[k];
    }
  }
};

/// Returns a power of two, of the factor at which the motion is about as large as the mesh. In this
/// unit products of a slow motion's derivatives do not vanish, and no digit changes.
double unitOf(const NodeMotion& motion)
{
  double speed = 0; // in sizes of the mesh
  if (motion.straight && motion.straight->rows() > 0)
  {
    const double size =
      (motion.base->colwise().maxCoeff() - motion.base->colwise().minCoeff()).maxCoeff();
    speed = motion.straight->cwiseAbs().maxCoeff() / size;
  }
  for (const NodeMotion::Turn& turn : motion.turns)
  {
    speed = std::max(speed, std::abs(turn.angle));
  }
  return speed > 0 && std::isfinite(speed)
           ? std::ldexp(1, std::clamp(-std::ilogb(speed), -1000, 1000))
           : 1;
}

/// One cell's nodes, and what moves them.
class MovingCell
{
public:
  /// `unit`: of the factor, for the straight motion. `last`: the largest factor of interest, either
  /// way.
  MovingCell(const Mesh& mesh, const NodeMotion& motion, double unit, const InvertedBefore& before,
    double last)
    : mesh_(mesh)
    , motion_(motion)
    , unit_(unit)
    , before_(before)
    , last_(last)
    , fields_(1 + motion.turns.size())
  {
  }

  /// Returns whether the cell is to be followed.
  bool take(Index cell, double sign)
  {
    this->shape_ = cellShape(this->mesh_, cell);
    if (!this->shape_ || this->shape_->dimension != 3)
    {
      return false;
    }
    this->cell_ = cell;
    this->positive_ = this->before_.positivePlaces(cell);
    const bool isQuadratic =
      isQuadraticVolume(*this->shape_) && !this->positive_ && !this->hasFaces();
    this->map_ = isQuadratic ? CellMap::find(this->mesh_.types[cell]) : nullptr;
    this->sign_ = sign;
    this->gather(this->fields_[0], cell, this->motion_.base, this->motion_.straight, this->unit_);
    for (std::size_t t = 0; t < this->motion_.turns.size(); ++t)
    {
      const NodeMotion::Turn& turn = this->motion_.turns[t];
      this->gather(this->fields_[1 + t], cell, turn.first, turn.second, 1);
    }
    this->observer_.setZero();
    this->place(0);
    if (this->hasFaces() && !this->findWeights())
    {
      return false;
    }
    if (!this->motion_.turns.empty())
    {
      // A determinant is the same for an observer who turns with the cell, and sees it bend less.
      const Vector turn = this->meanTurn();
      const std::vector<Lengths> seen = this->bends(turn), still = this->bends(Vector::Zero());
      const bool isLess = sum(seen) < sum(still);
      this->observer_ = isLess ? turn : Vector(Vector::Zero());
      this->bends_ = isLess ? seen : still;
    }
    return true;
  }

  bool hasFaces() const { return morph::hasFaces(this->mesh_, this->cell_); }

  /// Calls act(determinant, lengths, isPlace) for each that is followed, from `factor` on. Not a
  /// place is a coefficient of a quadratic cell. A polyhedron has the centers that are found at
  /// `factor`.
  template <typename Act>
  void forEachBound(double factor, const Act& act)
  {
    this->place(factor);
    if (factor != 0 && this->hasFaces())
    {
      this->findWeights();
      this->bends_ =
        this->motion_.turns.empty() ? std::vector<Lengths>() : this->bends(this->observer_);
    }
    std::size_t place = 0;
    this->forEachPlace(this->now_,
      [&](const Pair& a, const Pair& b, const Pair& c)
      {
        Lengths lengths = this->bends_.empty() ? Lengths{} : this->bends_[place++];
        for (int j = 0; j < 2; ++j)
        {
          lengths[j] = { a.col(j).norm(), b.col(j).norm(), c.col(j).norm() };
        }
        act(determinant(a, b, c, this->sign_), lengths, true);
      });
    if (this->map_)
    {
      this->forEachCoefficient(act);
    }
  }

  /// The factor in which the placed cell moves by its size, as its observer sees it; 1 if it does
  /// not move.
  double unitHere() const
  {
    double size = 0, speed = 0;
    for (const Pair& x : this->now_)
    {
      size = std::max(size, (x.col(0) - this->now_[0].col(0)).norm());
      speed = std::max(speed, (x.col(1) - this->now_[0].col(1)).norm());
    }
    return speed > 1e-90 * size ? size / speed : 1;
  }

private:
  using Field = std::vector<Pair>; ///< of the cell's nodes

  /// Finds the centers of the placed polyhedron. Returns whether it has faces, and all edges a
  /// length.
  bool findWeights()
  {
    std::vector<Vector> x;
    for (const Pair& node : this->now_)
    {
      x.push_back(node.col(0) - this->now_[0].col(0));
    }
    return this->polyhedron_.take(this->mesh_, this->cell_, x);
  }

  void gather(
    Field& field, Index cell, const Points* first, const Points* second, double factor) const
  {
    field.resize(this->mesh_.cellSize(cell));
    for (std::size_t i = 0; i < field.size(); ++i)
    {
      const Index node = this->mesh_.cell(cell)[i];
      field[i].col(0) = first->row(node).transpose();
      field[i].col(1) = second ? Vector(factor * second->row(node).transpose()) : Vector(0, 0, 0);
    }
  }

  /// Sets the nodes' positions and the derivatives that the observer sees.
  void place(double factor)
  {
    this->now_ = this->fields_[0];
    for (std::size_t i = 0; i < this->now_.size(); ++i)
    {
      Pair& x = this->now_[i];
      x.col(0) += factor * x.col(1);
      for (std::size_t t = 0; t < this->motion_.turns.size(); ++t)
      {
        const Pair& turn = this->fields_[1 + t][i];
        const double speed = this->motion_.turns[t].angle, angle = factor * speed;
        const double half = std::sin(angle / 2);
        x.col(0) += std::sin(angle) * turn.col(0) + 2 * half * half * turn.col(1);
        x.col(1) += speed * (std::cos(angle) * turn.col(0) + std::sin(angle) * turn.col(1));
      }
      x.col(1) -= this->observer_.cross(x.col(0));
    }
  }

  /// Calls act() with the three edges at each place that was positive before.
  template <typename Act>
  void forEachPlace(const Field& x, const Act& act) const
  {
    std::size_t place = 0;
    const auto add = [&](const Pair& a, const Pair& b, const Pair& c)
    {
      const std::size_t number = place++;
      if (!this->positive_ || (*this->positive_)[number])
      {
        act(a, b, c);
      }
    };
    if (this->hasFaces())
    {
      this->polyhedron_.forEach(x.data(), add);
      return;
    }
    Pair corner[8];
    for (int k = 0; k < this->shape_->numberOfCorners; ++k)
    {
      corner[k] = x[this->shape_->cornerNode[k]];
    }
    forEachMeasuredPlace(this->shape_->shape, corner, add);
  }

  /// The angular velocity of the placed cell, by least squares over its edges.
  Vector meanTurn() const
  {
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    Vector momentum = Vector::Zero();
    const auto add = [&](const Pair& edge)
    {
      const Vector e = edge.col(0);
      inertia += e.squaredNorm() * Eigen::Matrix3d::Identity() - e * e.transpose();
      momentum += e.cross(edge.col(1));
    };
    this->forEachPlace(this->now_,
      [&](const Pair& a, const Pair& b, const Pair& c)
      {
        add(a);
        add(b);
        add(c);
      });
    return inertia.ldlt().solve(momentum);
  }

  /// Bounds of half the second derivatives of the edges, for an observer with the angular velocity
  /// `w`. He sees D x = dx / ds - w x x, and D D x of
  /// - a constant c: w x (w x c); of s c: that times s, less 2 w x c;
  /// - sin(s a) p + cos(s a) r: the same of p' = -a r - w x p and r' = a p - w x r, twice.
  /// The last entry is that of a quadratic cell's coefficients.
  std::vector<Lengths> bends(const Vector& w) const
  {
    Field c = this->fields_[0];
    std::vector<Field> fields = this->fields_;
    for (std::size_t i = 0; i < c.size(); ++i)
    {
      Vector fixed = c[i].col(0) - c[0].col(0);
      const Vector turned = w.cross(c[i].col(1));
      for (std::size_t t = 0; t < this->motion_.turns.size(); ++t)
      {
        const double a = this->motion_.turns[t].angle;
        Pair& x = fields[1 + t][i];
        fixed += x.col(1);
        x.col(1) *= -1;
        for (int times = 0; times < 2; ++times)
        {
          const Vector sine = -a * x.col(1) - w.cross(x.col(0));
          x.col(1) = a * x.col(0) - w.cross(x.col(1));
          x.col(0) = sine;
        }
      }
      fields[0][i] << w.cross(w.cross(fixed)) - 2 * turned, this->last_ * w.cross(turned);
    }
    std::vector<Lengths> result;
    for (const Field& field : fields)
    {
      std::size_t place = 0;
      const auto add = [&](int edge, double length)
      {
        result.resize(std::max(result.size(), place + 1));
        result[place][2][edge] += length / 2;
      };
      this->forEachPlace(field,
        [&](const Pair& a, const Pair& b, const Pair& c)
        {
          add(0, a.colwise().norm().sum());
          add(1, b.colwise().norm().sum());
          add(2, c.colwise().norm().sum());
          ++place;
        });
      for (int j = 0; j < 2 && this->map_; ++j)
      {
        const std::array<double, 3> lengths =
          largest(this->derivatives(field, Eigen::Vector2d::Unit(j)));
        for (int edge = 0; edge < 3; ++edge)
        {
          add(edge, lengths[edge]);
        }
      }
    }
    return result;
  }

  static double sum(const std::vector<Lengths>& bends)
  {
    double result = 0;
    for (const Lengths& lengths : bends)
    {
      result += lengths[2][0] + lengths[2][1] + lengths[2][2];
    }
    return result;
  }

  /// Of a quadratic cell with the nodes `field` times `factors`.
  CellMap::Derivatives derivatives(const Field& field, const Eigen::Vector2d& factors) const
  {
    Vector x[MostNodesOfVolume];
    std::transform(
      field.begin(), field.end(), x, [&](const Pair& pair) -> Vector { return pair * factors; });
    return this->map_->derivatives(x);
  }
  static std::array<double, 3> largest(const CellMap::Derivatives& of)
  {
    const double factor = std::sqrt(3.);
    return { factor * of.largest[0], factor * of.largest[1], factor * of.largest[2] };
  }

  /// A coefficient is a convex combination of determinants of the derivatives' own coefficients,
  /// so that the largest of these bound how it changes.
  template <typename Act>
  void forEachCoefficient(const Act& act)
  {
    // In units of the factor in which the cell moves by its size: a slow motion changes the values
    // by no more than rounding.
    const double unit = this->unitHere();
    constexpr double At[4] = { 0, -1, 1, 2 };
    BernsteinHalving::Coefficients values[4];
    for (int k = 0; k < 4; ++k)
    {
      values[k].fill(0);
      this->map_->determinant(this->derivatives(this->now_, { 1, unit * At[k] }), 0, values[k]);
    }
    Lengths lengths = this->bends_.empty() ? Lengths{} : this->bends_.back();
    lengths[0] = largest(this->derivatives(this->now_, { 1, 0 }));
    lengths[1] = largest(this->derivatives(this->now_, { 0, 1 }));
    for (int term = 0; term < this->map_->terms(); ++term)
    {
      // The cubic through the four values.
      const double v = this->sign_ * values[0][term], before = this->sign_ * values[1][term],
                   after = this->sign_ * values[2][term], second = this->sign_ * values[3][term];
      const double even = (after + before) / 2 - v, odd = (after - before) / 2;
      const double cubed = (second - v - 4 * even - 2 * odd) / 6;
      act({ v, (odd - cubed) / unit, even / (unit * unit), cubed / (unit * unit * unit) }, lengths,
        false);
    }
  }

  const Mesh& mesh_;
  const NodeMotion& motion_;
  double unit_;
  const InvertedBefore& before_;
  double last_;
  const std::vector<bool>* positive_ = nullptr; ///< see InvertedBefore::positivePlaces()
  std::vector<Field> fields_;  ///< base and straight, then first and second of each turn
  Field now_;                  ///< positions and derivatives
  std::vector<Lengths> bends_; ///< with turns: of each place
  Vector observer_;            ///< his angular velocity
  Index cell_ = -1;
  PolyhedronPlaces polyhedron_;
  const CellShape* shape_ = nullptr;
  const CellMap* map_ = nullptr; ///< of a quadratic cell
  double sign_ = 1;
};

/// One end of a range: how far the factor goes in one direction.
struct End
{
  double distance = Infinity;
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

/// Returns how far the cell is valid, or infinity where that is beyond `step.most`. `step`: has the
/// bounds at 0. No step passes the end, so that those to an end before that do not depend on it.
double follow(MovingCell& cell, Step& step)
{
  const double most = step.most;
  double factor = 0, length = step.take();
  for (int steps = 1; length < Infinity; ++steps)
  {
    factor += length;
    if (length <= Precision * factor || steps == MostSteps)
    {
      return factor;
    }
    step.most = most - factor;
    cell.forEachBound(step.sign * factor,
      [&step](const Polynomial& d, const Lengths& lengths, bool) { step.add(d, lengths); });
    length = step.take();
  }
  return length;
}

/// As follow(), for a polyhedron, whose centers change their weights on the way: a step is most of
/// that which the weights at its beginning allow, and is halved where the determinants with those
/// at its end are not positive. The first is at most `first`, later ones twice the last. Nothing
/// ends far beyond the first: there the cell has the shape of its motion.
double followPolyhedron(MovingCell& cell, Step& step, double first)
{
  constexpr double Most = 0.875, Far = 1e6;
  const double last = std::min(step.most, Far * first);
  step.most = Infinity;
  double factor = 0, allowed = step.take(), length = first;
  for (int steps = 1; steps < MostSteps && factor < last; ++steps)
  {
    length = std::min(length, Most * allowed);
    bool isValid = true;
    cell.forEachBound(step.sign * (factor + length),
      [&](const Polynomial& d, const Lengths& lengths, bool)
      {
        isValid = isValid && d[0] > 0;
        step.add(d, lengths);
      });
    const double next = step.take();
    factor += isValid ? length : 0;
    allowed = isValid ? next : allowed;
    if (length <= Precision * factor)
    {
      break;
    }
    length *= isValid ? 2 : 0.5;
  }
  return factor < last ? factor : Infinity;
}
}

ValidRange validRange(const Mesh& mesh, const NodeMotion& given,
  const std::vector<std::int8_t>& orientation, const InvertedBefore& before, Monitor& monitor)
{
  const double unit = unitOf(given);
  NodeMotion motion = given;
  double last = Infinity;
  for (NodeMotion::Turn& turn : motion.turns)
  {
    turn.angle *= unit;
    last = std::min(last, FullTurn / std::abs(turn.angle));
  }
  const int degree = motion.turns.empty() ? 3 : 6;
  End low, high;
  Index inverted = -1;
  std::mutex mutex;
  // A search that knows the best ends so far takes fewer steps. The margin keeps the result
  // independent of the order of the cells.
  constexpr double Margin = 1 + 1e-9;
  std::atomic<double> lowest = last, highest = last;
  parallelBatches(monitor, mesh.numberOfCells(), Batch, Grain,
    [&](Index first, Index end)
    {
      MovingCell cell(mesh, motion, unit, before, last);
      Step down = { -1, degree, last, {} }, up = { 1, degree, last, {} };
      for (Index c = first; c < end; ++c)
      {
        if (!cell.take(c, orientation.empty() ? 1 : orientation[c]))
        {
          continue;
        }
        down.most = Margin * lowest;
        up.most = Margin * highest;
        down.bounds.clear();
        up.bounds.clear();
        bool isValid = true;
        cell.forEachBound(0,
          [&](const Polynomial& d, const Lengths& lengths, bool isPlace)
          {
            isValid = isValid && (d[0] > 0 || !isPlace);
            down.add(d, lengths);
            up.add(d, lengths);
          });
        const double pace = cell.unitHere();
        const auto endOf = [&](Step& step)
        { return cell.hasFaces() ? followPolyhedron(cell, step, pace) : follow(cell, step); };
        const double below = isValid ? endOf(down) : 0;
        const double above = isValid ? endOf(up) : 0;
        if (below < Infinity || above < Infinity)
        {
          const std::lock_guard<std::mutex> lock(mutex);
          inverted = isValid || (inverted >= 0 && inverted < c) ? inverted : c;
          low.add(below, c);
          high.add(above, c);
          lowest = std::min(low.distance, last);
          highest = std::min(high.distance, last);
        }
      }
    });
  if (inverted >= 0)
  {
    const double none = std::numeric_limits<double>::quiet_NaN();
    return { none, none, inverted, inverted, true };
  }
  // A factor beyond all numbers is no end.
  for (End* end : { &low, &high })
  {
    end->distance *= unit;
    end->cell = end->distance < Infinity ? end->cell : -1;
  }
  return { -low.distance, high.distance, low.cell, high.cell };
}
}
