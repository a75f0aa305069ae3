// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/MovableQuality.h"

#include "Mesh/CellShape.h"
#include "Mesh/StandingCells.h"

#include <algorithm>
#include <bitset>
#include <limits>
#include <tuple>
#include <utility>

namespace morph
{
bool MovableQuality::Result::operator<(const Result& other) const
{
  return std::make_tuple(-this->inverted, this->minimum) <
         std::make_tuple(-other.inverted, other.minimum);
}

MovableQuality::MovableQuality(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<Index>& free, const Communicator& communicator,
  const std::vector<Index>& hopeless)
  : mesh_(mesh)
  , orientation_(orientation)
  , free_(free)
  , communicator_(communicator)
  , skip_(mesh.numberOfCells(), 0)
{
  std::vector<char> isFree(mesh.numberOfNodes(), 0);
  for (Index node : free)
  {
    isFree[node] = 1;
  }
  for (Index c : hopeless)
  {
    this->skip_[c] = 1;
  }
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const CellShape& shape = *cellShape(mesh, c);
    if (this->skip_[c] != 0 || shape.dimension != 3 || shape.numberOfCorners == 0)
    {
      this->skip_[c] = 1;
      continue;
    }
    unsigned all = 0, free = 0;
    for (int k = 0; k < shape.numberOfCorners; ++k)
    {
      all |= 1u << k;
      free |= isFree[mesh.cell(c)[shape.cornerNode[k]]] ? 1u << k : 0u;
    }
    const unsigned movable = samplesOf(shape.shape, free);
    const unsigned fixed = samplesOf(shape.shape, all) & ~movable;
    if (fixed != 0 || std::bitset<8>(all & ~free).count() >= 3)
    {
      this->held_.push_back({ c, all & ~free, movable, fixed });
    }
    this->skip_[c] = movable == 0;
  }
}

void MovableQuality::cornersOf(Index cell, const Points& points, double (*x)[3]) const
{
  const CellShape& shape = *cellShape(this->mesh_, cell);
  copyStanding(this->mesh_, cell, shape, points, x[0]);
  for (int k = 0; k < shape.numberOfCorners; ++k)
  {
    x[k][2] *= this->orientation_[cell]; // a mirrored cell as its mirror image
  }
}

MovableQuality::Result MovableQuality::measure(const Points& points, Monitor& monitor) const
{
  Result result;
  result.scaledJacobian =
    measureCorners(this->mesh_, points, this->orientation_, this->skip_, monitor).scaledJacobian;
  for (const Cell& cell : this->held_)
  {
    if (cell.fixed != 0 && cell.movable != 0)
    {
      double x[8][3];
      this->cornersOf(cell.id, points, x);
      result.scaledJacobian[cell.id] =
        morph::scaledJacobian(*cellShape(this->mesh_, cell.id), x, cell.movable);
    }
  }
  this->summarize(result);
  return result;
}

void MovableQuality::measureAgain(
  const std::vector<Index>& cells, const Points& points, Result& result, Monitor& monitor) const
{
  constexpr Index Grain = 1024;
  monitor.parallelFor(static_cast<Index>(cells.size()), Grain,
    [&](Index first, Index last)
    {
      auto held = std::lower_bound(this->held_.begin(), this->held_.end(), cells[first],
        [](const Cell& cell, Index id) { return cell.id < id; });
      for (Index i = first; i < last; ++i)
      {
        const Index c = cells[i];
        while (held != this->held_.end() && held->id < c)
        {
          ++held;
        }
        if (this->skip_[c])
        {
          continue;
        }
        double x[8][3];
        this->cornersOf(c, points, x);
        const bool isHeld = held != this->held_.end() && held->id == c;
        const CellShape& shape = *cellShape(this->mesh_, c);
        result.scaledJacobian[c] =
          isHeld ? morph::scaledJacobian(shape, x, held->movable) : morph::scaledJacobian(shape, x);
      }
    });
  this->summarize(result);
}

void MovableQuality::summarize(Result& result) const
{
  result.inverted = 0;
  result.minimum = std::numeric_limits<double>::infinity();
  for (const double value : result.scaledJacobian)
  {
    result.minimum = std::min(result.minimum, value); // NaN is passed over
    result.inverted += value <= 0 ? 1 : 0;
  }
  result.minimum = this->communicator_.minimum(result.minimum);
  result.inverted = this->communicator_.sum(result.inverted);
}

bool MovableQuality::keepBetter(Points trial, Points& points, Result& best, Monitor& monitor) const
{
  Result result = this->measure(trial, monitor);
  const bool isBetter = best < result;
  if (isBetter)
  {
    best = std::move(result);
    points = std::move(trial);
  }
  return isBetter;
}

MovableQuality::Bounds MovableQuality::bounds(const Points& points) const
{
  Bounds result;
  for (const Cell& cell : this->held_)
  {
    double x[8][3];
    this->cornersOf(cell.id, points, x);
    const Shape shape = cellShape(this->mesh_, cell.id)->shape;
    result.movable = std::min(result.movable, scaledJacobianBound(shape, x, cell.prescribed));
  }
  result.movable = this->communicator_.minimum(result.movable);
  result.fixed = this->fixedMinimum(points);
  return result;
}

double MovableQuality::fixedMinimum(const Points& points) const
{
  double result = std::numeric_limits<double>::infinity();
  for (const Cell& cell : this->held_)
  {
    if (cell.fixed != 0)
    {
      double x[8][3];
      this->cornersOf(cell.id, points, x);
      result =
        std::min(result, morph::scaledJacobian(*cellShape(this->mesh_, cell.id), x, cell.fixed));
    }
  }
  return this->communicator_.minimum(result);
}
}
