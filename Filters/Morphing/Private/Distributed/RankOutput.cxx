// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/RankOutput.h"

#include "Distributed/Quality.h"
#include "Private/Data/BadCells.h"
#include "Private/Data/Output.h"
#include "Private/Data/Quality.h"
#include "Private/Data/Results.h"
#include "Private/Distributed/RankCrossings.h"
#include "Private/Morph/MorphOutput.h"
#include "Session/UndeformedMesh.h"

#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <utility>

namespace morph::filters::RankOutput
{
namespace
{
/// Writes what follows from the quality of all cells. Returns the crossings.
Crossings::Found writeMeasured(const RankMesh& mesh, const OnRanks::Morphing::Task& task,
  const morph::StepResult& step, const morph::Quality& mine, Results& results,
  morph::Monitor& monitor)
{
  const auto& ranks = mesh.Ranks();
  const morph::Quality whole = morph::distributed::reduce(ranks, mine, mesh.Whole().cellIds());
  const Quality::Judged judged = Judge(mesh, mine, task.Outputs.Mesh, monitor);
  MorphOutput::SetStatus(step, judged.Added, results, ranks.rank() == 0 ? &monitor : nullptr);
  results.Set(judged);
  Quality::Write(mine, task.Outputs.Mesh);
  results.Set(whole);
  results.SetNumber("WorstMeanScaledJacobian", morph::distributed::worstMean(ranks, mine));
  results.SetNumber("BoundaryMinimum", step.boundaryMinimum);
  if (task.Measures.Certify)
  {
    const morph::CertificateReport report =
      Certify(mesh, task.Outputs.Mesh, mesh.Unmeasured(), monitor);
    Quality::Write(report, task.Outputs.Mesh);
    results.Set(report);
  }
  Crossings::Found found;
  if (task.Measures.Cross)
  {
    found = RankCrossings::Find(mesh, task.Outputs.Mesh, monitor);
    if (found.Count > 0 && ranks.rank() == 0)
    {
      monitor.warn(found.Warning);
    }
    MorphOutput::SetCrossings(found, results);
  }
  return found;
}
}

Quality::Judged Judge(const RankMesh& mesh, const morph::Quality& mine, vtkUnstructuredGrid* output,
  morph::Monitor& monitor)
{
  const Quality::Judged own = Quality::Judge(mesh.Before(monitor), mine, output);
  return { mesh.Ranks().sum(own.Before), mesh.Ranks().sum(own.Added) };
}

morph::CertificateReport Certify(const RankMesh& mesh, vtkUnstructuredGrid* output,
  const std::vector<std::uint8_t>& skip, morph::Monitor& monitor)
{
  morph::CertificateReport report;
  mesh.Ranks().together(
    [&] { report = Quality::Certify(mesh.Piece(), output, mesh.Orientation(), skip, monitor); });
  morph::Index counts[3] = { report.certified, report.inverted, report.undecided };
  mesh.Ranks().sum(counts, 3);
  report.certified = counts[0];
  report.inverted = counts[1];
  report.undecided = counts[2];
  return report;
}

morph::Quality WritePoints(const RankMesh& mesh, vtkUnstructuredGrid* grid,
  const morph::Points& moved, int precision, bool all, vtkUnstructuredGrid* output,
  morph::Monitor& monitor)
{
  const morph::Mesh& piece = mesh.Piece();
  std::vector<std::uint8_t> skip = mesh.Unmeasured();
  if (!all)
  {
    std::vector<std::uint8_t> inner(skip.size(), 1);
    for (const morph::Index cell : mesh.Surface().OuterCells())
    {
      inner[cell] = skip[cell];
    }
    skip = std::move(inner);
  }
  morph::Quality mine;
  mesh.Ranks().together(
    [&]
    {
      morph::Points placed = moved;
      mesh.Whole().copyToDoubles(placed);
      Output::Write(
        grid, piece.points, placed.topRows(piece.numberOfNodes()), precision, output, monitor);
      Quality::Remove(output);
      mine = Quality::Measure(piece, output, mesh.Orientation(), skip, monitor);
    });
  return mine;
}

morph::Index WriteParts(
  const RankMesh& mesh, const morph::Quality& mine, bool all, const MorphOutput::Outputs& outputs)
{
  morph::Index inverted = 0;
  mesh.Ranks().together(
    [&]
    {
      outputs.BadCells->Initialize();
      if (all)
      {
        BadCells::Extract(mine, outputs.Mesh, outputs.BadCells);
      }
      inverted = mesh.Surface().Write(outputs.Mesh->GetPoints(), mine, outputs.Surface);
    });
  mesh.WriteGlobalIds(outputs.BadCells);
  mesh.WriteGlobalIds(outputs.Surface);
  return mesh.Ranks().sum(inverted);
}

void Write(const RankMesh& mesh, const OnRanks::Morphing::Task& task, const morph::StepResult& step,
  Results& results, morph::Monitor& monitor)
{
  const bool all = task.Measures.All;
  const morph::Quality mine =
    WritePoints(mesh, task.Grid, step.moved, task.Precision, all, task.Outputs.Mesh, monitor);
  Crossings::Found found;
  if (all)
  {
    found = writeMeasured(mesh, task, step, mine, results, monitor);
  }
  else
  {
    results.SetText("MorphStatus", "Unmeasured");
  }
  results.SetInteger("SurfaceInvertedCells", WriteParts(mesh, mine, all, task.Outputs));
  if (found.Count > 0)
  {
    mesh.Ranks().together([&] { mesh.Surface().MarkCrossing(found.Own, task.Outputs.Surface); });
  }
  if (mesh.Ranks().rank() == 0)
  {
    morph::warnOfLoose(step.loose, monitor);
  }
  MorphOutput::WriteCounts(step, results, task.Outputs.Mesh);
}
}
