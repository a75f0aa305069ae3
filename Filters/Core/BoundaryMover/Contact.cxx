// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/Contact.h"

#include "Geometry/TriangleTree.h"
#include "Support/Error.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <utility>

namespace morph
{
namespace
{
using Row = Eigen::RowVector3d;
using Facet = std::array<Index, 3>;

/// The faces of surfaces as triangles, outward.
struct Facets
{
  std::vector<Facet> corners;
  TriangleTree tree;

  Facets(std::vector<Facet> ids, const Points& points)
    : corners(std::move(ids))
    , tree(placesOf(corners, points))
  {
  }
  static std::vector<TriangleTree::Triangle> placesOf(
    const std::vector<Facet>& ids, const Points& points)
  {
    std::vector<TriangleTree::Triangle> result;
    for (const Facet& corner : ids)
    {
      result.push_back({ points.row(corner[0]), points.row(corner[1]), points.row(corner[2]) });
    }
    return result;
  }
};

bool takesPart(const BoundaryModel& model, std::size_t face, const Contact::Options& options)
{
  const Index surface = model.geometry.surfaceOfFace[face];
  return options.surfaces.empty() ||
         std::binary_search(options.surfaces.begin(), options.surfaces.end(), surface);
}

/// The faces from their first corner on.
std::vector<Facet> trianglesOf(const BoundaryModel& model, const Contact::Options& options)
{
  const BoundaryFaces& faces = model.faces;
  std::vector<Facet> result;
  for (std::size_t f = 0; f + 1 < faces.offsets.size(); ++f)
  {
    const bool isMirrored = model.orientation[f] < 0;
    for (Index k = faces.offsets[f] + 2; takesPart(model, f, options) && k < faces.offsets[f + 1];
         ++k)
    {
      Facet corners = { faces.connectivity[faces.offsets[f]], faces.connectivity[k - 1],
        faces.connectivity[k] };
      if (isMirrored)
      {
        std::swap(corners[1], corners[2]);
      }
      result.push_back(corners);
    }
  }
  return result;
}

std::vector<Index> nodesOf(const BoundaryModel& model, const Contact::Options& options)
{
  std::set<Index> nodes;
  for (std::size_t f = 0; f + 1 < model.faces.offsets.size(); ++f)
  {
    if (takesPart(model, f, options))
    {
      nodes.insert(model.faces.connectivity.begin() + model.faces.offsets[f],
        model.faces.connectivity.begin() + model.faces.offsets[f + 1]);
    }
  }
  return { nodes.begin(), nodes.end() };
}

/// The nearest place on another body; of several triangles that meet there, one that the place
/// faces, so that the gap is along its normal.
TriangleTree::Found otherBody(
  const BoundaryModel& model, const Facets& triangles, Index node, const Row& place, double radius)
{
  const auto isOther = [&, body = model.bodyOfNode[node]](Index triangle)
  { return model.bodyOfNode[triangles.corners[triangle][0]] != body; };
  const TriangleTree::Found found = triangles.tree.nearest(place, radius, isOther);
  const Row arm = place - found.place;
  if (found.triangle < 0 || arm.isZero(0))
  {
    return found;
  }
  constexpr double Rounding = 1e-9;
  const TriangleTree::Found facing = triangles.tree.nearest(place, (1 + Rounding) * arm.norm(),
    [&](Index triangle)
    {
      return isOther(triangle) &&
             std::abs(triangles.tree.normal(triangle).dot(arm)) > (1 - Rounding) * arm.norm();
    });
  return facing.triangle < 0 ? found : facing;
}

/// Normal, not of unit length.
Row normalAt(const Points& points, const std::array<Index, 3>& corners)
{
  const Row a = points.row(corners[0]);
  return (points.row(corners[1]) - a).cross(points.row(corners[2]) - a);
}

/// The weights of a place in a triangle, by areas; in one without area those of its nearest corner.
Row weightsAt(const Points& points, const std::array<Index, 3>& corners, const Row& place)
{
  const Row normal = normalAt(points, corners);
  Row weights = Row::Zero();
  if (normal.isZero(0))
  {
    int nearest = 0;
    for (int k = 1; k < 3; ++k)
    {
      const auto distance = [&](int corner)
      { return (points.row(corners[corner]) - place).squaredNorm(); };
      nearest = distance(k) < distance(nearest) ? k : nearest;
    }
    weights[nearest] = 1;
    return weights;
  }
  for (int k = 0; k < 3; ++k)
  {
    const Row a = points.row(corners[(k + 1) % 3]), b = points.row(corners[(k + 2) % 3]);
    weights[k] = (a - place).cross(b - place).dot(normal) / normal.squaredNorm();
  }
  return weights;
}

Row placeOf(const Points& points, const std::array<Index, 3>& corners, const Row& weights)
{
  return weights[0] * points.row(corners[0]) + weights[1] * points.row(corners[1]) +
         weights[2] * points.row(corners[2]);
}

std::set<Index> movingBodies(const BoundaryModel& model, const Choice& choice)
{
  std::set<Index> bodies;
  for (const Index node : choice.moving)
  {
    bodies.insert(model.bodyOfNode[node]);
  }
  return bodies;
}
}

void Contact::find(const BoundaryModel& model, const Options& options)
{
  this->followers_.clear();
  if (this->version_ == model.motionVersion && this->options_.distance == options.distance &&
      this->options_.surfaces == options.surfaces)
  {
    return;
  }
  this->version_ = -1;
  this->options_ = options;
  this->pairs_.clear();
  const Points& points = model.points();
  const Facets triangles(trianglesOf(model, options), points);
  for (const Index node : nodesOf(model, options))
  {
    const TriangleTree::Found found =
      otherBody(model, triangles, node, points.row(node), options.distance);
    if (found.triangle >= 0)
    {
      const Facet& corners = triangles.corners[found.triangle];
      this->pairs_.push_back({ node, corners, weightsAt(points, corners, found.place) });
    }
  }
  if (this->pairs_.empty())
  {
    std::ostringstream text;
    text << "No node is within `ContactDistance` " << options.distance
         << " of another body, so there is no contact to keep. Give a larger distance"
         << (options.surfaces.empty() ? "." : ", or other `ContactSurfaces`.");
    throw Error(text.str());
  }
  this->version_ = model.motionVersion;
}

bool Contact::hasMoved(const Points& points, const Surroundings::Result& result, const Pair& pair)
{
  return std::any_of(pair.corners.begin(), pair.corners.end(),
    [&](Index corner) { return result.moved.row(corner) != points.row(corner); });
}

Eigen::RowVector3d Contact::kept(
  const Points& points, const Surroundings::Result& result, const Pair& pair)
{
  const Row from = normalAt(points, pair.corners), to = normalAt(result.moved, pair.corners);
  Row gap = points.row(pair.node) - placeOf(points, pair.corners, pair.weights);
  if (!from.isZero(0) && !to.isZero(0)) // else the face has no direction
  {
    gap *= Eigen::Quaterniond::FromTwoVectors(from.transpose(), to.transpose())
             .toRotationMatrix()
             .transpose();
  }
  return placeOf(result.moved, pair.corners, pair.weights) + gap;
}

bool Contact::follow(
  const BoundaryModel& model, const Surroundings::Result& result, Choice& choice, Points& targets)
{
  const Points& points = model.points();
  const std::set<Index> moving = movingBodies(model, choice);
  std::vector<Index> added;
  TargetOfNode all = targetsOf(choice, targets);
  for (const Pair& pair : this->pairs_)
  {
    if (result.roles[pair.node] == Surroundings::Stays &&
        moving.count(model.bodyOfNode[pair.node]) == 0 && hasMoved(points, result, pair))
    {
      all[pair.node] = kept(points, result, pair);
      added.push_back(pair.node);
    }
  }
  if (added.empty())
  {
    return false;
  }
  this->followers_.insert(this->followers_.end(), added.begin(), added.end());
  setMoving(all, choice, targets);
  markMovingFaces(model.faces, choice);
  return true;
}

void Contact::warnOfLost(const BoundaryModel& model, const Choice& choice,
  const Surroundings::Result& result, Monitor& monitor) const
{
  constexpr double Rounding = 1e-9; // of the size
  const std::set<Index> moving = movingBodies(model, choice);
  double most = 0;
  std::vector<Index> lost;
  for (const Pair& pair : this->pairs_)
  {
    if (moving.count(model.bodyOfNode[pair.node]) == 0 && hasMoved(model.points(), result, pair))
    {
      const double distance =
        (result.moved.row(pair.node) - kept(model.points(), result, pair)).norm();
      if (distance > Rounding * model.size)
      {
        most = std::max(most, distance);
        lost.push_back(pair.node);
      }
    }
  }
  if (!lost.empty())
  {
    std::ostringstream text;
    text << "Contact is not kept where a zone or `Surroundings` moves or holds nodes in contact: "
         << lost.size() << " nodes are off by up to " << most << ", point ids " << listIds(lost)
         << ". Let their body stay, or its zones go.";
    monitor.warn(text.str());
  }
}

void Contact::setRoles(Surroundings::Result& result) const
{
  for (const Index node : this->followers_)
  {
    if (result.roles[node] == Surroundings::Moves)
    {
      result.roles[node] = Surroundings::Follows;
    }
  }
}

Contact::Gaps Contact::gaps(const BoundaryModel& model, const Points& points) const
{
  const Facets triangles(trianglesOf(model, this->options_), points);
  Gaps gaps{ std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity() };
  for (const Pair& pair : this->pairs_)
  {
    const Row place = points.row(pair.node);
    const TriangleTree::Found found =
      otherBody(model, triangles, pair.node, place, std::numeric_limits<double>::infinity());
    const Row arm = place - found.place;
    // At an edge the arm may lie in the plane of the face, by rounding below it.
    constexpr double Below = -1e-6;
    const double height = arm.dot(triangles.tree.normal(found.triangle));
    const double gap = height < Below * arm.norm() ? -arm.norm() : arm.norm();
    gaps.least = std::min(gaps.least, gap);
    gaps.most = std::max(gaps.most, gap);
  }
  return gaps;
}

std::string Contact::report(const Gaps& before, const Gaps& after) const
{
  std::ostringstream text;
  text << this->pairs_.size() << " nodes in contact: gap " << before.least << " to " << before.most
       << " before, " << after.least << " to " << after.most << " after";
  if (std::min(before.least, after.least) < 0)
  {
    text << "; below 0 bodies overlap";
  }
  return text.str();
}
}
