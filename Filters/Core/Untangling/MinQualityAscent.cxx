// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/MinQualityAscent.h"

#include "Energies/WorstCornerNorm.h"
#include "Mesh/CellShape.h"
#include "Mesh/KRing.h"
#include "Optimization/Minimizers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace morph
{
namespace
{
constexpr int FirstSquarings = 1, LastSquarings = 7; // powers 2, 4, ... 128
// A third of the work raised the minimum of the pipe's tetrahedra by another 5 %.
constexpr int LastSquaringsOfTetrahedra = 6;
constexpr int Rounds = 40;
// A ring of tetrahedra has several times as many cells, and more of them are poor. With five rings
// of hexahedra the nodes that stay hold the minimum down.
constexpr int Rings = 7, RingsOfTetrahedra = 3;
// A gain of this many significant ones in a full round promises more from the same power.
constexpr double Promising = 30;
// A mesh within this part of the bound is left as it is.
constexpr double NearBound = 5e-3;
constexpr int LowSquarings = 2; // norms that often lower the minimum at first: fewer steps

// The norm is about the minimum's reciprocal, so smaller gains than this are not worth their steps.
constexpr double LeastDecrease = 5e-5, LeastDecreaseInTetrahedra = 1e-4;
constexpr int SettledSteps = 5; // in a row, as the first ones may be short

int stepsOf(int squarings)
{
  return squarings <= LowSquarings ? 60 : 100;
}

// A power is of use if a minimum at the goal lowers a corner's share of the norm by this factor.
// In hexahedra low powers also lead to higher minima in the end.
constexpr double OfUse = 1.2, OfUseInTetrahedra = 10;

/// Returns the least number of squarings of use. Lower powers cannot tell the goal from the
/// minimum: they move far nodes and lower the minimum as often as not.
int firstSquarings(double minimum, double goal, double ofUse)
{
  int squarings = FirstSquarings;
  while (
    squarings < LastSquarings && std::exp2(squarings) * std::log(goal / minimum) < std::log(ofUse))
  {
    ++squarings;
  }
  return squarings;
}

// Worst are cells above the minimum m by at most these shares of m and of 1 - m.
constexpr double OfTheLeast = 0.5, OfTheWay = 0.1;

std::vector<Index> worstCells(const Mesh& mesh, const MovableQuality::Result& quality)
{
  const double least = quality.minimum;
  const double limit = least + std::min(OfTheLeast * least, OfTheWay * (1 - least));
  std::vector<Index> worst;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (quality.scaledJacobian[c] <= limit)
    {
      worst.push_back(c);
    }
  }
  return worst;
}
}

namespace
{
constexpr int MostLevels = 6;
constexpr double FewCells = 0.01; // of all: where more are at the minimum, it is no single place's
// Raising the next-worst cells may evaluate this part of what raising the minimum has, or as much
// as these passes over the mesh.
constexpr double OfSpent = 0.3, FewPasses = 20;
constexpr double OfSpentOnTetrahedra = 0.1, FewPassesOfTetrahedra = 10;
constexpr double LeastSteps = 10; // fewer are not worth the set-up

/// Returns the cells at the minimum, within NearBound.
std::vector<Index> atMinimum(const MovableQuality::Result& quality)
{
  std::vector<Index> cells;
  for (std::size_t c = 0; c < quality.scaledJacobian.size(); ++c)
  {
    if (quality.scaledJacobian[c] * (1 - NearBound) <= quality.minimum)
    {
      cells.push_back(static_cast<Index>(c));
    }
  }
  return cells;
}
}

bool mostlyTetrahedra(const Mesh& mesh, const Communicator& communicator)
{
  const Index tetrahedra = std::count_if(mesh.types.begin(), mesh.types.end(),
    [](std::uint8_t type) { return cellShape(type)->shape == Shape::Tet; });
  return 2 * communicator.sum(tetrahedra) > communicator.sum(mesh.numberOfCells());
}

double significantGain(double least)
{
  return std::max(1e-6, std::min(1e-3 * least, 1e-2 * (1 - least)));
}

bool hasReached(double minimum, double goal)
{
  return minimum >= (1 - NearBound) * std::min(goal, 1.);
}

namespace
{
struct Limits
{
  int squarings;          ///< of the first power, at least
  double cellEvaluations; ///< in all
};

/// What all searches on a mesh share.
class Ascent
{
public:
  explicit Ascent(const MovableQuality& measured)
    : mesh_(measured.mesh())
    , communicator_(measured.communicator())
    , isOfTetrahedra_(mostlyTetrahedra(this->mesh_, this->communicator_))
  {
  }

  bool isOfTetrahedra() const { return this->isOfTetrahedra_; }
  /// Raises the minimum as raiseMinimumQuality() does, and adds to `effort`.
  void raise(const MovableQuality& measured, double bound, const Limits& limits, Points& points,
    AscentEffort& effort, Monitor& monitor);

private:
  const Adjacency& around()
  {
    if (!this->around_)
    {
      this->around_.emplace(nodeToCells(this->mesh_));
    }
    return *this->around_;
  }

  const Mesh& mesh_;
  const Communicator& communicator_;
  bool isOfTetrahedra_ = false;
  std::optional<Adjacency> around_; ///< cells round nodes; made for the first search
};

void Ascent::raise(const MovableQuality& measured, double bound, const Limits& limits,
  Points& points, AscentEffort& effort, Monitor& monitor)
{
  const double goal = std::min(bound, 1.);
  MovableQuality::Result quality = measured.measure(points, monitor);
  if (!(quality.minimum > 0) || hasReached(quality.minimum, goal) ||
      this->communicator_.all(measured.free().empty()))
  {
    return;
  }
  const bool isOfTetrahedra = this->isOfTetrahedra_;
  const int rings = isOfTetrahedra ? RingsOfTetrahedra : Rings;
  const int lastSquarings = isOfTetrahedra ? LastSquaringsOfTetrahedra : LastSquarings;
  const double ofUse = isOfTetrahedra ? OfUseInTetrahedra : OfUse;
  const auto first = [&](double minimum)
  { return std::min(lastSquarings, firstSquarings(minimum, goal, ofUse)); };
  const Points start = points;
  Points trial = points;
  int squarings = std::max(limits.squarings, first(quality.minimum));
  double best = quality.minimum; // of `points`; `quality` is that of `trial`
  // Once a power's second round has gained little, those of higher powers do.
  bool repeats = true, isRepeated = false;
  const auto canGain = [&]
  { return !hasReached(best, goal) && best + significantGain(best) < goal; };
  for (int round = 0; round < Rounds && squarings <= lastSquarings && canGain(); ++round)
  {
    const KRing patch = kRingOfCells(this->mesh_, this->around(), measured.free(),
      worstCells(this->mesh_, quality), rings, this->communicator_);
    const auto cells = this->communicator_.sum(static_cast<double>(patch.cells.size()));
    const double left = (limits.cellEvaluations - effort.cellEvaluations) / cells;
    if (left < LeastSteps)
    {
      break;
    }
    WorstCornerNorm norm(this->mesh_, measured.orientation(), patch.cells, patch.nodes,
      quality.minimum, squarings, goal * (1 - NearBound / 2), this->communicator_);
    norm.keepEdges(this->mesh_, start);
    MinimizerLimits stepLimits;
    stepLimits.steps = static_cast<int>(std::min<double>(stepsOf(squarings), left));
    stepLimits.decrease = isOfTetrahedra ? LeastDecreaseInTetrahedra : LeastDecrease;
    stepLimits.settledSteps = SettledSteps;
    MinimizerEffort steps;
    limitedMemoryBfgs(norm, trial, stepLimits, steps, monitor);
    effort.cellEvaluations += cells * static_cast<double>(steps.evaluations);
    effort.squarings = squarings;
    MovableQuality::Result next = quality;
    measured.measureAgain(patch.cells, trial, next, monitor);
    const double gain = next.minimum - quality.minimum, least = significantGain(quality.minimum);
    const bool isPromising = gain > Promising * least;
    // Where as much again would pass the goal, a higher power gets there in a few steps.
    const bool isNear = next.minimum + gain >= goal;
    const bool more = isPromising && !isNear && steps.steps >= stepLimits.steps && repeats;
    repeats = repeats && (isPromising || !isRepeated);
    isRepeated = more;
    // A low power's norm can be lower with a lower minimum. The next power still starts there.
    quality = std::move(next);
    if (quality.minimum > best + significantGain(best))
    {
      points = trial;
      best = quality.minimum;
      ++effort.rounds;
    }
    monitor.progress(1 - std::pow(0.8, round + 1)); // how many rounds there will be is not known
    if (!more)
    {
      // Minima of tetrahedra rise by every second power about as far, for half the work.
      squarings += isOfTetrahedra ? 2 : 1;
    }
    if (isOfTetrahedra)
    {
      squarings = std::max(squarings, first(best));
    }
  }
}
}

AscentEffort raiseMinimumQuality(
  const MovableQuality& measured, double bound, Points& points, Monitor& monitor)
{
  AscentEffort effort;
  Ascent(measured).raise(
    measured, bound, { 0, std::numeric_limits<double>::infinity() }, points, effort, monitor);
  return effort;
}

AscentEffort raiseNextWorst(
  const MovableQuality& measured, const AscentEffort& before, Points& points, Monitor& monitor)
{
  const Mesh& mesh = measured.mesh();
  const Communicator& communicator = measured.communicator();
  const auto cells = communicator.sum(static_cast<double>(mesh.numberOfCells()));
  Ascent ascent(measured);
  const double part = ascent.isOfTetrahedra() ? OfSpentOnTetrahedra : OfSpent;
  const double passes = ascent.isOfTetrahedra() ? FewPassesOfTetrahedra : FewPasses;
  // Its mesh is the best for the powers that are done.
  const Limits limits{ before.squarings, std::max(part * before.cellEvaluations, passes * cells) };
  AscentEffort effort;
  ascent.raise(measured, measured.bounds(points).movable, limits, points, effort, monitor);
  std::vector<char> stays(mesh.numberOfNodes(), 0);
  std::vector<Index> free = measured.free();
  std::optional<MovableQuality> rest; // refers to `free`: made again whenever that changes
  const MovableQuality* current = &measured;
  for (int level = 0; level < MostLevels && effort.cellEvaluations < limits.cellEvaluations &&
                      !communicator.all(free.empty());
       ++level)
  {
    const MovableQuality::Result quality = current->measure(points, monitor);
    if (!(quality.minimum > 0) || quality.minimum >= 1 - NearBound)
    {
      break;
    }
    const std::vector<Index> worst = atMinimum(quality);
    if (communicator.sum(static_cast<double>(worst.size())) > FewCells * cells)
    {
      break;
    }
    std::vector<Index> corners;
    for (const Index c : worst)
    {
      const int count = cellShape(mesh.types[c])->numberOfCorners;
      corners.insert(corners.end(), mesh.cell(c), mesh.cell(c) + count);
    }
    communicator.spread(corners);
    std::for_each(corners.begin(), corners.end(), [&](Index node) { stays[node] = 1; });
    free.erase(std::remove_if(free.begin(), free.end(), [&](Index node) { return stays[node]; }),
      free.end());
    rest.emplace(mesh, measured.orientation(), free, communicator);
    current = &*rest;
    ascent.raise(*current, current->bounds(points).movable, limits, points, effort, monitor);
  }
  return effort;
}
}
