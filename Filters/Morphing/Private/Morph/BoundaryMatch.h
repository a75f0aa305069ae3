// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"

#include <string>
#include <vector>

class vtkPointSet;

/// Matches the points of a displaced boundary to nodes of the undeformed mesh, and computes the
/// nodes' targets.
namespace morph::filters::BoundaryMatch
{
struct Options
{
  std::string BoundaryIdArray;   ///< empty: none
  std::string DisplacementArray; ///< empty: the boundary's points are the targets
  double ScaleFactor = 1;        ///< target = rest + ScaleFactor * (target - rest)
  double MatchTolerance = 1e-6;  ///< of the undeformed mesh's size
  bool HoldUnnamedBoundary = true;
};

struct Result
{
  std::vector<morph::Index> Ids;     ///< sorted, unique
  morph::Points Targets;             ///< #Ids x 3, finite
  std::vector<morph::Index> Sources; ///< #Ids, the boundary point that a node follows, -1: held
  morph::Index Unmatched = 0;        ///< boundary points that stand for no node
  std::vector<std::string> Warnings;
};

/// Matches the points of `boundary`. `outer`, `size`: of the undeformed mesh; see GridMesh::Size.
/// Ids come from the first of: the
/// array BoundaryIdArray; MorphPointId; the point's own number where the boundary has as many
/// points as the mesh (outer nodes only); PointIds; vtkOriginalPointIds, with a warning; the
/// nearest node within MatchTolerance, if there is a DisplacementArray. The outer nodes within
/// MatchTolerance of that node move with it, unless they have a point of their own. A node that is
/// named more than once goes where it is named first. Nodes that the array MorphFree marks (not 0)
/// are solved with the interior, unless another point names them. With HoldUnnamedBoundary all
/// other outer nodes are held, except those in the middle of an edge or face one of whose corners
/// moves. Throws morph::Error naming ids and the remedy where none of these works, for arrays that
/// are not numeric or not as long as the boundary has points, and where all points are free. Cost:
/// one pass over the boundary; by position also a point locator over the mesh.
Result Match(vtkPointSet* boundary, const morph::Mesh& rest, const morph::BoundaryFaces& outer,
  double size, const Options& options);
}
