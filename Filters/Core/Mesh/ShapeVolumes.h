// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// The cells of each shape in each body, from which cellSigns() takes their orientation. Parts of a
/// mesh add up to the whole.
struct ShapeVolumes
{
  static const int Shapes; ///< per body

  std::vector<double> volume; ///< #bodies * Shapes, the summed signed volumes
  std::vector<Index> cells;   ///< #bodies * Shapes, their number
};

/// Sums up the volume cells, but for those with a nonzero entry in `skip` (#cells, or empty).
ShapeVolumes shapeVolumes(const Mesh& mesh, const ConnectedComponents& bodies,
  const std::vector<std::uint8_t>& skip, Monitor& monitor);

/// cellSigns() by volumes that are known.
std::vector<std::int8_t> cellSigns(
  const Mesh& mesh, const ConnectedComponents& bodies, const ShapeVolumes& volumes);
}
