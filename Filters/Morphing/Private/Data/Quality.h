// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"
#include "Quality/Certificate.h"
#include "Quality/ScaledJacobian.h"

#include <cstdint>
#include <vector>

class vtkUnstructuredGrid;

/// Scaled Jacobian and certificate as every filter of this module writes them.
namespace morph::filters::Quality
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

/// Bodies that have cells of orientation -1: mirrored ones. `orientation`: #cells (Topology.h).
morph::Index MirroredBodies(
  const morph::ConnectedComponents& bodies, const std::vector<std::int8_t>& orientation);

/// Whether Measure() of these cells gives what measuring the points that were computed, in double,
/// has given.
bool IsThatOfComputed(vtkUnstructuredGrid* output);

/// Adds to `output` the cell array `ScaledJacobian` (double, NaN where not measured) as active
/// scalars (point arrays stay, but none is active: viewers would color by that one).
void Write(const morph::Quality& quality, vtkUnstructuredGrid* output);

/// Examines `output` on its points as written; parameters as for Measure().
morph::CertificateReport Certify(const morph::Mesh& mesh, vtkUnstructuredGrid* output,
  const std::vector<std::int8_t>& orientation, std::vector<std::uint8_t> skip,
  morph::Monitor& monitor);

/// Adds to `output` the cell array `JacobianCertificate` (signed char: 1 certified, 0 undecided or
/// not examined, -1 inverted).
void Write(const morph::CertificateReport& report, vtkUnstructuredGrid* output);

/// Removes the certificate and its counts, so that an input's own do not pass for this mesh's.
void RemoveCertificate(vtkUnstructuredGrid* output);
}
