// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/LargestFactor.h"

#include "Quality/CellMap.h"
#include "Quality/Certificate.h"
#include "Quality/MeasuredPlaces.h"
#include "Quality/PolyhedronQuality.h"
#include "Quality/PolynomialRoot.h"
#include "Support/Parallel.h"

#include <Eigen/Cholesky>
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
constexpr Index Batch = 64; // cells, of some milliseconds at most
constexpr Index Grain = 8;
constexpr int MostSteps = 4000; // of a cell, for slivers that shear without end
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
  /// `last`: the largest factor that step() is asked for.
  MovingCell(
    const Mesh& mesh, const CombinedMotion& motion, const InvertedBefore& before, double last)
    : mesh_(mesh)
    , motion_(motion)
    , before_(before)
    , last_(last)
    , fields_(2 + 2 * motion.turns.size())
    , edges_(fields_.size())
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
    this->positive_ = this->before_.positivePlaces(cell);
    const bool isQuadratic = isQuadraticVolume(*this->shape_) && !this->positive_;
    this->map_ = isQuadratic ? CellMap::find(this->mesh_.types[cell]) : nullptr;
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
    this->setEdges(this->edgesAtRest_, this->fields_[0].data());
    // A determinant is the same for an observer who turns with the cell, and sees it move less.
    const Speeds seen = this->speeds(this->meanTurn()), still = this->speeds(Vector::Zero());
    this->speeds_ = seen.sum < still.sum ? seen : still;
    return true;
  }

  bool isQuadratic() const { return this->map_ != nullptr; }

  bool isValidAtRest() const
  {
    for (const auto& e : this->edgesAtRest_)
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
      result = d > 0 ? std::min(result, safeStep(d, size, this->speeds_.ofPlace[place])) : 0;
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

  /// How fast the edges change at most, as an observer sees it.
  struct Speeds
  {
    std::vector<std::array<double, 3>> ofPlace;
    std::array<double, 3> quadratic = {}; ///< of the derivatives of a quadratic cell
    double sum = 0;
  };

  /// The angular velocity of the cell at the factor 0, by least squares over its edges.
  Vector meanTurn()
  {
    Field velocity = this->fields_[1];
    for (std::size_t t = 0; t < this->motion_.turns.size(); ++t)
    {
      for (int i = 0; i < this->nodes_; ++i)
      {
        velocity[i] += this->motion_.turns[t].angle * this->fields_[2 + 2 * t][i];
      }
    }
    this->setEdges(this->edges_[0], velocity.data());
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    Vector momentum = Vector::Zero();
    for (std::size_t place = 0; place < this->edgesAtRest_.size(); ++place)
    {
      for (int k = 0; k < 3; ++k)
      {
        const Vector& e = this->edgesAtRest_[place][k];
        inertia += e.squaredNorm() * Eigen::Matrix3d::Identity() - e * e.transpose();
        momentum += e.cross(this->edges_[0][place][k]);
      }
    }
    return inertia.ldlt().solve(momentum);
  }

  /// The speeds for an observer with the angular velocity `w`: of x = base + f straight + sum of
  /// sin(f a) p + (1 - cos(f a)) q he sees dx / df - w x x, which is straight - w x (base + sum of
  /// q) - f w x straight + sum of cos(f a) (a p + w x q) + sin(f a) (a q - w x p).
  Speeds speeds(const Vector& w)
  {
    std::vector<Field>& seen = this->seen_;
    seen.assign(this->fields_.size(), Field(this->nodes_));
    for (int i = 0; i < this->nodes_; ++i)
    {
      Vector turned = this->fields_[0][i] - this->fields_[0][0];
      for (std::size_t t = 0; t < this->motion_.turns.size(); ++t)
      {
        const double angle = this->motion_.turns[t].angle;
        const Vector &p = this->fields_[2 + 2 * t][i], &q = this->fields_[3 + 2 * t][i];
        seen[2 + 2 * t][i] = angle * p + w.cross(q);
        seen[3 + 2 * t][i] = angle * q - w.cross(p);
        turned += q;
      }
      seen[0][i] = this->fields_[1][i] - w.cross(turned);
      seen[1][i] = this->last_ * w.cross(this->fields_[1][i]);
    }
    const auto fastest = [&](const auto& sizeOf)
    {
      double speed = sizeOf(0) + sizeOf(1);
      for (std::size_t field = 2; field < seen.size(); field += 2)
      {
        speed += std::hypot(sizeOf(field), sizeOf(field + 1));
      }
      return speed;
    };
    Speeds result;
    std::vector<CellMap::Derivatives> parts;
    for (std::size_t field = 0; field < seen.size(); ++field)
    {
      this->setEdges(this->edges_[field], seen[field].data());
      if (this->isQuadratic())
      {
        parts.push_back(this->map_->derivatives(seen[field].data()));
      }
    }
    result.ofPlace.resize(this->edgesAtRest_.size());
    for (std::size_t place = 0; place < result.ofPlace.size(); ++place)
    {
      for (int k = 0; k < 3; ++k)
      {
        const double speed =
          fastest([&](std::size_t field) { return this->edges_[field][place][k].norm(); });
        result.ofPlace[place][k] = speed;
        result.sum += speed;
      }
    }
    for (int k = 0; k < 3 && this->isQuadratic(); ++k)
    {
      result.quadratic[k] =
        fastest([&](std::size_t field) { return std::sqrt(3.) * parts[field].largest[k]; });
    }
    return result;
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
    const CellMap::Derivatives derivatives = this->map_->derivatives(this->now_.data());
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
    return least > 0 ? safeStep(least, size, this->speeds_.quadratic) : 0;
  }

  using Field = std::vector<Vector>; ///< of the cell's nodes
  const Mesh& mesh_;
  const CombinedMotion& motion_;
  const InvertedBefore& before_;
  const std::vector<bool>* positive_ = nullptr; ///< see InvertedBefore::positivePlaces()
  double last_;
  std::vector<Field> fields_; ///< base, straight, and first and second of each turn
  std::vector<Field> seen_;   ///< scratch memory of speeds()
  std::vector<Edges> edges_;  ///< of seen_
  Edges edgesAtRest_, edgesNow_;
  Field now_;
  PolyhedronPlaces polyhedron_;
  Speeds speeds_;
  const CellShape* shape_ = nullptr;
  const CellMap* map_ = nullptr; ///< of a quadratic cell
  double sign_ = 1;
  int nodes_ = 0;
  bool isPolyhedron_ = false;
};

/// The factor up to which a cell is valid, or infinity where it is beyond `last` or `known`.
double follow(MovingCell& cell, double last, double known)
{
  const double least = (cell.isQuadratic() ? 1e-5 : 1e-9) * last;
  double factor = 0;
  for (int steps = 0; steps < MostSteps; ++steps)
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
  return factor;
}
}

LargestFactor largestFactor(const Mesh& mesh, const CombinedMotion& motion,
  const std::vector<std::int8_t>& orientation, const InvertedBefore& before, Monitor& monitor)
{
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
  parallelBatches(monitor, mesh.numberOfCells(), Batch, Grain,
    [&](Index first, Index end)
    {
      MovingCell cell(mesh, motion, before, last);
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
