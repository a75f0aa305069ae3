// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Methods.h"
#include "Distributed/Quality.h"
#include "Mesh/NodePartition.h"
#include "Mesh/Polyhedra.h"
#include "Private/Data/BadCells.h"
#include "Private/Data/Output.h"
#include "Private/Data/Quality.h"
#include "Private/Data/Surface.h"
#include "Private/Distributed/OnRanks.h"
#include "Private/Distributed/RankMatch.h"
#include "Private/Distributed/RankMesh.h"
#include "Private/Pipeline/Input.h"
#include "Quality/BoundaryDetermined.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"
#include "vtkMorphAlgorithm.h"

#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

namespace morph::filters::OnRanks
{
namespace
{
using Clock = std::chrono::steady_clock;
using morph::distributed::DistributedMesh;
using morph::distributed::Method;

double secondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Throws for what is not done on several ranks, the same on all of them.
void requireAvailable(const Morphing::Task& task, const Session::Options& options)
{
  const auto refuse = [&](const std::string& what)
  {
    throw morph::Error(what + " of " + options.Method +
                       " needs one MPI rank, and the mesh is distributed over several. Run on "
                       "one, or choose another setting.");
  };
  if (options.PostSmooth)
  {
    refuse("PostSmooth");
  }
  if (options.Validity == vtkMorphAlgorithm::VALIDITY_SUB_STEP)
  {
    refuse("Validity Sub Step");
  }
  if (options.Validity == vtkMorphAlgorithm::VALIDITY_REPAIR)
  {
    refuse("Validity Repair");
  }
  if (task.FeatureLines)
  {
    refuse("FeatureLines");
  }
}

/// Certifies this process's cells. The counts are those of the whole mesh.
morph::CertificateReport certify(const RankMesh& mesh, vtkUnstructuredGrid* output,
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
}

class Morphing::Internals
{
public:
  explicit Internals(filters::Results& results)
    : Results(results)
  {
  }

  filters::Results& Results;
  RankMesh Mesh;
  std::unique_ptr<Method> Prepared;
  std::vector<morph::Index> PreparedFor; ///< the prescribed nodes of Prepared
  std::string PreparedOptions;

  void Prepare(const morph::NodePartition& partition, const Session::Options& options,
    morph::Monitor& monitor);
  morph::Index RequireFeasible(const BoundaryMatch::Result& match,
    const morph::NodePartition& partition, const Session::Options& options);
  void Write(const Task& task, const Session::Options& options, const morph::Points& moved,
    morph::Monitor& monitor);
  std::string Worst(const morph::Quality& mine, morph::Index bad, const morph::Points& moved) const;
};

Morphing::Morphing(Results& results)
  : Own(new Internals(results))
{
}

Morphing::~Morphing() = default;

void Morphing::Internals::Prepare(
  const morph::NodePartition& partition, const Session::Options& options, morph::Monitor& monitor)
{
  const auto& ranks = this->Mesh.Ranks();
  this->Results.SetNumber("PrepareSeconds", 0);
  const bool same = this->Prepared && this->PreparedFor == partition.prescribed &&
                    this->PreparedOptions == options.PrepareOptions;
  if (ranks.sum(morph::Index(!same)) == 0)
  {
    return;
  }
  const auto start = Clock::now();
  this->Prepared.reset();
  std::unique_ptr<Method> method = morph::distributed::makeMethod(options.CreateMorpher());
  method->prepare(this->Mesh.Whole(), partition, monitor);
  this->Prepared = std::move(method);
  this->PreparedFor = partition.prescribed;
  this->PreparedOptions = options.PrepareOptions;
  this->Results.SetInteger("PrepareCount", this->Results.Integer("PrepareCount") + 1);
  this->Results.SetNumber("PrepareSeconds", ranks.maximum(secondsSince(start)));
}

/// With a validity that asks for a valid mesh, throws where the boundary itself inverts cells.
/// Returns the number of such cells.
morph::Index Morphing::Internals::RequireFeasible(const BoundaryMatch::Result& match,
  const morph::NodePartition& partition, const Session::Options& options)
{
  const DistributedMesh& whole = this->Mesh.Whole();
  morph::Points points = whole.mesh().points;
  points(match.Ids, morph::allColumns) = match.Targets;
  std::vector<morph::Index> own;
  whole.ranks().together(
    [&]
    {
      for (morph::Index cell :
        morph::boundaryDeterminedInversions(whole.mesh(), partition, whole.orientation(), points))
      {
        if (whole.isGhost()[cell] == 0)
        {
          own.push_back(whole.cellId(cell));
        }
      }
    });
  own = whole.ranks().gather(own);
  std::sort(own.begin(), own.end());
  if (!own.empty() && options.Validity >= vtkMorphAlgorithm::VALIDITY_SUB_STEP)
  {
    throw Validity::Infeasible(
      "The boundary itself inverts " + std::to_string(own.size()) +
        " cells, at corners that no free node can mend, so no valid mesh exists: cell ids " +
        morph::listIds(own) +
        ". Move the boundary less there, leave some of its nodes free, or set Validity to Report "
        "to see the mesh.",
      static_cast<morph::Index>(own.size()));
  }
  return static_cast<morph::Index>(own.size());
}

/// The worst cells of all ranks, a line for each.
std::string Morphing::Internals::Worst(
  const morph::Quality& mine, morph::Index bad, const morph::Points& moved) const
{
  struct Line
  {
    double jacobian;
    std::int64_t id;
    double centre[3];
  };
  constexpr std::size_t Most = 10;
  const auto before = [](const Line& a, const Line& b)
  { return std::tie(a.jacobian, a.id) < std::tie(b.jacobian, b.id); };
  const morph::Mesh& piece = this->Mesh.Piece();
  std::vector<Line> lines;
  for (morph::Index cell : morph::invertedCells(mine))
  {
    const int corners = morph::cellShape(piece.types[cell])->numberOfCorners;
    Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
    for (int k = 0; k < corners; ++k)
    {
      centre += moved.row(piece.cell(cell)[k]) / corners;
    }
    lines.push_back({ mine.scaledJacobian[cell], this->Mesh.Whole().cellId(cell),
      { centre[0], centre[1], centre[2] } });
  }
  std::sort(lines.begin(), lines.end(), before);
  lines.resize(std::min(lines.size(), Most));
  lines = this->Mesh.Ranks().gather(lines);
  std::sort(lines.begin(), lines.end(), before);
  lines.resize(std::min(lines.size(), Most));
  std::ostringstream text;
  text << bad << " cells are inverted or degenerate. The worst, with their centres:";
  for (const Line& line : lines)
  {
    text << "\n  cell " << line.id << " at (" << line.centre[0] << ", " << line.centre[1] << ", "
         << line.centre[2] << "), scaled Jacobian " << line.jacobian;
  }
  text << (bad > static_cast<morph::Index>(lines.size()) ? "\n  ...\n" : "\n");
  return text.str();
}

void Morphing::Internals::Write(const Task& task, const Session::Options& options,
  const morph::Points& moved, morph::Monitor& monitor)
{
  const auto& ranks = this->Mesh.Ranks();
  const morph::Mesh& piece = this->Mesh.Piece();
  const morph::Index nodes = piece.numberOfNodes();
  ranks.together(
    [&]
    {
      Output::Write(task.Grid, piece.points, moved.topRows(nodes), task.Precision, task.Output);
      Quality::Remove(task.Output);
    });
  std::vector<std::uint8_t> skip = this->Mesh.Unmeasured();
  if (!task.Measures.All)
  {
    std::vector<std::uint8_t> inner(skip.size(), 1);
    for (const morph::Index cell : this->Mesh.Surface().OuterCells())
    {
      inner[cell] = skip[cell];
    }
    skip = std::move(inner);
  }
  morph::Quality mine;
  ranks.together(
    [&] { mine = Quality::Measure(piece, task.Output, this->Mesh.Orientation(), skip, monitor); });
  const morph::Quality whole =
    morph::distributed::reduce(ranks, mine, this->Mesh.Whole().cellIds());
  const morph::Index bad = whole.inverted + whole.degenerate;
  if (task.Measures.All)
  {
    if (bad > 0 && options.Validity >= vtkMorphAlgorithm::VALIDITY_REPORT)
    {
      const std::string found = this->Worst(mine, bad, moved);
      if (options.Validity == vtkMorphAlgorithm::VALIDITY_REFUSE)
      {
        throw morph::Error(
          "The morph is refused: " + found +
          "Move the boundary less, or run on one MPI rank with Validity set to Repair or Sub "
          "Step.");
      }
      if (ranks.rank() == 0)
      {
        monitor.warn(found + "The output Bad cells holds them all. Move the boundary less, or run "
                             "on one MPI rank with Validity set to Repair.");
      }
    }
    Quality::Write(mine, task.Output);
    this->Results.Set(whole);
    if (task.Measures.Certify)
    {
      const morph::CertificateReport report = certify(this->Mesh, task.Output, skip, monitor);
      Quality::Write(report, task.Output);
      this->Results.Set(report);
    }
    this->Results.SetText("MorphStatus", bad > 0 ? "Inverted" : "Valid");
    this->Results.SetNumber(
      "LargestValidStep", bad > 0 ? std::numeric_limits<double>::quiet_NaN() : 1);
  }
  else
  {
    this->Results.SetText("MorphStatus", "Unmeasured");
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
      surfaceInverted = this->Mesh.Surface().Write(task.Output->GetPoints(), mine, task.Surface);
    });
  this->Results.SetInteger("SurfaceInvertedCells", ranks.sum(surfaceInverted));
  this->Mesh.WriteGlobalIds(task.BadCells);
  this->Mesh.WriteGlobalIds(task.Surface);
}

void Morphing::Run(const Task& task, const Session::Options& options, morph::Monitor& monitor)
{
  Internals& own = *this->Own;
  Results& results = own.Results;
  requireAvailable(task, options);
  std::unique_ptr<Method> sample = morph::distributed::makeMethod(options.CreateMorpher());
  if (!sample)
  {
    throw morph::Error(options.Method +
                       " needs one MPI rank, and the mesh is distributed over several. Run on one, "
                       "or use a linear method, Morph FEMWARP for instance.");
  }
  if (own.Mesh.Take(task.Grid, sample->layers(), GridMesh::UnknownCells::Refuse, monitor))
  {
    own.Prepared.reset();
  }
  own.Mesh.RequireVolumeCells();
  if (own.Mesh.Ranks().sum(morph::Index(morph::hasPolyhedra(own.Mesh.Piece()))) > 0)
  {
    throw morph::Error(options.Method +
                       " of a mesh with polyhedra needs one MPI rank, and the mesh is distributed "
                       "over several. Run on one.");
  }
  const DistributedMesh& whole = own.Mesh.Whole();
  const auto& ranks = whole.ranks();
  results.SetInteger("MirroredBodies", whole.mirroredBodies());
  if (whole.mirroredBodies() > 0 && ranks.rank() == 0)
  {
    monitor.warn(std::to_string(whole.mirroredBodies()) +
                 " bodies of the mesh are mirrored: in VTK's order of nodes all their cells of a "
                 "type are inverted. They are morphed and measured as if they were not. Reverse "
                 "their order of nodes if a solver expects VTK's.");
  }
  vtkPointSet* displaced = nullptr;
  ranks.together([&] { displaced = Input::RequireBoundary(task.Boundary); });
  BoundaryMatch::Options matching = options.Matching;
  matching.ScaleFactor *= task.Fraction;
  const BoundaryMatch::Result match = RankMatch::Match(displaced, whole, matching);
  for (const std::string& warning : match.Warnings)
  {
    if (ranks.rank() == 0)
    {
      monitor.warn(warning);
    }
  }
  morph::NodePartition partition;
  ranks.together(
    [&]
    {
      monitor.check();
      partition = morph::partitionNodes(whole.mesh(), match.Ids);
    });
  const morph::Index determined = own.RequireFeasible(match, partition, options);

  morph::ProgressRange preparing(monitor, 0.05, 0.45);
  own.Prepare(partition, options, preparing);
  morph::ProgressRange evaluating(monitor, 0.45, 0.75);
  const auto start = Clock::now();
  const std::unique_ptr<morph::Morpher> settings = options.CreateMorpher();
  options.SetEvaluateOptions(*settings);
  own.Prepared->takeEvaluateOptions(*settings);
  morph::Points moved;
  const morph::EvaluateReport report = own.Prepared->evaluate(match.Targets, moved, evaluating);
  results.SetNumber("EvaluateSeconds", ranks.maximum(secondsSince(start)));
  morph::ProgressRange writing(monitor, 0.75, 1);
  own.Write(task, options, moved, writing);

  morph::Index prescribed = 0;
  for (morph::Index node : match.Ids)
  {
    prescribed += whole.owns(node);
  }
  results.SetInteger("BoundaryInvertedCells", determined);
  results.SetInteger("SubSteps", 0);
  results.SetInteger("SolverIterations", report.iterations);
  results.SetInteger("PrescribedPoints", ranks.sum(prescribed));
  results.SetInteger("UnmatchedPoints", match.Unmatched);
  results.SetCounts(report.statistics);
  results.Write(task.Output);
}

void ExtractBoundary(vtkUnstructuredGrid* grid, vtkPolyData* output, morph::Monitor& monitor)
{
  RankMesh mesh;
  mesh.Take(grid, 1, GridMesh::UnknownCells::Refuse, monitor);
  mesh.RequireVolumeCells();
  const morph::distributed::Ranks& ranks = mesh.Ranks();
  const morph::BoundaryFaces& faces = mesh.Whole().outerFaces();
  if (ranks.sum(static_cast<morph::Index>(faces.cells.size())) == 0 && ranks.rank() == 0)
  {
    Surface::WarnOfNone(faces, monitor);
  }
  ranks.together([&] { Surface::Write(grid, mesh.Piece(), faces, output, &mesh.Orientation()); });
  mesh.WriteGlobalIds(output);
}

Measured Measure(
  vtkUnstructuredGrid* grid, bool certified, vtkUnstructuredGrid* output, morph::Monitor& monitor)
{
  RankMesh mesh;
  mesh.Take(grid, 1, GridMesh::UnknownCells::Keep, monitor);
  Measured result;
  const std::vector<std::uint8_t>& skip = mesh.Unmeasured();
  morph::Quality mine;
  mesh.Ranks().together(
    [&]
    {
      output->ShallowCopy(grid);
      mine = Quality::Measure(mesh.Piece(), output, mesh.Orientation(), skip, monitor);
      Quality::Remove(output);
      Quality::Write(mine, output);
      result.Unmeasured = Quality::Unmeasured(mesh.Piece(), mine, skip, grid);
    });
  mesh.Ranks().sum(result.Unmeasured.data(), result.Unmeasured.size());
  result.Whole = morph::distributed::reduce(mesh.Ranks(), mine, mesh.Whole().cellIds());
  if (certified)
  {
    result.Certificates = certify(mesh, output,
      mesh.HighestDimension() == 3 ? skip : std::vector<std::uint8_t>(skip.size(), 1), monitor);
    Quality::Write(result.Certificates, output);
  }
  result.MirroredBodies = mesh.Whole().mirroredBodies();
  return result;
}
}
