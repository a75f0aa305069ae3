// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// The cells of each shape in each body, from which cellSigns() takes their orientation.
struct ShapeVolumes
{
  static const int Shapes; ///< per body

  std::vector<double> volume; ///< #bodies * Shapes, the summed signed volumes
  std::vector<double> cells;  ///< #bodies * Shapes, their number
};

/// Sums up the volume cells of all processes. Collective.
ShapeVolumes shapeVolumes(const Mesh& mesh, const ConnectedComponents& bodies, Monitor& monitor,
  const Communicator& processes);

/// cellSigns() by volumes that are known.
std::vector<std::int8_t> cellSigns(
  const Mesh& mesh, const ConnectedComponents& bodies, const ShapeVolumes& volumes);
}
