// SPDX-License-Identifier: BSD-3-Clause
#include "MeshEnergy.h"

#include "BlockSum.h"
#include "CellShape.h"
#include "NodeUses.h"
#include "SimplicialDecomposition.h"

#include <Eigen/LU>

#include <algorithm>
#include <limits>

namespace morph
{
namespace
{
constexpr Index Grain = 512;
constexpr double Barrier = 1e-9; // regularisation that keeps nothing inverted finite

using Corners = Eigen::Matrix<double, 3, 8>;

Eigen::Matrix3d jacobian(const Corners& x, const TargetShapes::Tetrahedron& tetrahedron)
{
  Eigen::Matrix3d D;
  for (int k = 0; k < 3; ++k)
  {
    D.col(k) = x.col(tetrahedron.corner[k + 1]) - x.col(tetrahedron.corner[0]);
  }
  return D * Eigen::Map<const Eigen::Matrix3d>(tetrahedron.inverse);
}

struct Sum
{
  double energy = 0;
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  Sum& operator+=(const Sum& other)
  {
    this->energy += other.energy;
    this->least = std::min(this->least, other.least);
    this->most = std::max(this->most, other.most);
    return *this;
  }
};
}

MeshEnergy::MeshEnergy(const Mesh& mesh, const std::vector<Index>& free)
  : free_(free)
  , row_(mesh.numberOfNodes(), -1)
{
  for (std::size_t i = 0; i < free.size(); ++i)
  {
    this->row_[free[i]] = static_cast<std::int32_t>(i);
  }
  this->cornerStart_.push_back(0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const CellShape& shape = *cellShape(mesh.types[c]);
    const int corners = morph::numberOfCorners(shape.shape);
    if (corners == 0)
    {
      continue;
    }
    for (int a = 0; a < corners; ++a)
    {
      this->corner_.push_back(static_cast<std::int32_t>(mesh.cell(c)[shape.cornerNode[a]]));
    }
    this->ofCell_.push_back(c);
    this->cornerStart_.push_back(static_cast<Index>(this->corner_.size()));
  }

  this->uses_ =
    placesOfRows(static_cast<Index>(this->corner_.size()), static_cast<Index>(free.size()),
      [this](Index place) { return this->row_[this->corner_[place]]; });
}

bool MeshEnergy::isMovable(
  const std::int32_t* corners, const TargetShapes::Tetrahedron& tetrahedron) const
{
  return std::any_of(
    tetrahedron.corner, tetrahedron.corner + 4, [&](int a) { return this->row_[corners[a]] >= 0; });
}

void MeshEnergy::setTargets(const TargetShapes& targets)
{
  this->start_.assign(1, 0);
  this->tetrahedra_.clear();
  this->tetrahedra_.reserve(targets.tetrahedra.size());
  for (Index c = 0; c < this->cells(); ++c)
  {
    for (Index t = targets.start[this->ofCell_[c]]; t < targets.start[this->ofCell_[c] + 1]; ++t)
    {
      const TargetShapes::Tetrahedron& tetrahedron = targets.tetrahedra[t];
      if (tetrahedron.weight > 0 && this->isMovable(this->corners(c), tetrahedron))
      {
        this->tetrahedra_.push_back(tetrahedron);
      }
    }
    this->start_.push_back(static_cast<Index>(this->tetrahedra_.size()));
  }
}

MeshEnergy::Corners MeshEnergy::positions(Index cell, const Points& points) const
{
  Corners x;
  const int n = this->numberOfCorners(cell);
  for (int a = 0; a < n; ++a)
  {
    x.col(a) = points.row(this->corners(cell)[a]).transpose();
  }
  return x;
}

FoldoverDensity MeshEnergy::densityOf(const TargetShapes::Tetrahedron& tetrahedron) const
{
  FoldoverDensity own = this->density_;
  own.theta = tetrahedron.theta;
  own.stiffness = tetrahedron.stiffened ? own.stiffness : 0;
  return own;
}

MeshEnergy::State MeshEnergy::evaluate(const Points& points, Monitor& monitor) const
{
  const Sum sum = blockSum(this->cells(), monitor, Sum{},
    [&](Index c)
    {
      Sum result;
      const Corners x = this->positions(c, points);
      for (Index t = this->start_[c]; t < this->start_[c + 1]; ++t)
      {
        const TargetShapes::Tetrahedron& tetrahedron = this->tetrahedra_[t];
        const Eigen::Matrix3d J = jacobian(x, tetrahedron);
        const FoldoverDensity own = this->densityOf(tetrahedron);
        const double phi = own.distortion(J);
        const double gap = 1 - own.stiffness * phi;
        result.energy +=
          tetrahedron.weight * (gap > 0 ? phi / gap : std::numeric_limits<double>::infinity());
        result.least = std::min(result.least, J.determinant());
        result.most = tetrahedron.stiffened ? std::max(result.most, phi) : result.most;
      }
      return result;
    });
  return { sum.energy, sum.least, sum.most };
}

Objective::Value MeshEnergy::value(const Points& points, Monitor& monitor) const
{
  const State state = this->evaluate(points, monitor);
  return { state.energy, this->density_.epsilon > Barrier || state.leastDeterminant > 0 };
}

void MeshEnergy::gradient(const Points& points, Points& result, Monitor& monitor) const
{
  // Each cell writes what it gives to its corners; then each node sums up, in the order of the cells.
  Points parts(static_cast<Index>(this->corner_.size()), 3);
  monitor.parallelFor(this->cells(), Grain,
    [&](Index first, Index last)
    {
      for (Index c = first; c < last; ++c)
      {
        const Corners x = this->positions(c, points);
        auto own = parts.middleRows(this->cornerStart_[c], this->numberOfCorners(c));
        own.setZero();
        for (Index t = this->start_[c]; t < this->start_[c + 1]; ++t)
        {
          const TargetShapes::Tetrahedron& tetrahedron = this->tetrahedra_[t];
          Eigen::Matrix3d P;
          this->densityOf(tetrahedron).gradient(jacobian(x, tetrahedron), P);
          const Eigen::Matrix3d force =
            tetrahedron.weight * P *
            Eigen::Map<const Eigen::Matrix3d>(tetrahedron.inverse).transpose();
          own.row(tetrahedron.corner[0]) -= force.rowwise().sum().transpose();
          for (int k = 0; k < 3; ++k)
          {
            own.row(tetrahedron.corner[k + 1]) += force.col(k).transpose();
          }
        }
      }
    });
  sumOverPlaces(this->uses_, parts, result, monitor);
}
}
