// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphMesh.h"

#include "Private/MorphMesh/Internals.h"
#include "Private/Options.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Monitor.h"
#include "Private/Pipeline/Ports.h"
#include "Private/Pipeline/Ranks.h"
#include "Private/Pipeline/Steps.h"
#include "Private/Pipeline/Time.h"
#include "Private/Pipeline/UpToDateInput.h"
#include "Support/Error.h"
#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkLBWarpMorph.h"
#include "vtkRadialBasisMorph.h"
#include "vtkSimplexLinearMorph.h"
#include "vtkSimplexNaturalNeighborMorph.h"
#include "vtkSmoothingMorph.h"
#include "vtkWeightedResidualMorph.h"

#include <vtkAbstractTransform.h>
#include <vtkDataArraySelection.h>
#include <vtkExtractSelection.h>
#include <vtkImplicitFunction.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationDoubleVectorKey.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkSelection.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <string>

namespace filters = morph::filters;

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(vtkMorphMesh);

namespace
{
vtkSmartPointer<vtkMorphAlgorithm> makeMethod(int method)
{
  switch (method)
  {
    case vtkMorphMesh::METHOD_LBWARP:
      return vtkSmartPointer<vtkLBWarpMorph>::New();
    case vtkMorphMesh::METHOD_WEIGHTED_RESIDUAL:
      return vtkSmartPointer<vtkWeightedResidualMorph>::New();
    case vtkMorphMesh::METHOD_SIMPLEX_LINEAR:
      return vtkSmartPointer<vtkSimplexLinearMorph>::New();
    case vtkMorphMesh::METHOD_SIMPLEX_NATURAL_NEIGHBOR:
      return vtkSmartPointer<vtkSimplexNaturalNeighborMorph>::New();
    case vtkMorphMesh::METHOD_SMOOTHING:
      return vtkSmartPointer<vtkSmoothingMorph>::New();
    case vtkMorphMesh::METHOD_INVERSION_FREE:
      return vtkSmartPointer<vtkInversionFreeMorph>::New();
    case vtkMorphMesh::METHOD_RADIAL_BASIS:
      return vtkSmartPointer<vtkRadialBasisMorph>::New();
    default:
      return vtkSmartPointer<vtkFEMWarpMorph>::New();
  }
}
}

vtkMorphMesh::vtkMorphMesh()
  : Internals(new vtkInternals(this))
  , MeshOptions(std::make_unique<morph::MorphMeshOptions>())
{
  this->Shared = this->Internals.get();
  this->SetNumberOfOutputPorts(3);
  this->Internals->Results.Reset();
}

vtkMorphMesh::~vtkMorphMesh() = default;

vtkUnstructuredGrid* vtkMorphMesh::GetOutput()
{
  return this->GetOutput(0);
}

vtkUnstructuredGrid* vtkMorphMesh::GetOutput(int port)
{
  return vtkUnstructuredGrid::SafeDownCast(this->GetOutputDataObject(port));
}

vtkDataArraySelection* vtkMorphMesh::GetSurfaceList()
{
  return this->Internals->Displacement->GetSurfaceList();
}

void vtkMorphMesh::FindSurfaces(
  vtkDataObject* shown, vtkSelection* selection, vtkDataArraySelection* names)
{
  vtkInternals& own = *this->Internals;
  own.Displacement->SetSelectionExtractor(own.Extractor);
  try
  {
    const filters::Selection::OnGrid ofBlocks = own.OfBlocks(shown, selection);
    own.Displacement->FindSurfaces(ofBlocks.Shown ? ofBlocks.Shown.Get() : shown,
      ofBlocks.Shown ? ofBlocks.Selection.Get() : selection, names);
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro("Cannot find the surfaces of this selection: " << error.what());
  }
}

void vtkMorphMesh::CopySurfaces(vtkDataArraySelection* names, vtkPolyData* output)
{
  this->Internals->CopySurfaces(names, output);
}

void vtkMorphMesh::SetPick(vtkAlgorithm* selection)
{
  this->Internals->Picker.Selection = selection;
}

void vtkMorphMesh::SetPickPort(int port)
{
  this->Internals->Picker.Port = std::max(port, -1);
}

int vtkMorphMesh::GetPickPort() const
{
  return this->Internals->Picker.Port;
}

vtkDataArraySelection* vtkMorphMesh::GetPickedSurfaces()
{
  filters::Picker& picker = this->Internals->Picker;
  this->FindSurfaces(picker.Shown(this), picker.Update(), picker.Names);
  return picker.Names;
}

vtkStringArray* vtkMorphMesh::GetSurfaceSizes()
{
  return this->Internals->Displacement->GetSurfaceSizes();
}

vtkDataArraySelection* vtkMorphMesh::GetZoneList()
{
  return this->Internals->Displacement->GetZoneList();
}

vtkStringArray* vtkMorphMesh::GetZoneSizes()
{
  return this->Internals->Displacement->GetZoneSizes();
}

vtkDoubleArray* vtkMorphMesh::GetSurfaceBounds()
{
  return this->Internals->Displacement->GetSurfaceBounds();
}

vtkIdType vtkMorphMesh::GetZonePoints() const
{
  return this->Internals->Displacement->GetZonePoints();
}

vtkIdType vtkMorphMesh::GetLayerPoints() const
{
  return this->Internals->Displacement->GetLayerPoints();
}

vtkMorphAlgorithm* vtkMorphMesh::GetMethodFilter()
{
  vtkInternals& own = *this->Internals;
  if (!own.Morph || own.MorphMethod != this->MeshOptions->Method)
  {
    own.MorphMethod = this->MeshOptions->Method;
    own.Morph = makeMethod(own.MorphMethod);
    own.MorphTime = own.Morph->GetMTime();
  }
  return own.Morph;
}

vtkMTimeType vtkMorphMesh::GetMTime()
{
  vtkInternals& own = *this->Internals;
  // A time of modification must not decrease, so that a change inside becomes one of this object.
  if (own.Morph && own.Morph->GetMTime() != own.MorphTime)
  {
    own.MorphTime = own.Morph->GetMTime();
    this->Modified();
  }
  return this->Superclass::GetMTime();
}

vtkTypeBool vtkMorphMesh::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  return filters::Ports::MakeOutput(request, inputVector, outputVector) ||
         this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

int vtkMorphMesh::FillOutputPortInformation(int port, vtkInformation* info)
{
  return filters::Ports::FillOutputInformation(port, info);
}

int vtkMorphMesh::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const filters::Steps steps(this->MeshOptions->NumberOfSteps, nullptr);
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    vtkInformation* output = outputVector->GetInformationObject(port);
    output->Remove(Pipeline::TIME_STEPS()); // the executive has copied the mesh's
    output->Remove(Pipeline::TIME_RANGE());
    steps.Write(output);
  }
  // A user who is about to choose surfaces wants to see their names before the first execution. See
  // vtkBoundaryDisplacement for several ranks.
  if (filters::Ranks::Processes() == 1)
  {
    this->Internals->List(filters::upToDateInput(this, inputVector));
  }
  return 1;
}

int vtkMorphMesh::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  filters::Time::AskRest(this->MeshOptions->RestTime, inputVector[0]->GetInformationObject(0));
  return 1;
}

int vtkMorphMesh::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInternals& own = *this->Internals;
  vtkSmartPointer<vtkDataObject> input = vtkDataObject::GetData(inputVector[0]);
  vtkSelection* selection = vtkSelection::GetData(inputVector[1]);
  vtkDataObject* target = vtkDataObject::GetData(inputVector[2]);
  vtkSelection* zone = vtkSelection::GetData(inputVector[3]);
  vtkDataObject* control = vtkDataObject::GetData(inputVector[4]);
  vtkUnstructuredGrid* output = own.Blocks.Output(outputVector);
  vtkUnstructuredGrid* badCells = vtkUnstructuredGrid::GetData(outputVector, 1);
  vtkPolyData* surface = vtkPolyData::GetData(outputVector, 2);
  filters::Monitor monitor(this, this->Options->NumberOfThreads);
  std::string partial;
  own.Results.Reset();
  own.SlideReport = "None";
  const auto work = [&]
  {
    const filters::Input::Mesh mesh =
      filters::Input::TakeMesh(input, own.Blocks, this->Options->CoincidentPoints,
        filters::Input::Use::ToMorphOnRanks, this->GetClassName(), monitor);
    input = mesh.Data;
    vtkSelection* ofGrid = nullptr;
    filters::Ranks::Together(
      [&]
      {
        auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
        if (!grid)
        {
          filters::Input::RequireGrid(input, "The input"); // has the message
        }
        own.IsDistributed = mesh.IsDistributed;
        own.TakeGrid(grid);
        own.TakeTarget(target);
        own.TakeControlPoints(control);
        own.TakeZone(zone);
        ofGrid = own.OfGrid(selection);
      });
    partial = own.Run(
      ofGrid, filters::Ports::Asked(request, outputVector), output, badCells, surface, monitor);
  };
  const auto clear = [&]
  {
    output->Initialize();
    badCells->Initialize();
    surface->Initialize();
    own.Results.Reset();
  };
  const filters::Execution::Outcome outcome =
    filters::Execution::Run(this, "morph this mesh", work, clear);
  for (const std::string& warning : monitor.TakeWarnings())
  {
    if (!this->MeshOptions->Live) // they would come with every step of a drag
    {
      vtkWarningMacro(<< warning);
    }
  }
  if (outcome != filters::Execution::Outcome::Done)
  {
    own.WriteUndeformed(input,
      outcome == filters::Execution::Outcome::Cancelled ? "Cancelled" : "Failed", output, surface);
  }
  own.Blocks.Scatter(outputVector);
  if (!partial.empty())
  {
    vtkErrorMacro(<< partial);
  }
  if (own.Morph)
  {
    own.MorphTime = own.Morph->GetMTime();
  }
  return 1;
}

const char* vtkMorphMesh::GetMorphStatus() const
{
  return this->Internals->Results.Text("MorphStatus").c_str();
}

const char* vtkMorphMesh::GetAdvice() const
{
  return this->Internals->Results.Text("Advice").c_str();
}

#define morphResultMacro(name, type, kind)                          \
  type vtkMorphMesh::Get##name() const                              \
  {                                                                 \
    return static_cast<type>(this->Internals->Results.kind(#name)); \
  }
morphResultMacro(MinScaledJacobian, double, Number);
morphResultMacro(MeanScaledJacobian, double, Number);
morphResultMacro(WorstMeanScaledJacobian, double, Number);
morphResultMacro(BoundaryMinimum, double, Number);
morphResultMacro(InvertedCells, vtkIdType, Integer);
morphResultMacro(DegenerateCells, vtkIdType, Integer);
morphResultMacro(InvertedBefore, vtkIdType, Integer);
morphResultMacro(NewInvertedCells, vtkIdType, Integer);
morphResultMacro(CrossingFaces, vtkIdType, Integer);
morphResultMacro(WorstCellId, vtkIdType, Integer);
morphResultMacro(SurfaceInvertedCells, vtkIdType, Integer);
morphResultMacro(BoundaryInvertedCells, vtkIdType, Integer);
morphResultMacro(MirroredBodies, vtkIdType, Integer);
morphResultMacro(CertifiedCells, vtkIdType, Integer);
morphResultMacro(UncertifiedCells, vtkIdType, Integer);
morphResultMacro(UndecidedCells, vtkIdType, Integer);
morphResultMacro(LargestValidStep, double, Number);
morphResultMacro(PrepareSeconds, double, Number);
morphResultMacro(EvaluateSeconds, double, Number);
morphResultMacro(SubSteps, vtkIdType, Integer);
morphResultMacro(PrepareCount, int, Integer);
morphResultMacro(PrescribedPoints, vtkIdType, Integer);
morphResultMacro(UnmatchedPoints, vtkIdType, Integer);
morphResultMacro(AttachedPoints, vtkIdType, Integer);
morphResultMacro(SolverIterations, int, Integer);
morphResultMacro(MaxTargetDistanceBefore, double, Number);
morphResultMacro(MeanTargetDistanceBefore, double, Number);
morphResultMacro(MaxTargetDistance, double, Number);
morphResultMacro(MeanTargetDistance, double, Number);

void vtkMorphMesh::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->PrintOptions(os, indent);
  os << indent << "PickPort: " << this->GetPickPort() << "\n";
  this->Internals->Results.Print(os, indent);
}
