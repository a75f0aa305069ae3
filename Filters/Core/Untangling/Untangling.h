// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Energies/MeshEnergy.h"
#include "Energies/TargetMatrices.h"
#include "Mesh/NodePartition.h"
#include "Mesh/Topology.h"
#include "Untangling/FoldoverContinuation.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Makes the cells of a mesh valid by a foldover-free energy, as far as its boundary allows. Where
/// the boundary is folded (see foldedFaces()) either the cell behind a folded face is inverted or
/// its neighbors are: then the mesh is untangled without the tetrahedra on folded faces, and around
/// these faces with them again from there; of the two results that with fewer inverted cells
/// besides those on folded faces is kept.
class Untangling
{
public:
  /// `mesh`: the reference shapes; `orientation`: #cells, see Topology's cellSigns(); `faces`,
  /// `geometry`: of the mesh's boundary, see boundaryFaces() and classify(). All but `partition`
  /// are held by reference.
  Untangling(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
    const NodePartition& partition, const BoundaryFaces& faces, const Classification& geometry);

  struct Result
  {
    bool valid = false;         ///< all tetrahedra are positive
    std::vector<Index> onFolds; ///< inverted cells on folded faces, ascending
  };
  /// `targets`: of all cells, to which `energy` may be set to others in the end; `points`: #nodes x
  /// 3, the start in, the result out.
  Result run(const TargetMatrices& targets, MeshEnergy& energy, FoldoverContinuation& stages,
    Points& points, Monitor& monitor) const;

private:
  struct InvertedCounts
  {
    Index others = 0;
    std::vector<Index> onFolds;
    bool operator<(const InvertedCounts& other) const;
  };
  /// The inverted cells. `cellsBehind`: those behind folded faces.
  InvertedCounts countInverted(
    const std::vector<Index>& cellsBehind, const Points& points, Monitor& monitor) const;
  /// Ids of the cells behind faces, ascending.
  std::vector<Index> cellsBehind(const std::vector<Index>& folded) const;
  /// Leaves out of `targets` what cannot be made positive at two or more prescribed nodes, for a
  /// few rounds. Returns whether the rest is positive.
  bool untangleAwayFromFolds(TargetMatrices& targets, MeshEnergy& energy,
    FoldoverContinuation& stages, Points& points, Monitor& monitor) const;
  /// Moves the nodes near these cells alone; returns whether the tetrahedra there are positive.
  bool untanglePatch(const std::vector<Index>& cells, const TargetMatrices& targets,
    FoldoverContinuation& stages, int most, Points& points, Monitor& monitor) const;

  const Mesh& mesh_;
  const std::vector<std::int8_t>& orientation_;
  const BoundaryFaces& faces_;
  const Classification& geometry_;
  std::vector<Index> free_;
  std::vector<char> isFixed_; ///< #nodes
};
}
