// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/MorphOutput.h"

#include "Private/Data/BadCells.h"
#include "Private/Data/Output.h"
#include "Private/Data/Quality.h"
#include "Private/Data/Results.h"
#include "Private/Morph/KeptMesh.h"
#include "Private/Pipeline/Input.h"
#include "Quality/ScaledJacobian.h"
#include "Session/Series.h"
#include "Session/UndeformedMesh.h"

#include <vtkDataObject.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <limits>
#include <string>
#include <vector>

namespace morph::filters::MorphOutput
{
namespace
{
/// Measures all cells, and writes what follows from it.
void measureAll(const KeptMesh& kept, const morph::StepResult& step, Measures measures,
  vtkPointSet* boundary, Results& results, const Outputs& outputs, morph::Monitor& monitor)
{
  vtkUnstructuredGrid* output = outputs.Mesh;
  const morph::UndeformedMesh& rest = *kept.Rest();
  const bool known =
    !step.valid.measured.scaledJacobian.empty() && Quality::IsThatOfComputed(output);
  const morph::Quality measured =
    known ? morph::Quality() : Quality::Measure(rest.mesh(), output, rest.orientation(), monitor);
  const morph::Quality& quality = known ? step.valid.measured : measured;
  const Quality::Judged judged = Quality::Judge(rest.before(monitor), quality, output);
  SetStatus(step, judged.Added, results, &monitor);
  results.Set(judged);
  Quality::Write(quality, output);
  results.Set(quality);
  results.SetNumber("WorstMeanScaledJacobian", morph::worstMean(quality));
  results.SetNumber("BoundaryMinimum", step.boundaryMinimum);
  if (measures.Certify)
  {
    const morph::CertificateReport report =
      Quality::Certify(rest.mesh(), output, rest.orientation(), {}, monitor);
    Quality::Write(report, output);
    results.Set(report);
  }
  Crossings::Found found;
  if (measures.Cross)
  {
    found = Crossings::Find(
      rest.mesh(), rest.outerFaces(), rest.orientation(), output, boundary, monitor);
    if (found.Count > 0)
    {
      monitor.warn(found.Warning);
    }
    SetCrossings(found, results);
  }
  BadCells::Extract(quality, output, outputs.BadCells);
  results.SetInteger(
    "SurfaceInvertedCells", kept.Surface().Write(output->GetPoints(), quality, outputs.Surface));
  if (found.Count > 0)
  {
    kept.Surface().MarkCrossing(found.Own, outputs.Surface);
  }
}

/// Measures the cells behind the outer faces alone.
void measureSurface(
  const KeptMesh& kept, Results& results, const Outputs& outputs, morph::Monitor& monitor)
{
  vtkUnstructuredGrid* output = outputs.Mesh;
  const morph::UndeformedMesh& rest = *kept.Rest();
  const morph::Quality quality =
    Quality::Measure(rest.mesh(), output, rest.orientation(), kept.Surface().OuterCells(), monitor);
  results.SetInteger(
    "SurfaceInvertedCells", kept.Surface().Write(output->GetPoints(), quality, outputs.Surface));
  results.SetText("MorphStatus", "Unmeasured");
}
}

void WriteMesh(const KeptMesh& kept, const morph::Points& moved, int precision,
  vtkUnstructuredGrid* grid, vtkUnstructuredGrid* output, morph::Monitor& monitor)
{
  Output::Write(grid, kept.Rest()->mesh().points, moved, precision, output, monitor);
  Quality::Remove(output);
}

void WriteMeasures(const KeptMesh& kept, const morph::StepResult& step, Measures measures,
  vtkPointSet* boundary, Results& results, const Outputs& outputs, morph::Monitor& monitor)
{
  if (measures.All)
  {
    measureAll(kept, step, measures, boundary, results, outputs, monitor);
  }
  else
  {
    outputs.BadCells->Initialize();
    measureSurface(kept, results, outputs, monitor);
  }
  morph::warnOfLoose(step.loose, monitor);
  WriteCounts(step, results, outputs.Mesh);
}

void SetStatus(
  const morph::StepResult& step, morph::Index bad, Results& results, morph::Monitor* monitor)
{
  const bool isRounded = step.valid.status != "Inverted" && bad > 0;
  if (isRounded && monitor)
  {
    monitor->warn("Rounding to single precision inverts " + std::to_string(bad) +
                  " cells. Set `OutputPointsPrecision` to double.");
  }
  results.SetText("MorphStatus", isRounded ? "Inverted" : step.valid.status);
  results.SetNumber("LargestValidStep",
    isRounded ? std::numeric_limits<double>::quiet_NaN() : step.valid.largestValidStep);
}

void SetCrossings(const Crossings::Found& found, Results& results)
{
  results.SetInteger("CrossingFaces", found.Count);
  const std::string status = results.Text("MorphStatus");
  if (found.Count > 0 && status != "Inverted" && status != "Partial")
  {
    results.SetText("MorphStatus", "CrossesItself");
    results.SetNumber("LargestValidStep", std::numeric_limits<double>::quiet_NaN());
  }
}

void WriteCounts(const morph::StepResult& step, Results& results, vtkDataObject* output)
{
  results.SetInteger("BoundaryInvertedCells", step.boundaryInverted);
  results.SetInteger("SubSteps", step.valid.subSteps);
  results.SetInteger("SolverIterations", step.iterations);
  results.SetInteger("PrescribedPoints", step.prescribed);
  results.SetInteger("UnmatchedPoints", step.unmatched);
  results.SetInteger("AttachedPoints", step.attached);
  results.SetCounts(step.statistics);
  results.Write(output);
}

void WriteUndeformed(vtkDataObject* input, const char* status, morph::Index boundaryInverted,
  Results& results, vtkUnstructuredGrid* output)
{
  output->Initialize();
  if (Input::IsReadable(input))
  {
    output->ShallowCopy(input);
  }
  results.SetText("MorphStatus", status);
  if (boundaryInverted > 0)
  {
    // What the error tells.
    results.SetInteger("BoundaryInvertedCells", boundaryInverted);
  }
  results.Write(output);
  if (boundaryInverted > 0)
  {
    results.SetCounts({ { "BoundaryDeterminedCells", boundaryInverted } });
  }
}
}
