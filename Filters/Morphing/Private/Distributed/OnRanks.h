// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Data/Quality.h"
#include "Private/Morph/KeptMesh.h"

#include <memory>
#include <utility>
#include <vector>

class vtkPolyData;
class vtkUnstructuredGrid;

namespace morph::filters
{
/// What filters do with a mesh whose pieces are on several MPI processes. Every function is
/// collective: all processes call it, also those without cells, and it throws morph::Error on all
/// or none of them. Not to be called unless Ranks::TakePieces().
namespace OnRanks
{
/// A mesh that each process brings a piece of.
std::unique_ptr<KeptMesh> MakeMesh();

/// Writes the outer faces of the whole mesh that belong to this process's cells, as
/// Surface::Write() does, with global ids.
void ExtractBoundary(vtkUnstructuredGrid* grid, vtkPolyData* output, morph::Monitor& monitor);

/// Quality::MeasureAll(), and the number of mirrored bodies.
std::pair<Quality::Measured, morph::Index> Measure(vtkUnstructuredGrid* grid, bool certified,
  std::vector<Quality::OfCriterion>& criteria, vtkUnstructuredGrid* output,
  morph::Monitor& monitor);
}
}
