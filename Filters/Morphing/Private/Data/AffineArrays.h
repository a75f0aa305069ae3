// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/AffineModes.h"

#include <optional>

class vtkDataArray;
class vtkPointSet;

/// What a displaced boundary says of its own motion: fields that stay while it is dragged, and the
/// affine motion that multiplies them. A filter that uses them checks them against the points.
namespace morph::filters::AffineArrays
{
/// Point array of four components: w and p of morph::AffineFields.
constexpr const char* FieldsName = "AffineFields";
/// Field data, three tuples of four components: the rows of morph::AffineMotion.
constexpr const char* MotionName = "AffineMotion";

/// Adds both to `boundary`. `fields`: one tuple a point; the same object as the last time tells
/// that they stay.
void Write(vtkDataArray* fields, const morph::AffineMotion& motion, vtkPointSet* boundary);
/// Removes both, those of an input for instance.
void Remove(vtkPointSet* boundary);

/// By how much a coordinate may differ from what the arrays say, and still be the same up to
/// rounding. `size`: of the largest number that leads to it; `isFloat`: it has single precision.
double Rounding(double size, bool isFloat);

struct Found
{
  vtkDataArray* Fields = nullptr; ///< four components, one tuple a point
  morph::AffineMotion Motion;     ///< finite
};
/// What `boundary` has of them; nothing where one is missing, of another length or not finite.
std::optional<Found> Read(vtkPointSet* boundary);
}
