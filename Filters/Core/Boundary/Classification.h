// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/CurveChains.h"
#include "Boundary/SurfacePatches.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// What is known about the geometry before the mesh is looked at. Arrays are empty where nothing
/// is.
struct GivenGeometry
{
  std::vector<Index> surface; ///< #faces, surface id, NoGeometry where unknown
  /// #nodes, 0 vertex, 1 curve, 2 surface; read at boundary nodes
  std::vector<std::int8_t> dimension;
  std::vector<Index> id; ///< #nodes, id of that vertex, curve or surface; with `dimension`
  /// #nodes, place on the curve; read where `dimension` is 1; NaN where unknown
  std::vector<double> parameter;
};

struct ClassificationOptions
{
  /// degrees, [0, 180]: neighboring faces that turn by more lie on different surfaces
  double featureAngle = 25;
  /// degrees, [0, 180]: a curve that turns by more at a node has a vertex there
  double cornerAngle = 45;
  bool featuresInside = false; ///< look for features inside surfaces whose ids are given, too
  GivenGeometry given;
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
  std::vector<Index> surfaces;   ///< numbers of the surfaces that meet there, ascending
};

struct GeometrySurface
{
  Index id = 0;
  std::vector<Index> faces; ///< ascending
  /// ascending: all nodes on its faces, those of its curves and vertices too
  std::vector<Index> nodes;
  std::vector<Index> curves; ///< numbers of its curves, ascending
};

/// Which geometry owns each node: a vertex, curve, surface or volume (dimension 0 to 3).
struct Classification
{
  std::vector<std::int8_t> dimension; ///< #nodes; -1 for a node of no volume cell
  /// #nodes, number in `vertices`, `curves` or `surfaces`, or of the body; -1 for none
  std::vector<Index> entity;
  std::vector<double> parameter; ///< #nodes, place on its curve, NaN where the dimension is not 1
  std::vector<Index> surfaceOfFace;      ///< #faces, number in `surfaces`
  std::vector<GeometryVertex> vertices;  ///< by node
  std::vector<GeometryCurve> curves;     ///< by lowest node, then lowest edge
  std::vector<GeometrySurface> surfaces; ///< by lowest face, as sorted corner ids
  SurfaceEdges edges;                    ///< of the boundary faces

  /// Id of the geometry that owns the node: as given or its number; of volumes the body's number;
  /// -1 for none.
  Index id(Index node) const;
};

/// Finds vertices, curves and surfaces on the boundary of a mesh.
///
/// Surfaces are connected patches of boundary faces: of one given id, or with no feature edge
/// between (see surfacePatches()). Curves are the edges where surfaces meet, where other than two
/// faces meet, and feature edges that end inside a surface, cut into chains at vertices. A node is
/// a vertex where it is given as one; where a curve ends, or three or more curve edges meet; where
/// a curve turns by more than `cornerAngle` or changes the surfaces beside it; and where surfaces
/// touch in the node alone. Closed curves without a vertex and closed surfaces without a curve are
/// left so.
///
/// With `given.dimension` the faces' ids are those of their surface nodes; a face all of whose
/// nodes are on curves goes with a neighbor. Curve edges inside a surface (seams) are those that
/// join nodes given to one curve. Mid-side and face nodes belong to the edge or face they lie in.
///
/// Numbers follow the node ids as the members say and are the ids where none are given; ids that
/// are missing among given ones follow the greatest of them. The shape of the result does not
/// depend on the numbering. Throws Error for arrays of the wrong length, angles outside their
/// range, and given dimensions or ids that contradict each other, with node ids. Cost: a sort of
/// the boundary's edges.
Classification classify(const Mesh& mesh, const BoundaryFaces& faces,
  const ClassificationOptions& options, Monitor& monitor);

/// The same for faces without cells, a triangulated surface for instance: all its nodes are corners
/// of faces or `between` them. Volumes have no part in it.
Classification classify(const ConstPoints& points, const BoundaryFaces& faces,
  const ClassificationOptions& options, Monitor& monitor);
}
