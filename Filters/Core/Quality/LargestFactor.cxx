// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/LargestFactor.h"

#include "Quality/MeasuredPlaces.h"
#include "Quality/PolyhedronPlaces.h"
#include "Quality/PolynomialRoot.h"
#include "Quality/QuadraticJacobian.h"
#include "Quality/QuadraticMap.h"

#include <Eigen/Geometry>

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
constexpr Index Grain = 256;
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double Turn = 6.28318530717958647692;

/// The three edges at each place where a cell is measured.
using Edges = std::vector<std::array<Vector, 3>>;

/// The step in which a determinant of value `d` cannot reach 0. `size`: bounds of its three
/// columns; `speed`: of their changes by the factor.
double safeStep(double d, const std::array<double, 3>& size, const std::array<double, 3>& speed)
{
  // (size + h speed) products less the product of sizes, less d.
  const double a[4] = { d,
    -(speed[0] * size[1] * size[2] + size[0] * speed[1] * size[2] + size[0] * size[1] * speed[2]),
    -(speed[0] * speed[1] * size[2] + speed[0] * size[1] * speed[2] +
      size[0] * speed[1] * speed[2]),
    -(speed[0] * speed[1] * speed[2]) };
  return firstPositiveRoot(a, 3);
}

/// One cell's nodes, and what moves them.
class MovingCell
{
public:
  MovingCell(const Mesh& mesh, const CombinedMotion& motion, const InvertedBefore& before)
    : mesh_(mesh)
    , motion_(motion)
    , before_(before)
    , fields_(2 + 2 * motion.turns.size())
    , edges_(fields_.size())
  {
  }

  /// Returns whether the cell is to be followed.
  bool take(Index cell, double sign)
  {
    this->shape_ = cellShape(this->mesh_.types[cell]);
    if (!this->shape_ || this->shape_->dimension != 3)
    {
      return false;
    }
    this->positive_ = this->before_.positivePlaces(cell);
    const bool isQuadratic = isQuadraticVolume(*this->shape_) && !this->positive_;
    this->map_ = isQuadratic ? QuadraticMap::find(this->mesh_.types[cell]) : nullptr;
    this->sign_ = sign;
    const auto nodes = this->mesh_.cell(cell);
    this->nodes_ = static_cast<int>(this->mesh_.cellSize(cell));
    this->now_.resize(this->nodes_);
    this->isPolyhedron_ = this->shape_->shape == Shape::Polyhedron;
    this->gather(0, this->motion_.base, nodes);
    this->gather(1, this->motion_.straight, nodes);
    for (std::size_t t = 0; t < this->motion_.turns.size(); ++t)
    {
      this->gather(2 + 2 * t, this->motion_.turns[t].first, nodes);
      this->gather(3 + 2 * t, this->motion_.turns[t].second, nodes);
    }
    if (this->isPolyhedron_ &&
        !this->polyhedron_.take(this->mesh_, cell, *this->motion_.base, sign))
    {
      return false;
    }
    this->setSpeeds();
    return true;
  }

  bool isQuadratic() const { return this->map_ != nullptr; }

  bool isValidAtRest() const
  {
    for (const auto& e : this->edges_[0])
    {
      if (!(this->sign_ * e[0].dot(e[1].cross(e[2])) > 0))
      {
        return false;
      }
    }
    return true;
  }

  /// The step from `factor` in which the cell stays valid; 0 or less where it is not valid.
  double step(double factor)
  {
    this->place(factor);
    double result = Infinity;
    this->setEdges(this->edgesNow_, this->now_.data());
    for (std::size_t place = 0; place < this->edgesNow_.size(); ++place)
    {
      const auto& e = this->edgesNow_[place];
      const std::array<double, 3> size = { e[0].norm(), e[1].norm(), e[2].norm() };
      const double d = this->sign_ * e[0].dot(e[1].cross(e[2]));
      result = d > 0 ? std::min(result, safeStep(d, size, this->speed_[place])) : 0;
      if (result == 0)
      {
        return 0;
      }
    }
    return this->isQuadratic() ? std::min(result, this->quadraticStep()) : result;
  }

private:
  template <typename Nodes>
  void gather(std::size_t field, const Points* values, const Nodes& nodes)
  {
    this->fields_[field].resize(this->nodes_);
    for (int i = 0; i < this->nodes_; ++i)
    {
      this->fields_[field][i] =
        values ? Vector(values->row(nodes[i]).transpose()) : Vector(Vector::Zero());
    }
  }

  /// `x`: all nodes of the cell.
  void setEdges(Edges& edges, const Vector* x) const
  {
    edges.clear();
    std::size_t place = 0;
    const auto add = [&](const Vector& a, const Vector& b, const Vector& c)
    {
      const bool isFollowed = !this->positive_ || (*this->positive_)[place];
      ++place;
      if (isFollowed)
      {
        edges.push_back({ a, b, c });
      }
    };
    if (this->isPolyhedron_)
    {
      this->polyhedron_.forEach(x, add);
      return;
    }
    Vector corner[8];
    this->gatherCorners(x, corner);
    forEachMeasuredPlace(this->shape_->shape, corner, add);
  }

  /// In the order of the shape.
  void gatherCorners(const Vector* x, Vector* corner) const
  {
    for (int k = 0; k < this->shape_->numberOfCorners; ++k)
    {
      corner[k] = x[this->shape_->cornerNode[k]];
    }
  }

  /// The fastest change of a vector whose parts are given by `sizeOf(field)`.
  template <typename SizeOf>
  double speedOf(const SizeOf& sizeOf) const
  {
    double speed = sizeOf(1);
    for (std::size_t t = 0; t < this->motion_.turns.size(); ++t)
    {
      speed +=
        std::abs(this->motion_.turns[t].angle) * std::hypot(sizeOf(2 + 2 * t), sizeOf(3 + 2 * t));
    }
    return speed;
  }

  void setSpeeds()
  {
    for (std::size_t field = 0; field < this->fields_.size(); ++field)
    {
      this->setEdges(this->edges_[field], this->fields_[field].data());
    }
    this->speed_.resize(this->edges_[0].size());
    for (std::size_t place = 0; place < this->speed_.size(); ++place)
    {
      for (int k = 0; k < 3; ++k)
      {
        this->speed_[place][k] =
          this->speedOf([&](std::size_t field) { return this->edges_[field][place][k].norm(); });
      }
    }
    if (!this->isQuadratic())
    {
      return;
    }
    std::vector<QuadraticMap::Derivatives> parts;
    for (const Field& field : this->fields_)
    {
      parts.push_back(this->map_->derivatives(field.data()));
    }
    for (int k = 0; k < 3; ++k)
    {
      this->quadraticSpeed_[k] =
        this->speedOf([&](std::size_t field) { return std::sqrt(3.) * parts[field].largest[k]; });
    }
  }

  void place(double factor)
  {
    this->now_ = this->fields_[0];
    const auto add = [&](std::size_t field, double weight)
    {
      for (int i = 0; i < this->nodes_; ++i)
      {
        this->now_[i] += weight * this->fields_[field][i];
      }
    };
    add(1, factor);
    for (std::size_t t = 0; t < this->motion_.turns.size(); ++t)
    {
      const double angle = factor * this->motion_.turns[t].angle, half = std::sin(angle / 2);
      add(2 + 2 * t, std::sin(angle));
      add(3 + 2 * t, 2 * half * half);
    }
  }

  /// A coefficient is a convex combination of determinants of the derivatives' own coefficients,
  /// so that the largest of these bound how it changes.
  double quadraticStep() const
  {
    const QuadraticMap::Derivatives derivatives = this->map_->derivatives(this->now_.data());
    BernsteinHalving::Coefficients c;
    c.fill(0);
    this->map_->determinant(derivatives, 0, c);
    double least = Infinity;
    for (int term = 0; term < this->map_->terms(); ++term)
    {
      least = std::min(least, this->sign_ * c[term]);
    }
    std::array<double, 3> size;
    for (int k = 0; k < 3; ++k)
    {
      size[k] = std::sqrt(3.) * derivatives.largest[k];
    }
    return least > 0 ? safeStep(least, size, this->quadraticSpeed_) : 0;
  }

  using Field = std::vector<Vector>; ///< of the cell's nodes
  const Mesh& mesh_;
  const CombinedMotion& motion_;
  const InvertedBefore& before_;
  const std::vector<bool>* positive_ = nullptr; ///< see InvertedBefore::positivePlaces()
  std::vector<Field> fields_; ///< base, straight, and first and second of each turn
  std::vector<Edges> edges_;  ///< of fields_
  Edges edgesNow_;
  Field now_;
  PolyhedronPlaces polyhedron_;
  std::vector<std::array<double, 3>> speed_; ///< of each place
  std::array<double, 3> quadraticSpeed_;
  const CellShape* shape_ = nullptr;
  const QuadraticMap* map_ = nullptr; ///< of a quadratic cell
  double sign_ = 1;
  int nodes_ = 0;
  bool isPolyhedron_ = false;
};

/// The factor up to which a cell is valid, or infinity where it is beyond `last` or `known`.
double follow(MovingCell& cell, double last, double known)
{
  const double least = (cell.isQuadratic() ? 1e-5 : 1e-9) * last;
  double factor = 0;
  for (;;)
  {
    const double step = cell.step(factor);
    if (step <= least)
    {
      return factor;
    }
    factor += step;
    // Equal for any order of the cells: one that ends before the others never comes here.
    if (factor >= last || factor > known)
    {
      return Infinity;
    }
  }
}
}

LargestFactor largestFactor(const Mesh& mesh, const CombinedMotion& motion,
  const std::vector<std::int8_t>& orientation, const InvertedBefore& before, Monitor& monitor)
{
  monitor.check();
  double fastest = 0;
  for (const CombinedMotion::Turn& turn : motion.turns)
  {
    fastest = std::max(fastest, std::abs(turn.angle));
  }
  const double last = Turn / fastest;
  LargestFactor result;
  Index inverted = -1;
  std::mutex mutex;
  std::atomic<double> known = Infinity;
  monitor.parallelFor(mesh.numberOfCells(), Grain,
    [&](Index first, Index end)
    {
      MovingCell cell(mesh, motion, before);
      for (Index c = first; c < end; ++c)
      {
        if (!cell.take(c, orientation.empty() ? 1 : orientation[c]))
        {
          continue;
        }
        const bool isValid = cell.isValidAtRest();
        const double factor = isValid ? follow(cell, last, known.load()) : 0;
        if (isValid && factor == Infinity)
        {
          continue;
        }
        const std::lock_guard<std::mutex> lock(mutex);
        if (!isValid)
        {
          inverted = inverted < 0 ? c : std::min(inverted, c);
        }
        else if (factor < result.factor || (factor == result.factor && c < result.cell))
        {
          result.factor = factor;
          result.cell = c;
          known = factor;
        }
      }
    });
  if (inverted >= 0)
  {
    return { std::numeric_limits<double>::quiet_NaN(), inverted };
  }
  return result;
}
}
