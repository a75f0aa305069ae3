// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <vector>

class vtkDataArray;
class vtkDataObject;
class vtkDataSet;

/// The checks of every data set before its use. VTK checks neither the lengths of arrays nor ids,
/// and reads past the end of both.
namespace morph::filters::DataCheck
{
/// The place where node ids of cells are checked.
enum class Cells
{
  Here,   ///< Require()
  InCore, ///< morph::validate(), which sees every new mesh
};

/// Throws a morph::Error that begins with `subject` ("The input") and says what to do, where
/// - a point or cell array has fewer tuples than there are points or cells (more do no harm);
/// - the cells of a grid or of polygonal data are inconsistent, or name points that do not exist;
/// - a coordinate is above LargestLength, or the largest side of the bounding box is below
///   SmallestLength and not 0. Coordinates that are not finite pass: their user names the nodes.
/// Null passes, and so do data without points of their own. Cost: one pass over the points, and
/// over the cells of other data than grids.
void Require(vtkDataObject* data, const char* subject, Cells cells = Cells::Here);

/// Throws as above for point and cell arrays that are too short, in data of any type.
void RequireLengths(vtkDataSet* data, const char* subject);

/// The point array by which ParaView's Resample With Dataset marks points without a value: 0.
constexpr const char* MaskName = "vtkValidPointMask";
/// Whether a component of a point's `value` is NaN, or `mask` is 0 there. `mask`: null for none.
bool IsMissing(const Eigen::RowVector3d& value, vtkDataArray* mask, morph::Index point);
}
