// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Energies/TargetMatrices.h"
#include "Mesh/NodePartition.h"
#include "Morpher/Morpher.h"
#include "Quality/MovableQuality.h"
#include "Support/Communicator.h"
#include "Untangling/Untangling.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace morph
{
/// The most steps that raise the minimum scaled Jacobian, see raiseQuality().
struct RaisingSteps
{
  static constexpr int None = 0, Quick = 14, Default = 40, Thorough = 200;
};

struct ImprovementOptions
{
  int steps = RaisingSteps::Default;
  bool raisesValid = true; ///< whether the minimum of a mesh without inverted cells rises, too
  bool nearOnly = false;   ///< whether to leave a mesh that cannot be untangled near inverted cells
  double minimumAtRest = 0; ///< scaled Jacobian of the undeformed mesh
  /// for Newton's linear systems of the whole mesh, by unknownOrdering(); null: none
  const NodePreconditioner* preconditioner = nullptr;
};

/// Untangles and improves a mesh whose boundary has moved: the stages of InversionFree.h. On
/// several processes each has its own cells, and all take the same steps. Holds its arguments by
/// reference, but for the options.
class MeshImprovement
{
public:
  /// `mesh`: the reference shapes, with edges about 1 long, see unitEdgeScale(). `orientation`:
  /// #cells, see cellSigns() in Topology.h. `boundary`, `geometry`: of the mesh's outer faces, see
  /// boundaryFaces() and classify(); not read with `nearOnly`. `hopeless`: cells, ascending, that
  /// the boundary inverts (boundaryDeterminedInversions()): the others are improved without them.
  MeshImprovement(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
    const NodePartition& partition, const BoundaryFaces& boundary, const Classification& geometry,
    const std::vector<Index>& hopeless, const ImprovementOptions& options,
    const Communicator& communicator = Communicator::alone());

  struct Outcome
  {
    bool untangled = false;     ///< no cell is inverted but hopeless ones
    std::vector<Index> onFolds; ///< inverted cells on folded faces of the boundary
    MinimizerEffort effort;
  };
  /// Improves `points`, #nodes x 3. The result has no more inverted cells or, with as many, no
  /// lower minimum. `guide`: #nodes x 3, gives the targets' edge lengths. `target`: with which it
  /// is untangled; where that fails and the undeformed mesh is tangled, IdealSkew is next.
  /// `isRepair`: raises the minimum within ten rings of cells that were inverted alone.
  Outcome run(const Points& guide, TargetConstruction target, bool isRepair, Points& points,
    Monitor& monitor) const;

  MovableQuality quality() const;

private:
  /// Returns the minimum scaled Jacobian beyond which raising it is of no use, as the boundary
  /// holds that of the whole mesh there; infinite where it does not.
  double goal(const MovableQuality& quality, const Points& points) const;
  using Keep = std::function<bool(const Points& trial)>;
  /// Untangles from `start`, whose inverted cells are `inverted`. At a folded face of the boundary
  /// (see foldedFaces()) either its cell or the neighbors are inverted. The mesh is then first
  /// untangled without the tetrahedra on folded faces, and next without those that stay inverted at
  /// two or more fixed nodes; from there with all, near the inverted ones. Keeps what is better.
  /// Returns the cells on folds.
  std::vector<Index> untangle(const Aim& aim, const std::vector<Index>& inverted,
    const Points& start, const Keep& keepBetter, MinimizerEffort& effort, Monitor& monitor) const;
  const Mesh& mesh_;
  const std::vector<std::int8_t>& orientation_;
  const NodePartition& partition_;
  const BoundaryFaces& boundary_;
  const Classification& geometry_;
  const std::vector<Index>& hopeless_;
  const ImprovementOptions options_;
  const Communicator& communicator_;
};

/// Returns the power of two that makes a mesh's edges about 1 long. So no number depends on the
/// unit of length.
double unitEdgeScale(const Mesh& mesh, const Communicator& communicator = Communicator::alone());

/// Warns of what stays inverted, and returns the counts of InversionFree. `determined`: cells that
/// the boundary itself inverts, ascending. Ids are those of the whole mesh.
EvaluateReport reportImprovement(
  const MeshImprovement::Outcome& outcome, const std::vector<Index>& determined, Monitor& monitor);
}
