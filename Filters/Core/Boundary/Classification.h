// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/SurfaceEdges.h"
#include "Boundary/SurfacePatches.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Given knowledge about the geometry. Unknown arrays are empty.
struct GivenGeometry
{
  std::vector<Index> surface; ///< #faces, surface id, NoGeometry where unknown
  /// #nodes, 0 vertex, 1 curve, 2 surface; read at boundary nodes
  std::vector<std::int8_t> dimension;
  std::vector<Index> id; ///< #nodes, id of that vertex, curve or surface; with `dimension`
  /// #nodes, parameter on the curve; read where `dimension` is 1; NaN where unknown
  std::vector<double> parameter;
};

struct ClassificationOptions
{
  /// degrees, [0, 180]: an edge whose faces turn by more is a feature
  double featureAngle = 25;
  /// degrees, [0, 180]: a curve that turns by more at a node has a vertex there
  double cornerAngle = 45;
  bool featuresInside = false; ///< also find features inside surfaces whose ids are given
  GivenGeometry given;
  /// Of a mesh: a number for each of the last faces, which lie inside and are classified apart.
  /// Connected ones of one number are a surface, without curves; it ends at features, too.
  std::vector<Index> sheets;
};

struct GeometryVertex
{
  Index id = 0;
  Index node = -1;
};

struct GeometryCurve : CurveChain
{
  Index id = 0;
  std::vector<double> parameter; ///< #nodes, ascending in [0, 1]: arc length, or as given
  std::vector<Index> surfaces;   ///< numbers of the adjacent surfaces, ascending
};

struct GeometrySurface
{
  Index id = 0;
  std::vector<Index> faces; ///< ascending
  /// ascending: all nodes of its faces, including its curves and vertices
  std::vector<Index> nodes;
  std::vector<Index> curves; ///< numbers of its curves, ascending
};

/// Which geometry owns each node: a vertex, curve, surface or volume (dimension 0 to 3).
struct Classification
{
  std::vector<std::int8_t> dimension; ///< #nodes; -1 for a node of no volume cell
  /// #nodes, number in `vertices`, `curves` or `surfaces`, or of the body; -1 for none
  std::vector<Index> entity;
  /// #nodes, parameter on its curve, NaN where the dimension is not 1
  std::vector<double> parameter;
  std::vector<Index> surfaceOfFace;      ///< #faces, number in `surfaces`
  std::vector<GeometryVertex> vertices;  ///< by node
  std::vector<GeometryCurve> curves;     ///< by lowest node, then lowest edge
  std::vector<GeometrySurface> surfaces; ///< by lowest face, as sorted corner ids
  SurfaceEdges edges;                    ///< of the boundary faces

  /// Returns the id of the node's vertex, curve or surface: as given, or its number. For a volume
  /// it is the body's number; -1 for none.
  Index id(Index node) const;
};

/// Finds vertices, curves and surfaces on the boundary of a mesh.
///
/// Surfaces are connected patches of boundary faces with one given id, or without feature edges
/// between them (see surfacePatches()). Curves are edges where surfaces meet or the number of
/// adjacent faces is not two, and feature edges that end inside a surface. They are cut into chains
/// at vertices. A node is a vertex if it is given as one, or ends a curve, or has three or more
/// curve edges. It also is one where a curve turns by more than `cornerAngle`, or changes its
/// adjacent surfaces, or where surfaces touch only in the node. Closed curves need no vertex,
/// closed surfaces no curve.
///
/// With `given.dimension`, a face has the id of its surface nodes. A face with all nodes on curves
/// joins a neighbor. Curve edges inside a surface (seams) join nodes given to one curve. Mid-side
/// and face nodes belong to their edge or face.
///
/// Entities are numbered by node ids, as the members say; the numbers are the ids where none are
/// given. Ids missing among given ones follow the largest given id. Surfaces of sheets come last,
/// so that the others are what they are without sheets. The shape of the result does
/// not depend on the numbering. Throws Error, with node ids, for arrays of the wrong length, angles
/// outside their range, and contradicting dimensions or ids. Cost: a sort of the boundary's edges.
Classification classify(const Mesh& mesh, const BoundaryFaces& faces,
  const ClassificationOptions& options, Monitor& monitor);

/// Classifies faces without cells, for instance a triangulated surface. All `points` (#nodes x 3)
/// are corners of faces or `between` them. No node belongs to a volume.
Classification classify(const ConstPoints& points, const BoundaryFaces& faces,
  const ClassificationOptions& options, Monitor& monitor);
}
