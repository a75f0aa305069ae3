// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
class CellGeometry;

/// A number by which solvers accept or refuse cells.
struct Criterion
{
  const char* name;
  double limit;  ///< the usual one
  bool isAtMost; ///< the limit: good cells are at most at it; else above it
  /// Of a cell; NaN where it has none. Null where VTK alone has a formula.
  double (*measure)(const CellGeometry&, Index cell);

  bool isBeyond(double value, double ofLimit) const
  {
    return this->isAtMost ? value > ofLimit : value <= ofLimit;
  }
};

/// All of them. Cells are measured by their corners.
///
///   AspectRatio     longest edge / shortest edge; of linear triangles, quads and tets Verdict's
///   Skewness        equiangle: over the angles a of faces with n edges, the maximum of
///                   (a - e) / (180 - e) and (e - a) / e, e = 180 (n - 2) / n degrees
///   Warpage         over the faces: 1 - cos^3 of the angle between the normals at corners that are
///                   no neighbors
///   JacobianRatio   smallest / largest determinant of the corners
///   Taper           Verdict's, of quads and hexahedra
///   NonOrthogonality  degrees between a face's normal and the line between the centers of its
///                   cells, the maximum over inner faces
///   FaceSkewness    distance of a face's center from that line, relative to the larger of 0.2 of
///                   its length and the face's extent along that distance; on the boundary the line
///                   is the normal through the cell's center, and 0.4 of it counts
///   FacePyramid     volume of the pyramid of a face and the cell's center, the minimum
///   FirstHeight     mean distance of a cell's other corners from a boundary face of the walls, the
///                   minimum
///
/// The first five have the conventions of Verdict (Sandia report SAND2007-1751), applied to the
/// faces of any cell; the next three are OpenFOAM's, with its centers (PolyhedronQuality.h). A cell
/// of dimension 2 is its own face, and has none of the last four.
const std::vector<Criterion>& criteria();

/// Returns a value for each cell, NaN where `skip` (#cells) is not zero. `points`: #nodes x 3;
/// `orientation`: #cells of +1 / -1 (Topology.h). Cells that are skipped are neighbors still.
/// `isWall`: #nodes, not 0 at the corners of the walls; empty: the whole boundary is wall. Cost:
/// about a microsecond a face, and for the last four a table of faces.
std::vector<double> measureCriterion(const Criterion& criterion, const Mesh& mesh,
  const ConstPoints& points, const std::vector<std::int8_t>& orientation,
  const std::vector<std::uint8_t>& skip, const std::vector<std::uint8_t>& isWall, Monitor& monitor);
}
