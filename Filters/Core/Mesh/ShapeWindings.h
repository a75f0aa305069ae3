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

/// Corrects the signs of cellSigns() in tangled bodies of several shapes. There the summed volume
/// of one shape may be negative because its cells are tangled. Faces that cells of two shapes share
/// tell whether their node lists wind alike. The volume of the whole body, which no inner node can
/// change, then gives the sign of all. It does this only in bodies with a shape whose summed volume
/// is less than half the sum of absolute volumes. Polyhedra, and shapes with a single cell in a
/// body, keep their sign. Cost: a pass over the cells of bodies with several shapes; a sort of the
/// faces in those tangled bodies. Collective.
void alignShapeSigns(const Mesh& mesh, const ConnectedComponents& bodies,
  std::vector<std::int8_t>& signs, const Communicator& processes);
}
