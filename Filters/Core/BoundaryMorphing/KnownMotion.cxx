// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/KnownMotion.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace morph
{
namespace
{
std::vector<Index> knownOf(const std::vector<Index>& nodes, const BoundaryMotion& motion)
{
  std::vector<Index> known;
  std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(known),
    [&](Index node) { return motion.state[node] != BoundaryMotion::Unknown; });
  return known;
}

/// The distance below which a node lies in an affine span: 1e-9 of the model's size, or the
/// rounding of distant coordinates.
double flatTolerance(const Points& rest)
{
  if (rest.rows() == 0)
  {
    return 0;
  }
  const double size = (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm();
  return 1e-9 * size + 8 * std::numeric_limits<double>::epsilon() * rest.cwiseAbs().maxCoeff();
}
}

KnownMotion::KnownMotion(const Classification& geometry, const BoundaryMotion& motion)
  : motion_(motion)
  , tolerance_(flatTolerance(motion.rest))
{
  for (const GeometrySurface& surface : geometry.surfaces)
  {
    this->ofSurface_.push_back(knownOf(surface.nodes, motion));
  }
  this->surface_.resize(this->ofSurface_.size());
}

const MotionSums& KnownMotion::ofSurface(Index surface)
{
  std::optional<MotionSums>& sums = this->surface_[surface];
  if (!sums)
  {
    sums = this->sumOf(this->ofSurface_[surface]);
  }
  return *sums;
}

void KnownMotion::sumBodies()
{
  if (!this->body_.empty())
  {
    return;
  }
  std::vector<std::vector<Index>> ofBody(1);
  for (Index node : this->motion_.known())
  {
    const std::size_t body = static_cast<std::size_t>(this->motion_.bodyOfNode[node] + 1);
    ofBody.resize(std::max(ofBody.size(), body + 1));
    ofBody[body].push_back(node);
  }
  for (const std::vector<Index>& nodes : ofBody)
  {
    this->body_.push_back(this->sumOf(nodes));
  }
}

MotionSums KnownMotion::sumOf(const std::vector<Index>& ids)
{
  this->summed_ += static_cast<Index>(ids.size());
  return MotionSums(this->motion_, ids);
}

/// Adds a nonempty set by the share of the directions in which the places leave its center.
void KnownMotion::add(const MotionSums& sums, const Points& places, MotionAround& around) const
{
  if (sums.empty())
  {
    return;
  }
  const PrincipalDirections directions = sums.directions(places);
  const Points arms = (places.rowwise() - sums.center()) * directions.axes();
  double share = 1;
  for (int j = 0; j < 3; ++j)
  {
    if (arms.col(j).cwiseAbs().maxCoeff() > this->tolerance_)
    {
      share = std::min(share, directions.shares()[j]);
    }
  }
  around.add(sums, directions, share);
}

const MotionSums& KnownMotion::besides(const GeometryCurve& curve)
{
  const auto found = this->besides_.find(curve.surfaces);
  if (found != this->besides_.end())
  {
    return found->second;
  }
  std::vector<Index> order = curve.surfaces;
  std::stable_sort(order.begin(), order.end(),
    [&](Index a, Index b) { return this->ofSurface_[a].size() > this->ofSurface_[b].size(); });
  MotionSums sums;
  for (auto surface = order.begin(); surface != order.end(); ++surface)
  {
    if (surface == order.begin())
    {
      sums = this->ofSurface(*surface);
      continue;
    }
    std::vector<Index> others; // known nodes that the larger sets do not have
    for (Index node : this->ofSurface_[*surface])
    {
      const auto has = [&](Index larger)
      {
        const std::vector<Index>& nodes = this->ofSurface_[larger];
        return std::binary_search(nodes.begin(), nodes.end(), node);
      };
      if (std::none_of(order.begin(), surface, has))
      {
        others.push_back(node);
      }
    }
    sums.add(this->sumOf(others));
  }
  return this->besides_.emplace(curve.surfaces, sums).first->second;
}

MotionAround KnownMotion::around(const GeometryCurve& curve)
{
  const Points places = this->motion_.rest(curve.nodes, allColumns);
  MotionAround around;
  this->add(this->sumOf(knownOf(curve.nodes, this->motion_)), places, around);
  if (around.left() > 0)
  {
    this->add(this->besides(curve), places, around);
  }
  if (around.left() > 0)
  {
    this->addBody(this->motion_.bodyOfNode[curve.nodes[0]], places, around);
  }
  return around;
}

MotionAround KnownMotion::around(Index body, const std::vector<Index>& nodes)
{
  MotionAround around;
  this->addBody(body, this->motion_.rest(nodes, allColumns), around);
  return around;
}

void KnownMotion::addBody(Index body, const Points& places, MotionAround& around)
{
  this->sumBodies();
  const std::size_t place = static_cast<std::size_t>(body + 1);
  if (place < this->body_.size())
  {
    this->add(this->body_[place], places, around);
  }
}
}
