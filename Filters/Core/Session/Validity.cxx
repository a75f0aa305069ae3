// SPDX-License-Identifier: BSD-3-Clause
#include "Session/Validity.h"

#include "Mesh/CellShape.h"
#include "Mesh/OwnCells.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/ShellLayer.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Quality/BoundaryDetermined.h"
#include "Quality/ScaledJacobian.h"
#include "Session/AfterMotion.h"
#include "Session/IncrementalMorph.h"
#include "Support/Error.h"
#include "Support/Lists.h"
#include "Support/Monitor.h"
#include "Untangling/BoundaryCheck.h"
#include "Untangling/InversionFree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>
#include <utility>

namespace morph
{
namespace
{
/// The mesh with a vertex, which no method reads, in the place of some cells.
Mesh withoutCells(const Mesh& mesh, const InvertedBefore& left)
{
  Mesh rest;
  rest.points = mesh.points;
  rest.layer = mesh.layer;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const bool isLeft = left.positivePlaces(c) != nullptr;
    rest.add(isLeft ? std::uint8_t(Vertex) : mesh.types[c], mesh.cell(c),
      mesh.cell(c) + (isLeft ? 1 : mesh.cellSize(c)));
  }
  return rest;
}
}

const InvertedBefore& Validity::beforeFor(Mode mode, const InvertedBefore& before)
{
  static const InvertedBefore none{};
  return mode == Mode::RepairAll ? none : before;
}

std::string Validity::note(Mode mode, const std::vector<Index>& ids)
{
  if (mode == Mode::None || mode == Mode::RepairAll || ids.empty())
  {
    return {};
  }
  return std::to_string(ids.size()) +
         " cells of the undeformed mesh are inverted or degenerate. Unless they become worse, they "
         "do not count as inverted by the motion: cell ids " +
         listIds(ids) + ". `Validity` set to Repair all repairs them, too.";
}

void Validity::requireFeasible() const
{
  if (!asksForValidMesh(this->mode))
  {
    return;
  }
  Points points = this->mesh.points;
  points(this->partition.prescribed, allColumns) = this->targets;
  const std::vector<Index> determined = this->all().gatherCells(this->before.without(
    boundaryDeterminedInversions(this->mesh, this->partition, this->orientation, points)));
  if (!determined.empty())
  {
    throw Infeasible(
      "The boundary itself inverts " + std::to_string(determined.size()) +
        " cells, at corners that no free node can mend, so no valid mesh exists: "
        "cell ids " +
        listIds(determined) +
        ". Move the boundary less there, leave some of its nodes free, or set `Validity` "
        "to Report to see the mesh.",
      static_cast<Index>(determined.size()));
  }
}

Quality Validity::measure(const Points& points, Monitor& monitor) const
{
  return measureQuality(
    this->mesh, points, this->orientation, OwnCells::others(this->mesh, this->all()), monitor);
}

Index Validity::count(const std::vector<Index>& cells) const
{
  return this->all().sum(static_cast<Index>(cells.size()));
}

std::vector<Index> Validity::idsOf(const std::vector<Index>& cells) const
{
  const std::vector<Index> own = this->all().idsOfCells(cells);
  const std::vector<double> numbers =
    this->all().gather(std::vector<double>(own.begin(), own.end()));
  std::vector<Index> ids(numbers.begin(), numbers.end());
  sortUnique(ids);
  return ids;
}

std::vector<Index> Validity::inverted(const Quality& quality, const Points& points) const
{
  return this->before.added(points, invertedCells(quality));
}

std::vector<Index> Validity::inverted(const Points& points, Monitor& monitor) const
{
  return this->inverted(this->measure(points, monitor), points);
}

std::string Validity::worst(
  const std::vector<Index>& cells, Index count, const Quality& quality, const Points& points) const
{
  constexpr std::size_t MostNamed = 10;
  using Named = std::array<double, 5>; // the scaled Jacobian, the id in the whole mesh, the center
  std::vector<Named> named;
  const std::vector<Index> ids = this->all().idsOfCells(cells);
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    const Index cell = cells[i];
    Eigen::RowVector3d center = Eigen::RowVector3d::Zero();
    const bool isPrism = this->mesh.layer.nodes > 0; // of whose front it is
    const Index corners =
      cornerCount(this->mesh, cell, *cellShape(this->mesh.types[cell])) / (isPrism ? 2 : 1);
    for (Index k = 0; k < corners; ++k)
    {
      center += points.row(this->mesh.cell(cell)[k]) / static_cast<double>(corners);
    }
    named.push_back({ quality.scaledJacobian[cell], static_cast<double>(ids[i]), center[0],
      center[1], center[2] });
  }
  const auto keepWorst = [&]
  {
    std::sort(named.begin(), named.end());
    named.resize(std::min(named.size(), MostNamed));
  };
  keepWorst();
  std::vector<double> numbers;
  for (const Named& cell : named)
  {
    numbers.insert(numbers.end(), cell.begin(), cell.end());
  }
  numbers = this->all().gather(numbers);
  named.resize(numbers.size() / 5);
  for (std::size_t i = 0; i < named.size(); ++i)
  {
    std::copy_n(numbers.begin() + 5 * static_cast<std::ptrdiff_t>(i), 5, named[i].begin());
  }
  keepWorst();
  std::ostringstream text;
  for (const auto& [jacobian, id, x, y, z] : named)
  {
    text << "\n  cell " << static_cast<Index>(id) << " at (" << x << ", " << y << ", " << z
         << "), scaled Jacobian " << jacobian;
  }
  text << (count > static_cast<Index>(named.size()) ? "\n  ...\n" : "\n");
  return text.str();
}

std::string Validity::found(const Quality& quality, const Points& points) const
{
  const std::vector<Index> inverted = this->inverted(quality, points);
  const Index count = this->count(inverted), all = this->count(invertedCells(quality));
  return std::to_string(count) + " cells are inverted or degenerate" +
         (count == all ? "" : " by the motion") +
         ". The worst, with their centers:" + this->worst(inverted, count, quality, points);
}

Validity::Outcome Validity::ofSubSteps(const SubStepResult& result, Monitor& monitor) const
{
  Outcome outcome{ "SubStepped", result.reached, result.attempts };
  if (result.reached < 1)
  {
    std::ostringstream text;
    text << "No valid mesh was found for the whole motion: " << result.attempts
         << " steps came as far as " << result.reached
         << " of it, and the result is the valid mesh there. ";
    if (result.isForbidden)
    {
      text << "The boundary then folds, runs into itself, or leaves no room to ";
    }
    else
    {
      text << "The next step inverted ";
    }
    const std::vector<Index> cells = this->all().cellsOf(result.inverted);
    text << result.inverted.size() << " cells, at the result's places:"
         << this->worst(cells, static_cast<Index>(result.inverted.size()),
              this->measure(result.moved, monitor), result.moved)
         << (result.isForbidden
                ? "Mend the boundary there, move it less, or give it another path by steps of its "
                  "own."
                : "Move the boundary less, or refine the mesh there.");
    outcome.status = "Partial";
    outcome.error = text.str();
  }
  return outcome;
}

bool Validity::repair(Points& moved, Monitor& monitor) const
{
  const auto bad = [&](const Points& points) { return this->inverted(points, monitor); };
  if (this->needsPieces)
  {
    return repairPolyhedra(this->mesh, this->hanging, this->reference, this->partition, bad, moved,
      monitor, this->all());
  }
  Index least = this->count(bad(moved));
  // Near the inverted cells at first: the linear methods of the whole mesh take far longer. Cells
  // that were inverted before are not seen there: they would be repaired, too, or nothing would.
  const bool leavesSome = !this->all().all(this->before.cells().empty());
  const Mesh others = leavesSome ? withoutCells(this->mesh, this->before) : Mesh();
  const NodePartition ofOthers =
    leavesSome ? partitionNodes(others, this->partition.prescribed) : NodePartition();
  // The first attempt prepares little, and is mostly the last.
  const double end[] = { 0, 0.7, 1 }, prepared[] = { 0.05, 0.3 };
  for (int attempt = 0; attempt < 2 && least > 0; ++attempt)
  {
    const double begin = end[attempt],
                 middle = begin + prepared[attempt] * (end[attempt + 1] - begin);
    ProgressRange first(monitor, begin, middle), second(monitor, middle, end[attempt + 1]);
    InversionFree repair;
    repair.setReference(this->reference);
    repair.setNearOnly(attempt == 0);
    const bool seesOthers = leavesSome && attempt == 0;
    repair.prepare(seesOthers ? others : this->mesh, seesOthers ? ofOthers : this->partition, first,
      this->processes);
    Points repaired = moved;
    repair.repair(repaired, second);
    placeImages(this->mesh, repaired, this->all());
    const Index left = this->count(bad(repaired));
    if (left < least)
    {
      moved.swap(repaired);
      least = left;
    }
  }
  return least == 0;
}

Validity::Outcome Validity::remaining(
  const Points& moved, const std::string& reason, Monitor& monitor) const
{
  Outcome outcome{ "Inverted", std::numeric_limits<double>::quiet_NaN() };
  outcome.measured = this->measure(moved, monitor);
  outcome.error = "No valid mesh was found, and the result is the best that was: " +
                  this->found(outcome.measured, moved) + reason;
  return outcome;
}

Validity::Outcome Validity::subStep(
  const std::function<std::unique_ptr<Morpher>()>& make, Points& moved, Monitor& monitor) const
{
  const bool repairs = this->isInversionFree || Validity::repairs(this->mode);
  const std::vector<Index> atRest =
    this->all().gatherCells(this->inverted(this->mesh.points, monitor));
  if (!atRest.empty())
  {
    return this->remaining(moved,
      "The undeformed mesh has inverted or degenerate cells, too, so there is no valid mesh to "
      "take steps from: cell ids " +
        listIds(atRest) +
        (repairs ? ". Mend the mesh or the boundary there, or leave more nodes free."
                 : ". Repair it first, its boundary held, by Morph Inversion Free."),
      monitor);
  }
  const BoundaryPath path = straightPath(this->mesh.points, this->partition, this->targets);
  const BoundaryCheck check(
    this->mesh, this->partition, this->orientation, this->faces, monitor, this->all());
  SubStepLimits limits;
  limits.attempts = this->maximumSubSteps;
  if (repairs)
  {
    limits.failures = repairFailures;
  }
  limits.forbidden = [&](double time)
  { return this->idsOf(check.at(path(time)).all(this->before)); };
  const SubStepResult result = morphIncrementally(this->mesh, this->reference, this->partition,
    this->orientation, this->before, path, make, limits, monitor, this->processes);
  moved = result.moved;
  Outcome outcome = this->ofSubSteps(result, monitor);
  if (result.reached >= 1)
  {
    return outcome;
  }
  if (!result.isForbidden && !this->isInversionFree && this->mode == Mode::SubStep)
  {
    outcome.error += " `Validity` set to Repair often goes all the way where sub-steps stop.";
  }
  return outcome;
}

Validity::Outcome Validity::ensure(Points& moved, Monitor& monitor) const
{
  Quality quality = this->measure(moved, monitor);
  const auto crosses = [&]
  {
    if (this->mesh.layer.isCurved())
    {
      return false; // edges cross no edges in space
    }
    const WholeBoundary whole(this->mesh, this->faces, this->orientation, this->all());
    return !crossingCells(
      whole, whole.isAmong(this->partition.prescribed), whole.gather(moved), monitor)
              .empty();
  };
  if (this->all().all(this->inverted(quality, moved).empty()) &&
      !(this->mode == Mode::SubStep && crosses()))
  {
    Outcome valid;
    valid.measured = std::move(quality);
    return valid;
  }
  if (asksForValidMesh(this->mode) && this->mode != Mode::Refuse &&
      this->all().all(this->partition.free.empty()))
  {
    return this->remaining(
      moved, "Every node is prescribed, so the boundary alone decides.", monitor);
  }
  Outcome outcome{ "Inverted", std::numeric_limits<double>::quiet_NaN() };
  switch (this->mode)
  {
    case Mode::SubStep:
      return this->subStep(this->make, moved, monitor);
    case Mode::Repair:
    case Mode::RepairAll:
    {
      ProgressRange first(monitor, 0, 0.8), second(monitor, 0.8, 1);
      if (this->repair(moved, first))
      {
        return { "Repaired" };
      }
      const auto make = [this]() -> std::unique_ptr<Morpher>
      {
        auto method = std::make_unique<InversionFree>();
        return this->needsPieces ? morpherForPolyhedra(std::move(method), false, this->hanging)
                                 : std::move(method);
      };
      return this->subStep(make, moved, second);
    }
    case Mode::Refuse:
    {
      const std::string text =
        "The morph is refused: " + this->found(quality, moved) +
        (this->isInversionFree ? "Set `Validity` to Sub Step, or move the boundary less."
                               : "Set `Validity` to Repair or Sub Step, move the boundary less, or "
                                 "use Morph Inversion Free.");
      throw Error(text);
    }
    case Mode::Report:
      outcome.warning =
        this->found(quality, moved) + "The output Bad cells holds them all. " +
        (this->isInversionFree
            ? "Move the boundary less, or in relative steps."
            : "Morph Inversion Free, or `Validity` set to Repair, keeps cells valid.");
      break;
    default:
      break;
  }
  outcome.measured = std::move(quality);
  return outcome;
}
}
