// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Classification.h"

namespace morph
{
/// Surface ids of the faces: `given.surface`, or, from nodes that are given to surfaces, the id that a face's surface nodes
/// have. A face without a surface node takes the id of a neighbor: first over edges that cannot lie on a curve, since their
/// ends are on different curves; then over edges that are no features, the flattest first. Empty if neither is given.
/// Throws Error naming nodes of one face that are given to different surfaces.
std::vector<Index> givenSurfaces(
  const BoundaryFaces& faces, const SurfaceEdges& edges, const ClassificationOptions& options);

/// Marks, in patches.isCurve, edges of given curves inside a surface, such as seams: those that join nodes given to one curve,
/// features that join two vertices, and, where a curve needs one, its straightest continuation to a node given as a vertex. An edge between
/// nodes that have their two curve edges already is a chord of the curve and stays unmarked.
void markGivenSeams(const ConstPoints& points, const SurfaceEdges& edges,
  const ClassificationOptions& options, SurfacePatches& patches);
}
