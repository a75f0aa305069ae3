// SPDX-License-Identifier: BSD-3-Clause
#include "Morpher/Morpher.h"

#include "Mesh/Mesh.h"
#include "Mesh/ShellLayer.h"
#include "Support/Communicator.h"
#include "Support/Error.h"
#include "Support/Monitor.h"
#include "Support/Parallel.h"
#include "Support/ReproducibleSum.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <typeinfo>
#include <utility>

namespace morph
{
bool CellStiffness::operator==(const CellStiffness& other) const
{
  const auto all = [](const CellStiffness& s)
  { return std::tie(s.kind, s.exponent, s.walls, s.values, s.noWalls, s.areWallsGlobal); };
  return all(*this) == all(other);
}

namespace
{
/// Returns the `ids` whose row of `some` is not finite.
template <typename Columns>
std::vector<Index> notFinite(const Columns& some, const std::vector<Index>& ids)
{
  std::vector<Index> where;
  for (Index i = 0; i < some.rows(); ++i)
  {
    if (!some.row(i).allFinite())
    {
      where.push_back(ids[i]);
    }
  }
  return where;
}

/// Throws unless these are finite displacements of the prescribed nodes.
template <typename Columns>
void requireMode(
  const Columns& displacement, const NodePartition& partition, const Communicator& processes)
{
  requireRows("The array of boundary displacements", displacement.rows(),
    static_cast<Index>(partition.prescribed.size()));
  if (!displacement.allFinite())
  {
    throw Error("Boundary displacements that are not finite (NaN or infinite) at node ids " +
                listIds(processes.idsOf(notFinite(displacement, partition.prescribed))) + ".");
  }
}

/// Throws unless what was found for the free nodes is finite.
template <typename Columns>
void requireFound(const Columns& free, const NodePartition& partition,
  const Communicator& processes, Monitor& monitor)
{
  if (reproducibleSum(free.rows(), monitor, Index(0),
        [&](Index i) { return Index(!free.row(i).allFinite()); }) > 0)
  {
    throw Error("The displacements found are not finite (NaN or infinite) at node ids " +
                listIds(processes.idsOf(notFinite(free, partition.free))) +
                ". The motion, or the mesh, is too large to compute with: scale it down.");
  }
}

/// Returns the nodes that are in no list of the partition.
std::vector<Index> outside(const NodePartition& partition, Index nodes)
{
  std::vector<bool> named(nodes);
  for (const std::vector<Index>* ids : { &partition.prescribed, &partition.free })
  {
    for (Index n : *ids)
    {
      named[n] = true;
    }
  }
  std::vector<Index> ids;
  for (Index n = 0; n < nodes; ++n)
  {
    if (!named[n])
    {
      ids.push_back(n);
    }
  }
  return ids;
}

/// Leaves the free nodes that count on this process.
std::shared_ptr<const NodePartition> countedHere(
  std::shared_ptr<const NodePartition> partition, const std::vector<Index>& elsewhere)
{
  if (elsewhere.empty())
  {
    return partition;
  }
  auto result = std::make_shared<NodePartition>(*partition);
  result->free.clear();
  std::set_difference(partition->free.begin(), partition->free.end(), elsewhere.begin(),
    elsewhere.end(), std::back_inserter(result->free));
  return result;
}
}

Morpher::~Morpher() = default;

void Morpher::prepare(const Mesh& rest, const NodePartition& partition, Monitor& monitor,
  std::shared_ptr<const Communicator> processes)
{
  this->processes_ = std::move(processes);
  auto points = std::make_shared<Points>();
  points->resize(rest.points.rows(), 3);
  *points = rest.points;
  this->processes().together(
    [&]
    {
      this->prepareFor(
        rest, std::move(points), std::make_shared<NodePartition>(partition), monitor);
    });
}

void Morpher::prepare(std::shared_ptr<const Mesh> rest,
  std::shared_ptr<const NodePartition> partition, Monitor& monitor,
  std::shared_ptr<const Communicator> processes)
{
  this->processes_ = std::move(processes);
  this->processes().together(
    [&]
    {
      this->prepareFor(
        *rest, std::shared_ptr<const Points>(rest, &rest->points), partition, monitor);
    });
}

void Morpher::prepareFor(const Mesh& rest, std::shared_ptr<const Points> points,
  std::shared_ptr<const NodePartition> partition, Monitor& monitor)
{
  this->prepared_ = false; // until all members below are consistent
  validate(rest);
  requireIndexable(rest);
  this->requireMesh(rest);
  const Communicator& processes = this->processes();
  if (processes.all(partition->prescribed.empty()))
  {
    throw Error(Error::Kind::Singular, "No node is prescribed, so nothing says where the mesh "
                                       "goes. Prescribe the boundary's nodes.");
  }
  this->rest_ = std::move(points);
  this->copies_ = processes.rows();
  this->partition_ = countedHere(std::move(partition), this->copies_->countedElsewhere());
  this->outside_ = outside(this->partition(), rest.points.rows());
  this->higherOrderNodes_.prepare(rest, this->partition(), processes);
  this->normal_ = rest.layer.normal;
  this->images_ = imagesAmong(rest.layer, this->partition().free);
  this->shell_ = rest.layer.isCurved() ? std::make_shared<Mesh>(rest) : nullptr;
  this->prescribedImages_ = curvedImages(rest.layer, this->partition().prescribed);
  this->fits_ = ShellFits(rest, this->partition(), processes);
  monitor.check();
  this->isComplete_ =
    processes.all(this->higherOrderNodes_.empty() && this->copies_->countedElsewhere().empty());
  this->hasFree_ = !processes.all(this->partition().free.empty());
  if (this->hasFree_)
  {
    FirstSpeaks whole(monitor, this->processes());
    this->doPrepare(rest, whole);
  }
  this->prepared_ = true;
  monitor.progress(1);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): for methods that keep it
void Morpher::setReference(Points)
{
}

bool Morpher::preparesLike(const Morpher& other) const
{
  return typeid(*this) == typeid(other) && this->hasPrepareOptionsOf(other);
}

void Morpher::takeEvaluateOptions(const Morpher& /*other*/)
{
}

bool Morpher::hasPrepareOptionsOf(const Morpher& /*other*/) const
{
  return true;
}

void Morpher::warnOf(const Points&, Monitor&) const
{
}

void Morpher::requirePrepared() const
{
  if (!this->prepared_)
  {
    throw Error(
      "The method is not prepared: call prepare() first, and again after one that failed.");
  }
}

Points Morpher::displacementOf(const ConstPoints& prescribed, Monitor& monitor) const
{
  const std::vector<Index>& ids = this->partition().prescribed;
  Points displacement(static_cast<Index>(ids.size()), 3);
  const Index bad = reproducibleSum(displacement.rows(), monitor, Index(0),
    [&](Index i)
    {
      displacement.row(i) = prescribed.row(i) - this->restPoints().row(ids[i]);
      return Index(!displacement.row(i).allFinite());
    });
  if (bad > 0)
  {
    throw Error("Prescribed positions that are not finite (NaN or infinite) at node ids " +
                listIds(this->processes().idsOf(notFinite(displacement, ids))) + ".");
  }
  for (const auto& [front, back] : this->prescribedImages_)
  {
    displacement.row(back) = displacement.row(front);
  }
  return displacement;
}

EvaluateReport Morpher::displaceRest(const Points& prescribed, Points& free, Monitor& monitor) const
{
  if (this->fits_.empty() || !dynamic_cast<const LinearMorpher*>(this))
  {
    return this->displace(prescribed, free, monitor);
  }
  Points rest = prescribed;
  const std::vector<AffineFit> fits = this->fits_.takeOff(rest);
  EvaluateReport report = this->displace(rest, free, monitor);
  this->fits_.addTo(fits, free);
  return report;
}

void Morpher::keepInPlane(Points& free) const
{
  for (const auto& [front, back] : this->images_)
  {
    Eigen::RowVector3d mean = (free.row(front) + free.row(back)) / 2;
    mean -= mean.dot(this->normal_) * this->normal_;
    free.row(front) = mean;
    free.row(back) = mean;
  }
}

template <typename Displacement>
void Morpher::place(Index node, const Displacement& displacement, Points& result) const
{
  for (int j = 0; j < 3; ++j)
  {
    const double rest = this->restPoints()(node, j), d = displacement[j];
    result(node, j) =
      d != 0 ? rest + d : rest; // bit for bit where nothing moves: -0.0 + 0.0 would be 0.0
  }
}

void Morpher::complete(Points& displacement) const
{
  this->copies_->update(displacement);
  this->higherOrderNodes_.apply(displacement);
  this->copies_->update(displacement); // a process may not have all cells of its nodes
}

EvaluateReport Morpher::evaluate(
  const ConstPoints& prescribed, Points& moved, Monitor& monitor) const
{
  EvaluateReport report;
  this->processes().together(
    [&]
    {
      this->requirePrepared();
      const std::vector<Index>& ids = this->partition().prescribed;
      requireRows(
        "The array of prescribed positions", prescribed.rows(), static_cast<Index>(ids.size()));

      const Points displacement = this->displacementOf(prescribed, monitor);
      Points freeDisplacement(static_cast<Index>(this->partition().free.size()), 3);
      FirstSpeaks whole(monitor, this->processes());
      if (this->hasFree_)
      {
        this->warnOf(displacement, whole);
        report = this->displaceRest(displacement, freeDisplacement, whole);
        this->keepInPlane(freeDisplacement);
      }
      requireFound(freeDisplacement, this->partition(), this->processes(), monitor);

      // Allocates only if the caller's array does not fit: mapping new pages takes longer than
      // filling them.
      const bool overlaps = moved.data() < prescribed.data() + prescribed.size() &&
                            prescribed.data() < moved.data() + moved.size();
      Points fresh;
      Points& result = moved.rows() == this->restPoints().rows() && !overlaps ? moved : fresh;
      result.resize(this->restPoints().rows(), 3);
      if (this->isComplete_)
      {
        parallel(freeDisplacement.rows(), monitor,
          [&](Index i)
          { this->place(this->partition().free[i], freeDisplacement.row(i), result); });
        for (Index n : this->outside_)
        {
          result.row(n) = this->restPoints().row(n);
        }
      }
      else
      {
        Points all = Points::Zero(this->restPoints().rows(), 3);
        all(this->partition().free, allColumns) = freeDisplacement;
        all(ids, allColumns) = displacement;
        this->complete(all);
        for (Index n = 0; n < all.rows(); ++n)
        {
          this->place(n, all.row(n), result);
        }
      }
      // The undeformed position plus the displacement may differ from the given position in the
      // last bit.
      result(ids, allColumns) = prescribed;
      if (this->shell_)
      {
        placeImages(*this->shell_, result, this->processes());
      }
      if (&result == &fresh)
      {
        moved.swap(fresh);
      }
      monitor.progress(1);
    });
  return report;
}

EvaluateReport LinearMorpher::applyTranspose(
  const ConstPoints& gradient, Points& prescribed, Monitor& monitor) const
{
  EvaluateReport report;
  this->processes().together(
    [&]
    {
      this->requirePrepared();
      requireRows("The gradient", gradient.rows(), this->restPoints().rows());
      Points all = gradient;
      if (!all.allFinite())
      {
        throw Error("The gradient has entries that are not finite (NaN or infinite).");
      }
      const std::vector<Index>&ids = this->partition().prescribed,
            &elsewhere = this->copies_->countedElsewhere();
      // Prescribed nodes have no weights: they also receive the gradient from higher-order nodes.
      all(elsewhere, allColumns).setZero();
      this->higherOrderNodes_.applyTranspose(all);
      this->copies_->add(all);
      all(elsewhere, allColumns).setZero();
      Points result = all(ids, allColumns);
      if (this->hasFree_)
      {
        FirstSpeaks whole(monitor, this->processes());
        Points free = all(this->partition().free, allColumns);
        this->keepInPlane(free);
        if (this->fits_.empty())
        {
          report = this->displaceTranspose(free, result, whole);
        }
        else
        {
          Points ofRest = Points::Zero(result.rows(), 3);
          report = this->displaceTranspose(free, ofRest, whole);
          this->fits_.transpose(free, ofRest);
          result += ofRest;
        }
      }
      monitor.check(); // a method whose product takes milliseconds need not ask
      if (!this->isComplete_)
      {
        all.setZero();
        all(ids, allColumns) = result;
        this->copies_->add(all);
        all(elsewhere, allColumns).setZero();
        result = all(ids, allColumns);
      }
      prescribed.swap(result);
      monitor.progress(1);
    });
  return report;
}

Points LinearMorpher::mode(
  const Points& displacement, EvaluateReport& report, Monitor& monitor) const
{
  const NodePartition& partition = this->partition();
  requireMode(displacement, partition, this->processes());
  Points free(static_cast<Index>(partition.free.size()), 3);
  if (this->hasFree_)
  {
    report = this->displaceRest(displacement, free, monitor);
    this->keepInPlane(free);
  }
  requireFound(free, partition, this->processes(), monitor);
  Points all = Points::Zero(this->restPoints().rows(), 3);
  all(partition.free, allColumns) = free;
  all(partition.prescribed, allColumns) = displacement;
  this->complete(all);
  return all;
}

EvaluateReport LinearMorpher::displaceFields(
  const FourFields& prescribed, FourFields& free, Monitor& monitor) const
{
  Points three = free.leftCols<3>(), fourth = three;
  Points given = prescribed.leftCols<3>();
  EvaluateReport report;
  {
    ProgressRange part(monitor, 0, 0.5);
    report = this->displaceRest(given, three, part);
  }
  given.setZero();
  given.col(0) = prescribed.col(3);
  ProgressRange part(monitor, 0.5, 1);
  const EvaluateReport other = this->displaceRest(given, fourth, part);
  free << three, fourth.col(0);
  report.iterations = std::max(report.iterations, other.iterations);
  report.relativeResidual = std::max(report.relativeResidual, other.relativeResidual);
  return report;
}

FourFields LinearMorpher::fields(
  const FourFields& prescribed, Monitor& monitor, EvaluateReport* report) const
{
  this->requirePrepared();
  const NodePartition& partition = this->partition();
  FourFields free = FourFields::Zero(static_cast<Index>(partition.free.size()), 4);
  EvaluateReport found;
  requireMode(prescribed, partition, this->processes());
  if (this->hasFree_)
  {
    FirstSpeaks whole(monitor, this->processes());
    found = this->fits_.empty() ? this->displaceFields(prescribed, free, whole)
                                : this->LinearMorpher::displaceFields(prescribed, free, whole);
    for (const auto& [front, back] : this->images_)
    {
      free.row(front) = free.row(back) = ((free.row(front) + free.row(back)) / 2).eval();
    }
  }
  requireFound(free, partition, this->processes(), monitor);
  FourFields all = FourFields::Zero(this->restPoints().rows(), 4);
  all(partition.free, allColumns) = free;
  all(partition.prescribed, allColumns) = prescribed;
  if (!this->isComplete_)
  {
    Points three = all.leftCols<3>(), fourth = Points::Zero(all.rows(), 3);
    fourth.col(0) = all.col(3);
    this->complete(three);
    this->complete(fourth);
    all << three, fourth.col(0);
  }
  if (report)
  {
    *report = std::move(found);
  }
  monitor.progress(1);
  return all;
}

std::vector<Points> LinearMorpher::basis(const std::vector<Points>& displacements, Monitor& monitor,
  std::vector<EvaluateReport>* reports) const
{
  this->requirePrepared();
  std::vector<Points> modes;
  std::vector<EvaluateReport> found(displacements.size());
  const auto count = static_cast<double>(displacements.size());
  FirstSpeaks whole(monitor, this->processes());
  for (std::size_t i = 0; i < displacements.size(); ++i)
  {
    const auto done = static_cast<double>(i);
    ProgressRange part(whole, done / count, (done + 1) / count);
    this->processes().together(
      [&] { modes.push_back(this->mode(displacements[i], found[i], part)); });
  }
  if (reports)
  {
    reports->swap(found);
  }
  monitor.progress(1);
  return modes;
}
}
