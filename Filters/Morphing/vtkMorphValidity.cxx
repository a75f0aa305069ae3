// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphValidity.h"

#include "BoundaryDetermined.h"
#include "CellShape.h"
#include "Error.h"
#include "InversionFree.h"
#include "ScaledJacobian.h"
#include "SubSteps.h"
#include "vtkMorphAlgorithm.h"

#include <algorithm>
#include <limits>
#include <sstream>

bool vtkMorphValidity::AsksForValidMesh() const
{
  return this->Mode >= vtkMorphAlgorithm::VALIDITY_SUB_STEP;
}

void vtkMorphValidity::RequireFeasible() const
{
  if (!this->AsksForValidMesh())
  {
    return;
  }
  morph::Points points = this->Mesh.points;
  for (std::size_t i = 0; i < this->Partition.prescribed.size(); ++i)
  {
    points.row(this->Partition.prescribed[i]) = this->Targets.row(static_cast<morph::Index>(i));
  }
  const std::vector<morph::Index> determined =
    morph::boundaryDeterminedInversions(this->Mesh, this->Partition, this->Orientation, points);
  if (!determined.empty())
  {
    throw morph::Error(
      "The boundary itself inverts " + std::to_string(determined.size()) +
      " cells at corners whose nodes it all prescribes, so no valid mesh exists: cell ids " +
      morph::listIds(determined) +
      ". Move the boundary less there, leave some of these nodes free, or set Validity to Report "
      "to see the mesh.");
  }
}

std::string vtkMorphValidity::Describe(const std::vector<morph::Index>& inverted,
  const morph::Quality& quality, const morph::Points& points) const
{
  constexpr std::size_t Most = 10;
  std::vector<morph::Index> worst = inverted;
  std::stable_sort(worst.begin(), worst.end(),
    [&](morph::Index a, morph::Index b)
    { return quality.scaledJacobian[a] < quality.scaledJacobian[b]; });
  worst.resize(std::min(worst.size(), Most));
  std::ostringstream text;
  for (morph::Index cell : worst)
  {
    Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
    const int corners = morph::cellShape(this->Mesh.types[cell])->numberOfCorners;
    for (int k = 0; k < corners; ++k)
    {
      centre += points.row(this->Mesh.cell(cell)[k]) / corners;
    }
    text << "\n  cell " << cell << " at (" << centre[0] << ", " << centre[1] << ", " << centre[2]
         << "), scaled Jacobian " << quality.scaledJacobian[cell];
  }
  text << (inverted.size() > worst.size() ? "\n  ...\n" : "\n");
  return text.str();
}

bool vtkMorphValidity::Repair(morph::Points& moved, morph::Monitor& monitor) const
{
  morph::InversionFree repair;
  repair.setReference(this->Reference);
  repair.prepare(this->Mesh, this->Partition, monitor);
  morph::Points repaired = moved;
  repair.repair(repaired, monitor);
  if (!morph::invertedCells(this->Mesh, repaired, this->Orientation, monitor).empty())
  {
    return false;
  }
  moved.swap(repaired);
  return true;
}

vtkMorphValidity::Outcome vtkMorphValidity::SubStep(
  const std::function<std::unique_ptr<morph::Morpher>()>& make, morph::Points& moved,
  morph::Monitor& monitor) const
{
  morph::SubStepLimits limits;
  limits.attempts = this->MaximumSubSteps;
  const morph::SubStepResult result = morph::followInSubSteps(this->Mesh, this->Reference,
    this->Partition, this->Orientation,
    morph::straightPath(this->Mesh.points, this->Partition, this->Targets), make, limits, monitor);
  moved = result.moved;
  Outcome outcome;
  outcome.Status = "SubStepped";
  outcome.LargestValidStep = result.reached;
  outcome.SubSteps = result.attempts;
  if (result.reached < 1)
  {
    std::ostringstream text;
    text << "No valid mesh was found for the whole motion: " << result.attempts
         << " steps came as far as " << result.reached
         << " of it, and the result is the valid mesh there. The next step inverted "
         << result.inverted.size() << " cells, at the result's places:"
         << this->Describe(result.inverted,
              morph::measureQuality(this->Mesh, result.moved, this->Orientation, {}, monitor),
              result.moved)
         << "Move the boundary less, or refine the mesh there.";
    outcome.Status = "Partial";
    outcome.Error = text.str();
  }
  return outcome;
}

vtkMorphValidity::Outcome vtkMorphValidity::Ensure(
  morph::Points& moved, morph::Monitor& monitor) const
{
  Outcome outcome;
  morph::Quality quality = morph::measureQuality(this->Mesh, moved, this->Orientation, {}, monitor);
  const std::vector<morph::Index> inverted = morph::invertedCells(quality);
  if (inverted.empty())
  {
    outcome.Measured = std::move(quality);
    return outcome;
  }
  const std::string found = std::to_string(inverted.size()) +
                            " cells are inverted or degenerate. The worst, with their centres:" +
                            this->Describe(inverted, quality, moved);
  switch (this->Mode)
  {
    case vtkMorphAlgorithm::VALIDITY_SUB_STEP:
      return this->SubStep(this->Make, moved, monitor);
    case vtkMorphAlgorithm::VALIDITY_REPAIR:
      if (this->Repair(moved, monitor))
      {
        outcome.Status = "Repaired";
        return outcome;
      }
      return this->SubStep([] { return std::make_unique<morph::InversionFree>(); }, moved, monitor);
    case vtkMorphAlgorithm::VALIDITY_REFUSE:
      throw morph::Error("The morph is refused: " + found +
                         "Set Validity to Repair or Sub Step, move the boundary less, or use "
                         "Morph Inversion Free.");
    case vtkMorphAlgorithm::VALIDITY_REPORT:
      outcome.Warning = found + "The output Bad cells holds them all. Morph Inversion Free, or "
                                "Validity set to Repair, keeps cells valid.";
      break;
    default:
      break;
  }
  outcome.Measured = std::move(quality);
  outcome.Status = "Inverted";
  outcome.LargestValidStep = std::numeric_limits<double>::quiet_NaN();
  return outcome;
}
