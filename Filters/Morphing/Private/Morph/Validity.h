// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"
#include "Morpher/IncrementalMorph.h"
#include "Morpher/Morpher.h"
#include "Quality/InvertedBefore.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace morph::filters
{
/// Treats the inverted cells that a motion makes, as vtkMorphAlgorithm::SetValidity() asks for.
class Validity
{
public:
  /// vtkMorphAlgorithm::ValidityType.
  int Mode = 0;
  morph::Index MaximumSubSteps = 0;
  const morph::Mesh& Mesh; ///< before the motion
  /// #nodes x 3, the undeformed mesh; see morph::Morpher::setReference()
  const morph::Points& Reference;
  /// of the undeformed mesh: cells that do not count unless they are worse; see BeforeFor()
  const morph::InvertedBefore& Before;
  const morph::NodePartition& Partition;
  const std::vector<std::int8_t>& Orientation;
  const morph::Points& Targets;      ///< #prescribed x 3
  const morph::BoundaryFaces& Faces; ///< of Mesh
  /// the method is the inversion-free one, which messages do not recommend to itself
  bool IsInversionFree = false;
  /// Makes a method with its options, not prepared yet.
  std::function<std::unique_ptr<morph::Morpher>()> Make;

  /// The error of a boundary that itself inverts cells: there is no result.
  struct Infeasible : morph::Error
  {
    Infeasible(const std::string& message, morph::Index cells)
      : Error(message)
      , Cells(cells)
    {
    }
    morph::Index Cells; ///< how many
  };

  struct Outcome
  {
    std::string Status = "Valid"; ///< see vtkMorphAlgorithm::GetMorphStatus()
    double LargestValidStep = 1;
    morph::Index SubSteps = 0;
    std::string Warning; ///< of inverted cells, where Mode asks for a report
    /// Not empty if the mesh has made a part of the motion, or if it is not valid as Mode asks.
    std::string Error;
    morph::Quality Measured; ///< of the method's own mesh where that is the result; else empty
  };

  /// Sub-steps that repair their meshes end after so many failures. Its failures take several times
  /// as long as its successes.
  static constexpr morph::Index RepairFailures = 6;

  /// Whether a mode wants no inverted cells, and whether it repairs.
  ///@{
  static bool AsksForValidMesh(int mode);
  static bool Repairs(int mode);
  ///@}
  /// What a mode judges by: the cells that were inverted `before`, or none if it repairs all.
  static const morph::InvertedBefore& BeforeFor(int mode, const morph::InvertedBefore& before);
  /// Throws Infeasible if the mode asks for a valid mesh and the boundary inverts these cells.
  static void RequireFeasible(int mode, const std::vector<morph::Index>& determined);
  /// A warning of cells that were inverted before and do not count in that mode, or nothing. `ids`:
  /// ascending.
  static std::string Note(int mode, const std::vector<morph::Index>& ids);

  /// The outcome of sub-steps. Where they have not made the whole motion, its error names what
  /// stopped them: `room`, what the boundary does where the next step is forbidden, as "leaves";
  /// `cells`, a text of where the cells are, to which a sentence may follow.
  static Outcome OfSubSteps(
    const morph::SubStepResult& result, const char* room, const std::string& cells);

  /// Throws Infeasible if Mode asks for a valid mesh and the targets themselves invert cells; the
  /// message names these cells. To be called before the method is evaluated.
  void RequireFeasible() const;
  /// Makes `moved`, #nodes x 3, the mesh that Mode asks for. If that is not found, it becomes the
  /// best mesh found, and Outcome::Error has the reason. Throws morph::Error where Mode refuses.
  Outcome Ensure(morph::Points& moved, morph::Monitor& monitor) const;

private:
  /// The inverted cells that count.
  std::vector<morph::Index> Inverted(
    const morph::Quality& quality, const morph::Points& points) const;
  std::vector<morph::Index> Inverted(const morph::Points& points, morph::Monitor& monitor) const;
  /// Describes the worst of these cells, a line for each.
  std::string Describe(const std::vector<morph::Index>& inverted, const morph::Quality& quality,
    const morph::Points& points) const;
  /// Repairs the mesh, if that leaves fewer cells that count. Returns whether none are left.
  bool Repair(morph::Points& moved, morph::Monitor& monitor) const;
  Outcome SubStep(const std::function<std::unique_ptr<morph::Morpher>()>& make,
    morph::Points& moved, morph::Monitor& monitor) const;
  /// The outcome of a mesh that stays invalid though Mode asks for a valid one. `reason`: why.
  Outcome Remaining(
    const morph::Points& moved, const std::string& reason, morph::Monitor& monitor) const;
  /// "N cells are inverted or degenerate ...", by the motion where others are, too, and the worst.
  std::string Found(const morph::Quality& quality, const morph::Points& points) const;
};
}
