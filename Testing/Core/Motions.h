// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Error.h"
#include "Meshes.h"
#include "NodePartition.h"

/// Boundary motions, and what tests of several morphing methods share.
namespace meshes
{
/// A fixed affine map with shear and translation.
Eigen::RowVector3d affine(const Eigen::RowVector3d& x);
/// A motion that is not affine: a twist about the z axis through the middle of a box of width w and height h, which it
/// also stretches 1.5 times.
Eigen::RowVector3d twist(const Eigen::RowVector3d& x, double w, double h, double angle);

/// The outer boundary prescribed.
morph::NodePartition outerPartition(const Mesh& mesh);
/// Where `map` takes the prescribed nodes.
Points targets(const Mesh& mesh, const morph::NodePartition& partition,
  const std::function<Eigen::RowVector3d(const Eigen::RowVector3d&)>& map);
/// all(4, 4, 4) with their inner nodes off the lattice, every cell valid.
std::vector<std::pair<std::string, Mesh>> jittered();

/// The kind and the message of the Error that `call` throws; fails the test where it throws none.
morph::Error::Kind kindOf(const std::function<void()>& call, std::string& message);
}
