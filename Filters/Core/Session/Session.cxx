// SPDX-License-Identifier: BSD-3-Clause
#include "Session/Session.h"

#include "Mesh/CollapsedCells.h"
#include "Mesh/Mesh.h"
#include "Mesh/OwnCells.h"
#include "Mesh/ShellLayer.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Quality/BoundaryDetermined.h"
#include "Quality/ScaledJacobian.h"
#include "Session/AfterMotion.h"
#include "Support/Communicator.h"
#include "Support/Error.h"
#include "Support/Monitor.h"
#include "Untangling/HigherOrderUntangling.h"
#include "Untangling/InversionFree.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace morph
{
void Series::clear()
{
  this->kept_.clear();
  this->stride_ = 1;
  this->last_ = 0;
}

void Series::check(std::uint64_t options, bool varies, std::uint64_t boundary)
{
  const State state{ options, varies, varies ? boundary : 0 };
  if (state != this->state_)
  {
    this->clear();
  }
  this->state_ = state;
}

void Series::keep(int number, Step step, double megabytes)
{
  const double size = std::max(1., 24. * static_cast<double>(step->moved.rows()));
  // A pass over all that is kept would make a run of many steps quadratic in their number.
  if (this->last_ % this->stride_ != 0)
  {
    this->kept_.erase(this->last_);
  }
  this->kept_[number] = std::move(step);
  this->last_ = number;
  // The last one is there besides, so that going back does not thin out what helps to go back.
  const auto full = [&]
  {
    const auto counted = this->kept_.size() - (number % this->stride_ != 0);
    return static_cast<double>(counted) * size > 1e6 * megabytes;
  };
  while (full() && this->stride_ <= this->kept_.rbegin()->first)
  {
    this->stride_ *= 2;
    this->thin();
  }
  if (full())
  {
    const Step last = this->kept_[number];
    this->kept_ = { { number, last } };
  }
}

void Series::thin()
{
  for (auto it = this->kept_.begin(); it != this->kept_.end();)
  {
    const bool stays = it->first == this->last_ || it->first % this->stride_ == 0;
    it = stays ? std::next(it) : this->kept_.erase(it);
  }
}

std::pair<int, Series::Step> Series::lastUntil(int number) const
{
  auto after = this->kept_.upper_bound(number);
  if (after == this->kept_.begin())
  {
    return { -1, nullptr };
  }
  return *std::prev(after);
}

namespace
{
/// A method with these options, not prepared, for the cells of `mesh` at its points or others.
std::unique_ptr<Morpher> makeMethod(const Session::Options& options, const UndeformedMesh& mesh)
{
  return mesh.fitted(options.settings(mesh.needsPieces()));
}

void requireAscending(const std::vector<Index>& ids)
{
  if (!std::is_sorted(ids.begin(), ids.end()))
  {
    throw Error("The ids of prescribed nodes do not ascend. Sort them, and their targets alike.");
  }
}

void requireTargets(const BoundaryTargets& boundary, const Communicator& processes)
{
  requireAscending(boundary.ids);
  requireRows(
    "The array of targets", boundary.targets.rows(), static_cast<Index>(boundary.ids.size()));
  std::vector<Index> wrong = immoderateRows(boundary.targets);
  if (!wrong.empty())
  {
    for (Index& row : wrong)
    {
      row = boundary.ids[row];
    }
    throw Error("The targets are not finite or beyond 1e50, at node ids " +
                listIds(processes.idsOf(wrong)) + ".");
  }
}

/// The same motion of the nodes `ids`; see UndeformedMesh::prescribedFor(). Those that it does not
/// name stay, and a warning says so.
BoundaryTargets forMethod(
  const BoundaryTargets& boundary, std::vector<Index> ids, const Mesh& from, Monitor& monitor)
{
  BoundaryTargets result;
  result.unmatched = boundary.unmatched;
  Points all = from.points;
  all(boundary.ids, allColumns) = boundary.targets;
  result.targets = all(ids, allColumns);
  std::vector<Index> staying;
  std::set_difference(
    ids.begin(), ids.end(), boundary.ids.begin(), boundary.ids.end(), std::back_inserter(staying));
  if (!staying.empty())
  {
    monitor.warn("Bodies of which no node is prescribed stay, " + std::to_string(staying.size()) +
                 " nodes: node ids " + listIds(staying) + ".");
  }
  result.ids = std::move(ids);
  return result;
}
}

std::unique_ptr<Morpher> Session::Options::settings(bool onPieces) const
{
  auto method = this->createMorpher();
  if (onPieces)
  {
    adaptToPieces(*method);
  }
  return method;
}

void Session::setMesh(Mesh mesh, Monitor& monitor)
{
  validate(mesh);
  this->setMesh(std::make_shared<const UndeformedMesh>(std::move(mesh), nullptr, monitor));
}

void Session::setMesh(std::shared_ptr<const UndeformedMesh> mesh)
{
  if (mesh != this->mesh_)
  {
    this->method_.reset();
    this->modes_.clear();
    this->samples_.reset();
    this->attached_ = {};
    this->partition_ = std::make_shared<NodePartition>();
    this->copies_.reset();
    this->steps_.clear();
    this->mesh_ = std::move(mesh);
  }
}

void Session::reportMesh(const Options& options, Monitor& whole) const
{
  const UndeformedMesh& mesh = *this->mesh_;
  const Communicator& processes = this->all();
  FirstSpeaks monitor(whole, processes);
  warnOfMirrored(mesh.mirroredBodies(), mesh.firstMirrored(), monitor);
  warnOfShared(mesh.repeatedCells(), mesh.touchingNodes(), monitor);
  warnOfUnmapped(mesh.unmappedCells(), monitor);
  if (options.measureAll)
  {
    std::string note;
    std::vector<Index> unrecognized;
    processes.together(
      [&]
      {
        const std::vector<Index>& before = mesh.before(monitor).cells();
        const std::vector<Index> own = unrecognizedCells(mesh.mesh(), before);
        std::vector<Index> others;
        std::set_difference(
          before.begin(), before.end(), own.begin(), own.end(), std::back_inserter(others));
        unrecognized = processes.gatherCells(own);
        note = Validity::note(options.validity, processes.gatherCells(others));
      });
    warnOfUnrecognized(unrecognized, monitor);
    if (!note.empty())
    {
      monitor.warn(note);
    }
  }
}

std::shared_ptr<StepResult> Session::morph(const BoundaryTargets& boundary, const Options& options,
  Monitor& whole, const AffineHandle* handle)
{
  FirstSpeaks monitor(whole, this->all());
  auto result = std::make_shared<StepResult>();
  this->all().together(
    [&] { *result = this->morphStep(this->mesh_->mesh(), boundary, handle, options, monitor); });
  return result;
}

std::pair<int, Series::Step> Session::lastUntil(int number) const
{
  while (true)
  {
    auto kept = this->steps_.lastUntil(number);
    const auto least = static_cast<int>(this->all().minimum(kept.first));
    if (this->all().all(kept.first == least))
    {
      return kept;
    }
    number = least;
  }
}

std::shared_ptr<const StepResult> Session::morphSeries(int step,
  const std::function<BoundaryTargets(int step)>& boundaryOf, const BoundaryTargets* whole,
  const Options& options, Monitor& all)
{
  FirstSpeaks monitor(all, this->all());
  this->effort.prepareSeconds = this->effort.evaluateSeconds = 0; // of a last step that is kept
  const bool isSame =
    !whole || (whole->ids == this->whole_.ids && whole->targets == this->whole_.targets);
  if (!this->all().all(isSame))
  {
    this->steps_.clear();
    this->whole_ = *whole;
  }
  auto [number, result] = this->lastUntil(step);
  const double first = number, count = step - first;
  constexpr int Most = 10; // messages about steps before the last; a million help nobody
  int partial = 0;
  while (number < step)
  {
    ++number;
    const BoundaryTargets boundary = boundaryOf(number);
    Mesh from = this->mesh_->mesh();
    if (result)
    {
      from.points = result->moved;
    }
    ProgressRange part(monitor, (number - 1 - first) / count, (number - first) / count);
    auto made = std::make_shared<StepResult>();
    inStep(number,
      [&]
      {
        this->all().together(
          [&] { *made = this->morphStep(from, boundary, nullptr, options, part); });
      });
    made->valid.measured = {}; // a series keeps meshes alone
    result = std::move(made);
    if (number < step && !result->valid.error.empty() && ++partial <= Most)
    {
      monitor.warn("Step " + std::to_string(number) + ": " + result->valid.error);
    }
    this->steps_.keep(number, result, options.stepMemoryLimit);
  }
  if (partial > Most)
  {
    monitor.warn(std::to_string(partial - Most) + " more steps came only part of the way.");
  }
  return result;
}

std::vector<Index> Session::counting(const std::vector<Index>& nodes) const
{
  std::vector<Index> result;
  std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(result),
    [this](Index node) { return this->countsHere(node); });
  return result;
}

bool Session::countsHere(Index node) const
{
  const std::vector<Index>& elsewhere = this->copies_->countedElsewhere();
  return !std::binary_search(elsewhere.begin(), elsewhere.end(), node);
}

StepResult Session::morphStep(const Mesh& from, const BoundaryTargets& boundary,
  const AffineHandle* handle, const Options& options, Monitor& monitor)
{
  const Communicator& processes = this->all();
  if (!from.layer.isCurved() && (!processes.all(boundary.leaving.empty()) ||
                                  leavesPlane(this->mesh_->mesh(), from.points, processes)))
  {
    return this->morphStep(bent(from, processes), boundary, handle, options, monitor);
  }
  const bool isBent = from.layer.isCurved() && !this->mesh_->mesh().layer.isCurved();
  const Mesh ofBent = isBent ? bent(this->mesh_->mesh(), processes) : Mesh();
  const Mesh& rest = isBent ? ofBent : this->mesh_->mesh();
  const HangingNodes& hanging = this->mesh_->hanging();
  const bool onPieces = this->mesh_->needsPieces();
  requireTargets(boundary, processes);
  if (std::vector<Index> ids = this->mesh_->prescribedFor(boundary.ids);
      !processes.all(ids == boundary.ids))
  {
    StepResult result = this->morphStep(
      from, forMethod(boundary, std::move(ids), from, monitor), nullptr, options, monitor);
    const std::vector<Index> dropped =
      droppedTargets(boundary, hanging, result.moved, this->mesh_->size());
    const std::string note = noteOfDropped(processes.gatherNodes(this->counting(dropped)));
    if (!note.empty() && result.valid.error.empty()) // else there is another reason
    {
      monitor.warn(note);
    }
    return result;
  }
  const std::vector<std::int8_t>& orientation = this->mesh_->orientation();
  const auto part = [&](double first, double last) { return ProgressRange(monitor, first, last); };
  const NodePartition& partition = this->partitionOf(boundary.ids);
  static const InvertedBefore none{};
  const InvertedBefore& before =
    options.measureAll ? Validity::beforeFor(options.validity, this->mesh_->before(monitor)) : none;
  const Validity validity{ options.validity, options.maximumSubSteps, from, rest.points, before,
    partition, orientation, boundary.targets, this->mesh_->outerFaces(), hanging,
    dynamic_cast<InversionFree*>(options.createMorpher().get()) != nullptr,
    [&] { return makeMethod(options, *this->mesh_); }, onPieces, this->mesh_->processes() };
  validity.requireFeasible();

  // A repair, where there is one, takes longest.
  auto preparing = part(0.05, 0.3);
  this->prepareFor(from, options, preparing);

  auto evaluating = part(0.3, 0.5);
  const Stopwatch watch;
  StepResult result;
  const LinearMorpher* byModes = this->preparedModes(handle, evaluating);
  const EvaluateReport report =
    byModes
      ? this->modes_.evaluate(*byModes, handle->motion, boundary.targets, result.moved, evaluating)
      : this->method_->evaluate(boundary.targets, result.moved, evaluating);
  placeImages(from, result.moved, processes); // of a sum of modes
  if (validity.isInversionFree && onPieces)
  {
    auto repairing = part(0.45, 0.5);
    const auto bad = [&](const Points& points)
    { return invertedCells(validity.measure(points, repairing)); };
    repairPolyhedra(from, hanging, rest.points, partition, bad, result.moved, repairing, processes);
  }
  if (validity.isInversionFree)
  {
    if (!processes.all(partition.higherOrderNodes.empty()))
    {
      auto untangling = part(0.49, 0.5);
      const OwnCells own(from, partition, orientation, processes);
      Points points = own.take(result.moved);
      untangleHigherOrder(
        own.mesh(), own.partition(), own.orientation(), points, untangling, own.communicator());
      result.moved(own.nodes(), allColumns) = points;
      this->copies_->update(result.moved);
    }
    hanging.place(from.points, result.moved);
    this->copies_->update(result.moved);
  }
  std::vector<Index> wrong = immoderateRows(result.moved, &evaluating);
  // Points of no cell may be anything, and stay so.
  wrong.erase(std::remove_if(wrong.begin(), wrong.end(),
                [&from](Index n) { return !from.points.row(n).allFinite(); }),
    wrong.end());
  if (!wrong.empty())
  {
    throw Error("The method gave positions that are not finite or beyond 1e50, at node ids " +
                listIds(processes.idsOf(wrong)) +
                ". Check the boundary for huge values, and the mesh for cells without "
                "volume.");
  }
  result.statistics = report.statistics;
  if (options.postSmooth)
  {
    auto smoothing = part(0.5, 0.7);
    result.statistics.push_back(
      { "PostSmoothSteps", smoothAfterwards(rest, hanging, onPieces, orientation, partition,
                             options.postSmoothIterations, result.moved, smoothing, processes) });
  }
  double seconds = watch.seconds();
  auto checking = part(options.postSmooth ? 0.7 : 0.5, 1);
  if (options.measureAll)
  {
    result.valid = validity.ensure(result.moved, checking);
    if (!this->samples_ && !isBent)
    {
      this->samples_ = std::make_unique<MovableQuality>(rest, orientation, partition.free);
    }
    const double minimum = processes.minimum(
      isBent ? MovableQuality(rest, orientation, partition.free).fixedMinimum(result.moved)
             : this->samples_->fixedMinimum(result.moved));
    result.boundaryMinimum =
      std::isfinite(minimum) ? minimum : std::numeric_limits<double>::quiet_NaN();
  }
  else
  {
    result.valid = { "Unmeasured", std::numeric_limits<double>::quiet_NaN() };
  }
  keepInPlane(rest, partition.free, result.moved, processes); // after smoothing and repairs
  this->attached_.apply(result.moved);
  const Parting parting = partingNodes(this->mesh_->onLinearEdges(), this->mesh_->outerFaces(),
    rest.points, result.moved, this->mesh_->size());
  warnOfParting(
    { processes.gatherNodes(this->counting(parting.nodes)), processes.maximum(parting.largest) },
    monitor);
  result.attached = static_cast<Index>(this->attached_.nodes().size());
  result.loose = this->attached_.loose();
  const std::string& status = result.valid.status;
  if (status != "Valid" && status != "Inverted" && status != "Unmeasured")
  {
    seconds = watch.seconds(); // cells were not measured alone, but repaired
  }
  this->effort.evaluateSeconds = processes.maximum(seconds);
  if (status == "Inverted")
  {
    const std::vector<Index> cells = processes.gatherCells(
      before.without(boundaryDeterminedInversions(from, partition, orientation, result.moved)));
    result.boundaryInverted = static_cast<Index>(cells.size());
  }
  result.iterations = report.iterations;
  result.prescribed = processes.sum(Index(std::count_if(boundary.ids.begin(), boundary.ids.end(),
    [&](Index node)
    { return (rest.layer.nodes == 0 || node < rest.layer.nodes) && this->countsHere(node); })));
  result.unmatched = boundary.unmatched;
  return result;
}

const LinearMorpher* Session::preparedModes(const AffineHandle* handle, Monitor& monitor)
{
  const auto* linear = dynamic_cast<const LinearMorpher*>(this->method_.get());
  // Always, not from the second motion on: a result must not depend on what ran before.
  if (handle && linear && !this->all().all(this->modes_.isPreparedFor(*linear, handle->fields)))
  {
    this->modes_.prepare(*linear, handle->fields, monitor);
  }
  return handle ? linear : nullptr;
}

const NodePartition& Session::partitionOf(const std::vector<Index>& prescribed)
{
  if (!this->all().all(this->copies_ && this->partition_->prescribed == prescribed))
  {
    this->samples_.reset();
    this->copies_ = this->all().rows();
    this->partition_ = std::make_shared<NodePartition>(
      partitionNodes(this->mesh_->mesh(), this->mesh_->hanging(), prescribed));
    this->attached_ = AttachedNodes(this->mesh_->mesh(), *this->partition_, this->all());
  }
  return *this->partition_;
}

void Session::prepare(const std::vector<Index>& ids, const Options& options, Monitor& whole)
{
  FirstSpeaks monitor(whole, this->all());
  this->all().together(
    [&]
    {
      requireAscending(ids);
      this->partitionOf(this->mesh_->prescribedFor(ids));
      this->prepareFor(this->mesh_->mesh(), options, monitor);
    });
}

void Session::prepareFor(const Mesh& from, const Options& options, Monitor& monitor)
{
  const Mesh& rest = this->mesh_->mesh();
  this->effort.prepareSeconds = 0;
  // setMesh() drops the method with the mesh that it is prepared for.
  const bool isOfMesh = &from == &rest;
  std::unique_ptr<Morpher> settings = options.settings(this->mesh_->needsPieces());
  const bool isPrepared =
    this->method_ && this->settings_->preparesLike(*settings) &&
    this->methodIsCurved_ == from.layer.isCurved() &&
    this->method_->partition().prescribed == this->partition_->prescribed &&
    ((isOfMesh && this->methodIsOfMesh_) || this->method_->restPoints() == from.points);
  if (this->all().all(isPrepared))
  {
    methodOf(*this->method_).takeEvaluateOptions(*settings);
    return;
  }
  const Stopwatch watch;
  this->method_.reset();
  this->modes_.clear();
  std::unique_ptr<Morpher> morpher = makeMethod(options, *this->mesh_);
  if (!isOfMesh && !this->all().all(from.points == rest.points))
  {
    morpher->setReference(rest.points);
  }
  if (isOfMesh)
  {
    morpher->prepare(std::shared_ptr<const Mesh>(this->mesh_, &rest), this->partition_, monitor,
      this->mesh_->processes());
  }
  else
  {
    morpher->prepare(from, *this->partition_, monitor, this->mesh_->processes());
  }
  this->method_ = std::move(morpher);
  this->methodIsOfMesh_ = isOfMesh;
  this->methodIsCurved_ = from.layer.isCurved();
  this->settings_ = std::move(settings);
  ++this->effort.preparations;
  this->effort.prepareSeconds = this->all().maximum(watch.seconds());
}

Points Session::transpose(
  const std::vector<Index>& ids, Points gradient, const Options& options, Monitor& monitor)
{
  requireRows("The gradient", gradient.rows(), this->mesh_->mesh().numberOfNodes());
  ProgressRange preparing(monitor, 0.05, 0.5), applying(monitor, 0.5, 1);
  this->prepare(ids, options, preparing);
  const auto* linear = dynamic_cast<const LinearMorpher*>(this->method_.get());
  if (!linear)
  {
    throw Error(options.method +
                " is not a linear method, so it has no adjoint that is the same for all "
                "motions. Use one that is, FEMWARP for instance.");
  }
  if (const Index front = this->mesh_->mesh().layer.nodes; front > 0)
  {
    gradient.bottomRows(gradient.rows() - front).setZero(); // a plane mesh is the front
  }
  Points own, all = Points::Zero(gradient.rows(), 3); // what hangs moves by its ties
  const bool reachesAttached = !gradient(this->attached_.nodes(), allColumns).isZero(0);
  this->attached_.applyTranspose(gradient);
  if (!this->all().all(!reachesAttached))
  {
    monitor.warn(
      "Nodes of shells, beams or links turn with the volume on which they hang, which is "
      "not linear. Their part of the derivatives is that about the undeformed mesh.");
  }
  this->copies_->collect(gradient);
  linear->applyTranspose(gradient, own, applying);
  all(this->partition_->prescribed, allColumns) = own;
  return all(ids, allColumns);
}
}
