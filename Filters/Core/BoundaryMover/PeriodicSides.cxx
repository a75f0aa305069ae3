// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/PeriodicSides.h"

#include "BoundaryMover/Patches.h"
#include "Geometry/NearestNodes.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

namespace morph
{
namespace
{
using Row = Eigen::RowVector3d;
using Motion = Eigen::Isometry3d;

const char* const Option = "PeriodicSurfaces";
constexpr double Match = 1e-6; // of the boundary's size: what single precision leaves

struct Side
{
  std::vector<Index> nodes; // ascending
  Points places;
  Eigen::Vector3d area = Eigen::Vector3d::Zero(); // outwards
};

/// Corners of the faces and nodes between them.
Side sideOf(const BoundaryModel& model, const Points& areas, const PatchPart& part)
{
  Side side;
  for (std::size_t f = 0; f < part.hasFace.size(); ++f)
  {
    if (part.hasFace[f])
    {
      side.area += areas.row(static_cast<Index>(f)).transpose();
    }
  }
  for (const Index node : model.faces.nodes)
  {
    if (part.hasNode[node])
    {
      side.nodes.push_back(node);
    }
  }
  side.places = model.points()(side.nodes, allColumns);
  return side;
}

/// The part of a patch whose faces look along its first one, or against it.
PatchPart facing(
  const BoundaryModel& model, const Points& areas, const PatchPart& whole, bool isAlong)
{
  PatchPart part{ std::vector<std::uint8_t>(whole.hasNode.size()),
    std::vector<std::uint8_t>(whole.hasFace.size()) };
  const auto first = std::find(whole.hasFace.begin(), whole.hasFace.end(), 1);
  for (std::size_t f = 0; f < whole.hasFace.size(); ++f)
  {
    const Index face = static_cast<Index>(f);
    part.hasFace[f] =
      whole.hasFace[f] &&
      (areas.row(face).dot(areas.row(first - whole.hasFace.begin())) > 0) == isAlong;
    for (Index k = model.faces.offsets[f]; part.hasFace[f] && k < model.faces.offsets[f + 1]; ++k)
    {
      part.hasNode[model.faces.connectivity[k]] = 1;
    }
  }
  return part;
}

/// A translation, and rotations about the axes and the direction in which both sides have no area.
std::vector<Motion> candidates(const Side& from, const Side& to)
{
  using Vector = Eigen::Vector3d;
  const Vector shift = (to.places.colwise().mean() - from.places.colwise().mean()).transpose(),
               center = from.places.colwise().mean().transpose(), after = -to.area;
  std::vector<Motion> result(1, Motion(Eigen::Translation3d(shift)));
  for (const Vector& direction : { Vector(from.area.cross(after)), Vector(Vector::UnitX()),
         Vector(Vector::UnitY()), Vector(Vector::UnitZ()) })
  {
    if (!(direction.norm() > 0))
    {
      continue;
    }
    const Vector axis = direction.normalized(), first = from.area - axis.dot(from.area) * axis,
                 second = after - axis.dot(after) * axis;
    const double angle = std::atan2(axis.dot(first.cross(second)), first.dot(second));
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    if (!(std::abs(angle) > 1e-6))
    {
      continue;
    }
    // The point c of the axis with turn (x - c) + c = y for the means x and y, up to a shift along
    // the axis.
    const Vector moved = center + shift - turn * center;
    const Eigen::Matrix3d rest = Eigen::Matrix3d::Identity() - turn + axis * axis.transpose();
    const Vector fixed = rest.inverse() * (moved - axis.dot(moved) * axis);
    result.push_back(Eigen::Translation3d(fixed) * Motion(turn) * Eigen::Translation3d(-fixed));
  }
  return result;
}

/// The number in `to` of the image of each node of `from`; -1 for none within `reach`. `near`: of
/// the places of `to`.
std::vector<Index> imagesBy(
  const Motion& motion, const Side& from, const Side& to, const NearestNodes& near, double reach)
{
  std::vector<Index> images(from.nodes.size(), -1);
  std::vector<std::int32_t> found;
  for (std::size_t i = 0; i < images.size(); ++i)
  {
    const Row place = from.places.row(static_cast<Index>(i));
    const Row image = (motion * Eigen::Vector3d(place.transpose())).transpose();
    near.nearest(image, 1, found);
    const Index nearest = found.front();
    images[i] = (to.places.row(nearest) - image).norm() <= reach ? nearest : -1;
  }
  return images;
}

bool isPrescribed(signed char role)
{
  return role == Surroundings::Moves || role == Surroundings::IsHeld ||
         role == Surroundings::IsZone;
}
}

PeriodicSides::Names PeriodicSides::parse(const std::string& text)
{
  const auto trimmed = [](const std::string& part)
  {
    const std::size_t first = part.find_first_not_of(" \t\n");
    return first == std::string::npos
             ? std::string()
             : part.substr(first, part.find_last_not_of(" \t\n") - first + 1);
  };
  Names names;
  for (std::size_t at = 0; at <= text.size();)
  {
    const std::size_t end = std::min(text.find(';', at), text.size());
    const std::string pair = text.substr(at, end - at);
    const std::size_t sign = pair.find('=');
    at = end + 1;
    if (trimmed(pair).empty())
    {
      continue;
    }
    names.push_back({ trimmed(pair.substr(0, sign)),
      sign == std::string::npos ? "" : trimmed(pair.substr(sign + 1)) });
    if (names.back()[0].empty() || names.back()[1].empty())
    {
      throw Error("`PeriodicSurfaces` has '" + trimmed(pair) +
                  "', which is no pair of names. Write pairs as left = right; front = back.");
    }
  }
  return names;
}

void PeriodicSides::find(const BoundaryModel& model, const Names& names)
{
  if (this->version_ == model.inputVersion && this->names_ == names)
  {
    return;
  }
  this->version_ = -1;
  this->turns_.clear();
  this->images_.clear();
  const Points areas = names.empty() ? Points() : model.outwardAreas(model.points());
  for (const auto& [first, second] : names)
  {
    PatchPart one = findPatches(model, { first }, Option),
              other = findPatches(model, { second }, Option);
    if (first == second)
    {
      other = facing(model, areas, one, false);
      one = facing(model, areas, one, true);
    }
    const Side from = sideOf(model, areas, one), to = sideOf(model, areas, other);
    std::vector<Index> best(from.nodes.size(), -1);
    Eigen::Matrix3d turn;
    Index missing = static_cast<Index>(best.size());
    std::vector<Motion> motions;
    std::optional<NearestNodes> near;
    if (!from.nodes.empty() && !to.nodes.empty())
    {
      motions = candidates(from, to);
      near.emplace(to.places);
    }
    for (const Motion& motion : motions)
    {
      std::vector<Index> images = imagesBy(motion, from, to, *near, Match * model.size);
      const Index without = std::count(images.begin(), images.end(), -1);
      if (without < missing)
      {
        missing = without;
        best = std::move(images);
        turn = motion.linear();
      }
    }
    if (from.nodes.size() != to.nodes.size() || missing > 0 || best.empty())
    {
      std::vector<Index> without;
      for (std::size_t i = 0; i < best.size(); ++i)
      {
        if (best[i] < 0)
        {
          without.push_back(from.nodes[i]);
        }
      }
      throw Error(
        "`PeriodicSurfaces`: " + first + " has " + std::to_string(from.nodes.size()) + " nodes, " +
        second + " has " + std::to_string(to.nodes.size()) +
        ", and they are no images of each other by a translation or rotation" +
        (without.empty() ? "." : ": point ids without an image: " + listIds(without) + ".") +
        " Each node needs one, to a millionth of the size. Give `PeriodicSurfaces` none if they "
        "need not stay images.");
    }
    for (std::size_t i = 0; i < best.size(); ++i)
    {
      this->images_.push_back({ from.nodes[i], to.nodes[best[i]], this->turns_.size() });
    }
    this->turns_.push_back(turn);
  }
  this->names_ = names;
  this->version_ = model.inputVersion;
}

void PeriodicSides::addImages(const BoundaryModel& model, Choice& choice, Points& targets) const
{
  if (this->images_.empty())
  {
    return;
  }
  const Points& points = model.points();
  TargetOfNode moving = targetsOf(choice, targets);
  std::set<Index> held(choice.held.begin(), choice.held.end());
  const auto take = [&](Index from, Index to, const Eigen::Matrix3d& turn)
  {
    const auto found = moving.find(from);
    if (found == moving.end())
    {
      return held.count(from) > 0 && moving.count(to) == 0 && held.insert(to).second;
    }
    held.erase(to);
    const Row step = (found->second - points.row(from)) * turn.transpose();
    return moving.try_emplace(to, points.row(to) + step).second;
  };
  // A node in a corner of the mesh has images of images.
  for (bool isChanged = true; isChanged;)
  {
    isChanged = false;
    for (const Image& image : this->images_)
    {
      const Eigen::Matrix3d& turn = this->turns_[image.pair];
      isChanged |= take(image.from, image.to, turn);
      isChanged |= take(image.to, image.from, turn.transpose());
    }
  }
  this->average(
    model,
    [&](Index node)
    {
      const auto found = moving.find(node);
      return found == moving.end() ? nullptr : found->second.data();
    },
    [](Index) { return false; });
  setMoving(moving, choice, targets);
  choice.held.assign(held.begin(), held.end());
  markMovingFaces(model.faces, choice);
}

void PeriodicSides::tie(const BoundaryModel& model, Surroundings::Result& result) const
{
  std::vector<Index> free;
  for (const Image& image : this->images_)
  {
    for (const Index node : { image.from, image.to })
    {
      if (result.roles[node] == Surroundings::IsFree)
      {
        free.push_back(node);
      }
    }
  }
  if (!free.empty())
  {
    sortUnique(free);
    throw Error("Nodes of `PeriodicSurfaces` are free: point ids " + listIds(free) +
                ". Such surfaces move, follow, slide or stay; or give `PeriodicSurfaces` none.");
  }
  this->average(
    model, [&](Index node) { return result.moved.row(node).data(); },
    [&](Index node) { return isPrescribed(result.roles[node]); });
  for (const Image& image : this->images_)
  {
    for (const Index node : { image.from, image.to })
    {
      const bool hasMoved = result.moved.row(node) != model.points().row(node);
      if (result.roles[node] == Surroundings::Stays && hasMoved)
      {
        result.roles[node] = Surroundings::Follows;
      }
    }
  }
}

void PeriodicSides::average(const BoundaryModel& model,
  const std::function<double*(Index)>& placeOf, const std::function<bool(Index)>& isGiven) const
{
  // Nodes that have two images, in corners of the mesh, take several passes.
  constexpr int Passes = 100;
  constexpr double Rounding = 1e-15;
  double change = 1;
  const auto set = [&](Index node, const Row& step)
  {
    Eigen::Map<Row> place(placeOf(node));
    const Row to = model.points().row(node) + step;
    change = std::max(change, (to - place).norm());
    place = to;
  };
  for (int pass = 0; pass < Passes && change > Rounding * model.size; ++pass)
  {
    change = 0;
    for (const Image& image : this->images_)
    {
      if (!placeOf(image.from))
      {
        continue;
      }
      const Eigen::Matrix3d& turn = this->turns_[image.pair];
      const bool isFrom = isGiven(image.from), isTo = isGiven(image.to);
      const Row step = Eigen::Map<Row>(placeOf(image.from)) - model.points().row(image.from),
                other = (Eigen::Map<Row>(placeOf(image.to)) - model.points().row(image.to)) * turn;
      if (image.from == image.to && !turn.isIdentity(0)) // on the axis, along which it may move
      {
        const Row axis = Eigen::AngleAxisd(turn).axis().transpose();
        if (!isFrom)
        {
          set(image.from, step.dot(axis) * axis);
        }
        continue;
      }
      const Row mean = isFrom ? step : isTo ? other : Row((step + other) / 2);
      if (!isFrom)
      {
        set(image.from, mean);
      }
      if (!isTo)
      {
        set(image.to, mean * turn.transpose());
      }
    }
  }
}
}
