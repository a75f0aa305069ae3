// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkMorphQuality_h
#define vtkMorphQuality_h

#include "ScaledJacobian.h"

#include <cstdint>
#include <vector>

class vtkUnstructuredGrid;

/// Scaled Jacobian as every filter of this module writes it.
namespace vtkMorphQuality
{
/// Measures `output` on its points as written (the rounding to float included). `mesh`: the cells
/// of `output`; its points are not read. `orientation`: #cells of +1 / -1 from the REST mesh
/// (Topology.h), or empty for VTK's order. Ghost cells (vtkGhostType duplicate or hidden) are not
/// measured.
morph::Quality Measure(const morph::Mesh& mesh, vtkUnstructuredGrid* output,
  const std::vector<std::int8_t>& orientation, morph::Monitor& monitor);

/// As above, and leaves out the cells whose entry in `skip` (#cells) is not zero.
morph::Quality Measure(const morph::Mesh& mesh, vtkUnstructuredGrid* output,
  const std::vector<std::int8_t>& orientation, std::vector<std::uint8_t> skip,
  morph::Monitor& monitor);

/// Adds to `output` the cell array `ScaledJacobian` (double, NaN where not measured) as active
/// scalars (point arrays stay, but none is active: viewers would color by that one), and the field
/// data MinScaledJacobian, MeanScaledJacobian (double, NaN if nothing was measured), InvertedCells,
/// DegenerateCells and WorstCellId (ids, -1 if nothing was measured). Arrays of these names are
/// replaced.
void Write(const morph::Quality& quality, vtkUnstructuredGrid* output);
}

#endif
