// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Optimization/BlockCsr3f.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <memory>
#include <utility>
#include <vector>

namespace morph
{
/// An objective function of the free nodes' positions, to be minimized. Its values do not depend on
/// threads, bit for bit. On several processes value and gradient are those of the whole mesh.
class Objective
{
public:
  virtual ~Objective();

  /// Returns the ids of the nodes that move, in the order of the gradient's rows.
  virtual const std::vector<Index>& free() const = 0;

  struct Value
  {
    double energy = 0;   ///< infinite where the function is undefined
    bool allowed = true; ///< false: no step may end here
    bool enough = false; ///< a minimizer may end here
  };
  /// `points`: #nodes x 3.
  virtual Value value(const Points& points, Monitor& monitor) const = 0;
  /// `result`: becomes #free x 3, d(energy)/d(position).
  virtual void gradient(const Points& points, Points& result, Monitor& monitor) const = 0;
  /// Both at once, where that takes less than one after the other. `result` has no meaning where
  /// the value is not finite.
  virtual Value valueAndGradient(const Points& points, Points& result, Monitor& monitor) const;

  /// Lets the free nodes of a mesh that is a surface move in its plane, or in its tangent planes at
  /// `points` (#nodes x 3), alone: takes the normal part from a gradient, and from second
  /// derivatives, whose diagonal gets another one.
  ///@{
  void keepTangent(const Points& points, Points& gradient) const;
  void keepTangent(const Points& points, BlockCsr3f& hessian) const;
  ///@}
  /// Gives both images of the nodes of a curved layer, in a direction or a gradient, their mean.
  void moveAlike(Points& direction) const;

  /// The processes that have parts of the mesh, and the copies of the gradient's rows.
  const Communicator& communicator() const { return *this->communicator_; }
  const CopiedRows& rows() const { return *this->rows_; }

protected:
  /// Call it once free() is known. `communicator` has to outlive this object. `normal`: that of a
  /// plane mesh, or zero; `images`: rows of the gradient whose nodes are images of each other
  /// across a curved one, front first.
  void share(const Communicator& communicator, const std::vector<Index>& free,
    const Eigen::RowVector3d& normal, std::vector<std::pair<Index, Index>> images)
  {
    this->normal_ = normal;
    this->images_ = std::move(images);
    this->communicator_ = &communicator;
    this->rows_ = communicator.rows(free);
  }

private:
  const Communicator* communicator_ = &Communicator::alone();
  /// Calls act(row, normal of length 1) for rows that have one.
  template <typename Act>
  void forEachNormal(const Points& points, const Act& act) const;

  Eigen::RowVector3d normal_ = Eigen::RowVector3d::Zero();
  std::vector<std::pair<Index, Index>> images_;
  std::shared_ptr<const CopiedRows> rows_ = std::make_shared<CopiedRows>();
};

/// An objective with second derivatives, for Newton's method.
class SecondOrderObjective : public Objective
{
public:
  /// Computes a positive semi-definite approximation of the second derivatives, #free x #free
  /// blocks, of the cells of this process. It first opens a matrix that this objective has not
  /// filled before.
  virtual void hessian(const Points& points, BlockCsr3f& result, Monitor& monitor) const = 0;
};
}
