// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/Dimension.h"

#include "BoundaryMover/Patches.h"
#include "BoundaryMover/SurfaceShape.h"
#include "Support/Error.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

namespace morph
{
namespace
{
using Row = SurfaceShape::Row;
using Kind = Dimension::Kind;

/// What a shape's fit leaves of a direction, in radians, and of a place, in parts of its radius.
constexpr double Parallel = 1e-4, Concentric = 1e-5;

double degrees(double radians)
{
  return radians * 180 / std::acos(-1.);
}

std::string digits(double value)
{
  std::ostringstream text;
  text << std::setprecision(4) << value;
  return text.str();
}

/// The angle between two lines, [0, 90] degrees in radians.
double between(const Row& a, const Row& b)
{
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

/// A dimension, and along what it changes.
struct Measured : Dimension
{
  std::vector<SurfaceShape> shapes;
  Row along = Row::Zero(); ///< unit vector from the first shape to the second, or an angle's axis
  Row place = Row::Zero(); ///< a point of an angle's axis
  std::array<double, 2> grows = { 1, 1 }; ///< of a radius or thickness: outwards, or inwards
};

class Measurement
{
public:
  Measurement(const BoundaryModel& model, const Choice& choice)
    : Model(model)
  {
    this->Found.surfaces = movingSurfaces(model, choice);
    std::sort(this->Found.surfaces.begin(), this->Found.surfaces.end(),
      [&](Index a, Index b)
      { return model.geometry.surfaces[a].id < model.geometry.surfaces[b].id; });
    const std::size_t count = this->Found.surfaces.size();
    if (count == 0 || count > 2)
    {
      throw Error("`Dimension` is that of two surfaces, or of one cylinder or sphere, and " +
                  std::to_string(count) + " move. Choose one or two.");
    }
    for (const Index s : this->Found.surfaces)
    {
      this->Found.shapes.emplace_back(model.points(), model.faces, model.geometry.surfaces[s]);
    }
    this->requireShapes();
    count == 1 ? this->radius() : this->two();
  }

  Measured take() { return std::move(this->Found); }

private:
  const BoundaryModel& Model;
  Measured Found;

  std::string name(std::size_t which) const
  {
    return surfaceName(this->Model.geometry, this->Found.surfaces[which]);
  }

  void requireShapes() const
  {
    for (std::size_t i = 0; i < this->Found.shapes.size(); ++i)
    {
      if (this->Found.shapes[i].kind() == SurfaceShape::Kind::Facets)
      {
        throw Error("`Dimension` needs planes, cylinders or spheres, and " + this->name(i) +
                    " is none of these. Choose such surfaces, or another displacement.");
      }
    }
  }

  void radius()
  {
    if (!this->Found.shapes[0].isRound())
    {
      throw Error("A plane alone has no `Dimension`, and only " + this->name(0) +
                  " moves. Choose a second surface, from which it is measured.");
    }
    this->Found.kind = Kind::Radius;
    this->Found.value = this->Found.shapes[0].radius();
  }

  void two()
  {
    const SurfaceShape &a = this->Found.shapes[0], &b = this->Found.shapes[1];
    using Of = SurfaceShape::Kind;
    if (a.kind() == Of::Plane && b.kind() == Of::Plane &&
        between(a.direction(), b.direction()) > Parallel)
    {
      this->angle();
      return;
    }
    // A plane and an axis are parallel where its normal is across the axis.
    const bool isAcross = (a.kind() == Of::Plane) != (b.kind() == Of::Plane);
    if (a.kind() != Of::Sphere && b.kind() != Of::Sphere)
    {
      const double angle = between(a.direction(), b.direction());
      const double off = isAcross ? std::acos(0.) - angle : angle;
      if (off > Parallel)
      {
        throw Error("`Dimension` needs parallel surfaces: " + this->name(0) + " and " +
                    this->name(1) + " are not, by " + digits(degrees(off)) +
                    " degrees. Choose others, or make them parallel first.");
      }
    }
    Row way = b.center() - a.center();
    if (a.kind() == Of::Plane || b.kind() == Of::Plane)
    {
      const Row& normal = a.kind() == Of::Plane ? a.direction() : b.direction();
      way = way.dot(normal) * normal;
    }
    else if (a.kind() == Of::Cylinder || b.kind() == Of::Cylinder)
    {
      const Row& axis = a.kind() == Of::Cylinder ? a.direction() : b.direction();
      way -= way.dot(axis) * axis;
    }
    const double distance = way.norm();
    const bool areAlike = a.kind() == b.kind() && a.isRound();
    if (areAlike && distance <= Concentric * (a.radius() + b.radius()))
    {
      this->Found.kind = Kind::Thickness;
      this->Found.value = std::abs(b.radius() - a.radius());
      this->Found.grows[a.radius() > b.radius() ? 1 : 0] = -1;
    }
    else
    {
      this->Found.kind = Kind::Distance;
      this->Found.value = distance;
      this->Found.along = way / distance;
    }
    if (!(this->Found.value > Concentric * this->Model.size))
    {
      throw Error("`Dimension` of " + this->name(0) + " and " + this->name(1) +
                  " is 0, so that it has no direction. Choose others.");
    }
  }

  /// Each surface lies on one side of the line in which the planes meet. The angle is that between
  /// these sides.
  void angle()
  {
    const SurfaceShape &a = this->Found.shapes[0], &b = this->Found.shapes[1];
    Row axis = a.direction().cross(b.direction()).normalized();
    Eigen::Matrix3d planes;
    planes << a.direction(), b.direction(), axis;
    const Eigen::Vector3d sides(a.direction().dot(a.center()), b.direction().dot(b.center()),
      axis.dot(a.center() + b.center()) / 2);
    this->Found.place = planes.inverse() * sides;
    const auto sideOf = [&](const SurfaceShape& plane)
    {
      const Row from = plane.center() - this->Found.place;
      return Row(from - from.dot(axis) * axis);
    };
    const Row first = sideOf(a), second = sideOf(b);
    const double turn = axis.dot(first.cross(second));
    this->Found.kind = Kind::Angle;
    this->Found.value = degrees(std::atan2(std::abs(turn), first.dot(second)));
    this->Found.along = turn < 0 ? Row(-axis) : axis;
    if (!(std::min(first.norm(), second.norm()) > Concentric * this->Model.size))
    {
      throw Error("`Dimension` of " + this->name(0) + " and " + this->name(1) +
                  " is no angle: one of them lies on both sides of the other. Choose others.");
    }
  }
};

/// The displacement of a point of one of the surfaces by its part of the change.
Row displaced(const Measured& measured, std::size_t which, double change, const Row& x)
{
  const double way = which == 0 ? -change : change;
  switch (measured.kind)
  {
    case Kind::Radius:
    case Kind::Thickness:
      return change * measured.grows[which] * measured.shapes[which].outwards(x);
    case Kind::Angle:
    {
      const Eigen::AngleAxisd turn(way * std::acos(-1.) / 180, measured.along.transpose());
      const Row from = x - measured.place;
      return Row((turn * from.transpose()).transpose()) - from;
    }
    default:
      return way * measured.along;
  }
}
}

std::string Dimension::text(const BoundaryModel& model) const
{
  static const std::array<const char*, 4> kinds = { "Radius", "Distance", "Angle", "Thickness" };
  std::string text = kinds[static_cast<std::size_t>(this->kind)];
  for (std::size_t i = 0; i < this->surfaces.size(); ++i)
  {
    text += (i == 0 ? " of " : " and ") + surfaceName(model.geometry, this->surfaces[i]);
  }
  return text + ": " + digits(this->value) + (this->kind == Kind::Angle ? " degrees" : "");
}

std::vector<Index> movingSurfaces(const BoundaryModel& model, const Choice& choice)
{
  std::vector<Index> surfaces;
  for (std::size_t s = 0; s < model.geometry.surfaces.size(); ++s)
  {
    const std::vector<Index>& faces = model.geometry.surfaces[s].faces;
    if (std::any_of(
          faces.begin(), faces.end(), [&](Index face) { return choice.isMovingFace[face] != 0; }))
    {
      surfaces.push_back(static_cast<Index>(s));
    }
  }
  return surfaces;
}

Dimension dimensionOf(const BoundaryModel& model, const Choice& choice)
{
  return Measurement(model, choice).take();
}

Points movedToDimension(const BoundaryModel& model, const Choice& choice, double wanted,
  DimensionSide side, double fraction, double* present)
{
  const Points from = model.points()(choice.moving, allColumns);
  const Measured measured = Measurement(model, choice).take();
  if (present)
  {
    *present = measured.value;
  }
  if (wanted == 0)
  {
    return from;
  }
  if (measured.kind == Kind::Angle && wanted >= 180)
  {
    throw Error("`Dimension` is an angle here, which is below 180 degrees. Give a smaller one.");
  }
  const double change = fraction * (wanted - measured.value);
  std::array<double, 2> parts = { 0.5, 0.5 };
  if (side != DimensionSide::Both)
  {
    parts = { side == DimensionSide::First ? 1. : 0., side == DimensionSide::Second ? 1. : 0. };
  }
  if (measured.kind == Kind::Radius)
  {
    parts[0] = 1;
  }
  Points to = from;
  std::vector<std::uint8_t> isDone(choice.moving.size(), 0);
  std::vector<Index> torn;
  for (std::size_t which = 0; which < measured.surfaces.size(); ++which)
  {
    const double part = parts[which] * change;
    const GeometrySurface& surface = model.geometry.surfaces[measured.surfaces[which]];
    const double radius = measured.shapes[which].radius();
    if (measured.kind == Kind::Thickness && radius + part * measured.grows[which] <= 0)
    {
      throw Error("`Dimension` would leave " +
                  surfaceName(model.geometry, measured.surfaces[which]) + " no radius: it has " +
                  digits(radius) + ". Give a smaller one, or let the other side move.");
    }
    for (const Index node : surface.nodes)
    {
      const auto at = std::lower_bound(choice.moving.begin(), choice.moving.end(), node);
      if (at == choice.moving.end() || *at != node)
      {
        continue;
      }
      const Index i = static_cast<Index>(at - choice.moving.begin());
      const Row there = from.row(i) + displaced(measured, which, part, from.row(i));
      if (isDone[i] && (there - to.row(i)).norm() > Concentric * model.size)
      {
        torn.push_back(node);
      }
      to.row(i) = there;
      isDone[i] = 1;
    }
  }
  if (!torn.empty())
  {
    throw Error("`Dimension` moves two surfaces apart that share nodes: point ids " +
                listIds(torn) + ". Choose surfaces that do not touch, or whose angle changes.");
  }
  return to;
}
}
