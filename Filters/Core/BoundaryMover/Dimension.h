// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/BoundaryModel.h"
#include "BoundaryMover/Choice.h"

#include <string>
#include <vector>

namespace morph
{
/// A dimension of a part, as a drawing has it, measured between two surfaces or of one.
struct Dimension
{
  enum class Kind
  {
    Radius,    ///< of a cylinder or a sphere
    Distance,  ///< of parallel planes; from the axis of a cylinder, or the center of a sphere
    Angle,     ///< between the sides of two planes that the surfaces lie on; degrees, (0, 180)
    Thickness, ///< of two cylinders with one axis, or spheres with one center
  };
  Kind kind = Kind::Distance;
  double value = 0;            ///< degrees, or the unit of the points
  std::vector<Index> surfaces; ///< their numbers, by ascending id

  /// "Distance of Surface 2 and Surface 3: 23", with four digits.
  std::string text(const BoundaryModel& model) const;
};

/// Which of two surfaces moves: each by half of the change, or one of them by all of it. The first
/// is that with the lower id.
enum class DimensionSide
{
  Both,
  First,
  Second
};

/// The numbers of the surfaces with faces that move, ascending.
std::vector<Index> movingSurfaces(const BoundaryModel& model, const Choice& choice);

/// The dimension of the surfaces that move. Throws Error where there is none, with why: they are
/// not one or two, have a free form, are not parallel, or touch. Cost: a few passes over their
/// nodes.
Dimension dimensionOf(const BoundaryModel& model, const Choice& choice);

/// Returns where what moves goes, #moving x 3. `present`: becomes the value that the dimension has;
/// null: unwanted. Changes the dimension by `fraction` of what it lacks to be `wanted`. A distance
/// changes along the shortest line between the shapes. A radius and a thickness change away from
/// axis or center, and an angle about the line in which the planes meet. With 0 wanted all stays.
/// Throws Error as dimensionOf() does, and for an angle of 180 degrees and more, a radius that is
/// left with nothing, and nodes that two surfaces would take apart.
Points movedToDimension(const BoundaryModel& model, const Choice& choice, double wanted,
  DimensionSide side, double fraction, double* present);
}
