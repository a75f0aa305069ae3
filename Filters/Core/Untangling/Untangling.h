// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Energies/MeshEnergy.h"
#include "Energies/TargetMatrices.h"
#include "Mesh/NodePartition.h"
#include "Mesh/Topology.h"
#include "Untangling/FoldoverContinuation.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace morph
{
/// Makes the cells of a mesh valid by a foldover-free energy, as far as its boundary allows. At a
/// folded face of the boundary (see foldedFaces()) either its cell or the neighbors are inverted.
/// The mesh is then first untangled without the tetrahedra on folded faces, and from there with
/// them, only around these faces. Of the two results, the one with fewer inverted cells away from
/// folded faces is kept.
class Untangling
{
public:
  /// `mesh`: the reference shapes; `orientation`: #cells, see cellSigns() in Topology.h; `faces`,
  /// `geometry`: of the mesh's boundary, see boundaryFaces() and classify(). All but `partition`
  /// are held by reference.
  Untangling(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
    const NodePartition& partition, const BoundaryFaces& faces, const Classification& geometry,
    const Communicator& communicator = Communicator::alone());

  struct Result
  {
    bool valid = false;         ///< all tetrahedra are positive
    std::vector<Index> onFolds; ///< inverted cells on folded faces, ascending
  };
  /// Untangles `points`, #nodes x 3, start and result. `targets`: makes those of all cells. They
  /// are as large as what `energy` keeps of them, so they are made when needed and not held
  /// besides. `energy` may end with other targets.
  Result run(const std::function<TargetMatrices()>& targets, MeshEnergy& energy,
    FoldoverContinuation& stages, Points& points, Monitor& monitor) const;

private:
  struct InvertedCounts
  {
    Index others = 0, folds = 0; ///< of all processes
    std::vector<Index> onFolds;  ///< of this one
    bool operator<(const InvertedCounts& other) const;
  };
  /// Counts the inverted cells. `cellsBehind`: cells behind folded faces.
  InvertedCounts countInverted(
    const std::vector<Index>& cellsBehind, const Points& points, Monitor& monitor) const;
  /// Returns the cells behind faces, ascending.
  std::vector<Index> cellsBehind(const std::vector<Index>& folded) const;
  /// Excludes from `targets` the tetrahedra with two or more prescribed nodes that stay inverted,
  /// for a few rounds. Returns whether the others are positive.
  bool untangleAwayFromFolds(TargetMatrices& targets, MeshEnergy& energy,
    FoldoverContinuation& stages, Points& points, Monitor& monitor) const;
  /// Moves only the nodes near these cells. Returns whether the tetrahedra there are positive.
  bool untanglePatch(const std::vector<Index>& cells, int rings, const TargetMatrices& targets,
    FoldoverContinuation& stages, int most, Points& points, Monitor& monitor) const;

  const Mesh& mesh_;
  const std::vector<std::int8_t>& orientation_;
  const BoundaryFaces& faces_;
  const Classification& geometry_;
  const Communicator& communicator_;
  std::vector<Index> free_;
  std::vector<char> isFixed_; ///< #nodes
};
}
