// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"

#include <string>
#include <vector>

class vtkDataSetAttributes;
class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

/// Conversion of vertices, curves and surfaces of a boundary between VTK's arrays and the core.
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
  std::string SurfaceIdArray;       ///< a cell array; empty: none
  bool UseGeometryArrays = true;    ///< the point arrays above, where the grid has them
  std::vector<morph::Index> Sheets; ///< of the last faces, see morph::ClassificationOptions

  /// Takes those that all filters have that classify a boundary.
  template <typename FilterOptions>
  void Take(const FilterOptions& from)
  {
    this->FeatureAngle = from.FeatureAngle;
    this->CornerAngle = from.CornerAngle;
    this->SurfaceIdArray = from.SurfaceIdArray;
    this->UseGeometryArrays = from.UseGeometryArrays;
  }
};

/// Classifies the boundary of `grid`. `mesh`, `faces`: of `grid`. Surface ids come from
/// SurfaceIdArray: a boundary face has the id of the two-dimensional cell on it or, in a grid
/// without such cells, of the volume cell behind it. Faces without a cell on them have none.
/// Without a SurfaceIdArray, GeometryDimension and GeometryId (and CurveParameter) are used if the
/// grid has them. Throws morph::Error as morph::classify() does, and for arrays that do not exist,
/// or have the wrong type or length, or values that are not whole numbers.
morph::Classification Classify(vtkUnstructuredGrid* grid, const morph::Mesh& mesh,
  const morph::BoundaryFaces& faces, const Options& options, morph::Monitor& monitor);

/// Classifies a surface that was extracted before. `faces`: its polygons, each a face, with its
/// points as nodes. `points`: #points x 3, the positions to use. SurfaceIdArray is a cell array of
/// the surface.
morph::Classification Classify(vtkPolyData* surface, const morph::Points& points,
  const morph::BoundaryFaces& faces, const Options& options, morph::Monitor& monitor);

/// The arrays and options that the geometry of an input depends on beside its points and faces.
std::string Key(vtkPointSet* input, const Options& options);

/// Adds the three arrays above for `nodes` (one tuple each), replacing arrays of these names:
/// signed char, vtkIdType and double.
void AddPointArrays(const morph::Classification& geometry, const std::vector<morph::Index>& nodes,
  vtkDataSetAttributes* output);

/// Adds the cell array GeometryId to the boundary's polygons: the id of each one's surface.
/// `faceOf`: the face of each polygon.
void AddSurfaceIds(const morph::Classification& geometry, const std::vector<morph::Index>& faceOf,
  vtkPolyData* output);

/// Writes the vertices as vtkVertex and the curves as vtkPolyLine, undeformed. Points have the
/// three arrays above and MorphPointId; cells have GeometryDimension (0 and 1) and GeometryId.
void WriteCurves(
  vtkUnstructuredGrid* grid, const morph::Classification& geometry, vtkPolyData* output);
}
