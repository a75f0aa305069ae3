// SPDX-License-Identifier: BSD-3-Clause
#include "Morpher/SiteMethod.h"

#include "Morpher/BodyByBody.h"
#include "Support/Lists.h"
#include "Support/ProgressRange.h"

#include <algorithm>

namespace morph
{
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
  partition.free = consecutive(own, sites.rows());
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
