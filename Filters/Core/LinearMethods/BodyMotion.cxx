// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/BodyMotion.h"

#include "Geometry/AffineFit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace morph
{
namespace
{
constexpr double Affine = 1e-9; // of the mesh's size: rounding of an affine motion

using Row = Eigen::RowVector3d;
using Matrix = Eigen::Matrix3d;

/// The motion of one body.
struct Motion
{
  double corners = 0, moved = 0; ///< prescribed ones, and those of them that move
  Row centre = Row::Zero(), mean = Row::Zero();
  Matrix gradient = Matrix::Zero();

  Row at(const Row& x) const { return this->mean + (x - this->centre) * this->gradient; }
};

/// Prescribed corners, of which each counts on one process, and their sums over the processes.
class BodyMotions
{
public:
  BodyMotions(const Mesh& rest, const ConnectedComponents& bodies, const NodePartition& partition,
    const Points& displacement, const Communicator& communicator)
    : rest_(rest)
    , displacement_(displacement)
    , communicator_(communicator)
    , motions_(bodies.count)
  {
    const std::unique_ptr<CopiedRows> rows = communicator.rows(partition.prescribed);
    const std::vector<Index>& elsewhere = rows->countedElsewhere();
    for (Index i = 0; i < displacement.rows(); ++i)
    {
      const Index node = partition.prescribed[i], body = bodies.ofNode[node];
      if (body >= 0 && !std::binary_search(elsewhere.begin(), elsewhere.end(), i))
      {
        this->corners_.push_back({ i, node, body });
      }
    }
    this->centre();
    this->fit();
  }

  const std::vector<Motion>& motions() const { return this->motions_; }

  /// Whether all corners move as their bodies.
  bool areAffine() const
  {
    double most = 0, length = this->size();
    for (const Corner& corner : this->corners_)
    {
      const Row x = this->rest_.points.row(corner.node), u = this->displacement_.row(corner.row);
      length = std::max(length, u.cwiseAbs().maxCoeff());
      most = std::max(most, (this->motions_[corner.body].at(x) - u).norm());
    }
    length = this->communicator_.maximum(length);
    return this->communicator_.maximum(most) <= Affine * length;
  }

private:
  struct Corner
  {
    Index row; ///< of the displacement
    Index node, body;
  };

  /// Returns for each body the sum of body(corner, sum) over its corners, a fixed-size matrix.
  template <typename Sum, typename Body>
  std::vector<Sum> sums(const Body& body) const
  {
    const auto count = static_cast<Index>(this->motions_.size());
    std::vector<double> flat(count * Sum::SizeAtCompileTime, 0);
    for (const Corner& corner : this->corners_)
    {
      Eigen::Map<Sum> sum(flat.data() + corner.body * Sum::SizeAtCompileTime);
      body(corner, sum);
    }
    this->communicator_.sum(flat.data(), static_cast<int>(flat.size()));
    std::vector<Sum> result;
    for (Index b = 0; b < count; ++b)
    {
      result.push_back(Eigen::Map<const Sum>(flat.data() + b * Sum::SizeAtCompileTime));
    }
    return result;
  }

  /// The diagonal of the box of the whole mesh.
  double size() const
  {
    const Points& points = this->rest_.points;
    Row extent;
    for (int j = 0; j < 3; ++j)
    {
      const double infinite = std::numeric_limits<double>::infinity();
      const bool any = points.rows() > 0;
      extent[j] = this->communicator_.maximum(any ? points.col(j).maxCoeff() : -infinite) -
                  this->communicator_.minimum(any ? points.col(j).minCoeff() : infinite);
    }
    return std::max(0., extent.norm());
  }

  /// Finds the mean positions and displacements.
  void centre()
  {
    using Sum = Eigen::Matrix<double, 1, 8>; // of positions, displacements, and counts
    // Twice: sums of coordinates far from the origin lose the digits that tell the points apart.
    for (int pass = 0; pass < 2; ++pass)
    {
      const std::vector<Sum> sums = this->sums<Sum>(
        [&](const Corner& corner, Eigen::Map<Sum>& sum)
        {
          const Row u = this->displacement_.row(corner.row);
          sum.head<3>() += this->rest_.points.row(corner.node) - this->motions_[corner.body].centre;
          sum.segment<3>(3) += u;
          sum[6] += 1;
          sum[7] += (u.array() == 0).all() ? 0 : 1;
        });
      for (std::size_t b = 0; b < sums.size(); ++b)
      {
        Motion& motion = this->motions_[b];
        motion.corners = sums[b][6];
        motion.moved = sums[b][7];
        motion.centre += sums[b].head<3>() / std::max(1., motion.corners);
        motion.mean = sums[b].segment<3>(3) / std::max(1., motion.corners);
      }
    }
  }

  Row arm(const Corner& corner) const
  {
    return this->rest_.points.row(corner.node) - this->motions_[corner.body].centre;
  }

  void fit()
  {
    const std::vector<Matrix> spread = this->sums<Matrix>(
      [&](const Corner& corner, Eigen::Map<Matrix>& sum)
      {
        const Row arm = this->arm(corner);
        sum.noalias() += arm.transpose() * arm;
      });
    const std::vector<Matrix> stretch = this->sums<Matrix>(
      [&](const Corner& corner, Eigen::Map<Matrix>& sum)
      {
        const Row u = this->displacement_.row(corner.row);
        sum.noalias() += this->arm(corner).transpose() * (u - this->motions_[corner.body].mean);
      });
    std::vector<int> ranks;
    std::vector<Row> longest;
    for (std::size_t b = 0; b < spread.size(); ++b)
    {
      Motion& motion = this->motions_[b];
      const AffineFit fit(motion.centre, motion.mean, spread[b], stretch[b]);
      motion.gradient = fit.gradient();
      const Eigen::SelfAdjointEigenSolver<Matrix> axes(spread[b]);
      longest.emplace_back(axes.eigenvectors().col(2).transpose());
      int rank = 0;
      for (int j = 0; j < 3; ++j)
      {
        rank += AffineLeastSquares::isExtended(axes.eigenvalues()[j], axes.eigenvalues()[2]);
      }
      ranks.push_back(motion.moved > 0 ? rank : 3); // what stays needs no completion
    }
    if (std::all_of(ranks.begin(), ranks.end(), [](int rank) { return rank == 3; }))
    {
      return;
    }
    // The second axis from what the first leaves: a narrow strip's would have half the digits.
    const std::vector<Matrix> sides = this->sums<Matrix>(
      [&](const Corner& corner, Eigen::Map<Matrix>& sum)
      {
        const Row& axis = longest[corner.body];
        const Row arm = this->arm(corner), side = arm - arm.dot(axis) * axis;
        sum.noalias() += side.transpose() * side;
      });
    for (std::size_t b = 0; b < sides.size(); ++b)
    {
      const Eigen::SelfAdjointEigenSolver<Matrix> axes(sides[b]);
      complete(
        this->motions_[b].gradient, ranks[b], longest[b], axes.eigenvectors().col(2).transpose());
    }
  }

  /// Completes a gradient by a similarity, where the corners lie in a plane of these axes, or on
  /// the line of the first. Positions are rows.
  static void complete(Matrix& gradient, int rank, const Row& first, const Row& second)
  {
    Matrix map = Matrix::Identity() + gradient;
    const Row a = first * map, b = second * map, across = a.cross(b);
    if (rank == 2 && across.norm() > 0)
    {
      // The thickness scales with the sheet's lengths.
      const Row normal = first.cross(second);
      gradient += normal.transpose() * (across / std::sqrt(across.norm()) - normal);
    }
    else if (rank == 1 && a.norm() > 0)
    {
      const auto turn = Eigen::Quaterniond::FromTwoVectors(first.transpose(), a.transpose());
      gradient = a.norm() * turn.toRotationMatrix().transpose() - Matrix::Identity();
    }
  }

  const Mesh& rest_;
  const Points& displacement_;
  const Communicator& communicator_;
  std::vector<Corner> corners_;
  std::vector<Motion> motions_;
};
}

bool followAffinely(const Mesh& rest, const ConnectedComponents& bodies,
  const NodePartition& partition, const Points& displacement, Points& points,
  const Communicator& communicator)
{
  const BodyMotions fits(rest, bodies, partition, displacement, communicator);
  for (Index node : partition.free)
  {
    const Motion& motion = fits.motions()[bodies.ofNode[node]];
    const Row x = rest.points.row(node), u = motion.moved > 0 ? motion.at(x) : Row::Zero();
    points.row(node) = (u.array() == 0).all() ? x : Row(x + u);
  }
  return fits.areAffine();
}
}
