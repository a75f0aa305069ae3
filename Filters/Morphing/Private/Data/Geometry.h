// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"

#include <string>
#include <vector>

class vtkDataSetAttributes;
class vtkPolyData;
class vtkUnstructuredGrid;

/// Vertices, curves and surfaces of a grid's boundary, between VTK's arrays and the core.
namespace morph::filters::Geometry
{
constexpr const char* DimensionName = "GeometryDimension";
constexpr const char* IdName = "GeometryId";
constexpr const char* ParameterName = "CurveParameter";

struct Options
{
  double FeatureAngle = 25; ///< degrees
  double CornerAngle = 45;  ///< degrees
  bool FeaturesInside = false;
  std::string SurfaceIdArray;    ///< a cell array; empty: none
  bool UseGeometryArrays = true; ///< the point arrays above, where the grid has them
};

/// Classifies the boundary of `grid`; `mesh` and `faces` are its own. Surface ids come from
/// SurfaceIdArray: a boundary face has that of the two-dimensional cell on it, or, in a grid
/// without such cells, of the volume cell behind it; faces without a cell on them have none. Else
/// GeometryDimension and GeometryId (and CurveParameter) are used where the grid has them. Throws
/// morph::Error for arrays that do not exist, or have the wrong type or length or values that are
/// no whole numbers, and where morph::classify() does.
morph::Classification Classify(vtkUnstructuredGrid* grid, const morph::Mesh& mesh,
  const morph::BoundaryFaces& faces, const Options& options, morph::Monitor& monitor);

/// The same for a surface that was extracted before. `faces`: its polygons, each a face, of nodes
/// that are its points. `points`: #points x 3, where they are looked at. SurfaceIdArray is a cell
/// array of the surface.
morph::Classification Classify(vtkPolyData* surface, const morph::Points& points,
  const morph::BoundaryFaces& faces, const Options& options, morph::Monitor& monitor);

/// Adds the three arrays above for `nodes` (one tuple each), replacing arrays of these names:
/// signed char, vtkIdType and double.
void AddPointArrays(const morph::Classification& geometry, const std::vector<morph::Index>& nodes,
  vtkDataSetAttributes* output);

/// Adds the cell array GeometryId to the boundary's polygons: the id of each one's surface.
/// `faceOf`: the face of each polygon.
void AddSurfaceIds(const morph::Classification& geometry, const std::vector<morph::Index>& faceOf,
  vtkPolyData* output);

/// The vertices as vtkVertex and the curves as vtkPolyLine, at rest, with the three arrays above
/// and MorphPointId on the points, and GeometryDimension (0 and 1) and GeometryId on the cells.
void WriteCurves(
  vtkUnstructuredGrid* grid, const morph::Classification& geometry, vtkPolyData* output);
}
