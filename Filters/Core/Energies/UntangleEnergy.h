// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/CellBatches.h"
#include "Energies/TargetMatrices.h"
#include "Optimization/Objective.h"

#include <vector>

namespace morph
{
/// The untangling objective of P. M. Knupp, "Hexahedral and tetrahedral mesh untangling",
/// Engineering with Computers 17 (2001) 261-268: the mean over all tetrahedra of (|d - b| - (d -
/// b))^2, where d is the tetrahedron's determinant relative to its target's (his alpha over a
/// volume, so that the sizes of the mesh and of its cells do not matter) and b the margin. It is 0,
/// and flat, once all determinants are above the margin: what it leaves are barely valid cells, so
/// a shape measure has to follow. Tetrahedra without a free node and those of weight 0 are left
/// out. Not for two threads at once.
class UntangleEnergy : public Objective
{
public:
  /// `free`: ids of the nodes that move, ascending. `margin`: b, relative to the targets' volumes.
  /// Cost: passes over the cells; 8 bytes a tetrahedron and 50 a corner of a cell.
  UntangleEnergy(
    const Mesh& mesh, const std::vector<Index>& free, const TargetMatrices& targets, double margin);

  const std::vector<Index>& free() const override { return this->free_; }
  Value value(const Points& points, Monitor& monitor) const override;
  void gradient(const Points& points, Points& result, Monitor& monitor) const override;

  /// Of one tetrahedron in each cell of a batch: 1 / determinant of the target, with its sign; 0
  /// where the tetrahedron does not count.
  struct Volumes
  {
    double inverse[SimdWidth];
  };
  /// Those of each batch in turn.
  struct Tetrahedra
  {
    std::vector<Index> first{ 0 }; ///< #batches + 1
    std::vector<Volumes> volumes;
    double margin;
    Index count = 0; ///< that count
  };

private:
  std::vector<Index> free_;
  CellBatches batches_;
  Tetrahedra tetrahedra_;
  mutable Points parts_; ///< of the gradient, kept from call to call
};
}
