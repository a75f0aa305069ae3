// SPDX-License-Identifier: BSD-3-Clause
// Sliding nodes that FEMWARP does not pull along their surfaces, against a dense solution.
#include "DirectSolutions.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/SlidingWarp.h"
#include "Meshes.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>

using namespace meshes;
using namespace morph;

namespace
{
using Row = Eigen::RowVector3d;

constexpr int Side = 4;

/// A block whose faces x = 0 and y = 0 slide: the bottom moves, and all other faces stay.
struct Block
{
  Mesh mesh = hexes(Side, Side, Side);
  std::vector<Index> prescribed, sliding;
  std::vector<std::vector<Row>> normals; ///< of each sliding node
  Points moved;

  /// `turn`: of the block, so that no plane is an axis plane.
  explicit Block(const Eigen::Matrix3d& turn)
  {
    jitterInterior(this->mesh, 0.2, 5);
    const Points lattice = this->mesh.points;
    const auto is = [](double a, double b) { return std::abs(a - b) < 1e-9; };
    this->moved = Points::Zero(lattice.rows(), 3);
    for (Index n = 0; n < lattice.rows(); ++n)
    {
      const Row x = lattice.row(n);
      const bool stays = is(x[0], Side) || is(x[1], Side) || is(x[2], Side);
      if (stays || is(x[2], 0))
      {
        this->prescribed.push_back(n);
        const double s = (Side - x[0]) * (Side - x[1]) / (Side * Side);
        this->moved.row(n) = stays ? x : Row(x + Row(0.3 * s * x[0], 0.2 * s * x[1], 0.7 * s));
        continue;
      }
      this->moved.row(n) = x;
      if (is(x[0], 0) || is(x[1], 0))
      {
        this->sliding.push_back(n);
        std::vector<Row>& across = this->normals.emplace_back();
        for (int c = 0; c < 2; ++c)
        {
          if (is(x[c], 0))
          {
            across.push_back(Row::Unit(c) * turn.transpose());
          }
        }
      }
    }
    this->mesh.points = lattice * turn.transpose();
    this->moved = this->moved * turn.transpose();
  }

  SlidingWarp::Surfaces surfaces() const
  {
    return { [this](Index i, const Row&)
      {
        Eigen::Matrix3d free = Eigen::Matrix3d::Identity();
        for (const Row& n : this->normals[i])
        {
          free -= n.transpose() * n;
        }
        return free;
      },
      [this](Index i, const Row& x)
      {
        Row on = x;
        for (const Row& n : this->normals[i])
        {
          on -= n.dot(x) * n; // the planes contain the origin
        }
        return on;
      } };
  }

  /// Dense: the energy's minimum with the normal components of sliding nodes held at zero.
  Points expected() const
  {
    std::vector<Index> unknown;
    for (Index n = 0; n < this->mesh.numberOfNodes(); ++n)
    {
      if (!std::binary_search(this->prescribed.begin(), this->prescribed.end(), n))
      {
        unknown.push_back(n);
      }
    }
    ThreadedMonitor monitor;
    FemWarpSystem system = femWarpSystem(this->mesh, unknown, this->prescribed, {}, monitor);
    const Eigen::MatrixXd A = system.interior;
    const Points given =
      rows(this->moved, this->prescribed) - rows(this->mesh.points, this->prescribed);
    const Points b = -(system.coupling * given);
    const auto n = static_cast<Index>(unknown.size());
    Index held = 0;
    for (const auto& across : this->normals)
    {
      held += static_cast<Index>(across.size());
    }
    // Lagrange multipliers for the normal components.
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 * n + held, 3 * n + held);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(3 * n + held);
    for (int c = 0; c < 3; ++c)
    {
      all.block(c * n, c * n, n, n) = A;
      right.segment(c * n, n) = b.col(c);
    }
    Index at = 3 * n;
    for (std::size_t i = 0; i < this->sliding.size(); ++i)
    {
      const Index row =
        std::lower_bound(unknown.begin(), unknown.end(), this->sliding[i]) - unknown.begin();
      for (const Row& normal : this->normals[i])
      {
        for (int c = 0; c < 3; ++c)
        {
          all(at, c * n + row) = all(c * n + row, at) = normal[c];
        }
        ++at;
      }
    }
    const Eigen::VectorXd x = direct::solve(all, right);
    Points result = this->moved;
    for (Index i = 0; i < n; ++i)
    {
      result.row(unknown[i]) =
        this->mesh.points.row(unknown[i]) + Row(x[i], x[n + i], x[2 * n + i]);
    }
    return result;
  }
};
}

TEST(SlidingWarp, AgreesOnPlanesWithADenseSolution)
{
  for (const double angle : { 0., 0.7 })
  {
    const Block block(
      Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix());
    const Points expected = block.expected();
    Points first;
    for (const int threads : { 1, 3 })
    {
      ThreadedMonitor monitor(threads);
      SlidingWarp method;
      method.prepare(block.mesh, partitionNodes(block.mesh, block.prescribed), monitor);
      Points moved = block.moved;
      const auto rounds = method.slide(block.sliding, block.surfaces(), { 3 }, moved, monitor);
      ASSERT_FALSE(rounds.empty());
      EXPECT_GT(rounds[0].change, 0.05);
      double last = 1;
      for (const SlidingWarp::Round& round : rounds)
      {
        EXPECT_LT(round.force, last);
        last = round.force;
      }
      EXPECT_LT(last, 1e-8);
      for (std::size_t i = 0; i < block.sliding.size(); ++i)
      {
        const Index node = block.sliding[i];
        EXPECT_LT((moved.row(node) - expected.row(node)).norm(), 1e-8) << node;
        for (const Row& n : block.normals[i])
        {
          EXPECT_LT(std::abs(n.dot(moved.row(node))), 1e-12 * Side) << node;
        }
      }
      first = threads == 1 ? moved : first;
      EXPECT_TRUE(first == moved); // the same bits
    }
  }
}

// As while something is dragged. Afterwards the answer is the same as if it had not been.
TEST(SlidingWarp, ALooserToleranceComesAsNearAsItSays)
{
  const Block block(Eigen::Matrix3d::Identity());
  ThreadedMonitor monitor;
  SlidingWarp method, other;
  method.prepare(block.mesh, partitionNodes(block.mesh, block.prescribed), monitor);
  other.prepare(block.mesh, partitionNodes(block.mesh, block.prescribed), monitor);
  Points rough = block.moved, fine = block.moved, fresh = block.moved;
  method.slide(block.sliding, block.surfaces(), { 3, 1e-5 }, rough, monitor);
  method.slide(block.sliding, block.surfaces(), { 3 }, fine, monitor);
  other.slide(block.sliding, block.surfaces(), { 3 }, fresh, monitor);
  EXPECT_LT((rough - fine).cwiseAbs().maxCoeff(), 1e-4 * Side);
  EXPECT_GT((rough - fine).cwiseAbs().maxCoeff(), 1e-9 * Side);
  EXPECT_TRUE(fine == fresh); // the same bits
}

TEST(SlidingWarp, WithoutMotionKeepsTheBits)
{
  Block block(Eigen::Matrix3d::Identity());
  Points moved = block.mesh.points;
  ThreadedMonitor monitor;
  SlidingWarp method;
  method.prepare(block.mesh, partitionNodes(block.mesh, block.prescribed), monitor);
  EXPECT_TRUE(method.slide(block.sliding, block.surfaces(), { 3 }, moved, monitor).empty());
  EXPECT_TRUE(moved == block.mesh.points);
}
