// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/CellBatches.h"
#include "Energies/TargetMatrices.h"
#include "Optimization/Objective.h"

#include <array>
#include <vector>

namespace morph
{
/// The untangling objective of Knupp: the mean over all tetrahedra of (|d - b| - (d - b))^2. d is a
/// tetrahedron's determinant relative to its target's, b the margin. d is Knupp's alpha over a
/// volume, so it does not depend on the sizes of the mesh and its cells. The objective is 0, and
/// flat, once all determinants exceed the margin. It leaves barely valid cells, so a shape measure
/// has to follow. Tetrahedra without a free node or with weight 0 are left out. Not thread-safe.
/// Source: P. M. Knupp, "Hexahedral and tetrahedral mesh untangling", Engineering with Computers 17
/// (2001) 261-268.
class UntangleEnergy : public Objective
{
public:
  /// `free`: ids of the nodes that move, ascending. `margin`: b, relative to the targets' volumes.
  /// Cost: passes over the cells; 8 bytes a tetrahedron and 50 a corner of a cell.
  UntangleEnergy(const Mesh& mesh, const std::vector<Index>& free, const TargetMatrices& targets,
    double margin, const Communicator& communicator = Communicator::alone());

  const std::vector<Index>& free() const override { return this->free_; }
  Value value(const Points& points, Monitor& monitor) const override;
  void gradient(const Points& points, Points& result, Monitor& monitor) const override;

  /// The tetrahedra of all batches, in order.
  struct Tetrahedra
  {
    std::vector<Index> first{ 0 }; ///< #batches + 1
    /// Of one in each cell of a batch: 1 / determinant of its target, with its sign; 0 if left out.
    std::vector<std::array<double, SimdWidth>> inverse;
    double margin;
    Index count = 0; ///< those that are not left out, of all processes
  };

private:
  std::vector<Index> free_;
  CellBatches batches_;
  Tetrahedra tetrahedra_;
  mutable Points parts_; ///< of the gradient, kept between calls
};
}
