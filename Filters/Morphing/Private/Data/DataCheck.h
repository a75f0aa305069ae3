// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

#include <vector>

class vtkDataArray;
class vtkDataObject;
class vtkDataSet;

/// The checks of every data set before its use. VTK checks neither the lengths of arrays nor ids,
/// and reads past the end of both.
namespace morph::filters::DataCheck
{
/// Numbers between these bounds have sixth powers that neither overflow nor vanish.
constexpr double Largest = 1e50, Smallest = 1e-50;

/// The place where node ids of cells are checked.
enum class Cells
{
  Here,   ///< Require()
  InCore, ///< morph::validate(), which sees every new mesh
};

/// Throws a morph::Error that begins with `subject` ("The input") and says what to do, where
/// - a point or cell array has fewer tuples than there are points or cells (more do no harm);
/// - the cells of a grid or of polygonal data are inconsistent, or name points that do not exist;
/// - a coordinate is above Largest, or the largest side of the bounding box is below Smallest and
///   not 0. Coordinates that are not finite pass: their user names the nodes.
/// Null passes, and so do data without points of their own. Cost: one pass over the points, and
/// over the cells of other data than grids.
void Require(vtkDataObject* data, const char* subject, Cells cells = Cells::Here);

/// Throws as above for point and cell arrays that are too short, in data of any type.
void RequireLengths(vtkDataSet* data, const char* subject);

/// Whether x is finite and not above Largest.
bool IsModerate(const Eigen::RowVector3d& x);

/// The rows of `x` that are not moderate. `monitor`: has the threads for it, null for none.
std::vector<morph::Index> Immoderate(const morph::Points& x, morph::Monitor* monitor = nullptr);

/// The point array by which ParaView's Resample With Dataset marks points without a value: 0.
constexpr const char* MaskName = "vtkValidPointMask";
/// Whether a component of a point's `value` is NaN, or `mask` is 0 there. `mask`: null for none.
bool IsMissing(const Eigen::RowVector3d& value, vtkDataArray* mask, morph::Index point);

/// Throws morph::Error unless `size` is 0 or at least Smallest. `size`: the largest side of the
/// bounding box; `subject`: what it bounds.
void RequireExtent(double size, const char* subject);
}
