// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Meshes.h"

#include <functional>

/// Solids with curved boundaries, holes and cavities for tests of what depends on the boundary's
/// geometry.
namespace shapes
{
using morph::Index;
using morph::Mesh;
using Row = Eigen::RowVector3d;

/// The cells whose center `keep` accepts; nodes stay, so some may be used by no cell.
Mesh cut(const Mesh& mesh, const std::function<bool(const Row&)>& keep);
/// Both meshes in one.
Mesh together(const Mesh& a, const Mesh& b);

/// hexes(n, n, layers) with its square bent to a disc of radius 1 about the z axis, from z = 0 to
/// `height`: 4 n cells around.
Mesh cylinder(int n, int layers, double height = 2);
/// hexes(n, n, n) bent to the unit ball about the origin.
Mesh ball(int n);
/// The ball with its inner half cut out: two closed surfaces.
Mesh hollowBall(int n);
/// A box [-2, 2] x [-2, 2] x [0, layers] with a round hole of radius 1 along z; `around`: a
/// multiple of 4.
Mesh boxWithHole(int around, int through, int layers);
/// A plate with a crease on its top face, z = 1, that starts at x = 0 and fades out before the
/// other side.
Mesh creasedPlate();
}
