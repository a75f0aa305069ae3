// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphMesh.h"

#include "Private/Data/Results.h"
#include "Private/Data/Version.h"
#include "Private/Displace/SurfaceGrid.h"
#include "Private/Morph/MorphOutput.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Follower.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Monitor.h"
#include "Private/Pipeline/Ports.h"
#include "Private/Pipeline/Property.h"
#include "Private/Pipeline/Ranks.h"
#include "Private/Pipeline/Steps.h"
#include "Private/Pipeline/Time.h"
#include "Private/Pipeline/UpToDateInput.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"
#include "vtkBoundaryDisplacement.h"
#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkLBWarpMorph.h"
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
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkSelection.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace filters = morph::filters;

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(vtkMorphMesh);

namespace
{
using Names = std::set<std::string>;

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
    default:
      return vtkSmartPointer<vtkFEMWarpMorph>::New();
  }
}

bool setStatus(Names& names, const char* name, int status)
{
  return name && (status != 0 ? names.insert(name).second : names.erase(name) > 0);
}

/// Passes names to the filter inside, unless it has them.
void pass(const Names& names, Names& passed, vtkBoundaryDisplacement* to,
  void (vtkBoundaryDisplacement::*clear)(), void (vtkBoundaryDisplacement::*add)(const char*))
{
  if (names != passed)
  {
    (to->*clear)();
    for (const std::string& name : names)
    {
      (to->*add)(name.c_str());
    }
    passed = names;
  }
}

/// An error or warning of vtkBoundaryDisplacement with the names of this class's properties.
std::string inOwnWords(std::string text)
{
  const std::pair<const char*, const char*> names[] = { { "SlidingPatches names",
                                                          "SlidingSurfaces names" },
    { "HeldPatches names", "FixedSurfaces names" }, { "Patches names", "Surfaces names" } };
  for (const auto& [theirs, ours] : names)
  {
    const auto at = text.find(theirs);
    if (at != std::string::npos)
    {
      return text.replace(at, std::string(theirs).size(), ours);
    }
  }
  return text;
}
}

class vtkMorphMesh::vtkInternals
{
public:
  Names Surfaces, FixedSurfaces, SlidingSurfaces;
  vtkSmartPointer<vtkImplicitFunction> Region;
  vtkSmartPointer<vtkAbstractTransform> Transform;
  vtkSmartPointer<vtkExtractSelection> Extractor;
  vtkNew<vtkBoundaryDisplacement> Displacement;
  vtkSmartPointer<vtkMorphAlgorithm> Morph; ///< of the method, or null
  vtkMTimeType MorphTime = 0;               ///< of Morph, as this class has left it
  filters::Results Results{ filters::ResultTables::vtkMorphAlgorithm() };
  filters::Time Time;

  explicit vtkInternals(vtkMorphMesh* filter)
    : Filter(filter)
  {
  }

  /// Gives the filters inside the mesh, unless they have it.
  void TakeGrid(vtkUnstructuredGrid* grid);
  /// Lists the surfaces of the mesh that was taken.
  void List();
  /// Returns an error that comes with a result, or nothing.
  std::string Run(vtkSelection* selection, vtkInformation* asked, vtkUnstructuredGrid* output,
    vtkUnstructuredGrid* badCells, vtkPolyData* surface, morph::Monitor& monitor);
  /// Makes `output` the undeformed mesh, where that can be read, without a result.
  void WriteUndeformed(vtkDataObject* input, const char* status, vtkUnstructuredGrid* output);

private:
  vtkMorphMesh* Filter;
  vtkNew<vtkUnstructuredGrid> Rest;
  const vtkUnstructuredGrid* Input = nullptr; ///< that Rest was made from; compared, never used
  vtkMTimeType InputTime = 0;
  Names PassedSurfaces, PassedFixedSurfaces, PassedSlidingSurfaces;
  std::vector<std::string> BoundaryWarnings; ///< of the boundary that is kept

  void ConfigureDisplacement(vtkSelection* selection);
  void ConfigureMorph();
  void Displace(morph::Monitor& monitor);
  std::string Morphed(vtkInformation* asked, vtkUnstructuredGrid* output,
    vtkUnstructuredGrid* badCells, vtkPolyData* surface, morph::Monitor& monitor);
  void TakeResults();
};

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

void vtkMorphMesh::vtkInternals::ConfigureDisplacement(vtkSelection* selection)
{
  const vtkMorphMesh* from = this->Filter;
  vtkBoundaryDisplacement* to = this->Displacement;
  const bool anySelection = selection && selection->GetNumberOfNodes() > 0;
  const bool nothing = from->Moving == MOVE_SURFACES
                         ? this->Surfaces.empty() && !anySelection
                         : from->Moving == MOVE_SELECTION && !anySelection;
  const int moving[] = { this->Surfaces.empty() ? vtkBoundaryDisplacement::MOVE_SELECTION
                                                : vtkBoundaryDisplacement::MOVE_PATCHES,
    vtkBoundaryDisplacement::MOVE_SELECTION, vtkBoundaryDisplacement::MOVE_REGION,
    vtkBoundaryDisplacement::MOVE_EVERYTHING, vtkBoundaryDisplacement::MOVE_ARRAY };
  to->SetMoving(nothing ? vtkBoundaryDisplacement::MOVE_NOTHING : moving[from->Moving]);
  to->SetSelectionData(anySelection ? selection : nullptr);
  to->SetSelectionExtractor(this->Extractor);
  using Filter = vtkBoundaryDisplacement;
  pass(this->Surfaces, this->PassedSurfaces, to, &Filter::RemoveAllPatches, &Filter::AddPatch);
  pass(this->FixedSurfaces, this->PassedFixedSurfaces, to, &Filter::RemoveAllHeldPatches,
    &Filter::AddHeldPatch);
  pass(this->SlidingSurfaces, this->PassedSlidingSurfaces, to, &Filter::RemoveAllSlidingPatches,
    &Filter::AddSlidingPatch);
  to->SetRegion(this->Region);
  to->SetMovingArray(from->MovingArray);
  to->SetMotion(from->Displacement);
  to->SetTransform(this->Transform);
  to->SetVector(from->Vector);
  to->SetDistance(from->Distance);
  to->SetDisplacementArray(from->DisplacementArray);
  to->SetTranslation(from->Translation);
  to->SetRotation(from->Rotation);
  to->SetScale(from->Scale);
  to->SetAutoCenter(from->AutoCenter);
  to->SetCenter(from->Center);
  to->SetRadiusChange(from->RadiusChange);
  to->SetScaleFactor(from->ScaleFactor);
  to->SetSurroundings(from->Surroundings);
  to->SetFalloffRadius(from->FalloffRadius);
  to->SetFeatureAngle(from->FeatureAngle);
  to->SetCornerAngle(from->CornerAngle);
  to->SetSurfaceIdArray(from->SurfaceIdArray);
  to->SetUseGeometryArrays(from->UseGeometryArrays);
  // The boundary in the precision of the computation: the output alone is rounded.
  to->SetOutputPointsPrecision(DOUBLE_PRECISION);
  to->SetNumberOfThreads(from->NumberOfThreads);
}

void vtkMorphMesh::vtkInternals::ConfigureMorph()
{
  const vtkMorphMesh* from = this->Filter;
  vtkMorphAlgorithm* to = this->Filter->GetMethodFilter();
  to->SetInputDataObject(0, this->Rest);
  to->SetBoundaryData(this->Displacement->GetOutput());
  to->SetBoundaryIdArray(nullptr);
  to->SetDisplacementArray(nullptr);
  to->SetScaleFactor(1);
  to->SetValidity(from->Live ? vtkMorphAlgorithm::VALIDITY_NONE : from->Validity);
  to->SetNumberOfSteps(from->NumberOfSteps);
  to->SetStepping(from->Stepping);
  to->SetOutputPointsPrecision(from->OutputPointsPrecision);
  to->SetNumberOfThreads(from->NumberOfThreads);
}

void vtkMorphMesh::vtkInternals::List()
{
  this->ConfigureDisplacement(nullptr);
  this->Displacement->UpdateInformation();
}

void vtkMorphMesh::vtkInternals::Displace(morph::Monitor& monitor)
{
  const filters::Follower follower(this->Displacement, monitor);
  const vtkMTimeType before = this->Displacement->GetOutput()->GetMTime();
  this->Displacement->Update();
  if (this->Displacement->GetOutput()->GetMTime() != before)
  {
    this->BoundaryWarnings = follower.Warnings();
  }
  for (const std::string& warning : this->BoundaryWarnings)
  {
    monitor.warn(inOwnWords(warning));
  }
  monitor.check();
  if (!follower.Errors().empty())
  {
    // Otherwise the next update would find nothing to do, and no error.
    this->Displacement->Modified();
    throw morph::Error(inOwnWords(follower.Errors().front()));
  }
}

std::string vtkMorphMesh::vtkInternals::Morphed(vtkInformation* asked, vtkUnstructuredGrid* output,
  vtkUnstructuredGrid* badCells, vtkPolyData* surface, morph::Monitor& monitor)
{
  this->ConfigureMorph();
  const filters::Follower follower(this->Morph, monitor);
  const std::optional<double> time = filters::Ports::AskedTime(asked);
  if (time && this->Filter->NumberOfSteps > 0)
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
  monitor.check();
  output->ShallowCopy(this->Morph->GetOutput(0));
  badCells->ShallowCopy(this->Morph->GetOutput(1));
  surface->ShallowCopy(this->Morph->GetOutputDataObject(2));
  this->TakeResults();
  return follower.Errors().empty() ? std::string() : follower.Errors().front();
}

void vtkMorphMesh::vtkInternals::TakeResults()
{
  vtkMorphAlgorithm* from = this->Morph;
  filters::Results& to = this->Results;
  to.SetText("MorphStatus", from->GetMorphStatus());
  to.SetNumber("MinScaledJacobian", from->GetMinScaledJacobian());
  to.SetNumber("MeanScaledJacobian", from->GetMeanScaledJacobian());
  to.SetInteger("InvertedCells", from->GetInvertedCells());
  to.SetInteger("DegenerateCells", from->GetDegenerateCells());
  to.SetInteger("WorstCellId", from->GetWorstCellId());
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
  to.SetInteger("SolverIterations", from->GetSolverIterations());
}

std::string vtkMorphMesh::vtkInternals::Run(vtkSelection* selection, vtkInformation* asked,
  vtkUnstructuredGrid* output, vtkUnstructuredGrid* badCells, vtkPolyData* surface,
  morph::Monitor& monitor)
{
  this->ConfigureDisplacement(selection);
  morph::ProgressRange displacing(monitor, 0, 0.3);
  this->Displace(displacing);
  if (this->Displacement->GetMoving() == vtkBoundaryDisplacement::MOVE_NOTHING)
  {
    filters::SurfaceGrid::Write(this->Rest, this->Displacement->GetOutput(), output);
    filters::SurfaceGrid::Write(this->Displacement->GetOutput(), surface);
    this->Results.Write(output);
    return {};
  }
  morph::ProgressRange morphing(monitor, 0.3, 1);
  return this->Morphed(asked, output, badCells, surface, morphing);
}

void vtkMorphMesh::vtkInternals::WriteUndeformed(
  vtkDataObject* input, const char* status, vtkUnstructuredGrid* output)
{
  if (filters::Version::AbortRequested(this->Filter))
  {
    filters::Version::KeepAbortedOutput(this->Filter);
  }
  filters::MorphOutput::WriteUndeformed(input, status, 0, this->Results, output);
}

vtkMorphMesh::vtkMorphMesh()
  : Internals(new vtkInternals(this))
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(3);
  this->Internals->Results.Reset();
}

vtkMorphMesh::~vtkMorphMesh()
{
  this->SetMovingArray(nullptr);
  this->SetDisplacementArray(nullptr);
  this->SetSurfaceIdArray(nullptr);
}

void vtkMorphMesh::SetSelectionConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkMorphMesh::SetSelectionData(vtkSelection* selection)
{
  this->SetInputDataObject(1, selection);
}

void vtkMorphMesh::SetSelectionExtractor(vtkExtractSelection* extractor)
{
  if (this->Internals->Extractor != extractor)
  {
    this->Internals->Extractor = extractor;
    this->Modified();
  }
}

void vtkMorphMesh::SetSurfaceStatus(const char* name, int status)
{
  if (setStatus(this->Internals->Surfaces, name, status))
  {
    this->Modified();
  }
}

void vtkMorphMesh::RemoveAllSurfaces()
{
  if (!this->Internals->Surfaces.empty())
  {
    this->Internals->Surfaces.clear();
    this->Modified();
  }
}

void vtkMorphMesh::SetFixedSurfaceStatus(const char* name, int status)
{
  if (setStatus(this->Internals->FixedSurfaces, name, status))
  {
    this->Modified();
  }
}

void vtkMorphMesh::RemoveAllFixedSurfaces()
{
  if (!this->Internals->FixedSurfaces.empty())
  {
    this->Internals->FixedSurfaces.clear();
    this->Modified();
  }
}

void vtkMorphMesh::SetSlidingSurfaceStatus(const char* name, int status)
{
  if (setStatus(this->Internals->SlidingSurfaces, name, status))
  {
    this->Modified();
  }
}

void vtkMorphMesh::RemoveAllSlidingSurfaces()
{
  if (!this->Internals->SlidingSurfaces.empty())
  {
    this->Internals->SlidingSurfaces.clear();
    this->Modified();
  }
}

vtkDataArraySelection* vtkMorphMesh::GetSurfaceList()
{
  return this->Internals->Displacement->GetPatchList();
}

void vtkMorphMesh::SetRegion(vtkImplicitFunction* region)
{
  if (this->Internals->Region != region)
  {
    this->Internals->Region = region;
    this->Modified();
  }
}

vtkImplicitFunction* vtkMorphMesh::GetRegion()
{
  return this->Internals->Region;
}

void vtkMorphMesh::SetTransform(vtkAbstractTransform* transform)
{
  if (this->Internals->Transform != transform)
  {
    this->Internals->Transform = transform;
    this->Modified();
  }
}

vtkAbstractTransform* vtkMorphMesh::GetTransform()
{
  return this->Internals->Transform;
}

void vtkMorphMesh::SetMethod(int method)
{
  const int known = std::min(std::max(method, int(METHOD_FEMWARP)), int(METHOD_INVERSION_FREE));
  if (this->Method != known)
  {
    this->Method = known;
    this->Internals->Morph = nullptr;
    this->Modified();
  }
}

vtkMorphAlgorithm* vtkMorphMesh::GetMethodFilter()
{
  vtkInternals& own = *this->Internals;
  if (!own.Morph)
  {
    own.Morph = makeMethod(this->Method);
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
  vtkMTimeType time = this->Superclass::GetMTime();
  if (this->Displacement == DISPLACEMENT_TRANSFORM && own.Transform)
  {
    time = std::max(time, own.Transform->GetMTime());
  }
  if (this->Moving == MOVE_REGION && own.Region)
  {
    time = std::max(time, own.Region->GetMTime());
  }
  return time;
}

int vtkMorphMesh::FillInputPortInformation(int port, vtkInformation* info)
{
  // Any other type would make the executive run the filter block by block; see filters::Input.h.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 0 ? "vtkDataObject" : "vtkSelection");
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkMorphMesh::FillOutputPortInformation(int port, vtkInformation* info)
{
  return filters::Ports::FillOutputInformation(port, info);
}

int vtkMorphMesh::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const filters::Steps steps(this->NumberOfSteps, nullptr);
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    vtkInformation* output = outputVector->GetInformationObject(port);
    output->Remove(Pipeline::TIME_STEPS()); // the executive has copied the mesh's
    output->Remove(Pipeline::TIME_RANGE());
    steps.Write(output);
  }
  // A user who is about to choose surfaces wants to see their names before the first execution.
  auto* grid = vtkUnstructuredGrid::SafeDownCast(filters::upToDateInput(this, inputVector));
  if (grid && grid->GetNumberOfCells() > 0)
  {
    this->Internals->TakeGrid(grid);
    this->Internals->List();
  }
  return 1;
}

int vtkMorphMesh::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  filters::Time::AskRest(this->RestTime, inputVector[0]->GetInformationObject(0));
  return 1;
}

int vtkMorphMesh::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInternals& own = *this->Internals;
  vtkDataObject* input = vtkDataObject::GetData(inputVector[0]);
  vtkSelection* selection = vtkSelection::GetData(inputVector[1]);
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector);
  vtkUnstructuredGrid* badCells = vtkUnstructuredGrid::GetData(outputVector, 1);
  vtkPolyData* surface = vtkPolyData::GetData(outputVector, 2);
  filters::Monitor monitor(this, this->NumberOfThreads);
  std::string partial;
  own.Results.Reset();
  const auto work = [&]
  {
    if (filters::Ranks::Count(true) > 1)
    {
      throw morph::Error("Morph Mesh runs on a single MPI process only. Run on one.");
    }
    auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
    if (!grid)
    {
      filters::Input::RequireGrid(input, "The input"); // has the message
    }
    own.TakeGrid(grid);
    partial = own.Run(
      selection, filters::Ports::Asked(request, outputVector), output, badCells, surface, monitor);
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
    vtkWarningMacro(<< warning);
  }
  if (outcome != filters::Execution::Outcome::Done)
  {
    own.WriteUndeformed(
      input, outcome == filters::Execution::Outcome::Cancelled ? "Cancelled" : "Failed", output);
  }
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

#define morphResultMacro(name, type, kind)                          \
  type vtkMorphMesh::Get##name() const                              \
  {                                                                 \
    return static_cast<type>(this->Internals->Results.kind(#name)); \
  }
morphResultMacro(MinScaledJacobian, double, Number)
  morphResultMacro(MeanScaledJacobian, double, Number)
    morphResultMacro(InvertedCells, vtkIdType, Integer)
      morphResultMacro(DegenerateCells, vtkIdType, Integer)
        morphResultMacro(WorstCellId, vtkIdType, Integer)
          morphResultMacro(BoundaryInvertedCells, vtkIdType, Integer)
            morphResultMacro(MirroredBodies, vtkIdType, Integer)
              morphResultMacro(CertifiedCells, vtkIdType, Integer)
                morphResultMacro(UncertifiedCells, vtkIdType, Integer)
                  morphResultMacro(UndecidedCells, vtkIdType, Integer)
                    morphResultMacro(LargestValidStep, double, Number)
                      morphResultMacro(PrepareSeconds, double, Number)
                        morphResultMacro(EvaluateSeconds, double, Number)
                          morphResultMacro(SubSteps, vtkIdType, Integer)
                            morphResultMacro(PrepareCount, int, Integer)
                              morphResultMacro(PrescribedPoints, vtkIdType, Integer)
                                morphResultMacro(UnmatchedPoints, vtkIdType, Integer)
                                  morphResultMacro(SolverIterations, int, Integer)

                                    void vtkMorphMesh::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto text = [](const char* name) { return name ? name : "(none)"; };
  const auto list = [&](const char* name, const Names& values)
  {
    os << indent << name << ": ";
    for (const std::string& value : values)
    {
      os << (value == *values.begin() ? "" : ", ") << value;
    }
    os << "\n";
  };
  os << indent << "Moving: " << this->Moving << "\n";
  list("Surfaces", this->Internals->Surfaces);
  list("FixedSurfaces", this->Internals->FixedSurfaces);
  list("SlidingSurfaces", this->Internals->SlidingSurfaces);
  os << indent << "Region: " << this->Internals->Region.Get() << "\n";
  os << indent << "MovingArray: " << text(this->MovingArray) << "\n";
  os << indent << "Displacement: " << this->Displacement << "\n";
  os << indent << "Transform: " << this->Internals->Transform.Get() << "\n";
  os << indent << "Vector: " << this->Vector[0] << " " << this->Vector[1] << " " << this->Vector[2]
     << "\n";
  os << indent << "Distance: " << this->Distance << "\n";
  os << indent << "DisplacementArray: " << text(this->DisplacementArray) << "\n";
  const auto triple = [&](const char* name, const double* v)
  { os << indent << name << ": " << v[0] << " " << v[1] << " " << v[2] << "\n"; };
  triple("Translation", this->Translation);
  triple("Rotation", this->Rotation);
  triple("Scale", this->Scale);
  os << indent << "AutoCenter: " << this->AutoCenter << "\n";
  triple("Center", this->Center);
  os << indent << "RadiusChange: " << this->RadiusChange << "\n";
  os << indent << "ScaleFactor: " << this->ScaleFactor << "\n";
  os << indent << "Surroundings: " << this->Surroundings << "\n";
  os << indent << "FalloffRadius: " << this->FalloffRadius << "\n";
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "Validity: " << this->Validity << "\n";
  os << indent << "Live: " << this->Live << "\n";
  os << indent << "NumberOfSteps: " << this->NumberOfSteps << "\n";
  os << indent << "Stepping: " << this->Stepping << "\n";
  os << indent << "RestTime: " << this->RestTime << "\n";
  os << indent << "FeatureAngle: " << this->FeatureAngle << "\n";
  os << indent << "CornerAngle: " << this->CornerAngle << "\n";
  os << indent << "SurfaceIdArray: " << text(this->SurfaceIdArray) << "\n";
  os << indent << "UseGeometryArrays: " << this->UseGeometryArrays << "\n";
  os << indent << "OutputPointsPrecision: " << this->OutputPointsPrecision << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  this->Internals->Results.Print(os, indent);
}

morphSetNumberMacro(vtkMorphMesh, RestTime) morphSetNumberMacro(vtkMorphMesh, Distance)
  morphSetNumberMacro(vtkMorphMesh, ScaleFactor) morphSetNumberMacro(vtkMorphMesh, RadiusChange)
    morphSetNumberMacro(vtkMorphMesh, FalloffRadius, 0.0, 10.0)
      morphSetNumberMacro(vtkMorphMesh, FeatureAngle, 0.0, 180.0)
        morphSetNumberMacro(vtkMorphMesh, CornerAngle, 0.0, 180.0)
          morphSetVectorMacro(vtkMorphMesh, Vector) morphSetVectorMacro(vtkMorphMesh, Translation)
            morphSetVectorMacro(vtkMorphMesh, Rotation) morphSetVectorMacro(vtkMorphMesh, Scale)
              morphSetVectorMacro(vtkMorphMesh, Center)
