// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/FaceEnergy.h"

#include "Mesh/GatherMap.h"
#include "Support/Lists.h"
#include "Support/Parallel.h"
#include "Support/ReproducibleSum.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace morph
{
namespace
{
constexpr Index Grain = 256;
/// Of a block that the upper part has not, or whose other node is fixed.
constexpr std::uint16_t NoPlace = 0xffff;

using Plane = FaceEnergy::Plane;
/// How the two edges of a corner, as columns, change with its nodes.
constexpr double EdgeOfNode[3][2] = { { -1, -1 }, { 1, 0 }, { 0, 1 } };
}

FaceEnergy::Plane FaceEnergy::tangents(const Eigen::RowVector3d& normal)
{
  Plane plane;
  plane.col(0) = normal.unitOrthogonal().transpose();
  plane.col(1) = normal.cross(plane.col(0).transpose()).transpose();
  return plane;
}

FaceEnergy::FaceEnergy(std::vector<FaceCorner> corners, const std::vector<Index>& free, Index nodes)
  : corners_(std::move(corners))
  , free_(free)
  , row_(inverseIndex(free, nodes))
  , uses_(gatherMap(static_cast<Index>(3 * corners_.size()), static_cast<Index>(free.size()),
      [this](Index place) { return Index(this->rowAt(place)); }))
{
}

void FaceEnergy::setPlanes(const Points& cornerNormals, const Points& nodeNormals)
{
  this->planes_.resize(this->corners_.size());
  for (std::size_t c = 0; c < this->planes_.size(); ++c)
  {
    this->planes_[c] = FaceEnergy::tangents(cornerNormals.row(static_cast<Index>(c)));
  }
  this->normals_ = nodeNormals;
}

Eigen::Matrix2d FaceEnergy::jacobian(Index corner, const Points& points) const
{
  const FaceCorner& own = this->corners_[corner];
  Eigen::Matrix<double, 3, 2> edges;
  for (int k = 0; k < 2; ++k)
  {
    edges.col(k) = (points.row(own.node[k + 1]) - points.row(own.node[0])).transpose();
  }
  return this->planes_[corner].transpose() * edges * own.inverse;
}

EnergyState FaceEnergy::evaluate(const Points& points, Monitor& monitor) const
{
  return reproducibleSum(static_cast<Index>(this->corners_.size()), monitor, EnergyState(),
    [&](Index c)
    {
      const Eigen::Matrix2d J = this->jacobian(c, points);
      const double d = J.determinant();
      return EnergyState{ this->corners_[c].weight * this->density_.value(J), d, d > 0 ? 0 : 1 };
    });
}

Objective::Value FaceEnergy::value(const Points& points, Monitor& monitor) const
{
  const EnergyState state = this->evaluate(points, monitor);
  return { state.energy, this->density_.epsilon > 0 || state.minimumDeterminant > 0 };
}

void FaceEnergy::gradient(const Points& points, Points& result, Monitor& monitor) const
{
  const Index corners = static_cast<Index>(this->corners_.size());
  this->parts_.resize(3 * corners, 3);
  parallel(corners, Grain, monitor,
    [&](Index c)
    {
      Eigen::Matrix2d slope;
      this->density_.gradient(this->jacobian(c, points), slope);
      const FaceCorner& own = this->corners_[c];
      const Eigen::Matrix<double, 3, 2> force =
        own.weight * this->planes_[c] * slope * own.inverse.transpose();
      this->parts_.row(3 * c) = -force.rowwise().sum().transpose();
      this->parts_.row(3 * c + 1) = force.col(0).transpose();
      this->parts_.row(3 * c + 2) = force.col(1).transpose();
    });
  gatherSum(this->uses_, this->parts_, result, monitor);
  for (Index i = 0; i < result.rows(); ++i)
  {
    const Eigen::RowVector3d normal = this->normals_.row(i);
    result.row(i) -= result.row(i).dot(normal) * normal;
  }
}

void FaceEnergy::openMatrix(BlockCsr3f& matrix) const
{
  const Index rows = static_cast<Index>(this->free_.size());
  BlockPattern pattern;
  std::vector<std::int32_t> row, found;
  for (Index i = 0; i < rows; ++i)
  {
    found.clear();
    for (const Index* use = this->uses_.begin(i); use != this->uses_.end(i); ++use)
    {
      for (Index k = 0; k < 3; ++k)
      {
        found.push_back(this->rowAt(*use - *use % 3 + k));
      }
    }
    row.assign(1, static_cast<std::int32_t>(i));
    std::copy_if(found.begin(), found.end(), std::back_inserter(row),
      [i](std::int32_t column) { return column >= i; });
    sortUnique(row);
    for (const std::int32_t column : found)
    {
      const auto place = std::lower_bound(row.begin(), row.end(), column) - row.begin();
      pattern.places.push_back(column < i ? NoPlace : static_cast<std::uint16_t>(place));
    }
    pattern.columns.insert(pattern.columns.end(), row.begin(), row.end());
    pattern.offsets.push_back(static_cast<Index>(pattern.columns.size()));
    pattern.placeOffsets.push_back(static_cast<Index>(pattern.places.size()));
  }
  matrix.open(this->pattern_, std::move(pattern));
}

void FaceEnergy::addAlongNormal(Index row, BlockCsr3f& matrix) const
{
  Eigen::Map<Eigen::Matrix3f> block(matrix.blocks(row)); // that of the diagonal
  const Eigen::Vector3f normal = this->normals_.row(row).transpose().cast<float>();
  block += 0.5f * block.trace() * normal * normal.transpose();
}

void FaceEnergy::hessian(const Points& points, BlockCsr3f& result, Monitor& monitor) const
{
  if (!result.isOpenFor(this->pattern_))
  {
    this->openMatrix(result);
  }
  result.setZero();
  const Index corners = static_cast<Index>(this->corners_.size());
  // By the corner's two edges in its plane: the first edge's two entries, then the second's.
  std::vector<FaceDensity::Hessian> ofEdges(corners);
  parallel(corners, Grain, monitor,
    [&](Index c)
    {
      const FaceCorner& own = this->corners_[c];
      const FaceDensity::Hessian H = own.weight * this->density_.hessian(this->jacobian(c, points));
      FaceDensity::Hessian& edges = ofEdges[c];
      for (int a = 0; a < 2; ++a)
      {
        for (int b = 0; b < 2; ++b)
        {
          Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
          for (int k = 0; k < 2; ++k)
          {
            for (int l = 0; l < 2; ++l)
            {
              sum += own.inverse(a, k) * own.inverse(b, l) * H.block<2, 2>(2 * k, 2 * l);
            }
          }
          edges.block<2, 2>(2 * a, 2 * b) = sum;
        }
      }
    });
  const auto tangential = [this](Index row, const Plane& plane)
  {
    const Eigen::RowVector3d normal = this->normals_.row(row);
    return Plane(plane - normal.transpose() * (normal * plane));
  };
  parallel(result.rows(), Grain, monitor,
    [&](Index row)
    {
      const std::uint16_t* place = result.places(row);
      for (const Index* use = this->uses_.begin(row); use != this->uses_.end(row); ++use)
      {
        const Index c = *use / 3, own = *use % 3;
        const Plane left = tangential(row, this->planes_[c]);
        for (Index other = 0; other < 3; ++other, ++place)
        {
          if (*place == NoPlace)
          {
            continue;
          }
          Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
          for (int a = 0; a < 2; ++a)
          {
            for (int b = 0; b < 2; ++b)
            {
              sum +=
                EdgeOfNode[own][a] * EdgeOfNode[other][b] * ofEdges[c].block<2, 2>(2 * a, 2 * b);
            }
          }
          const Plane right = tangential(this->rowAt(3 * c + other), this->planes_[c]);
          Eigen::Map<Eigen::Matrix3f> block(result.blocks(row) + 9 * static_cast<Index>(*place));
          block += (left * sum * right.transpose()).cast<float>();
        }
      }
      this->addAlongNormal(row, result);
    });
}
}
