// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/SmoothMesh.h"

#include "Energies/MeshEnergy.h"
#include "Energies/UntangleEnergy.h"
#include "Mesh/CellShape.h"
#include "Mesh/HigherOrderNodes.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/Topology.h"
#include "Optimization/Minimizers.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Lists.h"
#include "Support/ReproducibleSum.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace morph
{
namespace
{
constexpr double Margin = 0.05;     // of untangling
constexpr Index StepsToValid = 100; // of untangling, between checks whether the mesh is valid
constexpr int UntangleSteps = 20;   // for one Newton step
constexpr double Bad = 0.2;         // scaled Jacobian
constexpr int Rings = 3;            // around bad cells
constexpr double MostOfMesh = 0.25; // maximum share of free nodes in a patch
constexpr int PatchSteps = 5;       // Newton steps in a round
constexpr int MostPatchRounds = 4;
constexpr int FinishShare = 5;            // of the limit of steps, for a round of the last stage
constexpr double LeastDecrease = 1e-6;    // of the shape measure in a step, relative
constexpr double RoundingEpsilon = 1e-10; // regularization: only for rounding

double volume(const Mesh& mesh, const std::vector<std::int8_t>& orientation, const Points& points,
  Monitor& monitor, const Communicator& communicator)
{
  return communicator.sum(reproducibleSum(mesh.numberOfCells(), monitor, 0.,
    [&](Index c)
    {
      const CellShape& shape = *cellShape(mesh, c);
      double x[8][3];
      copyCorners(mesh, c, shape, points, x[0]);
      return numberOfCorners(shape.shape) > 0 ? orientation[c] * signedVolume(shape.shape, x) : 0;
    }));
}

/// Returns the mean edge length at each node; 0 if it has none.
std::vector<double> edgeLengths(
  const Mesh& mesh, const Points& points, const Communicator& communicator)
{
  Points sums = Points::Zero(mesh.numberOfNodes(), 3); // of lengths and edges
  forCellEdges(mesh,
    [&](Index a, Index b)
    {
      const double length = (points.row(a) - points.row(b)).norm();
      for (Index node : { a, b })
      {
        sums(node, 0) += length;
        ++sums(node, 1);
      }
    });
  std::vector<Index> nodes = consecutive(mesh.numberOfNodes());
  communicator.rows(nodes)->add(sums);
  std::vector<double> mean(mesh.numberOfNodes());
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    mean[n] = sums(n, 0) / std::max(1., sums(n, 1));
  }
  return mean;
}

/// Returns the power of two that scales edges to a length near 1. So no number depends on the unit
/// of length.
double unitScale(const std::vector<double>& edgeLength, const Communicator& communicator)
{
  double sum = 0;
  Index count = 0;
  for (double length : edgeLength)
  {
    sum += length;
    count += length > 0;
  }
  sum = communicator.sum(sum); // a node of several processes counts on each
  count = communicator.sum(count);
  return sum > 0 ? std::exp2(-std::round(std::log2(sum / static_cast<double>(count)))) : 1;
}

/// Infinite without a measured cell.
class Smoother
{
public:
  Smoother(const Mesh& rest, const std::vector<std::int8_t>& orientation,
    const std::vector<Index>& free, const SmoothingOptions& options, Monitor& monitor,
    const Communicator& communicator)
    : mesh_(rest)
    , orientation_(orientation)
    , free_(free)
    , options_(options)
    , monitor_(monitor)
    , communicator_(communicator)
    , targets_(smoothingTargets(rest, orientation, options.target, monitor, communicator))
  {
  }

  SmoothingReport run(Points& points)
  {
    MeshEnergy energy(this->mesh_, this->free_, this->communicator_);
    const bool isCondition = this->options_.objective == SmoothingObjective::ConditionNumber;
    this->prepare(energy, isCondition);
    if (!this->isValid(energy, points))
    {
      this->untangle(energy, points);
      this->monitor_.progress(0.4);
    }
    if (this->isValid(energy, points))
    {
      this->edgeLength_ = edgeLengths(this->mesh_, points, this->communicator_);
      this->improvePatches(isCondition, points);
      this->monitor_.progress(0.5);
      this->improve(energy, this->options_.iterationLimit, points);
      this->report_.conditionSteps = isCondition ? this->newton_.steps : 0;
      if (this->options_.objective == SmoothingObjective::Adaptive)
      {
        this->monitor_.progress(0.8);
        const Index before = this->newton_.steps;
        this->finish(points);
        this->report_.conditionSteps = this->newton_.steps - before;
      }
      this->report_.isValid = true;
    }
    this->report_.newtonSteps = this->newton_.steps;
    this->report_.linearIterations = this->newton_.linearIterations;
    this->report_.evaluations += this->newton_.evaluations;
    return this->report_;
  }

private:
  void prepare(MeshEnergy& energy, bool isCondition) const
  {
    energy.setTargets(this->targets_);
    if (isCondition)
    {
      energy.setDensity(ConditionDensity());
      return;
    }
    FoldoverDensity density;
    density.epsilon = RoundingEpsilon;
    energy.setDensity(density);
  }

  bool isValid(const MeshEnergy& energy, const Points& points)
  {
    ++this->report_.evaluations;
    return energy.evaluate(points, this->monitor_).minimumDeterminant > 0;
  }

  /// Untangles until `energy` is finite: the shape measure does the rest to the margin better.
  void untangle(const MeshEnergy& energy, Points& points)
  {
    // The boundary determines the volume: cells cannot be larger on average than it allows.
    const double ratio =
      volume(this->mesh_, this->orientation_, points, this->monitor_, this->communicator_) /
      volume(
        this->mesh_, this->orientation_, this->mesh_.points, this->monitor_, this->communicator_);
    const UntangleEnergy tangle(this->mesh_, this->free_, this->targets_,
      Margin * (ratio > 0 ? ratio : 1), this->communicator_);
    MinimizerLimits limits;
    limits.slowDecrease = 0;
    MinimizerEffort effort;
    const Index most = Index(UntangleSteps) * this->options_.iterationLimit;
    while (effort.steps < most)
    {
      const Index goal = std::min(most, effort.steps + StepsToValid);
      limits.steps = static_cast<int>(goal - effort.steps);
      limitedMemoryBfgs(tangle, points, limits, effort, this->monitor_);
      if (effort.steps < goal || this->isValid(energy, points))
      {
        break; // no more progress, or none needed
      }
    }
    this->report_.untangleSteps = effort.steps;
    this->report_.evaluations += effort.evaluations;
  }

  /// Takes Newton steps until one moves no node far or lowers the measure little. Returns whether
  /// it lowered the measure.
  bool improve(const MeshEnergy& energy, int steps, Points& points)
  {
    BlockCsr3f matrix;
    MinimizerLimits limits;
    limits.steps = 1;
    double last = energy.value(points, this->monitor_).energy;
    const double start = last;
    for (int step = 0; step < steps; ++step)
    {
      const Points before = points;
      const double now =
        newton(energy, points, limits, matrix, this->newton_, this->monitor_).energy;
      const bool isSettled =
        last - now < LeastDecrease * now ||
        this->mostMove(energy.free(), before, points) < this->options_.stopMove;
      last = now;
      if (isSettled)
      {
        break;
      }
    }
    return start - last >= LeastDecrease * last;
  }

  double mostMove(const std::vector<Index>& free, const Points& before, const Points& after) const
  {
    double most = 0;
    for (Index node : free)
    {
      const double length = this->edgeLength_[node];
      most =
        std::max(most, (after.row(node) - before.row(node)).norm() / (length > 0 ? length : 1));
    }
    return this->communicator_.maximum(most);
  }

  /// Returns the free nodes in rings of cells around these.
  std::vector<Index> patchAround(const std::vector<Index>& cells)
  {
    if (this->around_.values.empty())
    {
      this->around_ = nodeToCells(this->mesh_);
    }
    return kRingOfCells(this->mesh_, this->around_, this->free_, cells, Rings, this->communicator_)
      .nodes;
  }

  void improvePatches(bool isCondition, Points& points)
  {
    for (int round = 0; round < MostPatchRounds; ++round)
    {
      const std::vector<Index> bad = this->badCells(points);
      if (this->communicator_.all(bad.empty()))
      {
        return;
      }
      const std::vector<Index> patch = this->patchAround(bad);
      // A node of several processes counts on each.
      const auto nodes = this->communicator_.sum(static_cast<double>(patch.size()));
      if (nodes == 0 ||
          nodes > MostOfMesh * this->communicator_.sum(static_cast<double>(this->free_.size())))
      {
        return;
      }
      MeshEnergy energy(this->mesh_, patch, this->communicator_);
      this->prepare(energy, isCondition);
      ++this->report_.patches;
      if (!this->improve(energy, PatchSteps, points))
      {
        return;
      }
    }
  }

  /// Lowers the condition number around bad cells. Nodes where the minimum would fall go back.
  void finish(Points& points)
  {
    const int steps = this->options_.iterationLimit / FinishShare;
    for (int round = 0; steps > 0 && round < MostPatchRounds; ++round)
    {
      const std::vector<Index> bad = this->badCells(points);
      const std::vector<Index> patch = this->patchAround(bad);
      if (this->communicator_.all(patch.empty()))
      {
        return;
      }
      MeshEnergy energy(this->mesh_, patch, this->communicator_);
      this->prepare(energy, true);
      ++this->report_.patches;
      Points trial = points;
      const bool isLower = this->improve(energy, steps, trial);
      const Index back = keepMinimum(
        this->mesh_, patch, points, trial,
        [this](const Points& measured) { return this->measure(measured); }, this->communicator_);
      points.swap(trial);
      if (!isLower || back > 0)
      {
        return; // the next round would move the same nodes
      }
    }
  }

  Quality measure(const Points& points) const
  {
    Quality quality = measureCorners(this->mesh_, points, this->orientation_, {}, this->monitor_);
    quality.minimum = minimumOfAll(quality, this->communicator_);
    return quality;
  }

  std::vector<Index> badCells(const Points& points) const
  {
    const Quality quality = this->measure(points);
    std::vector<Index> bad;
    for (Index c = 0; c < this->mesh_.numberOfCells(); ++c)
    {
      if (quality.scaledJacobian[c] < Bad)
      {
        bad.push_back(c);
      }
    }
    return bad;
  }

  const Mesh& mesh_;
  const std::vector<std::int8_t>& orientation_;
  const std::vector<Index>& free_;
  const SmoothingOptions& options_;
  Monitor& monitor_;
  const Communicator& communicator_;
  const TargetMatrices targets_;
  std::vector<double> edgeLength_;
  Adjacency around_; ///< cells of each node, empty until needed
  MinimizerEffort newton_;
  SmoothingReport report_;
};

bool isWorse(const Mesh& mesh, const std::vector<std::int8_t>& orientation, const Points& result,
  const Points& start, Monitor& monitor, const Communicator& communicator)
{
  const Quality after = measureQuality(mesh, result, orientation, {}, monitor);
  const Quality before = measureQuality(mesh, start, orientation, {}, monitor);
  const Index more = communicator.sum(after.inverted - before.inverted);
  const double now = minimumOfAll(after, communicator), then = minimumOfAll(before, communicator);
  return more > 0 || (more == 0 && !(now >= then));
}
}

SmoothingReport smoothMesh(const Mesh& rest, const std::vector<std::int8_t>& orientation,
  const NodePartition& partition, const SmoothingOptions& options, Points& points, Monitor& monitor,
  const Communicator& communicator)
{
  const double scale = unitScale(edgeLengths(rest, rest.points, communicator), communicator);
  Mesh mesh = rest;
  mesh.points *= scale;
  mesh.layer.thickness *= scale;
  Points result = points * scale;
  Smoother smoother(mesh, orientation, partition.free, options, monitor, communicator);
  SmoothingReport report = smoother.run(result);
  monitor.check();
  result /= scale;
  Points smoothed = points;
  // Scaling back and forth is exact except for coordinates that underflow, so fixed nodes are left
  // out.
  for (Index node : partition.free)
  {
    smoothed.row(node) = result.row(node);
  }
  HigherOrderNodes followers;
  followers.prepare(rest, partition, communicator);
  followers.carry(rest.points, smoothed);
  report.wasKept = (options.neverWorse || !report.isValid) &&
                   isWorse(rest, orientation, smoothed, points, monitor, communicator);
  if (!report.wasKept)
  {
    points.swap(smoothed);
  }
  return report;
}

namespace
{
constexpr int Layers = 30;
}

Index keepMinimum(const Mesh& mesh, const std::vector<Index>& free, const Points& start,
  Points& points, const std::function<Quality(Points&)>& measure, const Communicator& communicator)
{
  Points copy = start;
  const double minimum = measure(copy).minimum;
  if (!(minimum > 0))
  {
    return 0;
  }
  std::vector<char> movable(mesh.numberOfNodes(), 0);
  for (Index node : free)
  {
    movable[node] = 1;
  }
  std::vector<Index> back;
  const auto takeBack = [&](Index node)
  {
    if (movable[node])
    {
      points.row(node) = start.row(node);
      movable[node] = 0;
      back.push_back(node);
    }
  };
  for (int layer = 0; layer <= Layers; ++layer)
  {
    const Quality quality = measure(points);
    if (quality.minimum >= minimum)
    {
      break;
    }
    std::vector<Index> corners;
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      // Cells that are not measured are NaN.
      if (quality.scaledJacobian[c] < minimum)
      {
        corners.insert(
          corners.end(), mesh.cell(c), mesh.cell(c) + cellShape(mesh, c)->numberOfCorners);
      }
    }
    communicator.spread(corners);
    std::for_each(corners.begin(), corners.end(), takeBack);
    if (layer == Layers)
    {
      std::for_each(free.begin(), free.end(), takeBack);
    }
  }
  const std::unique_ptr<CopiedRows> rows = communicator.rows(back);
  return communicator.sum(static_cast<Index>(back.size() - rows->countedElsewhere().size()));
}
}
