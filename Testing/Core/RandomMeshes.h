// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <random>
#include <string>

namespace meshes
{
/// A mesh of a few cells whose nodes are shifted at random. `kind`: hexes, tets, wedges, pyramids,
/// quadratic hexes or quadratic tets. `number`: each third one is mirrored; half of the quadratic
/// hexahedra have 27 nodes.
morph::Mesh randomMesh(const std::string& kind, int number, std::mt19937& random);

/// #rows x 3, uniform in [-amount, amount].
morph::Points noise(morph::Index rows, double amount, std::mt19937& random);
}
