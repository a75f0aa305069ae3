// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/StiffenedDistortion.h"

#include "Energies/CellBatches.h"
#include "Energies/StiffenedKernel.h"
#include "Mesh/NodePartition.h"
#include "Mesh/ShellLayer.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace morph
{
namespace
{
using namespace foldover;
using namespace stiffened;

/// What an edge may become: this part of the undeformed length, in the scale of the cell, or as
/// many times longer.
constexpr double LeastLength = 0.2;
/// A limit that gives way leaves its edge this much room.
constexpr double Room = 0.8;

/// An edge from a tetrahedron's first corner. `nodes`: of a batch, from the cell's lane on.
Eigen::RowVector3d edgeOf(
  const Points& points, const std::int32_t* nodes, const int* corner, int edge)
{
  return points.row(nodes[corner[edge + 1] * SimdWidth]) - points.row(nodes[corner[0] * SimdWidth]);
}
}

struct StiffenedDistortion::Sum
{
  double energy[SimdWidth] = {}, largest[SimdWidth] = {};

  void add(const SimdDouble4& h, const SimdDouble4& f)
  {
    for (int lane = 0; lane < SimdWidth; ++lane)
    {
      this->energy[lane] += h[lane];
      this->largest[lane] = std::max(this->largest[lane], f[lane]);
    }
  }
  Sum& operator+=(const Sum& other)
  {
    for (int lane = 0; lane < SimdWidth; ++lane)
    {
      this->energy[lane] += other.energy[lane];
      this->largest[lane] = std::max(this->largest[lane], other.largest[lane]);
    }
    return *this;
  }
};

/// The samples of a batch.
struct StiffenedDistortion::Samples
{
  SimplicialDecomposition corners;
  double ideal, level, floor;
  const Bounds* bounds;
  const Limits* limits; ///< of corners; not of tetrahedra
  bool isTet, isHex;

  MORPH_SIMD_INLINE Samples(const StiffenedDistortion& own, Index batch)
    : corners(cornersOf(own.batches_.shape(batch)))
    , ideal(idealSquare(own.batches_.shape(batch)))
    , level(own.level_)
    , floor(own.floor_)
    , bounds(own.bounds_.data() + own.firstBound_[batch])
    , limits(own.limits_.data() + own.firstLimits_[batch])
    , isTet(own.batches_.shape(batch) == Shape::Tet)
    , isHex(own.batches_.shape(batch) == Shape::Hex)
  {
  }
};

struct StiffenedDistortion::BatchValue
{
  static MORPH_SIMD_INLINE void run(Index batch, const CellBatches& batches,
    const StiffenedDistortion& own, const Points& points, Sum& sum)
  {
    SimdVector x[8];
    foldover::cornersOf(batches, batch, points, x);
    const Samples samples(own, batch);
    SimdDouble4 h = {}, largest = {};
    if (samples.isTet)
    {
      const TetSample tet(x, samples.bounds, samples.floor);
      for (const SimdDouble4& f : tet.f)
      {
        enlarge(largest, f);
        h += Barrier(f, samples.level).h;
      }
    }
    for (int k = 0; !samples.isTet && k < samples.corners.count; ++k)
    {
      const Sample s(
        x, samples.corners.tets[k].corner, samples.bounds[k], samples.ideal, samples.floor);
      const EdgeTerms terms(s, samples.limits[k]);
      enlarge(largest, s.f);
      h += Barrier(s.f, samples.level).h + terms.ofLeast[0] + terms.ofLeast[1] + terms.ofLeast[2] +
           terms.ofMost[0] + terms.ofMost[1] + terms.ofMost[2];
    }
    if (samples.isHex)
    {
      const Sample s(
        x, nullptr, samples.bounds[samples.corners.count], samples.ideal, samples.floor);
      enlarge(largest, s.f);
      h += Barrier(s.f, samples.level).h;
    }
    sum.add(h, largest);
  }
};

struct StiffenedDistortion::BatchGradient
{
  static MORPH_SIMD_INLINE void run(Index batch, const CellBatches& batches,
    const StiffenedDistortion& own, const Points& points, Points& parts)
  {
    SimdVector x[8], to[8] = {};
    foldover::cornersOf(batches, batch, points, x);
    const Samples samples(own, batch);
    if (samples.isTet)
    {
      addTet(x, samples, to);
    }
    for (int k = 0; !samples.isTet && k < samples.corners.count; ++k)
    {
      const int* corner = samples.corners.tets[k].corner;
      const Sample s(x, corner, samples.bounds[k], samples.ideal, samples.floor);
      const EdgeTerms terms(s, samples.limits[k]);
      SimdMatrix force;
      forces(s, samples.level, force);
      for (int j = 0; j < 3; ++j)
      {
        const SimdDouble4 ofLimits = 8. * (terms.ofMost[j] - terms.ofLeast[j]) * s.bySquare[j];
        for (int i = 0; i < 3; ++i)
        {
          force[j][i] += ofLimits * s.e[j][i];
        }
      }
      addForces(force, corner, to);
    }
    if (samples.isHex)
    {
      const Sample s(
        x, nullptr, samples.bounds[samples.corners.count], samples.ideal, samples.floor);
      SimdMatrix force;
      forces(s, samples.level, force);
      for (int a = 0; a < 8; ++a)
      {
        for (int i = 0; i < 3; ++i)
        {
          to[a][i] += 0.25 * (CenterSigns[a][0] * force[0][i] + CenterSigns[a][1] * force[1][i] +
                               CenterSigns[a][2] * force[2][i]);
        }
      }
    }
    storeAtPlaces(batches, batch, to, parts);
  }

private:
  /// The derivatives of h by a sample's edges.
  static MORPH_SIMD_INLINE void forces(const Sample& s, double level, SimdMatrix& force)
  {
    const SimdDouble4 slope = 2. * Barrier(s.f, level).first * s.f;
    const SimdDouble4 byNormal = slope * s.byDeterminant;
    for (int j = 0; j < 3; ++j)
    {
      const SimdDouble4 byEdge = slope * s.bySquare[j];
      for (int i = 0; i < 3; ++i)
      {
        force[j][i] = byEdge * s.e[j][i] - byNormal * s.n[j][i];
      }
    }
  }

  static MORPH_SIMD_INLINE void addTet(
    const SimdVector (&x)[8], const Samples& samples, SimdVector (&to)[8])
  {
    const TetSample tet(x, samples.bounds, samples.floor);
    SimdDouble4 slope[4], all = {};
    for (int a = 0; a < 4; ++a)
    {
      slope[a] = 2. * Barrier(tet.f[a], samples.level).first * tet.f[a];
      all += slope[a];
    }
    for (int k = 0; k < 6; ++k)
    {
      const int a = TetSample::Edges[k][0], b = TetSample::Edges[k][1];
      const SimdDouble4 q = tet.q[k], byEdge = (slope[a] + slope[b]) / select(q == 0., q + 1., q);
      for (int i = 0; i < 3; ++i)
      {
        const SimdDouble4 force = byEdge * tet.e[k][i];
        to[b][i] += force;
        to[a][i] -= force;
      }
    }
    SimdMatrix force;
    for (int j = 0; j < 3; ++j)
    {
      for (int i = 0; i < 3; ++i)
      {
        force[j][i] = -all * tet.byDeterminant * tet.n[j][i];
      }
    }
    addForces(force, TetCorners[0].corner, to);
  }
};

struct StiffenedDistortion::BatchHessian
{
  static MORPH_SIMD_INLINE void run(Index batch, const CellBatches& batches,
    const StiffenedDistortion& own, const Points& points, SimdMatrix* sum)
  {
    SimdVector x[8];
    foldover::cornersOf(batches, batch, points, x);
    const Samples samples(own, batch);
    const SimdDouble4 one = SimdDouble4{} + 1.;
    for (int k = 0; k < samples.corners.count; ++k)
    {
      const int* corner = samples.corners.tets[k].corner;
      const Sample s(x, corner, samples.bounds[k], samples.ideal, samples.floor);
      SimdMatrix block[3][3];
      CosineModel(s, samples.level).blocks(block);
      const SimdDouble4 counts = select(s.f > 0., one, one * 0.);
      for (int a = 0; a < 3; ++a)
      {
        const SimdDouble4 near = Proximity * counts * s.bySquare[a];
        for (int i = 0; i < 3; ++i)
        {
          block[a][a][i][i] += near;
        }
      }
      if (!samples.isTet)
      {
        addLimits(s, EdgeTerms(s, samples.limits[k]), block);
      }
      addByCorners(block, corner, one, batches.corners(batch), sum);
    }
    if (samples.isHex)
    {
      const Sample s(
        x, nullptr, samples.bounds[samples.corners.count], samples.ideal, samples.floor);
      SimdMatrix block[3][3];
      CosineModel(s, samples.level).blocks(block);
      addByCenter(block, sum);
    }
  }

private:
  /// The limits' second derivatives, without the negative ones across a short edge.
  static MORPH_SIMD_INLINE void addLimits(
    const Sample& s, const EdgeTerms& terms, SimdMatrix (&block)[3][3])
  {
    for (int a = 0; a < 3; ++a)
    {
      const SimdDouble4 across = 8. * terms.ofMost[a] * s.bySquare[a];
      const SimdDouble4 along =
        (72. * terms.ofLeast[a] + 48. * terms.ofMost[a]) * s.bySquare[a] * s.bySquare[a];
      for (int j = 0; j < 3; ++j)
      {
        block[a][a][j][j] += across;
        for (int i = 0; i < 3; ++i)
        {
          block[a][a][j][i] += along * s.e[a][j] * s.e[a][i];
        }
      }
    }
  }
};

StiffenedDistortion::StiffenedDistortion(const Mesh& mesh,
  const std::vector<std::int8_t>& orientation, const std::vector<Index>& cells,
  const std::vector<Index>& free, const Points& start, const Communicator& communicator)
  : free_(unknownOrdering(mesh, free))
  , batches_(mesh, this->free_, cells)
{
  this->share(communicator, this->free_, mesh.layer.normal, curvedImages(mesh.layer, this->free_));
  for (Index batch = 0; batch < this->batches_.size(); ++batch)
  {
    const Shape shape = this->batches_.shape(batch);
    this->firstBound_.push_back(static_cast<Index>(this->bounds_.size()));
    this->firstLimits_.push_back(static_cast<Index>(this->limits_.size()));
    this->bounds_.resize(this->bounds_.size() + numberOfSamples(shape), Bounds{});
    this->limits_.resize(
      this->limits_.size() + (shape == Shape::Tet ? 0 : cornersOf(shape).count), Limits{});
    for (int lane = 0; lane < this->batches_.cells(batch); ++lane)
    {
      this->findBounds(batch, lane, orientation, start);
      if (shape != Shape::Tet)
      {
        this->findLimits(batch, lane, mesh.points, start);
      }
    }
  }
}

void StiffenedDistortion::findBounds(
  Index batch, int lane, const std::vector<std::int8_t>& orientation, const Points& start)
{
  const Shape shape = this->batches_.shape(batch);
  const SimplicialDecomposition corners = cornersOf(shape);
  Bounds* bounds = this->bounds_.data() + this->firstBound_[batch];
  const auto sign = static_cast<float>(orientation[this->batches_.cell(batch, lane)]);
  const auto infinite = sign * std::numeric_limits<float>::infinity();
  if (shape == Shape::Hex)
  {
    bounds[corners.count].bound[lane] = infinite; // a batch's cells have a free node
  }
  for (int k = 0; k < corners.count; ++k)
  {
    Eigen::Vector3d x[4];
    int free = 0, last = 0;
    for (int i = 0; i < 4; ++i)
    {
      const Index place = corners.tets[k].corner[i] * SimdWidth + lane;
      x[i] = start.row(this->batches_.nodes(batch)[place]).transpose();
      if (this->batches_.row(this->batches_.firstPlace(batch) + place) >= 0)
      {
        ++free;
        last = i;
      }
    }
    bounds[k].bound[lane] = free > 0 ? infinite : 0;
    if (free == 1 && last > 0)
    {
      const Eigen::Vector3d u = x[1 + last % 3] - x[0], v = x[1 + (last + 1) % 3] - x[0];
      const double sine = u.cross(v).norm() / (u.norm() * v.norm());
      bounds[k].bound[lane] = sign * static_cast<float>(sine / std::sqrt(idealSquare(shape)));
    }
  }
}

void StiffenedDistortion::findLimits(
  Index batch, int lane, const Points& shapes, const Points& start)
{
  const SimplicialDecomposition corners = cornersOf(this->batches_.shape(batch));
  Limits* limits = this->limits_.data() + this->firstLimits_[batch];
  const std::int32_t* nodes = this->batches_.nodes(batch) + lane;
  const auto length = [&](const Points& points, int k, int edge)
  { return edgeOf(points, nodes, corners.tets[k].corner, edge).norm(); };
  double before[MostCorners][3], now[MostCorners][3], sumBefore = 0, sumNow = 0;
  for (int k = 0; k < corners.count; ++k)
  {
    for (int edge = 0; edge < 3; ++edge)
    {
      before[k][edge] = length(shapes, k, edge);
      now[k][edge] = length(start, k, edge);
      sumBefore += before[k][edge];
      sumNow += now[k][edge];
    }
  }
  const double scale = sumBefore > 0 ? sumNow / sumBefore : 0;
  const auto isFree = [&](int a)
  { return this->batches_.row(this->batches_.firstPlace(batch) + a * SimdWidth + lane) >= 0; };
  for (int k = 0; k < corners.count; ++k)
  {
    const int* corner = corners.tets[k].corner;
    for (int edge = 0; edge < 3; ++edge)
    {
      if (!isFree(corner[0]) && !isFree(corner[edge + 1]))
      {
        continue;
      }
      const double undeformed = scale * before[k][edge], near = LeastLength * undeformed,
                   least = std::min(near, Room * now[k][edge]),
                   most = std::max(undeformed / LeastLength, now[k][edge] / Room);
      limits[k].near[edge][lane] = static_cast<float>(near * near);
      limits[k].least[edge][lane] = static_cast<float>(least * least);
      limits[k].byMost[edge][lane] = static_cast<float>(most > 0 ? 1 / (most * most) : 0);
    }
  }
}

void StiffenedDistortion::restoreLimits(const Points& points)
{
  for (Index batch = 0; batch < this->batches_.size(); ++batch)
  {
    const Shape shape = this->batches_.shape(batch);
    const SimplicialDecomposition corners = cornersOf(shape);
    Limits* limits = this->limits_.data() + this->firstLimits_[batch];
    for (int k = 0; shape != Shape::Tet && k < corners.count; ++k)
    {
      for (int edge = 0; edge < 3; ++edge)
      {
        for (int lane = 0; lane < this->batches_.cells(batch); ++lane)
        {
          float& least = limits[k].least[edge][lane];
          const float near = limits[k].near[edge][lane];
          if (least < near)
          {
            const std::int32_t* nodes = this->batches_.nodes(batch) + lane;
            const double square = edgeOf(points, nodes, corners.tets[k].corner, edge).squaredNorm();
            least = std::max(least, std::min(near, static_cast<float>(Room * Room * square)));
          }
        }
      }
    }
  }
}

StiffenedDistortion::State StiffenedDistortion::evaluate(
  const Points& points, Monitor& monitor) const
{
  const Sum sum = sumOverBatches<BatchValue, Sum>(this->batches_, monitor, *this, points);
  const double energy =
    this->communicator().sum((sum.energy[0] + sum.energy[1]) + (sum.energy[2] + sum.energy[3]));
  return { energy,
    this->communicator().maximum(*std::max_element(sum.largest, sum.largest + SimdWidth)) };
}

Objective::Value StiffenedDistortion::value(const Points& points, Monitor& monitor) const
{
  const double energy = this->evaluate(points, monitor).energy;
  return { energy, std::isfinite(energy) };
}

void StiffenedDistortion::gradient(const Points& points, Points& result, Monitor& monitor) const
{
  gatherFromBatches<BatchGradient>(this->batches_, this->parts_, result, monitor, *this, points);
  this->rows().add(result);
}

void StiffenedDistortion::hessian(const Points& points, BlockCsr3f& result, Monitor& monitor) const
{
  if (!result.isOpenFor(this->pattern_))
  {
    openBlocks(this->batches_, this->free_, this->pattern_, result, monitor);
  }
  sumBlocks<BatchHessian>(this->batches_, result, monitor, *this, points);
}
}
