// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Ranks.h"
#include "Mesh/Mesh.h"
#include "TestGrids.h"

#include <vtkAlgorithm.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <functional>
#include <string>
#include <vector>

/// Grids for the tests of filters on MPI ranks.
namespace rank_grids
{
/// This rank's random cells of a mesh, with global ids of points and cells.
vtkSmartPointer<vtkUnstructuredGrid> piece(
  const morph::distributed::Ranks& ranks, const morph::Mesh& whole);

/// A U, and the motion of the inner side of one prong across the gap, which is 2 wide.
morph::Mesh fork();
grids::Map intoTheGap(double way);

/// [0, 1]^2 moved by `place`: quadrilaterals and pairs of triangles, some wound the other way.
morph::Mesh sheet(const grids::Map& place);
grids::Row dome(const grids::Row& x);

std::vector<morph::Index> globalIds(vtkDataSet* data, const char* name);

/// Calls `work` as a program of one process would.
void alone(const std::function<void()>& work);

/// Aborts the filter on the last rank alone, as soon as it reports progress there.
void abortOnLastRank(const morph::distributed::Ranks& ranks, vtkAlgorithm* filter);

/// Expects that the filter reports one error, on one of the ranks, that has this text.
void expectOneError(
  const morph::distributed::Ranks& ranks, vtkAlgorithm* filter, const std::string& telling);

/// The largest distance, on any rank, of this rank's points from those of the whole mesh with the
/// same ids.
double distance(
  const morph::distributed::Ranks& ranks, vtkUnstructuredGrid* piece, vtkUnstructuredGrid* whole);
}
