// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Shapes/ShapeModes.h"

#include "Geometry/RotationFit.h"
#include "Mesh/Polyhedra.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Quality.h"
#include "Private/Pipeline/Input.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"
#include "Support/ReproducibleSum.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace morph::filters
{
namespace
{
using morph::Index;
using morph::Points;
using Clock = std::chrono::steady_clock;

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

/// The method, not prepared, for the cells of `mesh`.
std::unique_ptr<morph::LinearMorpher> forCellsOf(
  const morph::Mesh& mesh, std::unique_ptr<morph::LinearMorpher> method)
{
  if (!morph::hasPolyhedra(mesh))
  {
    return method;
  }
  // Of a linear method it is a linear one.
  std::unique_ptr<morph::Morpher> onPieces = morph::morpherForPolyhedra(std::move(method));
  return std::unique_ptr<morph::LinearMorpher>(
    dynamic_cast<morph::LinearMorpher*>(onPieces.release()));
}

/// The nodes that any of the shapes names, and those that all hold.
std::vector<Index> prescribedNodes(const std::vector<BoundaryMatch::Result>& matches, Index nodes)
{
  std::vector<std::uint8_t> isNamed(nodes, 0);
  std::vector<std::size_t> count(nodes, 0);
  for (const BoundaryMatch::Result& match : matches)
  {
    for (std::size_t k = 0; k < match.Ids.size(); ++k)
    {
      ++count[match.Ids[k]];
      isNamed[match.Ids[k]] |= match.Sources[k] >= 0;
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
  const BoundaryMatch::Result& match, const std::vector<Index>& prescribed, const Points& rest)
{
  Points result = Points::Zero(static_cast<Index>(prescribed.size()), 3);
  std::size_t row = 0;
  for (std::size_t k = 0; k < match.Ids.size(); ++k)
  {
    while (row < prescribed.size() && prescribed[row] < match.Ids[k])
    {
      ++row;
    }
    if (row < prescribed.size() && prescribed[row] == match.Ids[k])
    {
      result.row(static_cast<Index>(row)) =
        match.Targets.row(static_cast<Index>(k)) - rest.row(match.Ids[k]);
    }
  }
  return result;
}

/// The rotation of the nodes that move, and their rows of `displacement`.
std::pair<morph::AxisRotation, std::vector<Index>> rotationOf(const Points& displacement,
  const std::vector<Index>& prescribed, const Points& rest, double tolerance)
{
  std::vector<Index> moving;
  for (Index i = 0; i < displacement.rows(); ++i)
  {
    if (displacement.row(i).norm() > tolerance)
    {
      moving.push_back(i);
    }
  }
  Points from(static_cast<Index>(moving.size()), 3), to = from;
  for (Index i = 0; i < from.rows(); ++i)
  {
    from.row(i) = rest.row(prescribed[moving[i]]);
    to.row(i) = from.row(i) + displacement.row(moving[i]);
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
}

bool ShapeModes::SetGrid(vtkUnstructuredGrid* grid, morph::Monitor& monitor)
{
  const bool isCopied = this->Kept.Take(grid, monitor);
  if (isCopied)
  {
    this->Method.reset();
    this->Modes.clear();
  }
  return isCopied;
}

std::vector<BoundaryMatch::Result> ShapeModes::Match(
  const std::vector<Shape>& shapes, const Options& options, morph::Monitor& monitor)
{
  std::vector<BoundaryMatch::Result> matches;
  this->Warnings.clear();
  for (const Shape& shape : shapes)
  {
    monitor.check();
    matches.push_back(named(shape.Name,
      [&]
      {
        return BoundaryMatch::Match(shape.Boundary, this->Kept.Mesh(), this->Kept.OuterFaces(),
          this->Kept.Size(), options.Matching);
      }));
    for (const std::string& warning : matches.back().Warnings)
    {
      this->Warnings.push_back("Shape '" + shape.Name + "': " + warning);
      monitor.warn(this->Warnings.back());
    }
  }
  return matches;
}

ShapeModes::Solved ShapeModes::Describe(const Shape& shape, const BoundaryMatch::Result& match,
  const std::vector<Index>& prescribed, double tolerance, std::vector<Mode>& modes) const
{
  Points displacement = displacementOf(match, prescribed, this->Kept.Mesh().points);
  Solved solved;
  if (!shape.IsRotation)
  {
    solved.Modes = { modes.size() };
    modes.push_back({ std::move(displacement), {} });
    return solved;
  }
  const auto [rotation, moving] = named(shape.Name,
    [&] { return rotationOf(displacement, prescribed, this->Kept.Mesh().points, tolerance); });
  Points first = Points::Zero(displacement.rows(), 3), second = first;
  for (Index i : moving)
  {
    first.row(i) = rotation.first(this->Kept.Mesh().points.row(prescribed[i]));
    second.row(i) = rotation.second(this->Kept.Mesh().points.row(prescribed[i]));
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
  if (this->Method && this->MethodOptions == options.Method &&
      this->Method->partition().prescribed == prescribed)
  {
    return;
  }
  this->Method.reset();
  this->Modes.clear();
  auto method = forCellsOf(this->Kept.Mesh(), options.CreateMorpher());
  method->prepare(this->Kept.Mesh(), morph::partitionNodes(this->Kept.Mesh(), prescribed), monitor);
  this->Method = std::move(method);
  this->MethodOptions = options.Method;
  ++effort.Preparations;
}

ShapeModes::Effort ShapeModes::Solve(
  const std::vector<Shape>& shapes, const Options& options, morph::Monitor& monitor)
{
  const std::vector<BoundaryMatch::Result> matches = this->Match(shapes, options, monitor);
  const std::vector<Index> prescribed = prescribedNodes(matches, this->Kept.Mesh().numberOfNodes());
  std::vector<Mode> modes;
  std::vector<Solved> solved;
  for (std::size_t i = 0; i < shapes.size(); ++i)
  {
    solved.push_back(this->Describe(shapes[i], matches[i], prescribed,
      options.Matching.MatchTolerance * this->Kept.Size(), modes));
  }

  Effort effort;
  effort.Prescribed = static_cast<Index>(prescribed.size());
  const auto start = Clock::now();
  morph::ProgressRange preparing(monitor, 0, 0.5);
  this->Prepare(prescribed, options, effort, preparing);
  // The kept fields are replaced only once all are there: after an error or abort they stay.
  std::vector<Points> boundaries;
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < modes.size(); ++i)
  {
    const auto found = std::find_if(this->Modes.begin(), this->Modes.end(),
      [&](const Mode& mode) { return mode.Boundary == modes[i].Boundary; });
    if (found != this->Modes.end())
    {
      modes[i].Field = found->Field;
      continue;
    }
    open.push_back(i);
    boundaries.push_back(modes[i].Boundary);
  }
  if (!open.empty())
  {
    std::vector<morph::EvaluateReport> reports;
    morph::ProgressRange solving(monitor, 0.5, 1);
    std::vector<Points> fields = this->Method->basis(boundaries, solving, &reports);
    for (std::size_t k = 0; k < open.size(); ++k)
    {
      modes[open[k]].Field = std::make_shared<Points>(std::move(fields[k]));
      effort.Iterations += reports[k].iterations;
    }
  }
  effort.Solved = static_cast<int>(open.size());
  if (effort.Preparations + effort.Solved > 0)
  {
    effort.Seconds = std::chrono::duration<double>(Clock::now() - start).count();
  }
  this->Modes = std::move(modes);
  this->Shapes = std::move(solved);
  return effort;
}

bool ShapeModes::HasRanges() const
{
  return !morph::hasPolyhedra(this->Kept.Mesh());
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
  morph::NodeMotion motion = { &base, this->Modes[solved.Modes[0]].Field.get() };
  if (solved.Angle > 0)
  {
    motion.second = this->Modes[solved.Modes[1]].Field.get();
    motion.angle = solved.Angle;
  }
  return motion;
}

morph::CombinedMotion ShapeModes::Combined(
  const std::vector<double>& weights, Points& straight, morph::Monitor& monitor) const
{
  morph::CombinedMotion motion;
  motion.base = &this->Kept.Mesh().points;
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
  std::vector<double> result;
  for (std::size_t i = 0; i < this->Shapes.size(); ++i)
  {
    const Solved& shape = this->Shapes[i];
    const double along = morph::dot(*this->Modes[shape.Modes[0]].Field, gradient, monitor);
    if (shape.Angle == 0)
    {
      result.push_back(along);
      continue;
    }
    const double across = morph::dot(*this->Modes[shape.Modes[1]].Field, gradient, monitor);
    const double angle = weights[i] * shape.Angle;
    result.push_back(shape.Angle * (std::cos(angle) * along + std::sin(angle) * across));
  }
  return result;
}
}
