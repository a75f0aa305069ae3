// SPDX-License-Identifier: BSD-3-Clause
#include "Private/MorphMesh/Internals.h"

#include "Private/Data/GridMesh.h"
#include "Private/Data/Version.h"
#include "Private/Displace/ControlPoints.h"
#include "Private/Displace/Internals.h"
#include "Private/Displace/SurfaceGrid.h"
#include "Private/Displace/Zones.h"
#include "Private/Distributed/WholeSurface.h"
#include "Private/Distributed/WholeVolume.h"
#include "Private/Morph/KeptMesh.h"
#include "Private/Morph/MorphOutput.h"
#include "Private/Options.h"
#include "Private/Pipeline/Follower.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Ports.h"
#include "Private/Pipeline/Ranks.h"
#include "Private/Project/TargetDistance.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"
#include "vtkFEMWarpMorph.h"

#include <vtkDataArray.h>
#include <vtkDataObjectTree.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSelection.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <cstdint>
#include <optional>

namespace filters = morph::filters;

using Pipeline = vtkStreamingDemandDrivenPipeline;

void vtkMorphMesh::vtkInternals::TakeGrid(vtkUnstructuredGrid* grid)
{
  // A new copy would have all of its points and cells compared with those that are kept.
  if (this->Input != grid || this->InputTime != grid->GetMTime())
  {
    this->Rest->ShallowCopy(grid);
    this->Input = grid;
    this->InputTime = grid->GetMTime();
  }
  this->Displacement->SetInputDataObject(0, this->Rest);
}

vtkDataObject* vtkMorphMesh::vtkInternals::CopiedData::Update(vtkDataObject* given)
{
  const vtkMTimeType time = given ? given->GetMTime() : 0;
  if (this->Given != given || this->Time != time)
  {
    this->Copy.TakeReference(given ? given->NewInstance() : nullptr);
    if (given)
    {
      this->Copy->ShallowCopy(given);
    }
    this->Given = given;
    this->Time = time;
  }
  return this->Copy;
}

void vtkMorphMesh::vtkInternals::TakeTarget(vtkDataObject* target)
{
  this->Displacement->SetTargetData(this->Target.Update(target));
}

void vtkMorphMesh::vtkInternals::TakeControlPoints(vtkDataObject* points)
{
  this->Displacement->SetControlPointsData(this->ControlPoints.Update(points));
}

bool vtkMorphMesh::vtkInternals::HasHandles(bool anySelection) const
{
  const bool areConnected = !filters::ControlPoints::AreNone(this->ControlPoints.Copy);
  return filters::Ranks::Count(areConnected) > 0 || !this->Handles.empty() ||
         (this->Filter->Options->SelectedHandles && anySelection);
}

std::string vtkMorphMesh::vtkInternals::Advice() const
{
  const std::string none = "Nothing moves yet. ";
  if (this->NeedsHandles)
  {
    return none + "Give a handle: add a row to Handles, choose Control Points, or copy selected "
                  "points and tick Selected Handles.";
  }
  if (this->Filter->Options->Moving == MOVING_SELECTION)
  {
    return none + "Select points or cells in the view, and press Copy Active Selection.";
  }
  if (this->Filter->Options->Displacement == DISPLACEMENT_TARGET && !this->Target.Copy)
  {
    return none + "Choose the Target, a surface such as an STL file.";
  }
  return none + "Tick surfaces, or select cells in the view and press Add selected surfaces.";
}

void vtkMorphMesh::vtkInternals::ConfigureDisplacement(vtkSelection* selection)
{
  const vtkMorphMesh* from = this->Filter;
  vtkBoundaryDisplacement* to = this->Displacement;
  const bool anySelection =
    filters::Ranks::Count(selection && selection->GetNumberOfNodes() > 0) > 0;
  const bool hasHandles =
    from->Options->Displacement == DISPLACEMENT_HANDLES && from->Options->SelectedHandles;
  const bool selectionMoves = anySelection && !hasHandles;
  const bool byTarget =
    from->Options->Displacement == DISPLACEMENT_TARGET && this->Target.Copy && !selectionMoves;
  const bool byPoints = from->Options->Displacement == DISPLACEMENT_HANDLES ||
                        from->Options->Displacement == DISPLACEMENT_LATTICE;
  const int ofSurfaces = !this->Filter->Options->Surfaces.empty() || byTarget
                           ? vtkBoundaryDisplacement::MOVING_SURFACES
                         : selectionMoves ? vtkBoundaryDisplacement::MOVING_SELECTION
                         : byPoints       ? vtkBoundaryDisplacement::MOVING_EVERYTHING
                                          : vtkBoundaryDisplacement::MOVING_NOTHING;
  const int moving[] = { ofSurfaces,
    anySelection ? vtkBoundaryDisplacement::MOVING_SELECTION
                 : vtkBoundaryDisplacement::MOVING_NOTHING,
    vtkBoundaryDisplacement::MOVING_REGION, vtkBoundaryDisplacement::MOVING_EVERYTHING,
    vtkBoundaryDisplacement::MOVING_ARRAY, vtkBoundaryDisplacement::MOVING_NOTHING };
  this->NeedsHandles =
    from->Options->Displacement == DISPLACEMENT_HANDLES && !this->HasHandles(anySelection);
  morph::DisplacementOptions options = *from->Options;
  options.Moving =
    this->NeedsHandles ? int(vtkBoundaryDisplacement::MOVING_NOTHING) : moving[options.Moving];
  // The boundary in the precision of the computation: the output alone is rounded.
  options.OutputPointsPrecision = DOUBLE_PRECISION;
  to->TakeDisplacement(options, *this);
  to->SetSelectionData(anySelection ? selection : nullptr);
  to->SetZoneSelectionData(this->Zone);
  to->Internals->OuterBlocks = this->Blocks.Merged();
}

vtkSmartPointer<vtkDataArray> vtkMorphMesh::vtkInternals::SoftCells()
{
  const vtkMorphMesh* from = this->Filter;
  filters::Zones::Options options;
  options.Soft = from->MeshOptions->SoftZones;
  options.Region = this->ZoneRegion;
  options.RegionKind = from->Options->ZoneRegionType;
  options.Selection = this->Zone;
  options.Extractor = this->Extractor;
  options.SelectionKind = from->Options->ZoneSelectionType;
  if (options.Soft.empty() && options.RegionKind != ZONE_SOFT && options.SelectionKind != ZONE_SOFT)
  {
    return nullptr;
  }
  std::vector<filters::Zones::Part> parts;
  if (this->IsDistributed)
  {
    parts = filters::Zones::FindOnRanks(filters::Zones::Soft, this->Rest,
      filters::WholeVolume(*this->Displacement->Internals->Whole), this->Blocks.Merged(), options);
  }
  else
  {
    filters::Ranks::Together(
      [&]
      {
        if (this->Rest->GetNumberOfCells() > 0) // else the mesh is on another MPI rank
        {
          parts = filters::Zones::Find(filters::Zones::Soft, this->Rest,
            filters::GridMesh::FromGrid(this->Rest), this->Blocks.Merged(), options);
        }
      });
  }
  if (parts.empty())
  {
    return nullptr;
  }
  vtkNew<vtkDoubleArray> factors;
  factors->SetNumberOfTuples(this->Rest->GetNumberOfCells());
  factors->FillValue(1);
  for (const filters::Zones::Part& part : parts)
  {
    for (std::size_t c = 0; c < part.isCell.size(); ++c)
    {
      if (part.isCell[c])
      {
        factors->SetValue(static_cast<vtkIdType>(c), from->MeshOptions->SoftStiffness);
      }
    }
  }
  return factors.Get();
}

void vtkMorphMesh::vtkInternals::TakeZone(vtkSelection* selection)
{
  this->Zone = this->Filter->Options->ZoneSelectionType == ZONE_NONE
                 ? nullptr
                 : this->ZoneSelected.OfGrid(this->Blocks, selection, this->Extractor);
}

void vtkMorphMesh::vtkInternals::ConfigureMorph(vtkDataArray* soft, morph::Monitor& monitor)
{
  const vtkMorphMesh* from = this->Filter;
  vtkMorphAlgorithm* to = this->Filter->GetMethodFilter();
  to->SetInputDataObject(0, this->Rest);
  to->SetBoundaryData(this->Displacement->GetOutput());
  to->SetBoundaryIdArray(nullptr);
  to->SetDisplacementArray(nullptr);
  to->SetScaleFactor(1);
  to->SetValidity(
    from->MeshOptions->Live ? vtkMorphAlgorithm::VALIDITY_NONE : from->MeshOptions->Validity);
  to->SetQuality(from->MeshOptions->Quality);
  to->SetFeatureLines(from->MeshOptions->FeatureLines);
  to->SetNumberOfSteps(from->MeshOptions->NumberOfSteps);
  to->SetStepping(from->MeshOptions->Stepping);
  to->SetOutputPointsPrecision(from->Options->OutputPointsPrecision);
  to->SetNumberOfThreads(from->Options->NumberOfThreads);
  if (auto* stiff = vtkFEMWarpMorph::SafeDownCast(to))
  {
    stiff->SetStiffness(from->MeshOptions->Stiffness);
    stiff->SetStiffnessExponent(from->MeshOptions->StiffnessExponent);
    stiff->SetStiffnessArray(from->MeshOptions->StiffnessArray.c_str());
    stiff->SetWallArray(from->MeshOptions->WallArray.c_str());
    stiff->SetStiffnessValues(soft);
  }
  else if (soft)
  {
    throw morph::Error("This method has no stiffness, so there are no soft zones. Use FEMWARP.");
  }
  else if (from->MeshOptions->Stiffness != 0 ||
           !filters::Input::ArrayName(from->MeshOptions->StiffnessArray).empty())
  {
    monitor.warn("This method has no stiffness: Stiffness counts for FEMWARP alone.");
  }
}

void vtkMorphMesh::vtkInternals::List(vtkDataObject* input)
{
  morph::Monitor silent;
  vtkUnstructuredGrid* grid = nullptr;
  try
  {
    grid = vtkUnstructuredGrid::SafeDownCast(this->Blocks.Gather(input,
      this->Filter->Options->CoincidentPoints, filters::GridMesh::UnknownCells::Refuse, silent));
  }
  catch (const std::exception&)
  {
    return; // the execution raises the error again, and reports it
  }
  if (grid && grid->GetNumberOfCells() > 0)
  {
    this->TakeGrid(grid);
    this->ConfigureDisplacement(nullptr);
    this->Displacement->UpdateInformation();
  }
}

vtkSelection* vtkMorphMesh::vtkInternals::OfGrid(vtkSelection* selection)
{
  const vtkMorphMesh* from = this->Filter;
  const bool isUsed =
    from->Options->Moving == MOVING_SELECTION ||
    (from->Options->Moving == MOVING_SURFACES && this->Filter->Options->Surfaces.empty()) ||
    (from->Options->Displacement == DISPLACEMENT_HANDLES && from->Options->SelectedHandles);
  return isUsed || !this->Blocks.Merged()
           ? this->Selected.OfGrid(this->Blocks, selection, this->Extractor)
           : nullptr;
}

filters::Selection::OnGrid vtkMorphMesh::vtkInternals::OfBlocks(
  vtkDataObject* shown, vtkSelection* selection) const
{
  auto* tree = vtkDataObjectTree::SafeDownCast(shown);
  if (!tree || !selection || selection->GetNumberOfNodes() == 0)
  {
    return {};
  }
  return filters::Selection::Translate(this->Blocks, tree, selection, this->Extractor);
}

void vtkMorphMesh::vtkInternals::CopySurfaces(vtkDataArraySelection* names, vtkPolyData* output)
{
  this->Displacement->CopySurfaces(names, output);
  if (this->IsDistributed)
  {
    return; // as displaced: the first rank shows them, and does not have all of the morphed mesh
  }
  vtkPointSet* shown = this->Filter->GetOutput();
  vtkDataArray* ids = output->GetPointData()->GetArray("MorphPointId");
  if (!ids || !shown || shown->GetNumberOfPoints() != this->Rest->GetNumberOfPoints())
  {
    return;
  }
  vtkNew<vtkPoints> points;
  points->SetDataType(shown->GetPoints()->GetDataType());
  points->SetNumberOfPoints(output->GetNumberOfPoints());
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    points->SetPoint(i, shown->GetPoint(static_cast<vtkIdType>(ids->GetComponent(i, 0))));
  }
  output->SetPoints(points);
}

void vtkMorphMesh::vtkInternals::Displace(morph::Monitor& monitor)
{
  const filters::Follower follower(this->Displacement, monitor);
  if (filters::Ranks::Processes() > 1)
  {
    this->Displacement->Modified(); // it communicates, so that all ranks execute it or none
  }
  const vtkMTimeType before = this->Displacement->GetOutput()->GetMTime();
  this->Displacement->Update();
  if (this->Displacement->GetOutput()->GetMTime() != before)
  {
    this->BoundaryWarnings = follower.Warnings();
  }
  for (const std::string& warning : this->BoundaryWarnings)
  {
    monitor.warn(warning);
  }
  filters::Ranks::Together(
    [&]
    {
      monitor.check();
      if (!follower.Errors().empty())
      {
        // Otherwise the next update would find nothing to do, and no error.
        this->Displacement->Modified();
        throw morph::Error(follower.Errors().front());
      }
    });
}

std::string vtkMorphMesh::vtkInternals::Morphed(vtkInformation* asked, vtkUnstructuredGrid* output,
  vtkUnstructuredGrid* badCells, vtkPolyData* surface, morph::Monitor& monitor)
{
  const vtkSmartPointer<vtkDataArray> soft = this->SoftCells();
  filters::Ranks::Together([&] { this->ConfigureMorph(soft, monitor); });
  if (filters::Ranks::Processes() > 1)
  {
    this->Morph->Modified(); // as in Displace()
  }
  const filters::Follower follower(this->Morph, monitor);
  const std::optional<double> time = filters::Ports::AskedTime(asked);
  if (time && this->Filter->MeshOptions->NumberOfSteps > 0)
  {
    this->Morph->UpdateTimeStep(*time);
  }
  else
  {
    this->Morph->UpdateInformation();
    this->Morph->GetOutputInformation(0)->Remove(Pipeline::UPDATE_TIME_STEP());
    this->Morph->Update();
  }
  for (const std::string& warning : follower.Warnings())
  {
    monitor.warn(warning);
  }
  if (monitor.cancelled() || !follower.Errors().empty())
  {
    this->Morph->Modified(); // as in Displace()
  }
  filters::Ranks::Together([&] { monitor.check(); });
  output->ShallowCopy(this->Morph->GetOutput(0));
  badCells->ShallowCopy(this->Morph->GetOutput(1));
  surface->ShallowCopy(this->Morph->GetOutputDataObject(2));
  for (const char* name : { "SlideChange", "SlideForce" })
  {
    if (vtkDataArray* ofRounds = this->Displacement->GetOutput()->GetFieldData()->GetArray(name))
    {
      output->GetFieldData()->AddArray(ofRounds);
    }
  }
  this->SlideReport = this->Displacement->GetSlideReport();
  this->TakeResults();
  this->WriteDistances(output);
  return follower.Errors().empty() ? std::string() : follower.Errors().front();
}

void vtkMorphMesh::vtkInternals::TakeResults()
{
  vtkMorphAlgorithm* from = this->Morph;
  filters::Results& to = this->Results;
  to.SetText("MorphStatus", from->GetMorphStatus());
  to.SetText("SlideReport", this->SlideReport);
  to.SetNumber("MinScaledJacobian", from->GetMinScaledJacobian());
  to.SetNumber("MeanScaledJacobian", from->GetMeanScaledJacobian());
  to.SetNumber("WorstMeanScaledJacobian", from->GetWorstMeanScaledJacobian());
  to.SetNumber("BoundaryMinimum", from->GetBoundaryMinimum());
  to.SetInteger("InvertedCells", from->GetInvertedCells());
  to.SetInteger("DegenerateCells", from->GetDegenerateCells());
  to.SetInteger("InvertedBefore", from->GetInvertedBefore());
  to.SetInteger("NewInvertedCells", from->GetNewInvertedCells());
  to.SetInteger("CrossingFaces", from->GetCrossingFaces());
  to.SetInteger("WorstCellId", from->GetWorstCellId());
  to.SetInteger("SurfaceInvertedCells", from->GetSurfaceInvertedCells());
  to.SetInteger("BoundaryInvertedCells", from->GetBoundaryInvertedCells());
  to.SetInteger("MirroredBodies", from->GetMirroredBodies());
  to.SetInteger("CertifiedCells", from->GetCertifiedCells());
  to.SetInteger("UncertifiedCells", from->GetUncertifiedCells());
  to.SetInteger("UndecidedCells", from->GetUndecidedCells());
  to.SetNumber("LargestValidStep", from->GetLargestValidStep());
  to.SetNumber("PrepareSeconds", from->GetPrepareSeconds());
  to.SetNumber("EvaluateSeconds", from->GetEvaluateSeconds());
  to.SetInteger("SubSteps", from->GetSubSteps());
  to.SetInteger("PrepareCount", from->GetPrepareCount());
  to.SetInteger("PrescribedPoints", from->GetPrescribedPoints());
  to.SetInteger("UnmatchedPoints", from->GetUnmatchedPoints());
  to.SetInteger("AttachedPoints", from->GetAttachedPoints());
  to.SetInteger("SolverIterations", from->GetSolverIterations());
}

vtkSmartPointer<vtkPolyData> vtkMorphMesh::vtkInternals::BoundaryOfGrid() const
{
  vtkSmartPointer<vtkPolyData> boundary = this->Displacement->GetOutput();
  return this->IsDistributed ? this->Displacement->Internals->Whole->OfPiece(boundary) : boundary;
}

void vtkMorphMesh::vtkInternals::WriteDistances(vtkUnstructuredGrid* output)
{
  vtkPolyData* target = this->Displacement->GetFittedTarget();
  const vtkSmartPointer<vtkPolyData> boundary = this->BoundaryOfGrid();
  vtkDataArray* ids = boundary->GetPointData()->GetArray("MorphPointId");
  vtkDataArray* roles = boundary->GetPointData()->GetArray("Role");
  if (!target || !ids || !roles || output->GetNumberOfPoints() != this->Rest->GetNumberOfPoints())
  {
    return;
  }
  std::vector<morph::Index> nodes;
  for (vtkIdType i = 0; i < boundary->GetNumberOfPoints(); ++i)
  {
    if (roles->GetComponent(i, 0) == 1)
    {
      nodes.push_back(static_cast<morph::Index>(ids->GetComponent(i, 0)));
    }
  }
  morph::Points before(static_cast<morph::Index>(nodes.size()), 3), after = before;
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    this->Rest->GetPoint(nodes[i], before.row(static_cast<morph::Index>(i)).data());
    output->GetPoint(nodes[i], after.row(static_cast<morph::Index>(i)).data());
  }
  filters::TargetDistance::Summary distance =
    filters::TargetDistance::Write(target, nodes, before, after, output);
  if (this->IsDistributed)
  {
    this->SummarizeOnRanks(nodes, output, distance);
  }
  this->Results.SetNumber("MaxTargetDistanceBefore", distance.MaxBefore);
  this->Results.SetNumber("MeanTargetDistanceBefore", distance.MeanBefore);
  this->Results.SetNumber("MaxTargetDistance", distance.Max);
  this->Results.SetNumber("MeanTargetDistance", distance.Mean);
}

void vtkMorphMesh::vtkInternals::SummarizeOnRanks(const std::vector<morph::Index>& nodes,
  vtkUnstructuredGrid* output, filters::TargetDistance::Summary& distance) const
{
  const filters::WholeSurface& whole = *this->Displacement->Internals->Whole;
  const std::vector<std::int64_t> ids = whole.IdsOfPiece(nodes);
  const auto summarize = [&](const char* name)
  {
    vtkDataArray* array = output->GetPointData()->GetArray(name);
    std::vector<double> values;
    for (const morph::Index node : nodes)
    {
      values.push_back(array->GetComponent(static_cast<vtkIdType>(node), 0));
    }
    return whole.MaximumAndMean(ids, values);
  };
  std::tie(distance.MaxBefore, distance.MeanBefore) = summarize("TargetDistanceBefore");
  std::tie(distance.Max, distance.Mean) = summarize("TargetDistance");
}

std::string vtkMorphMesh::vtkInternals::Run(vtkSelection* selection, vtkInformation* asked,
  vtkUnstructuredGrid* output, vtkUnstructuredGrid* badCells, vtkPolyData* surface,
  morph::Monitor& monitor)
{
  this->ConfigureDisplacement(selection);
  morph::ProgressRange displacing(monitor, 0, 0.3);
  this->Displace(displacing);
  if (this->Displacement->GetMoving() == vtkBoundaryDisplacement::MOVING_NOTHING)
  {
    filters::SurfaceGrid::Write(this->Rest, this->BoundaryOfGrid(), output);
    filters::SurfaceGrid::Write(this->Displacement->GetOutput(), surface);
    this->Results.SetText("Advice", this->Advice());
    this->Results.Write(output);
    return {};
  }
  morph::ProgressRange morphing(monitor, 0.3, 1);
  return this->Morphed(asked, output, badCells, surface, morphing);
}

void vtkMorphMesh::vtkInternals::WriteUndeformed(
  vtkDataObject* input, const char* status, vtkUnstructuredGrid* output, vtkPolyData* surface)
{
  if (filters::Version::AbortRequested(this->Filter))
  {
    filters::Version::KeepAbortedOutput(this->Filter);
  }
  filters::MorphOutput::WriteUndeformed(input, status, 0, this->Results, output);
  filters::KeptMesh().WriteUndeformedSurface(output, surface);
}
