// SPDX-License-Identifier: BSD-3-Clause
#include "Morpher/SiteMethod.h"

#include "Mesh/Topology.h"
#include "Support/Error.h"
#include "Support/Lists.h"
#include "Support/Monitor.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace morph
{
namespace
{
std::vector<Index> at(const std::vector<Index>& places, const std::vector<Index>& ids)
{
  std::vector<Index> result(places.size());
  std::transform(
    places.begin(), places.end(), result.begin(), [&](Index place) { return ids[place]; });
  return result;
}

/// Adds the counts of another body, and takes its cost if that is greater.
void add(const EvaluateReport& other, EvaluateReport& report)
{
  report.iterations = std::max(report.iterations, other.iterations);
  report.relativeResidual = std::max(report.relativeResidual, other.relativeResidual);
  report.statistics.resize(other.statistics.size());
  for (std::size_t i = 0; i < other.statistics.size(); ++i)
  {
    report.statistics[i].name = other.statistics[i].name;
    report.statistics[i].value += other.statistics[i].value;
  }
}
}

BodyByBody::BodyByBody(std::unique_ptr<Morpher> method, std::vector<Index> bodyOfNode)
  : method_(std::move(method))
  , bodyOfNode_(std::move(bodyOfNode))
{
}

void BodyByBody::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const NodePartition& whole = this->partition();
  const std::vector<Index> bodyOfNode = this->bodyOfNode_.empty()
                                          ? bodyOfNodes(rest, connectedComponents(rest, monitor))
                                          : this->bodyOfNode_;
  std::map<Index, Body> bodies;
  for (std::size_t i = 0; i < whole.free.size(); ++i)
  {
    bodies[bodyOfNode[whole.free[i]]].free.push_back(static_cast<Index>(i));
  }
  for (std::size_t i = 0; i < whole.prescribed.size(); ++i)
  {
    const auto body = bodies.find(bodyOfNode[whole.prescribed[i]]);
    if (body != bodies.end())
    {
      body->second.prescribed.push_back(static_cast<Index>(i));
    }
  }
  // The points alone, so that ids in messages are those of the mesh.
  const auto points = std::make_shared<Mesh>();
  points->points = rest.points;
  this->bodies_.clear();
  const auto count = static_cast<double>(bodies.size());
  for (auto& [number, body] : bodies)
  {
    if (body.prescribed.empty())
    {
      throw Error(Error::Kind::Singular,
        "Body " + std::to_string(number) + " has no prescribed node, so nothing says where it " +
          "goes: node " + std::to_string(whole.free[body.free.front()]) +
          " and others. Prescribe at least one of its nodes, or remove it from the grid.");
    }
    const auto own = std::make_shared<NodePartition>();
    own->prescribed = at(body.prescribed, whole.prescribed);
    own->free = at(body.free, whole.free);
    const auto done = static_cast<double>(this->bodies_.size());
    ProgressRange part(monitor, done / count, (done + 1) / count);
    body.method.reset(&dynamic_cast<LinearMorpher&>(*this->method_->copyWithoutCells().release()));
    body.method->prepare(points, own, part);
    this->bodies_.push_back(std::move(body));
  }
}

void BodyByBody::warnOf(const Points& prescribed, Monitor& monitor) const
{
  for (const Body& body : this->bodies_)
  {
    warnBy(*body.method, prescribed(body.prescribed, allColumns), monitor);
  }
}

template <typename Act>
EvaluateReport BodyByBody::forEach(Monitor& monitor, const Act& act) const
{
  EvaluateReport report;
  const auto count = static_cast<double>(this->bodies_.size());
  double done = 0;
  for (const Body& body : this->bodies_)
  {
    ProgressRange part(monitor, done / count, (done + 1) / count);
    add(act(body, part), report);
    ++done;
  }
  return report;
}

EvaluateReport BodyByBody::displace(const Points& prescribed, Points& free, Monitor& monitor) const
{
  return this->forEach(monitor,
    [&](const Body& body, Monitor& part)
    {
      Points own(static_cast<Index>(body.free.size()), 3);
      const EvaluateReport report =
        displaceBy(*body.method, prescribed(body.prescribed, allColumns), own, part);
      free(body.free, allColumns) = own;
      return report;
    });
}

EvaluateReport BodyByBody::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  return this->forEach(monitor,
    [&](const Body& body, Monitor& part)
    {
      Points own = prescribed(body.prescribed, allColumns);
      const EvaluateReport report =
        transposeBy(*body.method, free(body.free, allColumns), own, part);
      prescribed(body.prescribed, allColumns) = own;
      return report;
    });
}

SiteMethod::SiteMethod(std::unique_ptr<Morpher> method)
  : method_(std::move(method))
{
}

void SiteMethod::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const Communicator& processes = this->processes();
  const std::vector<Index>&prescribed = this->partition().prescribed,
        &free = this->partition().free;
  const ConnectedComponents bodies = connectedComponents(rest, monitor, processes);
  const std::vector<Index> ofNode = bodyOfNodes(rest, bodies), ids = processes.idsOf(prescribed);
  Points named = Points::Zero(rest.numberOfNodes(), 3); // number in the whole mesh, and body
  for (std::size_t i = 0; i < prescribed.size(); ++i)
  {
    named.row(prescribed[i]) << static_cast<double>(ids[i]),
      static_cast<double>(ofNode[prescribed[i]]), 0;
  }
  named = processes.gather(named, prescribed);
  const Points sites = processes.gather(rest.points, prescribed);
  this->sites_.clear();
  for (std::size_t i = 0; i < prescribed.size(); ++i)
  {
    const auto id = static_cast<double>(ids[i]);
    const auto column = named.col(0);
    const Index site = std::lower_bound(column.begin(), column.end(), id) - column.begin();
    if (site < named.rows() && named(site, 0) == id &&
        !std::binary_search(
          this->countedElsewhere().begin(), this->countedElsewhere().end(), prescribed[i]))
    {
      this->sites_.emplace_back(static_cast<Index>(i), site);
    }
  }

  // The sites, and then this process's free nodes.
  Mesh points;
  const auto own = static_cast<Index>(free.size());
  points.points.resize(sites.rows() + own, 3);
  points.points << sites, rest.points(free, allColumns);
  NodePartition partition;
  partition.prescribed = consecutive(sites.rows());
  partition.free = consecutive<Index>(own, sites.rows());
  this->serial_ = this->method_->copyWithoutCells();
  if (bodies.count > 1)
  {
    requirePrescribedBodies(bodies, this->partition(), processes);
    std::vector<Index> ofPoint;
    for (Index i = 0; i < sites.rows(); ++i)
    {
      ofPoint.push_back(static_cast<Index>(named(i, 1)));
    }
    for (const Index node : free)
    {
      ofPoint.push_back(ofNode[node]);
    }
    this->serial_ = std::make_unique<BodyByBody>(std::move(this->serial_), std::move(ofPoint));
  }
  QuietRange silent(monitor, 0, 1);
  processes.together([&] { this->serial_->prepare(points, partition, silent); });
}

EvaluateReport SiteMethod::displace(const Points& prescribed, Points& free, Monitor& monitor) const
{
  Points all = Points::Zero(this->restPoints().rows(), 3);
  all(this->partition().prescribed, allColumns) = prescribed;
  const Points sites = this->processes().gather(all, this->partition().prescribed);
  const Points& rest = this->serial_->restPoints();
  EvaluateReport report;
  QuietRange silent(monitor, 0, 1);
  this->processes().together(
    [&]
    {
      Points moved;
      report = this->serial_->evaluate(rest.topRows(sites.rows()) + sites, moved, silent);
      free = moved.bottomRows(free.rows()) - rest.bottomRows(free.rows());
    });
  report.statistics.clear(); // of this process's nodes alone
  return report;
}

EvaluateReport SiteMethod::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  const auto& linear = dynamic_cast<const LinearMorpher&>(*this->serial_);
  Points gradient = Points::Zero(this->serial_->restPoints().rows(), 3), ofSites;
  gradient.bottomRows(free.rows()) = free;
  EvaluateReport report;
  QuietRange silent(monitor, 0, 1);
  this->processes().together([&] { report = linear.applyTranspose(gradient, ofSites, silent); });
  this->processes().sum(ofSites.data(), static_cast<int>(ofSites.size()));
  for (const auto& [row, site] : this->sites_)
  {
    prescribed.row(row) += ofSites.row(site);
  }
  report.statistics.clear();
  return report;
}

std::unique_ptr<Morpher> onProcesses(std::unique_ptr<Morpher> method)
{
  if (method->copyWithoutCells())
  {
    return std::make_unique<SiteMethod>(std::move(method));
  }
  return method->layers() > 0 ? std::move(method) : nullptr;
}
}
