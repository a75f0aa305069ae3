// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/MorphOutput.h"

#include "Private/Data/BadCells.h"
#include "Private/Data/MeshNotes.h"
#include "Private/Data/Output.h"
#include "Private/Data/Quality.h"
#include "Private/Data/Results.h"
#include "Private/Morph/Session.h"
#include "Private/Pipeline/Input.h"
#include "Quality/ScaledJacobian.h"

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
void measureAll(const Session& session, const StepResult& step, Measures measures,
  vtkPointSet* boundary, Results& results, vtkUnstructuredGrid* output,
  vtkUnstructuredGrid* badCells, vtkPolyData* surface, morph::Monitor& monitor)
{
  const KeptMesh& kept = session.GetKept();
  const bool known =
    !step.Valid.Measured.scaledJacobian.empty() && Quality::IsThatOfComputed(output);
  const morph::Quality measured =
    known ? morph::Quality() : Quality::Measure(kept.Mesh(), output, kept.Orientation(), monitor);
  const morph::Quality& quality = known ? step.Valid.Measured : measured;
  const Quality::Judged judged = Quality::Judge(kept.Before(monitor), quality, output);
  SetStatus(step, judged.Added, results, &monitor);
  results.Set(judged);
  Quality::Write(quality, output);
  results.Set(quality);
  results.SetNumber("WorstMeanScaledJacobian", morph::worstMean(quality));
  results.SetNumber("BoundaryMinimum", step.BoundaryMinimum);
  if (measures.Certify)
  {
    const morph::CertificateReport report =
      Quality::Certify(kept.Mesh(), output, kept.Orientation(), {}, monitor);
    Quality::Write(report, output);
    results.Set(report);
  }
  if (measures.Cross)
  {
    const Crossings::Found found = Crossings::Find(
      kept.Mesh(), kept.OuterFaces(), kept.Orientation(), output, boundary, monitor);
    if (found.Faces > 0)
    {
      monitor.warn(found.Warning);
    }
    SetCrossings(found, results);
  }
  BadCells::Extract(quality, output, badCells);
  results.SetInteger(
    "SurfaceInvertedCells", kept.Surface().Write(output->GetPoints(), quality, surface));
}

/// Measures the cells behind the outer faces alone.
void measureSurface(const Session& session, Results& results, vtkUnstructuredGrid* output,
  vtkPolyData* surface, morph::Monitor& monitor)
{
  const KeptMesh& kept = session.GetKept();
  const morph::Quality quality =
    Quality::Measure(kept.Mesh(), output, kept.Orientation(), kept.Surface().OuterCells(), monitor);
  results.SetInteger(
    "SurfaceInvertedCells", kept.Surface().Write(output->GetPoints(), quality, surface));
  results.SetText("MorphStatus", "Unmeasured");
}
}

void WriteMesh(const Session& session, const morph::Points& moved, int precision,
  vtkUnstructuredGrid* grid, vtkUnstructuredGrid* output, morph::Monitor& monitor)
{
  Output::Write(grid, session.GetKept().Mesh().points, moved, precision, output, monitor);
  Quality::Remove(output);
}

void WriteMeasures(const Session& session, const StepResult& step, Measures measures,
  vtkPointSet* boundary, Results& results, vtkUnstructuredGrid* output,
  vtkUnstructuredGrid* badCells, vtkPolyData* surface, morph::Monitor& monitor)
{
  if (measures.All)
  {
    measureAll(session, step, measures, boundary, results, output, badCells, surface, monitor);
  }
  else
  {
    badCells->Initialize();
    measureSurface(session, results, output, surface, monitor);
  }
  MeshNotes::WarnOfLoose(step.Loose, monitor);
  WriteCounts(step, results, output);
}

void SetStatus(const StepResult& step, morph::Index bad, Results& results, morph::Monitor* monitor)
{
  const bool isRounded = step.Valid.Status != "Inverted" && bad > 0;
  if (isRounded && monitor)
  {
    monitor->warn("Rounding to single precision inverts " + std::to_string(bad) +
                  " cells. Set OutputPointsPrecision to double.");
  }
  results.SetText("MorphStatus", isRounded ? "Inverted" : step.Valid.Status);
  results.SetNumber("LargestValidStep",
    isRounded ? std::numeric_limits<double>::quiet_NaN() : step.Valid.LargestValidStep);
}

void SetCrossings(const Crossings::Found& found, Results& results)
{
  results.SetInteger("CrossingFaces", found.Faces);
  const std::string status = results.Text("MorphStatus");
  if (found.Faces > 0 && status != "Inverted" && status != "Partial")
  {
    results.SetText("MorphStatus", "CrossesItself");
    results.SetNumber("LargestValidStep", std::numeric_limits<double>::quiet_NaN());
  }
}

void WriteCounts(const StepResult& step, Results& results, vtkDataObject* output)
{
  results.SetInteger("BoundaryInvertedCells", step.BoundaryInverted);
  results.SetInteger("SubSteps", step.Valid.SubSteps);
  results.SetInteger("SolverIterations", step.Iterations);
  results.SetInteger("PrescribedPoints", step.Prescribed);
  results.SetInteger("UnmatchedPoints", step.Unmatched);
  results.SetInteger("AttachedPoints", step.Attached);
  results.SetCounts(step.Statistics);
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
