// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/MorphOutput.h"

#include "Private/Data/BadCells.h"
#include "Private/Data/Output.h"
#include "Private/Data/Results.h"
#include "Private/Morph/KeptMesh.h"
#include "Private/Pipeline/Input.h"
#include "Session/Session.h"
#include "Session/UndeformedMesh.h"
#include "Support/Communicator.h"

#include <vtkDataObject.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace morph::filters::MorphOutput
{
namespace
{
/// Sets the step's status and largest valid step. Where rounding has inverted `bad` cells of a mesh
/// that was valid, both are those of an inverted mesh.
void setStatus(
  const morph::StepResult& step, morph::Index bad, Results& results, morph::Monitor& monitor)
{
  const bool isRounded = step.valid.status != "Inverted" && bad > 0;
  if (isRounded)
  {
    monitor.warn("Rounding to single precision inverts " + std::to_string(bad) +
                 " cells. Set `OutputPointsPrecision` to double.");
  }
  results.SetText("MorphStatus", isRounded ? "Inverted" : step.valid.status);
  results.SetNumber("LargestValidStep",
    isRounded ? std::numeric_limits<double>::quiet_NaN() : step.valid.largestValidStep);
}

/// Sets the number of crossing faces and, of a mesh that is valid all the way, its status.
void setCrossings(const Crossings::Found& found, Results& results, morph::Monitor& monitor)
{
  results.SetInteger("CrossingFaces", found.Count);
  const std::string status = results.Text("MorphStatus");
  if (found.Count > 0)
  {
    monitor.warn(found.Warning);
  }
  if (found.Count > 0 && status != "Inverted" && status != "Partial")
  {
    results.SetText("MorphStatus", "CrossesItself");
    results.SetNumber("LargestValidStep", std::numeric_limits<double>::quiet_NaN());
  }
}

/// Those that are not measured, where the cells behind the outer faces alone are.
std::vector<std::uint8_t> innerCells(const KeptMesh& kept)
{
  const std::vector<std::uint8_t>& skip = kept.Unmeasured();
  std::vector<std::uint8_t> inner(kept.Grid().types.size(), 1);
  for (const morph::Index cell : kept.Surface().OuterCells())
  {
    inner[cell] = skip.empty() ? 0 : skip[cell];
  }
  return inner;
}
}

void WriteMesh(const KeptMesh& kept, const morph::Points& moved, int precision,
  vtkUnstructuredGrid* grid, vtkUnstructuredGrid* output, morph::Monitor& monitor)
{
  kept.All().together(
    [&]
    {
      morph::Points memory;
      Output::Write(
        grid, kept.Grid().points, kept.OfGrid(moved, memory), precision, output, monitor);
      Quality::Remove(output);
    });
}

Measured Measure(const KeptMesh& kept, const morph::Quality& known, Measures measures,
  vtkPointSet* boundary, const Outputs& outputs, morph::Monitor& monitor)
{
  vtkUnstructuredGrid* output = outputs.Mesh;
  const morph::Communicator& all = kept.All();
  const std::vector<std::int8_t>& orientation = kept.Rest()->orientation();
  const std::vector<std::uint8_t> skip = measures.All ? kept.Unmeasured() : innerCells(kept);
  // Of a part of a mesh, `known` has cells of other processes.
  const bool isKnown =
    skip.empty() && !known.scaledJacobian.empty() && Quality::IsThatOfComputed(output);
  morph::Quality measured;
  all.together(
    [&]
    {
      if (!isKnown)
      {
        measured = Quality::Measure(kept.Grid(), output, orientation, skip, monitor);
      }
    });
  const morph::Quality& quality = isKnown ? known : measured;
  Measured result;
  if (measures.All)
  {
    const morph::InvertedBefore& before = kept.Before(monitor);
    all.together([&] { result.Judged = Quality::Judge(before, quality, output); });
    result.Judged = { all.sum(result.Judged.Before), all.sum(result.Judged.Added) };
    Quality::Write(quality, output);
    result.Whole = morph::ofAll(quality, all);
    result.WorstMean = measures.WorstMean ? morph::worstMean(quality, 0.01, all) : 0;
  }
  if (measures.All && measures.Certify)
  {
    result.Certificates = Quality::Certify(kept.Grid(), output, orientation, skip, all, monitor);
    Quality::Write(result.Certificates, output);
  }
  if (measures.All && measures.Cross)
  {
    result.Crossing = Crossings::Find(*kept.Rest(), kept.Grid(), output, boundary, monitor);
  }
  all.together(
    [&]
    {
      outputs.BadCells->Initialize();
      if (measures.All)
      {
        BadCells::Extract(quality, output, outputs.BadCells);
      }
      result.SurfaceInverted = kept.Surface().Write(output->GetPoints(), quality, outputs.Surface);
      if (result.Crossing.Count > 0)
      {
        kept.Surface().MarkCrossing(result.Crossing.Own, outputs.Surface);
      }
    });
  result.SurfaceInverted = all.sum(result.SurfaceInverted);
  kept.WriteGlobalIds(outputs.BadCells);
  kept.WriteGlobalIds(outputs.Surface);
  return result;
}

void WriteMeasures(const KeptMesh& kept, const morph::StepResult& step, Measures measures,
  vtkPointSet* boundary, Results& results, const Outputs& outputs, morph::Monitor& whole)
{
  morph::FirstSpeaks monitor(whole, kept.All());
  const Measured measured =
    Measure(kept, step.valid.measured, measures, boundary, outputs, monitor);
  results.SetInteger("SurfaceInvertedCells", measured.SurfaceInverted);
  if (!measures.All)
  {
    results.SetText("MorphStatus", "Unmeasured");
  }
  else
  {
    setStatus(step, measured.Judged.Added, results, monitor);
    results.Set(measured.Judged);
    results.Set(measured.Whole);
    results.SetNumber("WorstMeanScaledJacobian", measured.WorstMean);
    results.SetNumber("BoundaryMinimum", step.boundaryMinimum);
    if (measures.Certify)
    {
      results.Set(measured.Certificates);
    }
    if (measures.Cross)
    {
      setCrossings(measured.Crossing, results, monitor);
    }
  }
  morph::warnOfLoose(step.loose, monitor);
  results.SetInteger("BoundaryInvertedCells", step.boundaryInverted);
  results.SetInteger("SubSteps", step.valid.subSteps);
  results.SetInteger("SolverIterations", step.iterations);
  results.SetInteger("PrescribedPoints", step.prescribed);
  results.SetInteger("UnmatchedPoints", step.unmatched);
  results.SetInteger("AttachedPoints", step.attached);
  results.SetCounts(step.statistics);
  results.Write(outputs.Mesh);
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
