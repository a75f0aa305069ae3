// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Private/Data/Crossings.h"

class vtkDataObject;
class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace morph
{
class Monitor;
struct StepResult;
}

namespace morph::filters
{
class KeptMesh;
class Results;

/// Writes the outputs of vtkMorphAlgorithm and their results.
namespace MorphOutput
{
/// What a filter that morphs writes.
struct Outputs
{
  vtkUnstructuredGrid* Mesh;
  vtkUnstructuredGrid* BadCells;
  vtkPolyData* Surface;
};

struct Measures
{
  bool All = true;      ///< of all cells, not of those behind the outer faces alone
  bool Certify = false; ///< vtkMorphAlgorithm::SetCertify(); with All alone
  bool Cross = true;    ///< whether the boundary crosses itself; with All alone
};

/// Writes the mesh at `moved`. `precision`: of the points, as vtkAlgorithm::DEFAULT_PRECISION.
/// Throws morph::Error where that precision does not hold the points.
void WriteMesh(const KeptMesh& kept, const morph::Points& moved, int precision,
  vtkUnstructuredGrid* grid, vtkUnstructuredGrid* output, morph::Monitor& monitor);
/// Writes what is measured on outputs.Mesh, which has a step's mesh: its quality, its inverted
/// cells and its surface. It does not read the step's points. `boundary`: the displaced one.
void WriteMeasures(const KeptMesh& kept, const morph::StepResult& step, Measures measures,
  vtkPointSet* boundary, Results& results, const Outputs& outputs, morph::Monitor& monitor);

/// Sets the step's status and largest valid step. Where rounding has inverted `bad` cells of a mesh
/// that was valid, both are those of an inverted mesh. `monitor`: is warned of it, or null.
void SetStatus(
  const morph::StepResult& step, morph::Index bad, Results& results, morph::Monitor* monitor);
/// Sets the number of crossing faces and, of a mesh that is valid all the way, its status.
void SetCrossings(const Crossings::Found& found, Results& results);
/// Sets the counts of a step and of its method, and adds all results to the output.
void WriteCounts(const morph::StepResult& step, Results& results, vtkDataObject* output);

/// Writes the undeformed mesh, if `input` is a readable mesh, without a result.
/// `boundaryInverted`: the number of cells that the boundary itself inverts, if that is the reason.
void WriteUndeformed(vtkDataObject* input, const char* status, morph::Index boundaryInverted,
  Results& results, vtkUnstructuredGrid* output);
}
}
