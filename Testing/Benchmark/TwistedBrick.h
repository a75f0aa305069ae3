// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"

#include <string>

namespace benchmark
{
/// A morphing problem: the undeformed mesh, its outer boundary and where the boundary goes.
struct Problem
{
  std::string name;
  morph::Mesh mesh;
  morph::NodePartition partition; ///< all outer boundary nodes prescribed
  morph::Points target;           ///< #prescribed x 3, new positions
  double size = 0;                ///< diagonal of the undeformed mesh's bounding box
};

/// A brick of nx x ny x nz unit hexahedra. Its boundary is twisted by 90 degrees about the line
/// through the center along `axis` (0: x, 2: z), linearly over the brick's length, and stretched
/// 1.5 times along that axis. Inner nodes of the undeformed mesh are off their lattice places by up
/// to `jitter` in each coordinate, always the same.
Problem twistedBrick(int nx, int ny, int nz, int axis, double jitter = 0);
}
