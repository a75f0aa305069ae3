// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/Delaunay.h"
#include "Interpolation/InterpolationSites.h"
#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// Those of the tetrahedra `used` that have an edge which leaves the mesh at one of its ends, by
/// more than 0.01 rad: they span a hole, a slot or the gap between bodies, and couple boundaries
/// that face each other across it. Whether a direction leaves the mesh at a node is told by the
/// outer face nearest to it, or by the sum of the normals of two that are equally near (Baerentzen,
/// Aanaes, IEEE Trans. Vis. Comput. Graph. 11 (2005) 243-253). `prescribed`: the ids the sites are
/// made from.
/// Cost: the volumes of cells and tetrahedra; where they differ also Topology's boundaryFaces and a
/// few tests a tetrahedron.
std::vector<int> bridgingTetrahedra(const Mesh& mesh, const std::vector<Index>& prescribed,
  const InterpolationSites& sites, const Delaunay& delaunay, const std::vector<int>& used,
  Monitor& monitor);
}
