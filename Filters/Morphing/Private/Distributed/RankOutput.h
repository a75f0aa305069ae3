// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Data/Quality.h"
#include "Private/Distributed/OnRanks.h"
#include "Private/Distributed/RankMesh.h"
#include "Session/Series.h"

namespace morph::filters::RankOutput
{
/// MorphOutput on several MPI processes. `step`: with `moved` of the local nodes, and
/// numbers of the whole mesh. Collective.
void Write(const RankMesh& mesh, const OnRanks::Morphing::Task& task, const morph::StepResult& step,
  Results& results, morph::Monitor& monitor);

/// The parts of Write(). Collective.
///@{
/// Writes the points, and measures this process's own cells: all, or those behind the outer faces
/// alone. `moved`: of the local nodes.
morph::Quality WritePoints(const RankMesh& mesh, vtkUnstructuredGrid* grid,
  const morph::Points& moved, int precision, bool all, vtkUnstructuredGrid* output,
  morph::Monitor& monitor);
/// Writes the surface and, where `all` cells are measured, the bad cells. Returns the number of
/// inverted cells behind the outer faces of the whole mesh.
morph::Index WriteParts(
  const RankMesh& mesh, const morph::Quality& mine, bool all, const MorphOutput::Outputs& outputs);
///@}

/// Quality::Judge() of the whole mesh. `mine`: of this process's own cells. Collective.
Quality::Judged Judge(const RankMesh& mesh, const morph::Quality& mine, vtkUnstructuredGrid* output,
  morph::Monitor& monitor);

/// Certifies this process's cells, and writes nothing. The counts are those of the whole mesh.
/// Collective.
morph::CertificateReport Certify(const RankMesh& mesh, vtkUnstructuredGrid* output,
  const std::vector<std::uint8_t>& skip, morph::Monitor& monitor);
}
