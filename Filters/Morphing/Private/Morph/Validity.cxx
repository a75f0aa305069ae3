// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/Validity.h"

#include "Mesh/Polyhedra.h"
#include "Morpher/IncrementalMorph.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Private/Morph/PolyhedralRepair.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"
#include "Untangling/BoundaryCheck.h"
#include "Untangling/InversionFree.h"
#include "vtkMorphAlgorithm.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <utility>

namespace morph::filters
{
namespace
{
/// The mesh without some cells, whose nodes keep their numbers.
morph::Mesh withoutCells(const morph::Mesh& mesh, const morph::InvertedBefore& left)
{
  morph::Mesh rest;
  rest.points = mesh.points;
  rest.offsets = { 0 };
  for (morph::Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (!left.positivePlaces(c))
    {
      rest.types.push_back(mesh.types[c]);
      rest.connectivity.insert(
        rest.connectivity.end(), mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
      rest.offsets.push_back(static_cast<morph::Index>(rest.connectivity.size()));
    }
  }
  return rest;
}
}

bool Validity::AsksForValidMesh(int mode)
{
  return mode >= vtkMorphAlgorithm::VALIDITY_SUB_STEP;
}

bool Validity::Repairs(int mode)
{
  return mode == vtkMorphAlgorithm::VALIDITY_REPAIR ||
         mode == vtkMorphAlgorithm::VALIDITY_REPAIR_ALL;
}

const morph::InvertedBefore& Validity::BeforeFor(int mode, const morph::InvertedBefore& before)
{
  static const morph::InvertedBefore none{};
  return mode == vtkMorphAlgorithm::VALIDITY_REPAIR_ALL ? none : before;
}

void Validity::RequireFeasible(int mode, const std::vector<morph::Index>& determined)
{
  if (AsksForValidMesh(mode) && !determined.empty())
  {
    throw Infeasible(
      "The boundary itself inverts " + std::to_string(determined.size()) +
        " cells, at corners that no free node can mend, so no valid mesh exists: "
        "cell ids " +
        morph::listIds(determined) +
        ". Move the boundary less there, leave some of its nodes free, or set Validity "
        "to Report to see the mesh.",
      static_cast<morph::Index>(determined.size()));
  }
}

std::string Validity::Note(int mode, const std::vector<morph::Index>& ids)
{
  if (mode == vtkMorphAlgorithm::VALIDITY_NONE || mode == vtkMorphAlgorithm::VALIDITY_REPAIR_ALL ||
      ids.empty())
  {
    return {};
  }
  return std::to_string(ids.size()) +
         " cells of the undeformed mesh are inverted or degenerate. Unless they become worse, they "
         "do not count as inverted by the motion: cell ids " +
         morph::listIds(ids) + ". Validity set to Repair all repairs them, too.";
}

void Validity::RequireFeasible() const
{
  if (!AsksForValidMesh(this->Mode))
  {
    return;
  }
  morph::Points points = this->Mesh.points;
  for (std::size_t i = 0; i < this->Partition.prescribed.size(); ++i)
  {
    points.row(this->Partition.prescribed[i]) = this->Targets.row(static_cast<morph::Index>(i));
  }
  RequireFeasible(this->Mode, this->Before.without(morph::boundaryDeterminedInversions(
                                this->Mesh, this->Partition, this->Orientation, points)));
}

std::vector<morph::Index> Validity::Inverted(
  const morph::Quality& quality, const morph::Points& points) const
{
  return this->Before.added(points, morph::invertedCells(quality));
}

std::vector<morph::Index> Validity::Inverted(
  const morph::Points& points, morph::Monitor& monitor) const
{
  return this->Before.added(
    points, morph::invertedCells(this->Mesh, points, this->Orientation, monitor));
}

std::string Validity::Describe(const std::vector<morph::Index>& inverted,
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
    Eigen::RowVector3d center = Eigen::RowVector3d::Zero();
    const morph::Index corners =
      morph::cornerCount(this->Mesh, cell, *morph::cellShape(this->Mesh.types[cell]));
    for (morph::Index k = 0; k < corners; ++k)
    {
      center += points.row(this->Mesh.cell(cell)[k]) / static_cast<double>(corners);
    }
    text << "\n  cell " << cell << " at (" << center[0] << ", " << center[1] << ", " << center[2]
         << "), scaled Jacobian " << quality.scaledJacobian[cell];
  }
  text << (inverted.size() > worst.size() ? "\n  ...\n" : "\n");
  return text.str();
}

std::string Validity::Found(const morph::Quality& quality, const morph::Points& points) const
{
  const std::vector<morph::Index> inverted = this->Inverted(quality, points);
  const bool countsAll = inverted.size() == morph::invertedCells(quality).size();
  return std::to_string(inverted.size()) + " cells are inverted or degenerate" +
         (countsAll ? "" : " by the motion") +
         ". The worst, with their centers:" + this->Describe(inverted, quality, points);
}

Validity::Outcome Validity::OfSubSteps(
  const morph::SubStepResult& result, const char* room, const std::string& cells)
{
  Outcome outcome;
  outcome.Status = "SubStepped";
  outcome.LargestValidStep = result.reached;
  outcome.SubSteps = result.attempts;
  if (result.reached < 1)
  {
    std::ostringstream text;
    text << "No valid mesh was found for the whole motion: " << result.attempts
         << " steps came as far as " << result.reached
         << " of it, and the result is the valid mesh there. ";
    if (result.isForbidden)
    {
      text << "The boundary then " << room << " no room to ";
    }
    else
    {
      text << "The next step inverted ";
    }
    text << result.inverted.size() << " cells" << cells
         << (result.isForbidden
                ? "Mend the boundary there, move it less, or give it another path by steps of its "
                  "own."
                : "Move the boundary less, or refine the mesh there.");
    outcome.Status = "Partial";
    outcome.Error = text.str();
  }
  return outcome;
}

bool Validity::Repair(morph::Points& moved, morph::Monitor& monitor) const
{
  const auto bad = [&](const morph::Points& points)
  { return this->Inverted(points, monitor).size(); };
  if (morph::hasPolyhedra(this->Mesh))
  {
    return PolyhedralRepair::Run(this->Mesh, this->Reference, this->Partition, bad, moved, monitor);
  }
  std::size_t least = bad(moved);
  // Near the inverted cells at first: the linear methods of the whole mesh take far longer. Cells
  // that were inverted before are not seen there: they would be repaired, too, or nothing would.
  const bool leavesSome = !this->Before.cells().empty();
  const morph::Mesh others = leavesSome ? withoutCells(this->Mesh, this->Before) : morph::Mesh();
  const morph::NodePartition ofOthers =
    leavesSome ? morph::partitionNodes(others, this->Partition.prescribed) : morph::NodePartition();
  const double end[] = { 0, 0.2, 1 };
  for (int attempt = 0; attempt < 2 && least > 0; ++attempt)
  {
    const double begin = end[attempt], middle = begin + 0.3 * (end[attempt + 1] - begin);
    morph::ProgressRange first(monitor, begin, middle), second(monitor, middle, end[attempt + 1]);
    morph::InversionFree repair;
    repair.setReference(this->Reference);
    repair.setNearOnly(attempt == 0);
    const bool seesOthers = leavesSome && attempt == 0;
    repair.prepare(
      seesOthers ? others : this->Mesh, seesOthers ? ofOthers : this->Partition, first);
    morph::Points repaired = moved;
    repair.repair(repaired, second);
    const std::size_t left = bad(repaired);
    if (left < least)
    {
      moved.swap(repaired);
      least = left;
    }
  }
  return least == 0;
}

Validity::Outcome Validity::Remaining(
  const morph::Points& moved, const std::string& reason, morph::Monitor& monitor) const
{
  Outcome outcome;
  outcome.Measured = morph::measureQuality(this->Mesh, moved, this->Orientation, {}, monitor);
  outcome.Status = "Inverted";
  outcome.LargestValidStep = std::numeric_limits<double>::quiet_NaN();
  outcome.Error = "No valid mesh was found, and the result is the best that was: " +
                  this->Found(outcome.Measured, moved) + reason;
  return outcome;
}

Validity::Outcome Validity::SubStep(const std::function<std::unique_ptr<morph::Morpher>()>& make,
  morph::Points& moved, morph::Monitor& monitor) const
{
  const bool repairs = this->IsInversionFree || Repairs(this->Mode);
  const std::vector<morph::Index> atRest = this->Inverted(this->Mesh.points, monitor);
  if (!atRest.empty())
  {
    return this->Remaining(moved,
      "The undeformed mesh has inverted or degenerate cells, too, so there is no valid mesh to "
      "take steps from: cell ids " +
        morph::listIds(atRest) +
        (repairs ? ". Mend the mesh or the boundary there, or leave more nodes free."
                 : ". Repair it first, its boundary held, by Morph Inversion Free."),
      monitor);
  }
  const morph::BoundaryPath path =
    morph::straightPath(this->Mesh.points, this->Partition, this->Targets);
  const morph::BoundaryCheck check(
    this->Mesh, this->Partition, this->Orientation, this->Faces, monitor);
  morph::SubStepLimits limits;
  limits.attempts = this->MaximumSubSteps;
  if (repairs)
  {
    limits.failures = RepairFailures;
  }
  limits.forbidden = [&](double time) { return check.at(path(time)).all(this->Before); };
  const morph::SubStepResult result = morph::morphIncrementally(this->Mesh, this->Reference,
    this->Partition, this->Orientation, this->Before, path, make, limits, monitor);
  moved = result.moved;
  if (result.reached >= 1)
  {
    return OfSubSteps(result, "", "");
  }
  Outcome outcome = OfSubSteps(result, "folds, or leaves",
    ", at the result's places:" +
      this->Describe(result.inverted,
        morph::measureQuality(this->Mesh, result.moved, this->Orientation, {}, monitor),
        result.moved));
  if (!result.isForbidden && !this->IsInversionFree &&
      this->Mode == vtkMorphAlgorithm::VALIDITY_SUB_STEP)
  {
    outcome.Error += " Validity set to Repair often goes all the way where sub-steps stop.";
  }
  return outcome;
}

Validity::Outcome Validity::Ensure(morph::Points& moved, morph::Monitor& monitor) const
{
  Outcome outcome;
  morph::Quality quality = morph::measureQuality(this->Mesh, moved, this->Orientation, {}, monitor);
  if (this->Inverted(quality, moved).empty())
  {
    outcome.Measured = std::move(quality);
    return outcome;
  }
  if (AsksForValidMesh(this->Mode) && this->Mode != vtkMorphAlgorithm::VALIDITY_REFUSE &&
      this->Partition.free.empty())
  {
    return this->Remaining(
      moved, "Every node is prescribed, so the boundary alone decides.", monitor);
  }
  switch (this->Mode)
  {
    case vtkMorphAlgorithm::VALIDITY_SUB_STEP:
      return this->SubStep(this->Make, moved, monitor);
    case vtkMorphAlgorithm::VALIDITY_REPAIR:
    case vtkMorphAlgorithm::VALIDITY_REPAIR_ALL:
    {
      morph::ProgressRange first(monitor, 0, 0.5), second(monitor, 0.5, 1);
      if (this->Repair(moved, first))
      {
        outcome.Status = "Repaired";
        return outcome;
      }
      const auto make = [this]() -> std::unique_ptr<morph::Morpher>
      {
        auto method = std::make_unique<morph::InversionFree>();
        if (!morph::hasPolyhedra(this->Mesh))
        {
          return method;
        }
        return morph::morpherForPolyhedra(std::move(method));
      };
      return this->SubStep(make, moved, second);
    }
    case vtkMorphAlgorithm::VALIDITY_REFUSE:
    {
      const std::string text =
        "The morph is refused: " + this->Found(quality, moved) +
        (this->IsInversionFree
            ? "Set Validity to Sub Step, or move the boundary less."
            : "Set Validity to Repair or Sub Step, move the boundary less, or use Morph Inversion "
              "Free.");
      throw morph::Error(text);
    }
    case vtkMorphAlgorithm::VALIDITY_REPORT:
      outcome.Warning =
        this->Found(quality, moved) + "The output Bad cells holds them all. " +
        (this->IsInversionFree
            ? "Move the boundary less, or in relative steps."
            : "Morph Inversion Free, or Validity set to Repair, keeps cells valid.");
      break;
    default:
      break;
  }
  outcome.Measured = std::move(quality);
  outcome.Status = "Inverted";
  outcome.LargestValidStep = std::numeric_limits<double>::quiet_NaN();
  return outcome;
}
}
