// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Distributed/OnRanks.h"
#include "Private/Distributed/RankMesh.h"
#include "Private/Morph/Series.h"

namespace morph::filters::RankOutput
{
/// MorphOutput::Write() on several MPI processes. `step`: with Moved of the local nodes, and
/// numbers of the whole mesh. Collective.
void Write(const RankMesh& mesh, const OnRanks::Morphing::Task& task, const StepResult& step,
  Results& results, morph::Monitor& monitor);

/// Certifies this process's cells, and writes nothing. The counts are those of the whole mesh.
/// Collective.
morph::CertificateReport Certify(const RankMesh& mesh, vtkUnstructuredGrid* output,
  const std::vector<std::uint8_t>& skip, morph::Monitor& monitor);
}
