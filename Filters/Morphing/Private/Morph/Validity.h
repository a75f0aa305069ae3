// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"
#include "Morpher/Morpher.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace morph::filters
{
/// What vtkMorphAlgorithm does where a method leaves inverted cells.
class Validity
{
public:
  /// vtkMorphAlgorithm::ValidityType.
  int Mode = 0;
  morph::Index MaximumSubSteps = 0;
  const morph::Mesh& Mesh; ///< before the motion
  /// #nodes x 3, the undeformed mesh; see morph::Morpher::setReference()
  const morph::Points& Reference;
  const morph::NodePartition& Partition;
  const std::vector<std::int8_t>& Orientation;
  const morph::Points& Targets;      ///< #prescribed x 3
  const morph::BoundaryFaces& Faces; ///< of Mesh
  /// the method is the inversion-free one, which is not told to use itself
  bool IsInversionFree = false;
  /// A method with its options, not prepared yet.
  std::function<std::unique_ptr<morph::Morpher>()> Make;

  /// No result, since the boundary itself inverts cells.
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
    /// Not empty: the mesh has not gone all the way, or Mode asks for a valid one and it is not.
    std::string Error;
    morph::Quality Measured; ///< of the method's own mesh where that is the result; else empty
  };

  /// Before the method is evaluated, where Mode asks for a valid mesh: throws Infeasible naming
  /// the
  /// cells that the targets themselves invert.
  void RequireFeasible() const;
  /// After that: `moved`, #nodes x 3, becomes what Mode asks for or, where that is not found, the
  /// best mesh that was; Outcome::Error says so. Throws morph::Error where it is refused.
  Outcome Ensure(morph::Points& moved, morph::Monitor& monitor) const;

private:
  bool AsksForValidMesh() const;
  /// The worst of these cells, a line for each.
  std::string Describe(const std::vector<morph::Index>& inverted, const morph::Quality& quality,
    const morph::Points& points) const;
  /// Takes a repaired mesh over where it has fewer bad cells. Returns whether none are left.
  bool Repair(morph::Points& moved, morph::Monitor& monitor) const;
  Outcome SubStep(const std::function<std::unique_ptr<morph::Morpher>()>& make,
    morph::Points& moved, morph::Monitor& monitor) const;
  /// Of a mesh that stays as it is though Mode asks for a valid one. `reason`: why it does.
  Outcome Remaining(
    const morph::Points& moved, const std::string& reason, morph::Monitor& monitor) const;
  /// "N cells are inverted or degenerate ...", and the worst of them.
  std::string Found(const morph::Quality& quality, const morph::Points& points) const;
};
}
