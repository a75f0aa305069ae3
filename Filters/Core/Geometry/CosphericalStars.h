// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/Delaunay.h"
#include "Support/Lists.h"
#include "Support/Monitor.h"

namespace morph
{
/// Tetrahedra that do not depend on how a Delaunay tessellation divides cospherical sites.
///
/// More than four sites on one empty sphere are the corners of one convex cell, whose division is
/// arbitrary. Here each such cell is divided into the pyramids from the mean
/// of its corners to its faces. A face with more than three corners is divided into triangles from
/// the mean of its own corners. Neighboring cells have the same face and divide it alike. So the
/// tetrahedra follow the sites through any rigid motion and any renumbering. Tetrahedra in no cell
/// remain.
///
/// `delaunay`: its tetrahedra are replaced, and the means follow its sites, as further ones.
/// Returns the sites of each mean, ascending. Cost: 2 microseconds a tetrahedron.
Adjacency starCosphericalCells(Delaunay& delaunay, Monitor& monitor);

/// Returns `values`, one row a site, followed by their means. `means`: from starCosphericalCells().
Points withMeans(const Points& values, const Adjacency& means, Monitor& monitor);
}
