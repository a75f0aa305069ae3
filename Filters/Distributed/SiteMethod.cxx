// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/SiteMethod.h"

#include "Distributed/Methods.h"
#include "Distributed/Silent.h"
#include "Morpher/BodyByBody.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace morph::distributed
{
SiteMethod::SiteMethod(std::unique_ptr<Morpher> method)
  : method_(std::move(method))
{
}

std::vector<Index> SiteMethod::gatherBodies() const
{
  const std::vector<Index> ofNode =
    bodyOfNodes(meshOf(this->processes()).mesh(), meshOf(this->processes()).bodies());
  const std::vector<Index>& prescribed = this->partition().prescribed;
  std::vector<Index> mine;
  for (const Index i : this->owned_)
  {
    mine.push_back(ofNode[prescribed[i]]);
  }
  const std::vector<Index> all = meshOf(this->processes()).ranks().gather(mine);
  std::vector<Index> result(all.size());
  for (std::size_t k = 0; k < all.size(); ++k)
  {
    result[this->place_[k]] = all[k];
  }
  for (const Index node : this->partition().free)
  {
    result.push_back(ofNode[node]);
  }
  return result;
}

Points SiteMethod::gather(const Points& rows) const
{
  std::vector<std::array<double, 3>> mine;
  for (Index i : this->owned_)
  {
    mine.push_back({ rows(i, 0), rows(i, 1), rows(i, 2) });
  }
  const auto all = meshOf(this->processes()).ranks().gather(mine);
  Points result(static_cast<Index>(all.size()), 3);
  for (std::size_t k = 0; k < all.size(); ++k)
  {
    result.row(this->place_[k]) << all[k][0], all[k][1], all[k][2];
  }
  return result;
}

void SiteMethod::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const DistributedMesh& mesh = meshOf(this->processes());
  const Ranks& ranks = mesh.ranks();
  const std::vector<Index>& prescribed = this->partition().prescribed;
  this->owned_.clear();
  std::vector<std::int64_t> ids;
  for (std::size_t i = 0; i < prescribed.size(); ++i)
  {
    if (mesh.owns(prescribed[i]))
    {
      this->owned_.push_back(static_cast<Index>(i));
      ids.push_back(mesh.nodeId(prescribed[i]));
    }
  }
  this->firstPlace_ = ranks.sumBefore(static_cast<Index>(ids.size()));
  ids = ranks.gather(ids);
  std::vector<Index> order(ids.size());
  std::iota(order.begin(), order.end(), Index(0));
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return ids[a] < ids[b]; });
  this->place_.resize(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
  {
    this->place_[order[k]] = static_cast<Index>(k);
  }
  const Points sites = this->gather(rest.points(prescribed, allColumns));
  this->gatheredBytes_ = ids.size() * (sizeof(std::int64_t) + 3 * sizeof(double));

  // The sites, and then this rank's free nodes.
  Mesh points;
  points.offsets = { 0 };
  const std::vector<Index>& free = this->partition().free;
  const Index own = static_cast<Index>(free.size());
  points.points.resize(sites.rows() + own, 3);
  points.points.topRows(sites.rows()) = sites;
  points.points.bottomRows(own) = rest.points(free, allColumns);
  NodePartition partition;
  partition.prescribed.resize(sites.rows());
  std::iota(partition.prescribed.begin(), partition.prescribed.end(), Index(0));
  partition.free.resize(own);
  std::iota(partition.free.begin(), partition.free.end(), sites.rows());
  this->serial_ = this->method_->copyWithoutCells();
  if (mesh.bodies().count > 1)
  {
    requirePrescribedBodies(mesh, this->partition());
    this->serial_ = std::make_unique<BodyByBody>(std::move(this->serial_), this->gatherBodies());
  }
  Silent silent(monitor);
  ranks.together([&] { this->serial_->prepare(points, partition, silent); });
}

EvaluateReport SiteMethod::displace(const Points& prescribed, Points& free, Monitor& monitor) const
{
  const Ranks& ranks = meshOf(this->processes()).ranks();
  const Points sites = this->gather(prescribed);
  const Points& rest = this->serial_->restPoints();
  EvaluateReport report;
  Silent silent(monitor);
  ranks.together(
    [&]
    {
      Points moved;
      report = this->serial_->evaluate(rest.topRows(sites.rows()) + sites, moved, silent);
      free = moved.bottomRows(free.rows()) - rest.bottomRows(free.rows());
    });
  report.statistics.clear(); // of this rank's nodes alone
  return report;
}

EvaluateReport SiteMethod::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  const Ranks& ranks = meshOf(this->processes()).ranks();
  const auto& linear = dynamic_cast<const LinearMorpher&>(*this->serial_);
  Points gradient = Points::Zero(this->serial_->restPoints().rows(), 3);
  gradient.bottomRows(free.rows()) = free;
  Points sites;
  EvaluateReport report;
  Silent silent(monitor);
  ranks.together([&] { report = linear.applyTranspose(gradient, sites, silent); });
  ranks.sum(sites.data(), static_cast<std::size_t>(sites.size()));
  for (std::size_t i = 0; i < this->owned_.size(); ++i)
  {
    prescribed.row(this->owned_[i]) += sites.row(this->place_[this->firstPlace_ + i]);
  }
  report.statistics.clear();
  return report;
}
}
