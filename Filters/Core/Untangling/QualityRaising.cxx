// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/QualityRaising.h"

#include "Energies/StiffenedDistortion.h"
#include "Mesh/CellShape.h"
#include "Mesh/OwnCells.h"
#include "Mesh/Topology.h"
#include "Support/Lists.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace morph
{
namespace
{
constexpr double NearBound = 2.5e-3; // a mesh within this part of the bound is left as it is
// The barrier leaves the worst sample a way, relative to its distortion. A step goes half of it. A
// way above NearWay shrinks by Closing where a step has gained less, other ways where it gains less
// than WorthWhile.
constexpr double NearWay = 0.15, LastWay = 0.01, Closing = 0.7;
constexpr int StepsOfRound = 12; // on a part of the mesh
// A search ends where this many steps, or a round, gain less than this.
constexpr int Patience = 4;
constexpr double WorthWhile = 3e-3;
// With few rings of hexahedra the nodes that stay hold the minimum down. Two rings of tetrahedra
// have as many cells.
constexpr int Rings = 7;
// Worst are cells above the minimum m by at most m / 2 and this share of 1 - m.
constexpr double OfTheWay = 0.1;
constexpr double WorstShare = 0.01; // cells that rise when the minimum is at its bound
constexpr double Growth = 1.1;      // of the floor under samples at their bounds, a step
constexpr double ForTheMean = 1.1;  // gain of the minimum that is worth a lower mean

bool isMostlyTetrahedra(const Mesh& mesh, const Communicator& communicator)
{
  const Index tetrahedra = std::count_if(mesh.types.begin(), mesh.types.end(),
    [](std::uint8_t type) { return cellShape(type)->shape == Shape::Tet; });
  return 2 * communicator.sum(tetrahedra) > communicator.sum(mesh.numberOfCells());
}

/// A part of a mesh with its objective.
struct Part
{
  Part(const MovableQuality& measured, const KRing& ring, const std::vector<Index>& cells,
    const Points& start, const Points& points)
    : mesh(measured.mesh(), cells)
    , processes(measured.communicator().part(this->mesh.nodes))
    , points(points(this->mesh.nodes, allColumns))
    , objective(this->mesh.mesh, this->mesh.take(measured.orientation()), consecutive(cells.size()),
        this->freeOf(ring), start(this->mesh.nodes, allColumns), *this->processes)
  {
  }

  SubMesh mesh;
  std::unique_ptr<Communicator> processes;
  Points points; ///< of its nodes
  StiffenedDistortion objective;

private:
  /// Nodes of hopeless cells alone are not in the part.
  std::vector<Index> freeOf(const KRing& ring) const
  {
    std::vector<Index> free = this->mesh.numbersOf(ring.nodes);
    free.erase(std::remove(free.begin(), free.end(), -1), free.end());
    return free;
  }
};

class Raising
{
public:
  Raising(const MovableQuality& measured, double goal, int steps, Points& points, Monitor& monitor)
    : measured_(measured)
    , mesh_(measured.mesh())
    , communicator_(measured.communicator())
    , goal_(std::min(goal, 1.))
    , steps_(steps)
    , points_(points)
    , start_(points)
    , monitor_(monitor)
    , isOfTetrahedra_(isMostlyTetrahedra(this->mesh_, this->communicator_))
    , quality_(measured.measure(points, monitor))
    , leastAtStart_(this->quality_.minimum)
    , meanAtStart_(this->meanOf(this->quality_))
  {
  }

  MinimizerEffort run()
  {
    if (!(this->quality_.minimum > 0) || this->communicator_.all(this->measured_.free().empty()))
    {
      return {};
    }
    this->around_ = nodeToCells(this->mesh_);
    // Far below the goal sums of distortions rise the fastest; near it they lower the minimum.
    this->way_ = 2 * this->quality_.minimum < this->goal_ ? 1. / 2 : NearWay;
    this->raiseMinimum();
    if (hasReached(this->quality_.minimum, this->goal_) && !hasReached(this->quality_.minimum, 1))
    {
      this->raiseOthers();
    }
    this->guardMean();
    return this->effort_;
  }

private:
  int rings() const { return this->isOfTetrahedra_ ? 2 : Rings; }
  int left() const { return this->steps_ - static_cast<int>(this->effort_.steps); }

  /// Returns the cells up to `limit`.
  std::vector<Index> cellsBelow(double limit) const
  {
    std::vector<Index> cells;
    for (Index c = 0; c < this->mesh_.numberOfCells(); ++c)
    {
      if (this->quality_.scaledJacobian[c] <= limit) // NaN without a sample
      {
        cells.push_back(c);
      }
    }
    return cells;
  }

  Part partAround(const std::vector<Index>& seeds, int rings, bool& isWhole, double& outside) const
  {
    KRing ring = kRingOfCells(
      this->mesh_, this->around_, this->measured_.free(), seeds, rings, this->communicator_);
    const auto count = [&](const std::vector<Index>& nodes)
    { return this->communicator_.sum(static_cast<double>(nodes.size())); };
    isWhole = rings == 0 || 2 * count(ring.nodes) > count(this->measured_.free());
    outside = std::numeric_limits<double>::infinity();
    std::vector<char> isInside(this->mesh_.numberOfCells(), isWhole ? 1 : 0);
    for (const Index c : ring.cells)
    {
      isInside[c] = 1;
    }
    if (isWhole)
    {
      ring.nodes = this->measured_.free();
    }
    std::vector<Index> cells;
    for (Index c = 0; c < this->mesh_.numberOfCells(); ++c)
    {
      const double own = this->quality_.scaledJacobian[c];
      if (isInside[c] != 0 && !std::isnan(own))
      {
        cells.push_back(c);
      }
      outside = isInside[c] == 0 && own < outside ? own : outside;
    }
    outside = this->communicator_.minimum(outside);
    return { this->measured_, ring, cells, this->start_, this->points_ };
  }

  void take(const Part& part)
  {
    this->points_(part.mesh.nodes, allColumns) = part.points;
    this->measured_.measureAgain(part.mesh.cells, this->points_, this->quality_, this->monitor_);
  }

  /// Takes `points` back where the minimum is lower now.
  void keepAtLeast(double minimum, const Points& points, const MovableQuality::Result& quality)
  {
    if (this->quality_.minimum < minimum)
    {
      this->points_ = points;
      this->quality_ = quality;
    }
  }

  double meanOf(const MovableQuality::Result& quality) const
  {
    double sum = 0;
    for (const double s : quality.scaledJacobian)
    {
      sum += std::isnan(s) ? 0 : s;
    }
    return this->communicator_.sum(sum);
  }

  /// The mean does not fall below the start's, unless the minimum has risen by ForTheMean: the
  /// energy at a fixed level is that of a mean, with a barrier just below the minimum.
  void guardMean()
  {
    const auto isEnough = [&]
    {
      return this->quality_.minimum > ForTheMean * this->leastAtStart_ ||
             this->meanOf(this->quality_) >= this->meanAtStart_;
    };
    if (isEnough())
    {
      return;
    }
    bool isWhole = false;
    double outside = 0;
    Part part = this->partAround({}, 0, isWhole, outside);
    part.objective.setLevel(
      (1 - NearWay) / part.objective.evaluate(part.points, this->monitor_).largest);
    MinimizerLimits limits;
    limits.steps = StepsOfRound / 2;
    BlockCsr3f matrix;
    newton(part.objective, part.points, limits, matrix, this->effort_, this->monitor_);
    const Points before = this->points_;
    const MovableQuality::Result had = this->quality_;
    this->take(part);
    this->keepAtLeast((1 - NearBound) * had.minimum, before, had);
    if (!isEnough())
    {
      this->points_ = this->start_;
    }
  }

  void raiseMinimum()
  {
    int rings = this->rings();
    for (bool isWhole = false;
         this->left() > 0 && !hasReached(this->quality_.minimum, this->goal_);)
    {
      const MovableQuality::Result before = this->quality_;
      const Points pointsBefore = this->points_;
      const double least = before.minimum;
      const double limit = least + std::min(least / 2, OfTheWay * (1 - least));
      double outside = 0;
      Part part =
        this->partAround(this->cellsBelow(std::min(limit, this->goal_)), rings, isWhole, outside);
      const double most = std::min(this->goal_ * (1 - NearBound), outside);
      this->climb(part, most, isWhole ? this->left() : std::min(StepsOfRound, this->left()), false);
      this->take(part);
      // Where other cells are the worst now, these nodes were enough.
      rings *= this->quality_.minimum < most ? 2 : 1;
      if (this->quality_.minimum < (1 + WorthWhile) * least)
      {
        this->keepAtLeast(before.minimum, pointsBefore, before);
        break;
      }
    }
  }

  /// Bisects for the value that WorstShare of all processes' cells are below.
  double limitOfWorst() const
  {
    const auto countBelow = [&](double limit)
    { return this->communicator_.sum(static_cast<double>(this->cellsBelow(limit).size())); };
    const double wanted = WorstShare * countBelow(1);
    double low = this->quality_.minimum, high = 1;
    while (high - low > NearBound * high)
    {
      const double middle = (low + high) / 2;
      (countBelow(middle) > wanted ? high : low) = middle;
    }
    return high;
  }

  /// Raises the worst cells but those at the bound of the minimum.
  void raiseOthers()
  {
    const double limit = this->limitOfWorst();
    if (hasReached(this->quality_.minimum, limit))
    {
      return;
    }
    const Points before = this->points_;
    const MovableQuality::Result had = this->quality_;
    bool isWhole = false;
    double outside = 0;
    Part part = this->partAround(this->cellsBelow(limit), this->rings() / 2, isWhole, outside);
    this->way_ = NearWay;
    this->climb(part, 1, StepsOfRound / 2, true);
    this->take(part);
    this->steps_ = static_cast<int>(this->effort_.steps) + StepsOfRound;
    this->raiseMinimum();
    this->keepAtLeast((1 - NearBound) * had.minimum, before, had);
  }

  /// The least sample. With a floor that follows it samples at their bounds do not count.
  double leastOf(StiffenedDistortion& objective, const Points& points, double& floor)
  {
    const auto least = [&]
    { return 1 / std::sqrt(objective.evaluate(points, this->monitor_).largest); };
    if (floor == 0)
    {
      return least();
    }
    objective.setFloor(Growth * floor);
    floor = std::max(floor, std::min(Growth * floor, least()));
    objective.setFloor(floor);
    return least();
  }

  /// Takes `most` steps, or until the minimum is at `goal`. `aboveBounds`: of samples that are not
  /// at their bounds.
  void climb(Part& part, double goal, int most, bool aboveBounds)
  {
    StiffenedDistortion& objective = part.objective;
    Points x = part.points;
    double floor = 0;
    double best = this->leastOf(objective, x, floor);
    if (aboveBounds)
    {
      floor = best;
      for (int i = 0; i < StepsOfRound; ++i)
      {
        best = this->leastOf(objective, x, floor);
      }
    }
    double& way = this->way_;
    double last = best;
    MinimizerLimits limits;
    limits.steps = 1;
    limits.doublings = StepsOfRound; // as long as they lower the energy: half of the way is typical
    BlockCsr3f matrix;
    double mark = best; // of the last steps' start
    for (int step = 0; step < most && best < goal; ++step)
    {
      if (step > 0 && step % Patience == 0)
      {
        if (way <= NearWay && best < (1 + WorthWhile) * mark)
        {
          break;
        }
        mark = best;
      }
      objective.setLevel(std::max(objective.level(), (1 - way) * last * last));
      const Index before = this->effort_.steps;
      newton(objective, x, limits, matrix, this->effort_, this->monitor_);
      this->effort_.steps = before + 1;
      this->monitor_.progress(std::min(1., static_cast<double>(before) / this->steps_));
      this->monitor_.check();
      objective.restoreLimits(x);
      const double least = this->leastOf(objective, x, floor), gain = least / last - 1;
      last = least;
      if (least > best)
      {
        best = least;
        part.points = x;
      }
      // The minimum's part of half of the way: f = 1 / s^2.
      const double expected = way > NearWay ? way / 4 : WorthWhile;
      way = gain < expected ? std::max(LastWay, Closing * way) : way;
      if (aboveBounds && gain < WorthWhile)
      {
        break;
      }
    }
  }

  const MovableQuality& measured_;
  const Mesh& mesh_;
  const Communicator& communicator_;
  const double goal_;
  int steps_;
  Points& points_;
  const Points start_;
  Monitor& monitor_;
  bool isOfTetrahedra_;
  MovableQuality::Result quality_;
  const double leastAtStart_, meanAtStart_;
  Adjacency around_; ///< cells round nodes
  double way_ = NearWay;
  MinimizerEffort effort_;
};
}

bool hasReached(double minimum, double goal)
{
  return minimum >= (1 - NearBound) * std::min(goal, 1.);
}

MinimizerEffort raiseQuality(
  const MovableQuality& quality, double goal, int steps, Points& points, Monitor& monitor)
{
  return Raising(quality, goal, steps, points, monitor).run();
}
}
