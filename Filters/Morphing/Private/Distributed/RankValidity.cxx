// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/RankValidity.h"

#include "Distributed/RankCommunicator.h"
#include "Morpher/IncrementalMorph.h"
#include "Private/Distributed/RankPolyhedra.h"
#include "Private/Distributed/RankQuality.h"
#include "Quality/BoundaryDetermined.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace morph::filters
{
/// The cells, by global ids, that the targets invert.
std::vector<morph::Index> RankValidity::DeterminedBy(const morph::Points& targets) const
{
  morph::Points points = this->Mesh.mesh().points;
  points(this->Partition.prescribed, morph::allColumns) = targets;
  std::vector<morph::Index> cells;
  this->Mesh.ranks().together(
    [&]
    {
      cells = morph::boundaryDeterminedInversions(
        this->Mesh.mesh(), this->Partition, this->Mesh.orientation(), points);
    });
  return this->Mesh.gatherCells(this->Before.without(cells));
}

/// These, and the cells around nodes that the targets leave no place.
std::vector<morph::Index> RankValidity::ForbiddenBy(
  const morph::Points& targets, morph::Monitor& monitor) const
{
  morph::Points points = this->Mesh.mesh().points;
  points(this->Partition.prescribed, morph::allColumns) = targets;
  std::vector<morph::Index> ids;
  this->Mesh.ranks().together(
    [&]
    {
      monitor.check();
      for (const morph::NodeWithoutPlace& node : morph::nodesWithoutPlace(
             this->Mesh.mesh(), this->Partition, this->Mesh.orientation(), points, monitor))
      {
        // All cells around a node are on the rank that owns it.
        const bool isNew = this->Before.without(node.cells).size() == node.cells.size();
        for (const morph::Index cell : node.cells)
        {
          if (isNew && this->Mesh.owns(node.node))
          {
            ids.push_back(this->Mesh.cellId(cell));
          }
        }
      }
    });
  ids = this->Mesh.ranks().gather(ids);
  const std::vector<morph::Index> determined = this->DeterminedBy(targets);
  ids.insert(ids.end(), determined.begin(), determined.end());
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

morph::Index RankValidity::RequireFeasible() const
{
  const std::vector<morph::Index> determined = this->DeterminedBy(this->Targets);
  morph::Validity::requireFeasible(this->Options.validity, determined);
  return static_cast<morph::Index>(determined.size());
}

morph::Validity::Outcome RankValidity::Remaining(
  const morph::Points& moved, const std::string& reason, morph::Monitor& monitor) const
{
  morph::Validity::Outcome outcome{ "Inverted", std::numeric_limits<double>::quiet_NaN() };
  outcome.error = "No valid mesh was found, and the result is the best that was: " +
                  RankQuality::Found(this->Mesh,
                    RankQuality::Measure(this->Mesh, moved, this->Before, monitor), moved) +
                  reason;
  return outcome;
}

morph::Validity::Outcome RankValidity::SubStep(morph::Points& moved, morph::Monitor& monitor) const
{
  const morph::Points& rest = this->Mesh.mesh().points;
  const auto inverted = [&](const morph::Points& points)
  {
    return this->Mesh.gatherCells(
      RankQuality::Measure(this->Mesh, points, this->Before, monitor).Added);
  };
  const std::vector<morph::Index> atRest = inverted(rest);
  if (!atRest.empty())
  {
    return this->Remaining(moved,
      "The undeformed mesh has inverted or degenerate cells, too, so there is no valid mesh to "
      "take steps from: cell ids " +
        morph::listIds(atRest) + ". Repair it first, its boundary held, by Morph Inversion Free.",
      monitor);
  }
  const morph::BoundaryPath path = morph::straightPath(rest, this->Partition, this->Targets);
  morph::SubStepLimits limits;
  limits.attempts = this->Options.maximumSubSteps;
  const bool repairs = morph::Validity::repairs(this->Options.validity);
  if (repairs)
  {
    limits.failures = morph::Validity::repairFailures;
  }
  limits.forbidden = [&](double time) { return this->ForbiddenBy(path(time), monitor); };
  const auto attempt = [&](const morph::Points& from, double time, morph::Monitor& part)
  {
    morph::ProgressRange first(part, 0, 0.5), second(part, 0.5, 1);
    const morph::distributed::DistributedMesh valid = this->Mesh.at(from);
    const std::unique_ptr<morph::Morpher> method = this->Make();
    method->setReference(this->Reference);
    method->prepare(valid.mesh(), this->Partition, first,
      std::make_shared<morph::distributed::RankCommunicator>(valid));
    morph::SubStepAttempt made;
    made.report = method->evaluate(path(time), made.moved, second);
    if (repairs)
    {
      RankPolyhedra::Repair(
        valid, this->Reference, this->Partition, this->NeedsPieces, this->Before, made.moved, part);
    }
    made.inverted = inverted(made.moved);
    return made;
  };
  const morph::SubStepResult result = morph::takeSubSteps(rest, limits, attempt, monitor);
  moved = result.moved;
  return morph::Validity::ofSubSteps(
    result, "leaves", ": cell ids " + morph::listIds(result.inverted) + ". ");
}

morph::Validity::Outcome RankValidity::Ensure(morph::Points& moved, morph::Monitor& monitor) const
{
  const RankQuality::Measured measured =
    RankQuality::Measure(this->Mesh, moved, this->Before, monitor);
  if (measured.AddedOfAll == 0)
  {
    return {};
  }
  const morph::Validity::Mode mode = this->Options.validity;
  const morph::Index free =
    this->Mesh.ranks().sum(static_cast<morph::Index>(this->Partition.free.size()));
  const bool repairs = morph::Validity::repairs(mode);
  if (free == 0 && (repairs || mode == morph::Validity::Mode::SubStep))
  {
    return this->Remaining(
      moved, "Every node is prescribed, so the boundary alone decides.", monitor);
  }
  if (repairs)
  {
    morph::ProgressRange first(monitor, 0, 0.5), second(monitor, 0.5, 1);
    const morph::distributed::RepairReport report = RankPolyhedra::Repair(
      this->Mesh, this->Reference, this->Partition, this->NeedsPieces, this->Before, moved, first);
    if (report.bad == 0)
    {
      return { "Repaired" };
    }
    if (report.tooLarge > 0)
    {
      return this->Remaining(moved,
        "On MPI ranks bad cells are repaired in patches, each on one rank. The patches would "
        "have " +
          std::to_string(report.tooLarge) + " cells of " + std::to_string(report.cells) +
          "; at most a quarter may be gathered. Set `Validity` to Sub Step, move the boundary "
          "less, "
          "or run on one rank.",
        monitor);
    }
    return this->SubStep(moved, second);
  }
  if (mode == morph::Validity::Mode::SubStep)
  {
    return this->SubStep(moved, monitor);
  }
  if (mode == morph::Validity::Mode::Refuse)
  {
    throw morph::Error("The morph is refused: " + RankQuality::Found(this->Mesh, measured, moved) +
                       "Set `Validity` to Repair or Sub Step, or move the boundary less.");
  }
  morph::Validity::Outcome outcome{ "Inverted", std::numeric_limits<double>::quiet_NaN() };
  if (mode == morph::Validity::Mode::Report)
  {
    outcome.warning = RankQuality::Found(this->Mesh, measured, moved) +
                      "The output Bad cells holds them all. `Validity` set to Repair keeps cells "
                      "valid.";
  }
  return outcome;
}
}
