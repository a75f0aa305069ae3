// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/HangingNodes.h"
#include "Mesh/Topology.h"
#include "Morpher/Morpher.h"
#include "Quality/InvertedBefore.h"
#include "Quality/ScaledJacobian.h"
#include "Session/IncrementalMorph.h"
#include "Support/Communicator.h"
#include "Support/Error.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace morph
{
/// Treats the inverted cells that a motion makes. Holds its arguments by reference. On several
/// processes all functions but the static ones are collective, and meshes are this process's part.
class Validity
{
public:
  /// What becomes of inverted cells, in the order of the property Validity.
  enum class Mode
  {
    None,     ///< they are counted
    Report,   ///< the worst are named
    SubStep,  ///< the motion is halved, and ends before the boundary crosses itself, too
    Repair,   ///< the inversion-free method starts from the mesh; then sub-steps
    Refuse,   ///< Error
    RepairAll ///< as Repair, and cells that were inverted before are repaired, too
  };
  Mode mode = Mode::None;
  Index maximumSubSteps = 0;
  const Mesh& mesh; ///< before the motion
  /// #nodes x 3, the undeformed mesh; see Morpher::setReference()
  const Points& reference;
  /// of the undeformed mesh: cells that do not count unless they are worse; see beforeFor()
  const InvertedBefore& before;
  const NodePartition& partition;
  const std::vector<std::int8_t>& orientation; ///< #cells
  const Points& targets;                       ///< #prescribed x 3
  /// of `mesh`; on several processes none, so that folds and crossings are not foreseen
  const BoundaryFaces& faces;
  const HangingNodes& hanging; ///< of the same
  /// the method is the inversion-free one, which messages do not recommend to itself
  bool isInversionFree = false;
  /// Makes a method with its options, not prepared yet.
  std::function<std::unique_ptr<Morpher>()> make;
  /// Whether any process has polyhedra, or cells at divided faces.
  bool needsPieces = false;
  std::shared_ptr<const Communicator> processes = nullptr; ///< null for one

  /// The error of a boundary that itself inverts cells: there is no result.
  struct Infeasible : Error
  {
    Infeasible(const std::string& message, Index count)
      : Error(message)
      , cells(count)
    {
    }
    Index cells; ///< how many
  };

  struct Outcome
  {
    /// Valid, SubStepped, Repaired; Partial, where sub-steps have made a part of the motion;
    /// Inverted, or Unmeasured.
    std::string status = "Valid";
    double largestValidStep = 1; ///< the part of the motion that is made; NaN with inverted cells
    Index subSteps = 0;          ///< tried
    std::string warning = {};    ///< of inverted cells, where `mode` asks for a report
    /// Not empty if the mesh has made a part of the motion, or if it is not valid as `mode` asks.
    std::string error = {};
    Quality measured = {}; ///< of the method's own mesh where that is the result; else empty
  };

  /// Sub-steps that repair their meshes end after so many failures. Its failures take several times
  /// as long as its successes.
  static constexpr Index repairFailures = 6;

  /// Whether a mode wants no inverted cells, and whether it repairs.
  ///@{
  static bool asksForValidMesh(Mode mode) { return mode >= Mode::SubStep; }
  static bool repairs(Mode mode) { return mode == Mode::Repair || mode == Mode::RepairAll; }
  ///@}
  /// What a mode judges by: the cells that were inverted `before`, or none if it repairs all.
  static const InvertedBefore& beforeFor(Mode mode, const InvertedBefore& before);
  /// A warning of cells that were inverted before and do not count in that mode, or nothing. `ids`:
  /// ascending.
  static std::string note(Mode mode, const std::vector<Index>& ids);

  /// Throws Infeasible if `mode` asks for a valid mesh and the targets themselves invert cells; the
  /// message names these cells. To be called before the method is evaluated.
  void requireFeasible() const;
  /// Makes `moved`, #nodes x 3, the mesh that `mode` asks for. If that is not found, it becomes the
  /// best mesh found, and Outcome::error has the reason. Throws Error where `mode` refuses. Cost: a
  /// measure of the mesh; of invalid ones a repair, or morphIncrementally(), or both.
  Outcome ensure(Points& moved, Monitor& monitor) const;
  /// Repairs the mesh, if that leaves fewer cells that count, by the inversion-free method: cells
  /// near the bad ones first. Returns whether none are left.
  bool repair(Points& moved, Monitor& monitor) const;
  /// The quality of this process's own cells at `points`, #nodes x 3.
  Quality measure(const Points& points, Monitor& monitor) const;

private:
  const Communicator& all() const
  {
    return this->processes ? *this->processes : Communicator::alone();
  }
  Index count(const std::vector<Index>& cells) const;
  /// The numbers in the whole mesh of these cells of all processes, ascending, each once.
  std::vector<Index> idsOf(const std::vector<Index>& cells) const;
  /// The worst of these cells of all processes, `count` in all, a line each.
  std::string worst(const std::vector<Index>& cells, Index count, const Quality& quality,
    const Points& points) const;
  /// The outcome of sub-steps. Where they have not made the whole motion, its error names what
  /// stopped them.
  Outcome ofSubSteps(const SubStepResult& result, Monitor& monitor) const;
  /// This process's inverted cells that count.
  std::vector<Index> inverted(const Quality& quality, const Points& points) const;
  std::vector<Index> inverted(const Points& points, Monitor& monitor) const;
  Outcome subStep(
    const std::function<std::unique_ptr<Morpher>()>& make, Points& moved, Monitor& monitor) const;
  /// The outcome of a mesh that stays invalid though `mode` asks for a valid one. `reason`: why.
  Outcome remaining(const Points& moved, const std::string& reason, Monitor& monitor) const;
  /// "N cells are inverted or degenerate ...", and the worst of those that count, a line each.
  std::string found(const Quality& quality, const Points& points) const;
};
}
