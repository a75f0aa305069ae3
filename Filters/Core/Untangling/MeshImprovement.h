// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Energies/TargetMatrices.h"
#include "Mesh/NodePartition.h"
#include "Morpher/Morpher.h"
#include "Quality/MovableQuality.h"
#include "Support/Communicator.h"
#include "Untangling/NearUntangling.h"

#include <cstdint>
#include <vector>

namespace morph
{
struct ImprovementOptions
{
  /// of cells other than tetrahedra, as the user asks for it
  TargetConstruction target = TargetConstruction::Stretched;
  FoldoverContinuation::Minimizer minimizer = FoldoverContinuation::Minimizer::Newton;
  bool raising = true; ///< whether to raise the minimum; never for Initial
  /// whether the energy starts from the best mesh so far, and not from the first guess
  bool startsFromBest = true;
  bool nearOnly = false; ///< whether to leave a mesh that cannot be untangled near inverted cells
  int refreshes = 2;     ///< how often stretched targets are recomputed from the current mesh
  bool validAtRest = true;
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
  /// boundaryFaces() and classify(); not read with `nearOnly`.
  MeshImprovement(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
    const NodePartition& partition, const BoundaryFaces& boundary, const Classification& geometry,
    const ImprovementOptions& options, const Communicator& communicator = Communicator::alone());

  struct Outcome
  {
    bool untangled = false;
    bool kept = false;          ///< the result is the alternative
    std::vector<Index> onFolds; ///< inverted cells on folded faces of the boundary
    MinimizerEffort effort;
  };
  /// Improves `points`, #nodes x 3. `alternative`: a mesh that the result must not be worse than;
  /// `enough`: the part of the undeformed mesh's minimum with which a valid mesh is the result,
  /// without the energy of the whole mesh; 0 for a repair.
  Outcome run(Points& points, const Aim& aim, const Points& alternative, double enough,
    Monitor& monitor) const;

  MovableQuality quality() const;

private:
  /// The targets of all cells. `isTangled`: of the mesh that is minimised. All cells then count
  /// alike, so that those of a boundary layer are untangled, too; never for Initial.
  TargetMatrices targets(const Aim& aim, bool isTangled, Monitor& monitor) const;
  /// Returns the minimum scaled Jacobian beyond which raising it is of no use, as the boundary
  /// holds that of the whole mesh there; infinite where it does not.
  double goal(const MovableQuality& quality, const Points& points) const;
  bool raisesMinimum() const
  {
    return this->options_.raising && this->options_.target != TargetConstruction::Initial;
  }
  /// Raises the minimum over the cells near `repaired` ones; nodes elsewhere stay. `goal`: as of
  /// raiseMinimumQuality(). Cost: a pass over the mesh, then that of the cells within ten rings.
  void raiseNear(
    const std::vector<Index>& repaired, double goal, Points& points, Monitor& monitor) const;
  /// Untangles and improves `points` by the energy. Returns whether the mesh is valid. `best`: the
  /// minimum of the best mesh so far, 0 without a valid one.
  bool minimizeEnergy(const MovableQuality& quality, double goal, double best, const Aim& aim,
    Points& points, Outcome& outcome, Monitor& monitor) const;

  const Mesh& mesh_;
  const std::vector<std::int8_t>& orientation_;
  const NodePartition& partition_;
  const BoundaryFaces& boundary_;
  const Classification& geometry_;
  const ImprovementOptions options_;
  const Communicator& communicator_;
};

/// The part of the undeformed mesh's minimum that is enough for a morph.
constexpr double EnoughOfMinimum = 0.75;

/// Returns the power of two that makes a mesh's edges about 1 long. So no number depends on the
/// unit of length.
double unitEdgeScale(const Mesh& mesh, const Communicator& communicator = Communicator::alone());

/// Warns of what stays inverted, and returns the counts of InversionFree. `determined`: cells that
/// the boundary itself inverts, ascending. Ids are those of the whole mesh.
EvaluateReport reportImprovement(
  const MeshImprovement::Outcome& outcome, const std::vector<Index>& determined, Monitor& monitor);
}
