// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"

#include "Geometry/AffineFit.h"
#include "Solvers/CsrMatrix.h"

#include <array>
#include <vector>

namespace morph::distributed
{
/// morph::AffineGuess with rows distributed over ranks: an affine displacement field in each
/// connected component of the rows. It fits the prescribed nodes that the component is coupled
/// with. All functions are collective. Memory and messages: 200 bytes a component on each rank.
class AffineParts
{
public:
  AffineParts() = default;
  /// `rows`: local nodes of the rows that this rank owns. `interior`: #rows x #rows. `coupling`:
  /// #rows x (prescribed, ghosts); `prescribed`, `ghosts`: the local nodes of its columns.
  AffineParts(const DistributedMesh& mesh, const std::vector<Index>& rows,
    const CsrMatrix& interior, const CsrMatrix& coupling, const std::vector<Index>& prescribed,
    const std::vector<Index>& ghosts);

  Index count() const { return static_cast<Index>(this->count_.size()); }
  /// The component of each row, by the same numbers on all ranks.
  const std::vector<Index>& ofRow() const { return this->ofRow_; }
  /// Returns the fit of each component; `prescribed`: #prescribed x 3 displacements of this rank's
  /// prescribed nodes, ghosts included.
  std::vector<AffineFit> fits(const DistributedMesh& mesh, const Points& prescribed) const;

  /// A sum of forces on points of a component, and their moments about its center.
  struct Load
  {
    Eigen::RowVector3d force = Eigen::RowVector3d::Zero();
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  };
  void add(
    Load& load, Index component, const Eigen::RowVector3d& x, const Eigen::RowVector3d& force) const
  {
    load.force += force;
    load.moment += (x - this->center_[component]).transpose() * force;
  }
  /// The adjoint of the fits' displacements at the loads' points: adds the derivatives to
  /// `prescribed` (#prescribed x 3) at the nodes that this rank owns. `loads`: of this rank, for
  /// each component.
  void addTranspose(const DistributedMesh& mesh, std::vector<Load> loads, Points& prescribed) const;

private:
  struct Coupled
  {
    Index component, node; ///< a component, and a row of `prescribed` that this rank owns
  };
  void number(const DistributedMesh& mesh, const std::vector<Index>& rows,
    const CsrMatrix& interior, const CsrMatrix& coupling, const std::vector<Index>& ghosts,
    Index prescribed);
  void couple(const DistributedMesh& mesh, const CsrMatrix& coupling);

  std::vector<Index> ofRow_;
  std::vector<Index> prescribed_; ///< local nodes
  std::vector<Coupled> coupled_;
  std::vector<double> count_; ///< of coupled nodes, for each component
  std::vector<Eigen::RowVector3d> center_;
  std::vector<Eigen::Matrix3d> inverse_; ///< see PrincipalDirections
};
}
