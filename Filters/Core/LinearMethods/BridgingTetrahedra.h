// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/Delaunay.h"
#include "Interpolation/InterpolationSites.h"
#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// Returns the tetrahedra of `used` with an edge that leaves the mesh at one end by more than 0.01
/// rad. They span a hole, a slot or the gap between bodies, and couple boundaries that face each
/// other across it. The nearest outer face decides whether a direction leaves the mesh, or the sum
/// of two equally near normals (Baerentzen, Aanaes, IEEE Trans. Vis. Comput. Graph. 11 (2005)
/// 243-253). `prescribed`: the ids that the sites are made from. Cost: the volumes of cells and
/// tetrahedra. If these differ, also boundaryFaces() and a few tests a tetrahedron.
std::vector<int> bridgingTetrahedra(const Mesh& mesh, const std::vector<Index>& prescribed,
  const InterpolationSites& sites, const Delaunay& delaunay, const std::vector<int>& used,
  Monitor& monitor);
}
