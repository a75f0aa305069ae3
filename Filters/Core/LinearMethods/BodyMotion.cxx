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
  Row center = Row::Zero(), mean = Row::Zero();
  Matrix gradient = Matrix::Zero();

  Row at(const Row& x) const { return this->mean + (x - this->center) * this->gradient; }
};

/// Prescribed corners, of which each counts on one process, and their sums over the processes.
class BodyMotions
{
public:
  BodyMotions(const Mesh& rest, const ConnectedComponents& bodies, const NodePartition& partition,
    const Points& displacement, const Communicator& communicator)
    : rest_(rest)
    , bodies_(bodies)
    , free_(partition.free)
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
    this->center();
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
  void center()
  {
    using Sum = Eigen::Matrix<double, 1, 8>; // of positions, displacements, and counts
    // Twice: sums of coordinates far from the origin lose the digits that tell the points apart.
    for (int pass = 0; pass < 2; ++pass)
    {
      const std::vector<Sum> sums = this->sums<Sum>(
        [&](const Corner& corner, Eigen::Map<Sum>& sum)
        {
          const Row u = this->displacement_.row(corner.row);
          sum.head<3>() += this->rest_.points.row(corner.node) - this->motions_[corner.body].center;
          sum.segment<3>(3) += u;
          sum[6] += 1;
          sum[7] += (u.array() == 0).all() ? 0 : 1;
        });
      for (std::size_t b = 0; b < sums.size(); ++b)
      {
        Motion& motion = this->motions_[b];
        motion.corners = sums[b][6];
        motion.moved = sums[b][7];
        motion.center += sums[b].head<3>() / std::max(1., motion.corners);
        motion.mean = sums[b].segment<3>(3) / std::max(1., motion.corners);
      }
    }
  }

  Row arm(const Corner& corner) const
  {
    return this->rest_.points.row(corner.node) - this->motions_[corner.body].center;
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
    std::vector<PrincipalDirections> directions;
    for (std::size_t b = 0; b < spread.size(); ++b)
    {
      directions.emplace_back(spread[b], this->motions_[b].corners);
    }
    this->limit(directions);
    bool areTold = true;
    for (std::size_t b = 0; b < spread.size(); ++b)
    {
      Motion& motion = this->motions_[b];
      motion.gradient =
        AffineFit(motion.center, motion.mean, directions[b].inverse(), stretch[b]).gradient();
      // What stays needs no completion.
      areTold = areTold && (motion.moved == 0 || directions[b].shares().minCoeff() == 1);
    }
    if (areTold)
    {
      return;
    }
    // The second axis from what the first leaves: a narrow strip's would have half the digits.
    const std::vector<Matrix> sides = this->sums<Matrix>(
      [&](const Corner& corner, Eigen::Map<Matrix>& sum)
      {
        const Row axis = directions[corner.body].axes().col(2).transpose();
        const Row arm = this->arm(corner), side = arm - arm.dot(axis) * axis;
        sum.noalias() += side.transpose() * side;
      });
    for (std::size_t b = 0; b < sides.size(); ++b)
    {
      const Row first = directions[b].axes().col(2).transpose();
      const Eigen::SelfAdjointEigenSolver<Matrix> axes(sides[b]);
      Row second = axes.eigenvectors().col(2).transpose();
      second -= second.dot(first) * first;
      // A line leaves rounding, in any direction.
      second = second.norm() > 0.5 ? Row(second.normalized()) : first.unitOrthogonal();
      complete(this->motions_[b].gradient, directions[b].shares(), first, second);
    }
  }

  /// Limits the directions of each body to what moves its free nodes.
  void limit(std::vector<PrincipalDirections>& directions) const
  {
    // Of each body, the largest leverages of its corners, and those of its free nodes.
    std::vector<double> largest(6 * directions.size(), 0);
    const auto add = [&](Index node, Index body, Index first)
    {
      Eigen::Map<Row> most(largest.data() + 6 * body + first);
      most = most.cwiseMax(
        directions[body].leverages(this->rest_.points.row(node) - this->motions_[body].center));
    };
    for (const Corner& corner : this->corners_)
    {
      add(corner.node, corner.body, 0);
    }
    for (const Index node : this->free_)
    {
      add(node, this->bodies_.ofNode[node], 3);
    }
    this->communicator_.maximum(largest.data(), static_cast<int>(largest.size()));
    for (std::size_t b = 0; b < directions.size(); ++b)
    {
      const Eigen::Map<const Row> within(largest.data() + 6 * b), reach(within.data() + 3);
      directions[b].limit(within, reach);
    }
  }

  /// Completes a gradient by a similarity, as far as the corners lie in a plane of these axes, or
  /// on the line of the first. `shares`: those of the gradient. Positions are rows.
  static void complete(Matrix& gradient, const Row& shares, const Row& first, const Row& second)
  {
    const Row a = first + first * gradient;
    if (shares[1] < 1 && a.norm() > 0)
    {
      const auto turn = Eigen::Quaterniond::FromTwoVectors(first.transpose(), a.transpose());
      gradient += (1 - shares[1]) * second.transpose() *
                  (a.norm() * second * turn.toRotationMatrix().transpose() - second);
    }
    const Row b = second + second * gradient, across = a.cross(b);
    if (shares[0] < 1 && across.norm() > 0)
    {
      // The thickness scales with the sheet's lengths.
      const Row normal = first.cross(second);
      gradient +=
        (1 - shares[0]) * normal.transpose() * (across / std::sqrt(across.norm()) - normal);
    }
  }

  const Mesh& rest_;
  const ConnectedComponents& bodies_;
  const std::vector<Index>& free_;
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
