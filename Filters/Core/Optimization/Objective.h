// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Optimization/BlockCsr3f.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <memory>
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

  /// Lets the free nodes of a plane mesh move in their plane alone: takes the normal part from a
  /// gradient, and from second derivatives, whose diagonal gets another one.
  ///@{
  void keepInPlane(Points& gradient) const;
  void keepInPlane(BlockCsr3f& hessian) const;
  ///@}

  /// The processes that have parts of the mesh, and the copies of the gradient's rows.
  const Communicator& communicator() const { return *this->communicator_; }
  const CopiedRows& rows() const { return *this->rows_; }

protected:
  /// Call it once free() is known. `communicator` has to outlive this object. `normal`: that of the
  /// mesh's layer.
  void share(const Communicator& communicator, const std::vector<Index>& free,
    const Eigen::RowVector3d& normal)
  {
    this->normal_ = normal;
    this->communicator_ = &communicator;
    this->rows_ = communicator.rows(free);
  }

private:
  const Communicator* communicator_ = &Communicator::alone();
  Eigen::RowVector3d normal_ = Eigen::RowVector3d::Zero();
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
