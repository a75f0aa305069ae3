// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"
#include "Quality/Certificate.h"
#include "Quality/Criteria.h"
#include "Quality/InvertedBefore.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Communicator.h"

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

class vtkDataSet;
class vtkUnstructuredGrid;

/// Measures and writes the scaled Jacobian and certificate for every filter of this module.
namespace morph::filters::Quality
{
/// Measures `output` on its points as written (the rounding to float included). `mesh`: the cells
/// of `output`; its points do not count. `orientation`: #cells of +1 / -1 at least, from the
/// undeformed mesh (Topology.h), or empty for VTK's order. Leaves out ghost cells (vtkGhostType
/// duplicate or hidden), and those whose entry in `skip` (#cells, or empty) is not zero.
morph::Quality Measure(const morph::Mesh& mesh, vtkUnstructuredGrid* output,
  const std::vector<std::int8_t>& orientation, std::vector<std::uint8_t> skip,
  morph::Monitor& monitor);

/// The number of cells of each type, 256 of them, that have no value though they are neither ghosts
/// of `grid` nor in `skip` (#cells).
std::vector<morph::Index> Unmeasured(const morph::Mesh& mesh, const morph::Quality& quality,
  std::vector<std::uint8_t> skip, vtkUnstructuredGrid* grid);

/// Whether measuring the points as written gives the same result as measuring the computed ones,
/// which are in double precision.
bool IsThatOfComputed(vtkUnstructuredGrid* output);

/// What a motion did.
struct Judged
{
  morph::Index Before = 0; ///< cells that are inverted or degenerate in the undeformed mesh
  morph::Index Added = 0;  ///< inverted or degenerate cells that the motion has made
};
/// Judges `output` on its points as written. `quality`: its measure.
Judged Judge(
  const morph::InvertedBefore& before, const morph::Quality& quality, vtkUnstructuredGrid* output);

/// Adds to `output` the cell array `ScaledJacobian` (double, NaN where not measured) as active
/// scalars (point arrays stay, but none is active: viewers would color by that one).
void Write(const morph::Quality& quality, vtkUnstructuredGrid* output);

/// Examines `output` on its points as written; parameters as for Measure(). The counts are those of
/// all `processes`. Collective.
morph::CertificateReport Certify(const morph::Mesh& mesh, vtkUnstructuredGrid* output,
  const std::vector<std::int8_t>& orientation, std::vector<std::uint8_t> skip,
  const morph::Communicator& processes, morph::Monitor& monitor);

/// Adds to `output` the cell array `JacobianCertificate` (signed char: 1 certified, 0 undecided or
/// not examined, -1 inverted).
void Write(const morph::CertificateReport& report, vtkUnstructuredGrid* output);

/// What a criterion says of a mesh.
struct OfCriterion
{
  const morph::Criterion* Criterion;
  double Limit;
  std::string Label; ///< the name, with the walls if they are given
  std::string Walls; ///< the name of an array that marks them; empty: the whole boundary
  double Worst = std::numeric_limits<double>::quiet_NaN();
  morph::Index WorstCell = -1; ///< the lowest id of the cells at it
  morph::Index Beyond = 0;     ///< cells beyond the limit

  /// Times it, a larger value is worse.
  double Sign() const { return this->Criterion->isAtMost ? 1 : -1; }
};

/// Reads "NonOrthogonality=70, AspectRatio, FirstHeight:BLADE". Without a number the limit is the
/// usual one. Throws morph::Error.
std::vector<OfCriterion> ReadCriteria(const std::string& text);

/// Measures the leading cells, those of `output`, and adds a cell array of the criterion's label.
/// `mesh`: has ghosts behind these, or none; `skip`: #cells; `cellIds`: #cells, or empty. Throws
/// morph::Error where there is no array of the walls' name.
void Measure(OfCriterion& criterion, const morph::Mesh& mesh, vtkUnstructuredGrid* output,
  const std::vector<std::int8_t>& orientation, std::vector<std::uint8_t> skip,
  const std::vector<std::int64_t>& cellIds, morph::Monitor& monitor);

/// Adds to the field data one array for each column, with a row for each criterion.
void Write(const std::vector<OfCriterion>& criteria, vtkUnstructuredGrid* output);

/// A mesh to be measured, or this process's part of it.
struct Part
{
  const morph::Mesh& Grid; ///< of the grid
  const morph::Mesh& Mesh; ///< perhaps with cells of other processes behind these
  const std::vector<std::int8_t>& Orientation; ///< #cells of Mesh
  const std::vector<std::uint8_t>& Skip;       ///< #cells of Grid; see Measure()
  int Dimension;                               ///< the highest of all cells
  const morph::Communicator& Processes;
};
/// All that vtkScaledJacobian tells of the whole mesh.
struct Measured
{
  morph::Quality Whole;                  ///< without the values of single cells
  std::vector<morph::Index> Unmeasured;  ///< see Unmeasured()
  morph::CertificateReport Certificates; ///< counts
};
/// Measures the mesh, also by `criteria`, and, if `certified`, examines it; `output` becomes `grid`
/// with the arrays. Collective.
Measured MeasureAll(const Part& part, bool certified, std::vector<OfCriterion>& criteria,
  vtkUnstructuredGrid* grid, vtkUnstructuredGrid* output, morph::Monitor& monitor);
/// MeasureAll() of a mesh that this process has all of, and the number of mirrored bodies.
std::pair<Measured, morph::Index> MeasureAlone(vtkUnstructuredGrid* grid, bool certified,
  std::vector<OfCriterion>& criteria, vtkUnstructuredGrid* output, morph::Monitor& monitor);

/// Removes the scaled Jacobian, the certificate and its counts, so that those of an input do not
/// pass for the output's.
void Remove(vtkDataSet* output);
}
