// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Shapes/Internals.h"

#include "LinearMethods/FemWarp.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "LinearMethods/RadialBasis.h"
#include "LinearMethods/SimplexLinear.h"
#include "LinearMethods/SimplexNaturalNeighbor.h"
#include "LinearMethods/WeightedResidual.h"
#include "Mesh/ShellLayer.h"
#include "Private/Data/Arrays.h"
#include "Private/Morph/SerialMesh.h"
#include "Private/Pipeline/Input.h"
#include "Session/UndeformedMesh.h"
#include "Support/Error.h"
#include "Support/Monitor.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace filters = morph::filters;

namespace
{
std::unique_ptr<morph::LinearMorpher> makeMethod(int method, double tolerance)
{
  switch (method)
  {
    case vtkMorphShapes::METHOD_LBWARP:
    {
      auto lbwarp = std::make_unique<morph::LogBarrierWarp>();
      lbwarp->setTolerance(tolerance);
      lbwarp->setOutsideHull(morph::LogBarrierWarp::OutsideHull::Relax);
      return lbwarp;
    }
    case vtkMorphShapes::METHOD_WEIGHTED_RESIDUAL:
      return std::make_unique<morph::WeightedResidual>();
    case vtkMorphShapes::METHOD_SIMPLEX_LINEAR:
      return std::make_unique<morph::SimplexLinear>();
    case vtkMorphShapes::METHOD_SIMPLEX_NATURAL_NEIGHBOR:
      return std::make_unique<morph::SimplexNaturalNeighbor>();
    case vtkMorphShapes::METHOD_RADIAL_BASIS:
      return std::make_unique<morph::RadialBasis>();
    default:
      break;
  }
  auto femwarp = std::make_unique<morph::FemWarp>();
  femwarp->setTolerance(tolerance);
  return femwarp;
}
}

filters::ShapeModes::Options vtkMorphShapes::vtkInternals::Options() const
{
  filters::ShapeModes::Options options;
  options.Matching.BoundaryIdArray = this->Filter->Options->BoundaryIdArray;
  options.Matching.displacementArray = this->Filter->Options->DisplacementArray;
  options.Matching.matchTolerance = this->Filter->Options->MatchTolerance;
  options.Matching.fixUnnamedBoundary = this->Filter->Options->FixUnnamedBoundary;
  options.CreateMorpher = [filter = this->Filter]
  { return makeMethod(filter->Options->Method, filter->Options->Tolerance); };
  return options;
}

std::vector<filters::ShapeModes::Shape> vtkMorphShapes::vtkInternals::Shapes(
  vtkInformationVector* boundaries) const
{
  const int number = boundaries->GetNumberOfInformationObjects();
  if (number == 0)
  {
    throw morph::Error("There is no shape: connect displaced boundaries to port 1, one for each "
                       "shape, Boundary Displacement's output for instance.");
  }
  std::vector<filters::ShapeModes::Shape> shapes;
  for (int i = 0; i < number; ++i)
  {
    const std::string name = this->Filter->GetShapeName(i);
    try
    {
      shapes.push_back({ name,
        filters::Input::RequireBoundary(
          this->Ports.AsOne(vtkDataObject::GetData(boundaries, i), "The boundary")),
        this->Filter->GetMotion(i) == MOTION_AS_ROTATION });
    }
    catch (const morph::Error& error)
    {
      throw morph::Error(error.kind(), "Shape '" + name + "': " + error.what());
    }
  }
  return shapes;
}

vtkMorphShapes::vtkInternals::Source vtkMorphShapes::vtkInternals::SourceOf(
  vtkInformationVector* boundaries) const
{
  Source source{ *this->Filter->Options, {}, {}, {} };
  for (int i = 0; i < boundaries->GetNumberOfInformationObjects(); ++i)
  {
    vtkDataObject* boundary = vtkDataObject::GetData(boundaries, i);
    if (!vtkPointSet::SafeDownCast(boundary))
    {
      return {}; // the time of composite data is not that of its blocks
    }
    source.Names.emplace_back(this->Filter->GetShapeName(i));
    source.Motions.push_back(this->Filter->GetMotion(i));
    source.Boundaries.emplace_back(boundary, boundary->GetMTime());
  }
  return source;
}

void vtkMorphShapes::vtkInternals::Solve(vtkInformationVector* boundaries, morph::Monitor& monitor)
{
  Source source = this->SourceOf(boundaries);
  const filters::RankGroup& processes = this->Modes.Group();
  if (!processes.Any(source.Boundaries.empty() || !(source == this->SolvedFrom)))
  {
    for (const std::string& warning : this->Modes.GetWarnings())
    {
      monitor.warn(warning);
    }
    this->Results.SetInteger("SolverIterations", 0);
    this->Results.SetNumber("PrepareSeconds", 0);
    this->Results.SetInteger("PrescribedPoints", this->Prescribed);
    return;
  }
  this->SolvedFrom = {};
  std::vector<filters::ShapeModes::Shape> shapes;
  processes.Together([&] { shapes = this->Shapes(boundaries); });
  const filters::ShapeModes::Effort effort = this->Modes.Solve(shapes, this->Options(), monitor);
  this->Results.SetInteger(
    "PrepareCount", this->Results.Integer("PrepareCount") + effort.Preparations);
  this->Results.SetInteger("SolveCount", this->Results.Integer("SolveCount") + effort.Solved);
  this->Results.SetInteger("SolverIterations", effort.Iterations);
  this->Results.SetNumber("PrepareSeconds", effort.Seconds);
  this->Results.SetInteger("PrescribedPoints", effort.Prescribed);
  this->Prescribed = effort.Prescribed;
  this->SolvedFrom = std::move(source);
}

std::vector<double> vtkMorphShapes::vtkInternals::PresentWeights(
  std::size_t shapes, vtkDataObject* table, morph::Monitor& monitor)
{
  std::vector<double> weights;
  for (std::size_t i = 0; i < shapes; ++i)
  {
    weights.push_back(this->Filter->GetWeight(static_cast<int>(i)));
  }
  if (!table)
  {
    this->Designs = {};
    return weights;
  }
  filters::Designs designs =
    filters::Designs::Read(table, this->Names(shapes), weights, this->Modes.Group());
  designs.KeepAnswer(std::move(this->Designs));
  this->Designs = std::move(designs);
  if (this->Filter->Options->CheckDesigns)
  {
    std::vector<morph::Index> rows;
    for (const std::size_t row : this->Designs.Inverted(this->Modes, monitor))
    {
      rows.push_back(static_cast<morph::Index>(row));
    }
    this->Results.SetText("InvertingDesigns", rows.empty() ? "none" : morph::listIds(rows, 100));
  }
  this->Rows = static_cast<vtkIdType>(this->Designs.Number());
  this->Row = this->RowOf(this->Rows);
  return this->Designs[this->Row];
}

void vtkMorphShapes::vtkInternals::WriteUndeformedSurface(
  vtkUnstructuredGrid* grid, vtkPolyData* surface) const
{
  const filters::ModeSolver none(std::make_unique<filters::SerialMesh>());
  const filters::ModeSolver* solver = this->Modes.GetSolver();
  (solver ? solver : &none)->WriteUndeformedSurface(grid, surface);
}

vtkIdType vtkMorphShapes::vtkInternals::RowOf(vtkIdType rows) const
{
  const auto last = static_cast<double>(std::max<vtkIdType>(rows - 1, 0));
  return static_cast<vtkIdType>(std::clamp(std::floor(this->Time), 0., last));
}

void vtkMorphShapes::vtkInternals::Morph(vtkUnstructuredGrid* grid, bool isDistributed,
  vtkInformationVector* boundaries, vtkDataObject* table, vtkInformationVector* outputs,
  morph::Monitor& monitor)
{
  if (this->Modes.SetGrid(grid, isDistributed, this->Options(), monitor))
  {
    this->SolvedFrom = {};
  }
  this->Modes.SetFeatureLines(this->Filter->Options->FeatureLines, monitor);
  this->Results.SetInteger("MirroredBodies", this->Modes.GetSolver()->Rest().mirroredBodies());
  this->Modes.GetSolver()->ReportMesh(monitor);
  morph::ProgressRange solving(monitor, 0, 0.6);
  this->Solve(boundaries, solving);
  morph::ProgressRange checking(monitor, 0.6, 0.8);
  const std::vector<double> weights =
    this->PresentWeights(boundaries->GetNumberOfInformationObjects(), table, checking);

  const morph::Stopwatch watch;
  const filters::RankGroup& group = this->Modes.Group();
  group.Together(
    [&] {
      morph::blend(this->Modes.Mesh().points, this->Modes.Weighted(weights), this->Moved, monitor);
    });
  morph::placeImages(this->Modes.Mesh(), this->Moved);
  this->Modes.GetSolver()->Attached().apply(this->Moved);
  this->Results.SetNumber("EvaluateSeconds", group.Maximum(watch.seconds()));
  if (group.IsFirst())
  {
    morph::warnOfLoose(this->Modes.GetSolver()->Attached().loose(), monitor);
  }
  morph::ProgressRange writing(monitor, 0.8, 1);
  this->Write(grid, weights, outputs, writing);
  this->WriteShapes(weights, this->Ports.Output(outputs));
  this->Weights = weights;
}

void vtkMorphShapes::vtkInternals::Write(vtkUnstructuredGrid* grid,
  const std::vector<double>& weights, vtkInformationVector* outputs, morph::Monitor& monitor)
{
  const bool all = this->Filter->Options->Quality == QUALITY_ALL;
  const filters::MorphOutput::Outputs written = { this->Ports.Output(outputs),
    vtkUnstructuredGrid::GetData(outputs, 1), vtkPolyData::GetData(outputs, 2) };
  const filters::MorphOutput::Measured measured = this->Modes.GetSolver()->Write(
    grid, this->Moved, this->Filter->Options->OutputPointsPrecision, all, written, monitor);
  const morph::Quality& quality = measured.Whole;
  this->Results.SetInteger("SurfaceInvertedCells", measured.SurfaceInverted);
  if (all)
  {
    this->Results.Set(quality);
    this->Results.Set(measured.Judged);
  }
  const bool isBad = measured.Judged.Added > 0;
  const char* status = isBad ? "Inverted" : measured.Crossing.Count > 0 ? "CrossesItself" : "Valid";
  this->Results.SetText("MorphStatus", all ? status : "Unmeasured");
  if (all)
  {
    this->Results.SetInteger("CrossingFaces", measured.Crossing.Count);
  }
  if (measured.Crossing.Count > 0 && this->Modes.Group().IsFirst())
  {
    monitor.warn(measured.Crossing.Warning);
  }
  if (this->Filter->Options->FindValidRanges && this->Modes.Mesh().layer.isCurved())
  {
    monitor.warn("`FindValidRanges` finds none for a curved shell: its cells are judged by the "
                 "normals around them, which turn with the shapes. See the number of inverted "
                 "cells at each weight, or set it to 0.");
  }
  else if (this->Filter->Options->FindValidRanges) // of a mesh that can be written
  {
    this->FindRanges(weights, monitor);
  }
  this->Results.Write(written.Mesh);
}

void vtkMorphShapes::vtkInternals::FindRanges(
  const std::vector<double>& weights, morph::Monitor& monitor)
{
  this->Ranges = filters::WeightRanges::Find(this->Modes, weights, monitor);
  this->Results.SetText("ValidRanges", this->Ranges.Text(this->Names(weights.size())));
  this->Results.SetNumber("LargestFactor", this->Ranges.LargestFactor);
}

std::vector<std::string> vtkMorphShapes::vtkInternals::Names(std::size_t number) const
{
  std::vector<std::string> names;
  for (std::size_t i = 0; i < number; ++i)
  {
    names.push_back(this->Filter->GetShapeName(static_cast<int>(i)));
  }
  return names;
}

void vtkMorphShapes::vtkInternals::WriteShapes(
  const std::vector<double>& weights, vtkUnstructuredGrid* output) const
{
  vtkFieldData* data = output->GetFieldData();
  data->AddArray(filters::Arrays::MakeOf<vtkStringArray>(
    "ShapeNames", this->Names(weights.size()), [](const std::string& name) { return name; }));
  data->AddArray(filters::Arrays::MakeOf<vtkDoubleArray>(
    "ShapeWeights", weights, [](double weight) { return weight; }));
  if (const auto& ranges = this->Ranges.Shapes; !ranges.empty())
  {
    data->AddArray(filters::Arrays::MakeOf<vtkDoubleArray>(
      "ShapeLowestWeight", ranges, [](const morph::ValidRange& range) { return range.lowest; }));
    data->AddArray(filters::Arrays::MakeOf<vtkDoubleArray>(
      "ShapeHighestWeight", ranges, [](const morph::ValidRange& range) { return range.highest; }));
  }
}
