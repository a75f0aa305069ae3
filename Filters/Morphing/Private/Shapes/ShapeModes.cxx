// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Shapes/ShapeModes.h"

#include "Private/Distributed/OnRanks.h"
#include "Private/Morph/SerialMesh.h"
#include "Session/UndeformedMesh.h"
#include "Support/Error.h"
#include "Support/Lists.h"
#include "Support/Monitor.h"
#include "Support/ReproducibleSum.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace morph::filters
{
namespace
{
using morph::Index;
using morph::Points;

/// Calls `work`; an error of it gets the shape's name.
template <typename Work>
auto named(const std::string& name, const Work& work)
{
  try
  {
    return work();
  }
  catch (const morph::Error& error)
  {
    throw morph::Error(error.kind(), "Shape '" + name + "': " + error.what());
  }
}

/// The nodes that any of the shapes names, and those that all hold.
std::vector<Index> prescribedNodes(const std::vector<morph::BoundaryTargets>& matches, Index nodes)
{
  std::vector<std::uint8_t> isNamed(nodes, 0);
  std::vector<std::size_t> count(nodes, 0);
  for (const morph::BoundaryTargets& match : matches)
  {
    for (std::size_t k = 0; k < match.ids.size(); ++k)
    {
      ++count[match.ids[k]];
      isNamed[match.ids[k]] |= match.sources[k] >= 0;
    }
  }
  std::vector<Index> ids;
  for (Index node = 0; node < nodes; ++node)
  {
    if (isNamed[node] || count[node] == matches.size())
    {
      ids.push_back(node);
    }
  }
  return ids;
}

/// The displacement of each of the `prescribed` nodes, zero for those that the match does not have.
Points displacementOf(
  const morph::BoundaryTargets& match, const std::vector<Index>& prescribed, const Points& rest)
{
  Points result = Points::Zero(static_cast<Index>(prescribed.size()), 3);
  std::size_t row = 0;
  for (std::size_t k = 0; k < match.ids.size(); ++k)
  {
    while (row < prescribed.size() && prescribed[row] < match.ids[k])
    {
      ++row;
    }
    if (row < prescribed.size() && prescribed[row] == match.ids[k])
    {
      result.row(static_cast<Index>(row)) =
        match.targets.row(static_cast<Index>(k)) - rest.row(match.ids[k]);
    }
  }
  return result;
}
}

bool ShapeModes::SetGrid(
  vtkUnstructuredGrid* grid, bool isDistributed, const Options& options, morph::Monitor& monitor)
{
  if (!this->Solver || this->Processes.IsOfAll() != isDistributed)
  {
    this->Processes = RankGroup(isDistributed);
    this->Solver = std::make_unique<ModeSolver>(
      isDistributed ? OnRanks::MakeMesh() : std::make_unique<SerialMesh>());
  }
  const bool isTaken = this->Solver->Take(grid, options.CreateMorpher, monitor);
  if (isTaken)
  {
    this->Settings.reset();
    this->Modes.clear();
  }
  return isTaken;
}

std::vector<morph::BoundaryTargets> ShapeModes::Match(
  const std::vector<Shape>& shapes, const Options& options, morph::Monitor& monitor)
{
  std::vector<morph::BoundaryTargets> matches;
  this->Warnings.clear();
  this->Processes.Together([&] { monitor.check(); });
  for (const Shape& shape : shapes)
  {
    matches.push_back(
      named(shape.Name, [&] { return this->Solver->Match(shape.Boundary, options.Matching); }));
    for (const std::string& warning : matches.back().warnings)
    {
      if (this->Processes.IsFirst())
      {
        this->Warnings.push_back("Shape '" + shape.Name + "': " + warning);
        monitor.warn(this->Warnings.back());
      }
    }
  }
  return matches;
}

std::pair<morph::AxisRotation, std::vector<Index>> ShapeModes::RotationOf(
  const Points& displacement, const std::vector<Index>& prescribed, double tolerance) const
{
  const Points& rest = this->Mesh().points;
  std::vector<Index> moving;
  constexpr std::size_t Width = 7; // an id, and two positions
  std::vector<double> rows;
  for (Index i = 0; i < displacement.rows(); ++i)
  {
    if (displacement.row(i).norm() <= tolerance)
    {
      continue;
    }
    moving.push_back(i);
    const Index node = prescribed[i];
    if (this->Solver->Owns(node))
    {
      rows.push_back(static_cast<double>(this->Solver->NodeId(node))); // ids are below 2^52
      const Eigen::RowVector3d from = rest.row(node), to = from + displacement.row(i);
      rows.insert(rows.end(), from.data(), from.data() + 3);
      rows.insert(rows.end(), to.data(), to.data() + 3);
    }
  }
  rows = this->Processes.Gather(rows);
  std::vector<std::size_t> order = consecutive<std::size_t>(rows.size() / Width);
  std::sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return rows[Width * a] < rows[Width * b]; });
  Points from(static_cast<Index>(order.size()), 3), to = from;
  for (std::size_t k = 0; k < order.size(); ++k)
  {
    const double* row = rows.data() + Width * order[k];
    from.row(static_cast<Index>(k)) << row[1], row[2], row[3];
    to.row(static_cast<Index>(k)) << row[4], row[5], row[6];
  }
  try
  {
    return { morph::fitRotation(from, to, tolerance), std::move(moving) };
  }
  catch (const morph::Error& error)
  {
    throw morph::Error(std::string(error.what()) +
                       " So it is not a rotation about an axis: take it as a displacement.");
  }
}

ShapeModes::Solved ShapeModes::Describe(const Shape& shape, const morph::BoundaryTargets& match,
  const std::vector<Index>& prescribed, double tolerance, std::vector<Mode>& modes) const
{
  const Points& rest = this->Mesh().points;
  Points displacement = displacementOf(match, prescribed, rest);
  Solved solved;
  if (!shape.IsRotation)
  {
    solved.Modes = { modes.size() };
    modes.push_back({ std::move(displacement), {} });
    return solved;
  }
  // All processes have the same points, so that it throws on all of them or none.
  const auto [rotation, moving] =
    named(shape.Name, [&] { return this->RotationOf(displacement, prescribed, tolerance); });
  Points first = Points::Zero(displacement.rows(), 3), second = first;
  for (Index i : moving)
  {
    first.row(i) = rotation.first(rest.row(prescribed[i]));
    second.row(i) = rotation.second(rest.row(prescribed[i]));
  }
  solved.Modes = { modes.size(), modes.size() + 1 };
  solved.Angle = rotation.angle;
  modes.push_back({ std::move(first), {} });
  modes.push_back({ std::move(second), {} });
  return solved;
}

void ShapeModes::Prepare(const std::vector<Index>& prescribed, const Options& options,
  Effort& effort, morph::Monitor& monitor)
{
  std::unique_ptr<const morph::LinearMorpher> settings = options.CreateMorpher();
  const bool isSame = this->Settings && this->Settings->preparesLike(*settings) &&
                      this->Settings->tolerance() == settings->tolerance() &&
                      this->PreparedFor == prescribed;
  if (!this->Processes.Any(!isSame))
  {
    return;
  }
  this->Settings.reset();
  this->Modes.clear();
  this->Solver->Prepare(options.CreateMorpher(), prescribed, monitor);
  this->PreparedFor = prescribed;
  this->Settings = std::move(settings);
  ++effort.Preparations;
}

void ShapeModes::TellDropped(
  const std::vector<Mode>& modes, const std::vector<Index>& prescribed, morph::Monitor& monitor)
{
  std::vector<double> ids; // below 2^52
  for (std::size_t i = 0; i < prescribed.size(); ++i)
  {
    const auto isElsewhere = [&](const Mode& mode)
    {
      return (mode.Field->row(prescribed[i]) - mode.Boundary.row(static_cast<Index>(i))).norm() >
             1e-6 * this->Solver->Rest().size();
    };
    if (this->Solver->Owns(prescribed[i]) && std::any_of(modes.begin(), modes.end(), isElsewhere))
    {
      ids.push_back(static_cast<double>(this->Solver->NodeId(prescribed[i])));
    }
  }
  ids = this->Processes.Gather(ids);
  std::sort(ids.begin(), ids.end());
  if (!ids.empty() && this->Processes.IsFirst())
  {
    this->Warnings.push_back(morph::noteOfDropped(std::vector<Index>(ids.begin(), ids.end())));
    monitor.warn(this->Warnings.back());
  }
}

std::vector<int> ShapeModes::FindKept(const std::vector<Mode>& modes) const
{
  const std::size_t kept = this->Modes.size();
  std::vector<Index> differs(modes.size() * kept);
  for (std::size_t k = 0; k < differs.size(); ++k)
  {
    differs[k] = modes[k / kept].Boundary != this->Modes[k % kept].Boundary;
  }
  this->Processes.Sum(differs.data(), differs.size());
  std::vector<int> found(modes.size(), -1);
  for (std::size_t i = 0; i < modes.size(); ++i)
  {
    const auto begin = differs.begin() + static_cast<std::ptrdiff_t>(i * kept);
    const auto same = std::find(begin, begin + static_cast<std::ptrdiff_t>(kept), 0);
    if (same != begin + static_cast<std::ptrdiff_t>(kept))
    {
      found[i] = static_cast<int>(same - begin);
    }
  }
  return found;
}

ShapeModes::Effort ShapeModes::Solve(
  const std::vector<Shape>& shapes, const Options& options, morph::Monitor& monitor)
{
  const std::vector<morph::BoundaryTargets> matches = this->Match(shapes, options, monitor);
  const std::vector<Index> prescribed = prescribedNodes(matches, this->Mesh().numberOfNodes());
  std::vector<Mode> modes;
  std::vector<Solved> solved;
  for (std::size_t i = 0; i < shapes.size(); ++i)
  {
    solved.push_back(this->Describe(shapes[i], matches[i], prescribed,
      options.Matching.matchTolerance * this->Solver->Rest().size(), modes));
  }

  Effort effort;
  effort.Prescribed = std::count_if(
    prescribed.begin(), prescribed.end(), [this](Index node) { return this->Solver->Owns(node); });
  this->Processes.Sum(&effort.Prescribed, 1);
  const morph::Stopwatch watch;
  morph::ProgressRange preparing(monitor, 0, 0.5);
  this->Prepare(prescribed, options, effort, preparing);
  // The kept fields are replaced only once all are there: after an error or abort they stay.
  std::vector<Points> boundaries;
  std::vector<std::size_t> open;
  const std::vector<int> kept = this->FindKept(modes);
  for (std::size_t i = 0; i < modes.size(); ++i)
  {
    if (kept[i] >= 0)
    {
      modes[i].Field = this->Modes[kept[i]].Field;
      continue;
    }
    open.push_back(i);
    boundaries.push_back(modes[i].Boundary);
  }
  if (!open.empty())
  {
    std::vector<morph::EvaluateReport> reports;
    morph::ProgressRange solving(monitor, 0.5, 1);
    std::vector<Points> fields = this->Solver->Basis(boundaries, reports, solving);
    for (std::size_t k = 0; k < open.size(); ++k)
    {
      modes[open[k]].Field = std::make_shared<Points>(std::move(fields[k]));
      effort.Iterations += reports[k].iterations;
    }
  }
  this->TellDropped(modes, prescribed, monitor);
  effort.Solved = static_cast<int>(open.size());
  if (effort.Preparations + effort.Solved > 0)
  {
    effort.Seconds = this->Processes.Maximum(watch.seconds());
  }
  this->Modes = std::move(modes);
  this->Shapes = std::move(solved);
  return effort;
}

std::vector<morph::WeightedMode> ShapeModes::Weighted(const std::vector<double>& weights) const
{
  std::vector<morph::WeightedMode> result;
  for (std::size_t i = 0; i < this->Shapes.size(); ++i)
  {
    const Solved& shape = this->Shapes[i];
    if (shape.Angle == 0)
    {
      result.push_back({ this->Modes[shape.Modes[0]].Field.get(), weights[i] });
      continue;
    }
    const double angle = weights[i] * shape.Angle, half = std::sin(angle / 2);
    result.push_back({ this->Modes[shape.Modes[0]].Field.get(), std::sin(angle) });
    result.push_back({ this->Modes[shape.Modes[1]].Field.get(), 2 * half * half });
  }
  return result;
}

morph::NodeMotion ShapeModes::MotionOf(std::size_t shape, const morph::Points& base) const
{
  const Solved& solved = this->Shapes[shape];
  const Points* field = this->Modes[solved.Modes[0]].Field.get();
  if (solved.Angle == 0)
  {
    return { &base, field, {} };
  }
  return { &base, nullptr, { { field, this->Modes[solved.Modes[1]].Field.get(), solved.Angle } } };
}

morph::NodeMotion ShapeModes::Combined(
  const std::vector<double>& weights, Points& straight, morph::Monitor& monitor) const
{
  morph::NodeMotion motion;
  motion.base = &this->Mesh().points;
  std::vector<morph::WeightedMode> modes;
  for (std::size_t i = 0; i < this->Shapes.size(); ++i)
  {
    const Solved& shape = this->Shapes[i];
    const Points* field = this->Modes[shape.Modes[0]].Field.get();
    if (shape.Angle == 0)
    {
      modes.push_back({ field, weights[i] });
    }
    else if (weights[i] != 0)
    {
      motion.turns.push_back(
        { field, this->Modes[shape.Modes[1]].Field.get(), weights[i] * shape.Angle });
    }
  }
  const Points none = Points::Zero(motion.base->rows(), 3);
  morph::blend(none, modes, straight, monitor);
  motion.straight = &straight;
  return motion;
}

std::vector<std::shared_ptr<const Points>> ShapeModes::Fields() const
{
  std::vector<std::shared_ptr<const Points>> fields;
  for (const Mode& mode : this->Modes)
  {
    fields.push_back(mode.Field);
  }
  return fields;
}

std::vector<double> ShapeModes::Angles() const
{
  std::vector<double> angles;
  for (const Solved& shape : this->Shapes)
  {
    angles.push_back(shape.Angle);
  }
  return angles;
}

std::vector<double> ShapeModes::Derivatives(
  const std::vector<double>& weights, const Points& gradient, morph::Monitor& monitor) const
{
  // A node counts once, and cells of other processes bring none.
  Points counted = Points::Zero(this->Mesh().numberOfNodes(), 3);
  for (Index node = 0; node < gradient.rows(); ++node)
  {
    if (this->Solver->Owns(node))
    {
      counted.row(node) = gradient.row(node);
    }
  }
  this->Solver->Attached().applyTranspose(counted);
  std::vector<double> result;
  for (std::size_t i = 0; i < this->Shapes.size(); ++i)
  {
    const Solved& shape = this->Shapes[i];
    const double along = morph::dot(*this->Modes[shape.Modes[0]].Field, counted, monitor);
    if (shape.Angle == 0)
    {
      result.push_back(along);
      continue;
    }
    const double across = morph::dot(*this->Modes[shape.Modes[1]].Field, counted, monitor);
    const double angle = weights[i] * shape.Angle;
    result.push_back(shape.Angle * (std::cos(angle) * along + std::sin(angle) * across));
  }
  this->Processes.Sum(result.data(), result.size());
  return result;
}
}
