// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Private/Data/Crossings.h"
#include "Private/Data/Quality.h"
#include "Quality/Certificate.h"
#include "Quality/ScaledJacobian.h"

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
  bool All = true;       ///< of all cells, not of those behind the outer faces alone
  bool Certify = false;  ///< vtkMorphAlgorithm::SetCertify(); with All alone
  bool Cross = true;     ///< whether the boundary crosses itself; with All alone
  bool WorstMean = true; ///< the mean of the worst cells; with All alone
};

/// What is measured of a mesh as written. All numbers are those of the whole mesh.
struct Measured
{
  // Of all cells alone.
  morph::Quality Whole; ///< without the values of single cells
  double WorstMean = 0; ///< where it is asked for
  Quality::Judged Judged;
  morph::CertificateReport Certificates; ///< counts, where they are asked for
  Crossings::Found Crossing;             ///< where they are asked for

  morph::Index SurfaceInverted = 0; ///< cells behind the outer faces
};

/// Writes the mesh at `moved`, of the nodes of kept.Rest(). `precision`: of the points, as
/// vtkAlgorithm::DEFAULT_PRECISION. Throws morph::Error where that precision does not hold the
/// points. Collective, as all functions that measure.
void WriteMesh(const KeptMesh& kept, const morph::Points& moved, int precision,
  vtkUnstructuredGrid* grid, vtkUnstructuredGrid* output, morph::Monitor& monitor);
/// Measures outputs.Mesh, which WriteMesh() has written, and writes its quality, its inverted cells
/// and its surface. `known`: of the computed points, or empty. `boundary`: the displaced one, or
/// null.
Measured Measure(const KeptMesh& kept, const morph::Quality& known, Measures measures,
  vtkPointSet* boundary, const Outputs& outputs, morph::Monitor& monitor);
/// Measures a step's mesh, as above, and writes the results. It does not read the step's points.
void WriteMeasures(const KeptMesh& kept, const morph::StepResult& step, Measures measures,
  vtkPointSet* boundary, Results& results, const Outputs& outputs, morph::Monitor& monitor);

/// Writes the undeformed mesh, if `input` is a readable mesh, without a result.
/// `boundaryInverted`: the number of cells that the boundary itself inverts, if that is the reason.
void WriteUndeformed(vtkDataObject* input, const char* status, morph::Index boundaryInverted,
  Results& results, vtkUnstructuredGrid* output);
}
}
