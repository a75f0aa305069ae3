// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Pipeline/Ranks.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <string>

class vtkDataObject;

/// The displacement field of another mesh, of an image, or of points.
namespace morph::filters::FieldDisplacement
{
/// The displacements of a field at the places, #places x 3; rows of NaN where it has none.
/// `field`: a vtkDataSet or composite data with the point vector array `name`, or a vtkTable with
/// the columns x, y, z, dx, dy, dz; null where this process has no part of it.
///
/// - In a cell the value is that of its shape functions.
/// - Outside of all cells it is that of the nearest place of the nearest cell, at most `reach` away
///   (the unit of the points).
/// - Points without cells give an affine fit of all and the residuals of the 20 nearest, by inverse
///   squared distance, at places with a point within `reach`. It has the points' values, and
///   reproduces affine fields. Source: equations (3) to (6) of Staten et al. (IMR 2011).
///
/// A place has no value where a point that it depends on is NaN, or vtkValidPointMask 0. Of several
/// blocks or processes the nearest one counts, the first of equal ones. Throws morph::Error on all
/// processes alike for no field, points that are not finite, and cells that VTK does not know. So
/// it does for arrays that are missing, not numeric or of other than three components. Collective
/// over `processes`, which have the same places. Cost: a search tree of the cells, and some
/// microseconds a place.
morph::Points At(vtkDataObject* field, const std::string& name, const morph::Points& places,
  double reach, const RankGroup& processes, morph::Monitor& monitor);
}
