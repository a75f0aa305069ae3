// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Data/Crossings.h"
#include "Private/Distributed/RankMesh.h"

class vtkUnstructuredGrid;

namespace morph::filters::RankCrossings
{
/// Crossings::Find() of the whole mesh, alike on each process. `output`: of this process's piece.
/// Surfaces have the names that the file gives. Memory and messages grow with the whole boundary:
/// 90 bytes a corner. Collective.
Crossings::Found Find(const RankMesh& mesh, vtkUnstructuredGrid* output, morph::Monitor& monitor);

/// Whether there are any where the nodes of the process's part are at `moved`. Collective, and
/// alike on each process.
bool Any(const RankMesh& mesh, const morph::Points& moved, morph::Monitor& monitor);
}
