// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/RankOutput.h"

#include "Distributed/Quality.h"
#include "Private/Data/BadCells.h"
#include "Private/Data/Output.h"
#include "Private/Data/Quality.h"
#include "Private/Data/Results.h"
#include "Private/Morph/MorphOutput.h"

#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <utility>

namespace morph::filters::RankOutput
{
namespace
{
/// Writes what follows from the quality of all cells.
void writeMeasured(const RankMesh& mesh, const OnRanks::Morphing::Task& task,
  const StepResult& step, const morph::Quality& mine, Results& results, morph::Monitor& monitor)
{
  const auto& ranks = mesh.Ranks();
  const morph::Quality whole = morph::distributed::reduce(ranks, mine, mesh.Whole().cellIds());
  MorphOutput::SetStatus(
    step, whole.inverted + whole.degenerate, results, ranks.rank() == 0 ? &monitor : nullptr);
  Quality::Write(mine, task.Output);
  results.Set(whole);
  results.SetNumber("WorstMeanScaledJacobian", morph::distributed::worstMean(ranks, mine));
  results.SetNumber("BoundaryMinimum", step.BoundaryMinimum);
  if (task.Measures.Certify)
  {
    const morph::CertificateReport report = Certify(mesh, task.Output, mesh.Unmeasured(), monitor);
    Quality::Write(report, task.Output);
    results.Set(report);
  }
}
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

void Write(const RankMesh& mesh, const OnRanks::Morphing::Task& task, const StepResult& step,
  Results& results, morph::Monitor& monitor)
{
  const auto& ranks = mesh.Ranks();
  const morph::Mesh& piece = mesh.Piece();
  std::vector<std::uint8_t> skip = mesh.Unmeasured();
  if (!task.Measures.All)
  {
    std::vector<std::uint8_t> inner(skip.size(), 1);
    for (const morph::Index cell : mesh.Surface().OuterCells())
    {
      inner[cell] = skip[cell];
    }
    skip = std::move(inner);
  }
  morph::Quality mine;
  ranks.together(
    [&]
    {
      Output::Write(task.Grid, piece.points, step.Moved.topRows(piece.numberOfNodes()),
        task.Precision, task.Output);
      Quality::Remove(task.Output);
      mine = Quality::Measure(piece, task.Output, mesh.Orientation(), skip, monitor);
    });
  if (task.Measures.All)
  {
    writeMeasured(mesh, task, step, mine, results, monitor);
  }
  else
  {
    results.SetText("MorphStatus", "Unmeasured");
  }
  morph::Index surfaceInverted = 0;
  ranks.together(
    [&]
    {
      task.BadCells->Initialize();
      if (task.Measures.All)
      {
        BadCells::Extract(mine, task.Output, task.BadCells);
      }
      surfaceInverted = mesh.Surface().Write(task.Output->GetPoints(), mine, task.Surface);
    });
  results.SetInteger("SurfaceInvertedCells", ranks.sum(surfaceInverted));
  mesh.WriteGlobalIds(task.BadCells);
  mesh.WriteGlobalIds(task.Surface);
  MorphOutput::WriteCounts(step, results, task.Output);
}
}
