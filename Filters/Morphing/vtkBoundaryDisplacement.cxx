// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBoundaryDisplacement.h"

#include "Private/Data/Surface.h"
#include "Private/Displace/BoundaryFields.h"
#include "Private/Displace/BoundaryModel.h"
#include "Private/Displace/Choice.h"
#include "Private/Displace/DisplacedSurface.h"
#include "Private/Displace/FitToTarget.h"
#include "Private/Displace/Motion.h"
#include "Private/Displace/Patches.h"
#include "Private/Displace/Surroundings.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Monitor.h"
#include "Private/Pipeline/Property.h"
#include "Private/Pipeline/UpToDateInput.h"
#include "Private/Project/TargetDistance.h"
#include "Support/Error.h"

#include <vtkAbstractTransform.h>
#include <vtkDataArraySelection.h>
#include <vtkExtractSelection.h>
#include <vtkImplicitFunction.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkSelection.h>
#include <vtkSmartPointer.h>

#include <algorithm>

namespace filters = morph::filters;

vtkStandardNewMacro(vtkBoundaryDisplacement);

namespace
{
/// The inputs of a choice. Modification times distinguish an object from an earlier one at its
/// address.
struct ChoiceKey
{
  vtkIdType InputVersion = -1;
  int Moving = -1;
  std::set<std::string> Patches, HeldPatches;
  std::string Array;
  vtkMTimeType Region = 0, Selection = 0;

  bool operator==(const ChoiceKey& other) const
  {
    return this->InputVersion == other.InputVersion && this->Moving == other.Moving &&
           this->Patches == other.Patches && this->HeldPatches == other.HeldPatches &&
           this->Array == other.Array && this->Region == other.Region &&
           this->Selection == other.Selection;
  }
};

vtkMTimeType timeOf(vtkObject* object)
{
  return object ? object->GetMTime() : 0;
}

/// Returns whether the names changed.
bool setStatus(std::set<std::string>& names, const std::string& name, bool status)
{
  return status ? names.insert(name).second : names.erase(name) > 0;
}
}

struct vtkBoundaryDisplacement::vtkInternals
{
  std::set<std::string> Patches, HeldPatches, SlidingPatches;
  vtkNew<vtkDataArraySelection> PatchList;
  vtkSmartPointer<vtkImplicitFunction> Region;
  vtkSmartPointer<vtkAbstractTransform> Transform;
  vtkSmartPointer<vtkExtractSelection> Extractor;

  filters::BoundaryModel Model;
  std::vector<std::string> Warnings; ///< of the geometry, not reported yet
  ChoiceKey ChosenFrom;
  filters::Choice::Result Choice;
  filters::Surroundings Spread;
  filters::BoundaryFields Fields;
  filters::FitToTarget Fit;

  /// Finds the boundary and its geometry, and its patches' names.
  void Classify(
    const vtkBoundaryDisplacement* filter, vtkPointSet* input, filters::Monitor& monitor);
  /// `target`: of MOTION_TARGET, or null.
  void Displace(vtkBoundaryDisplacement* filter, vtkPointSet* input, vtkSelection* selection,
    vtkPolyData* target, vtkPolyData* output, filters::Monitor& monitor);

private:
  /// The positions of what moves, on the target. Chooses what moves, too.
  morph::Points Fitted(vtkBoundaryDisplacement* filter, vtkPointSet* input, vtkSelection* selection,
    vtkPolyData* target, filters::Monitor& monitor);
  void WriteDistances(const filters::Surroundings::Result& result, vtkPolyData* output);
};

vtkBoundaryDisplacement::vtkBoundaryDisplacement()
  : Internals(new vtkInternals)
{
  this->SetNumberOfInputPorts(3);
  this->ResetResults();
}

vtkBoundaryDisplacement::~vtkBoundaryDisplacement()
{
  this->SetMovingArray(nullptr);
  this->SetDisplacementArray(nullptr);
  this->SetSurfaceIdArray(nullptr);
}

void vtkBoundaryDisplacement::SetSelectionConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkBoundaryDisplacement::SetSelectionData(vtkSelection* selection)
{
  this->SetInputDataObject(1, selection);
}

void vtkBoundaryDisplacement::SetTargetConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(2, output);
}

void vtkBoundaryDisplacement::SetTargetData(vtkDataObject* target)
{
  this->SetInputDataObject(2, target);
}

vtkPolyData* vtkBoundaryDisplacement::GetFittedTarget()
{
  return this->Motion == MOTION_TARGET ? this->Internals->Fit.Surface() : nullptr;
}

void vtkBoundaryDisplacement::SetSelectionExtractor(vtkExtractSelection* extractor)
{
  if (this->Internals->Extractor != extractor)
  {
    this->Internals->Extractor = extractor;
    this->Internals->ChosenFrom = ChoiceKey();
    this->Modified();
  }
}

void vtkBoundaryDisplacement::SetPatchStatus(const char* name, int status)
{
  if (name && setStatus(this->Internals->Patches, name, status != 0))
  {
    this->Modified();
  }
}

void vtkBoundaryDisplacement::RemoveAllPatches()
{
  if (!this->Internals->Patches.empty())
  {
    this->Internals->Patches.clear();
    this->Modified();
  }
}

void vtkBoundaryDisplacement::SetHeldPatchStatus(const char* name, int status)
{
  if (name && setStatus(this->Internals->HeldPatches, name, status != 0))
  {
    this->Modified();
  }
}

void vtkBoundaryDisplacement::RemoveAllHeldPatches()
{
  if (!this->Internals->HeldPatches.empty())
  {
    this->Internals->HeldPatches.clear();
    this->Modified();
  }
}

void vtkBoundaryDisplacement::SetSlidingPatchStatus(const char* name, int status)
{
  if (name && setStatus(this->Internals->SlidingPatches, name, status != 0))
  {
    this->Modified();
  }
}

void vtkBoundaryDisplacement::RemoveAllSlidingPatches()
{
  if (!this->Internals->SlidingPatches.empty())
  {
    this->Internals->SlidingPatches.clear();
    this->Modified();
  }
}

vtkDataArraySelection* vtkBoundaryDisplacement::GetPatchList()
{
  return this->Internals->PatchList;
}

void vtkBoundaryDisplacement::SetRegion(vtkImplicitFunction* region)
{
  if (this->Internals->Region != region)
  {
    this->Internals->Region = region;
    this->Modified();
  }
}

vtkImplicitFunction* vtkBoundaryDisplacement::GetRegion()
{
  return this->Internals->Region;
}

void vtkBoundaryDisplacement::SetTransform(vtkAbstractTransform* transform)
{
  if (this->Internals->Transform != transform)
  {
    this->Internals->Transform = transform;
    this->Modified();
  }
}

vtkAbstractTransform* vtkBoundaryDisplacement::GetTransform()
{
  return this->Internals->Transform;
}

int vtkBoundaryDisplacement::GetClassifyCount() const
{
  return this->Internals->Model.ClassifyCount();
}

int vtkBoundaryDisplacement::GetPrepareCount() const
{
  return this->Internals->Spread.PrepareCount();
}

vtkMTimeType vtkBoundaryDisplacement::GetMTime()
{
  vtkMTimeType time = this->Superclass::GetMTime();
  // An object that is not in use may change without an execution.
  if (this->Motion == MOTION_TRANSFORM)
  {
    time = std::max(time, timeOf(this->Internals->Transform));
  }
  if (this->Moving == MOVE_REGION)
  {
    time = std::max(time, timeOf(this->Internals->Region));
  }
  return time;
}

int vtkBoundaryDisplacement::FillInputPortInformation(int port, vtkInformation* info)
{
  // Any other type would make the executive run the filter block by block; see filters::Input.h.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 1 ? "vtkSelection" : "vtkDataObject");
  if (port > 0)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkBoundaryDisplacement::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  // A user who is about to choose patches wants to see their names before the first execution.
  auto* input = vtkPointSet::SafeDownCast(morph::filters::upToDateInput(this, inputVector));
  if (!input || input->GetNumberOfCells() == 0)
  {
    return 1;
  }
  filters::Monitor monitor(nullptr, this->NumberOfThreads);
  try
  {
    this->Internals->Classify(
      this, filters::Input::RequireGridOrPolyData(input, "The input"), monitor);
  }
  catch (const std::exception&)
  {
    // The execution raises the error again, and reports it.
    this->Internals->PatchList->RemoveAllArrays();
  }
  return 1;
}

int vtkBoundaryDisplacement::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* data = vtkDataObject::GetData(inputVector[0]);
  vtkSelection* selection = vtkSelection::GetData(inputVector[1]);
  vtkDataObject* given = vtkDataObject::GetData(inputVector[2]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  this->ResetResults();
  filters::Monitor monitor(this, this->NumberOfThreads);
  const auto displace = [&]
  {
    const int ranks = filters::Input::RequireOneRankWithCells(vtkDataSet::SafeDownCast(data));
    vtkPointSet* input = filters::Input::RequireGridOrPolyData(data, "The input");
    if (ranks == 0 || input->GetNumberOfCells() > 0)
    {
      const bool fits = this->Motion == MOTION_TARGET && this->Moving != MOVE_NOTHING;
      vtkPolyData* target =
        fits && given ? filters::Input::RequirePolyData(given, "The target") : nullptr;
      if (fits && !target)
      {
        throw morph::Error("There is no target to move onto. Set one (Target, port 2): a surface, "
                           "from an STL file for instance.");
      }
      this->Internals->Displace(this, input, selection, target, output, monitor);
    }
  };
  const auto clear = [&]
  {
    output->Initialize();
    this->ResetResults();
  };
  filters::Execution::Run(this, "displace this mesh's boundary", displace, clear);
  for (const std::string& warning : monitor.TakeWarnings())
  {
    vtkWarningMacro(<< warning);
  }
  return 1;
}

void vtkBoundaryDisplacement::vtkInternals::Classify(
  const vtkBoundaryDisplacement* filter, vtkPointSet* input, filters::Monitor& monitor)
{
  filters::Geometry::Options options;
  options.FeatureAngle = filter->FeatureAngle;
  options.CornerAngle = filter->CornerAngle;
  options.SurfaceIdArray = filters::Input::ArrayName(filter->SurfaceIdArray);
  options.UseGeometryArrays = filter->UseGeometryArrays;
  const int before = this->Model.ClassifyCount();
  this->Model.Update(input, options, monitor);
  if (this->Model.ClassifyCount() != before || this->PatchList->GetNumberOfArrays() == 0)
  {
    this->Warnings = monitor.TakeWarnings();
    this->PatchList->RemoveAllArrays();
    for (const std::string& name : filters::Patches::Names(this->Model.Geometry()))
    {
      this->PatchList->AddArray(name.c_str(), false);
    }
  }
}

void vtkBoundaryDisplacement::Choose(vtkPointSet* input, vtkSelection* selection)
{
  vtkInternals& own = *this->Internals;
  ChoiceKey key;
  key.InputVersion = own.Model.InputVersion();
  key.Moving = this->Moving;
  key.HeldPatches = own.HeldPatches;
  filters::Choice::Options options;
  options.How = static_cast<filters::Choice::By>(this->Moving);
  options.HeldPatches = own.HeldPatches;
  vtkSmartPointer<vtkExtractSelection> extractor = own.Extractor;
  if (this->Moving == MOVE_SELECTION)
  {
    key.Selection = timeOf(selection);
    if (!extractor)
    {
      extractor = vtkSmartPointer<vtkExtractSelection>::New();
    }
    options.Selection = selection;
    options.Extractor = extractor;
  }
  else if (this->Moving == MOVE_PATCHES)
  {
    const bool byTarget = own.Patches.empty() && this->Motion == MOTION_TARGET;
    key.Patches = options.Patches = byTarget ? own.Fit.NearestSurfaces(own.Model) : own.Patches;
  }
  else if (this->Moving == MOVE_REGION)
  {
    key.Region = timeOf(own.Region);
    options.Region = own.Region;
  }
  else if (this->Moving == MOVE_ARRAY)
  {
    key.Array = options.ArrayName = filters::Input::ArrayName(this->MovingArray);
  }
  if (!(key == own.ChosenFrom))
  {
    own.ChosenFrom = ChoiceKey(); // in case the choice throws
    own.Choice = filters::Choice::Choose(input, own.Model, options);
    own.ChosenFrom = key;
    ++this->ChooseCount;
  }
}

morph::Points vtkBoundaryDisplacement::vtkInternals::Fitted(vtkBoundaryDisplacement* filter,
  vtkPointSet* input, vtkSelection* selection, vtkPolyData* target, filters::Monitor& monitor)
{
  filters::FitToTarget::Options options;
  options.Align = filter->AlignTarget;
  options.FeatureAngle = filter->FeatureAngle;
  options.Angle = filter->TargetAngle;
  options.Reach = filter->TargetReach * this->Model.Size();
  if (filter->Moving == MOVE_PATCHES && this->Patches.empty())
  {
    this->Fit.Update(target, this->Model, nullptr, options, monitor);
    filter->Choose(input, selection);
  }
  else
  {
    filter->Choose(input, selection);
    this->Fit.Update(target, this->Model, &this->Choice, options, monitor);
  }
  return this->Fit.Targets(this->Model, this->Choice, monitor);
}

void vtkBoundaryDisplacement::vtkInternals::WriteDistances(
  const filters::Surroundings::Result& result, vtkPolyData* output)
{
  std::vector<morph::Index> points, nodes;
  for (std::size_t i = 0; i < this->Model.NodeOfPoint().size(); ++i)
  {
    const morph::Index node = this->Model.NodeOfPoint()[i];
    if (result.Roles[node] == filters::Surroundings::Moves)
    {
      points.push_back(static_cast<morph::Index>(i));
      nodes.push_back(node);
    }
  }
  filters::TargetDistance::Write(this->Fit.Surface(), points,
    this->Model.Points()(nodes, morph::allColumns), result.Moved(nodes, morph::allColumns), output);
}

void vtkBoundaryDisplacement::vtkInternals::Displace(vtkBoundaryDisplacement* filter,
  vtkPointSet* input, vtkSelection* selection, vtkPolyData* target, vtkPolyData* output,
  filters::Monitor& monitor)
{
  try
  {
    monitor.SetRange(0, 0.5);
    this->Classify(filter, input, monitor);
  }
  catch (...)
  {
    this->PatchList->RemoveAllArrays();
    throw;
  }
  for (const std::string& warning : this->Warnings)
  {
    monitor.warn(warning);
  }
  this->Warnings.clear();
  filters::Surface::WarnOfNone(this->Model.Faces(), monitor);
  if (this->Model.Faces().nodes.empty())
  {
    return;
  }
  morph::Points fitted;
  if (target)
  {
    monitor.SetRange(0.5, 0.7);
    fitted = this->Fitted(filter, input, selection, target, monitor);
  }
  else
  {
    filter->Choose(input, selection);
  }
  monitor.check();

  filters::Motion::Options motion;
  motion.Fitted = &fitted;
  motion.How = static_cast<filters::Motion::Kind>(filter->Motion);
  motion.Transform = this->Transform;
  motion.Vector = { filter->Vector[0], filter->Vector[1], filter->Vector[2] };
  motion.Distance = filter->Distance;
  motion.ArrayName = filters::Input::ArrayName(filter->DisplacementArray);
  std::copy(filter->Translation, filter->Translation + 3, motion.Translation.begin());
  std::copy(filter->Rotation, filter->Rotation + 3, motion.Rotation.begin());
  std::copy(filter->Scale, filter->Scale + 3, motion.Scale.begin());
  motion.AutoCenter = filter->AutoCenter;
  std::copy(filter->Center, filter->Center + 3, motion.Center.begin());
  motion.RadiusChange = filter->RadiusChange;
  motion.ScaleFactor = filter->ScaleFactor;
  const morph::Points targets = filters::Motion::Targets(input, this->Model, this->Choice, motion);

  filters::Surroundings::Options rest;
  rest.How = static_cast<filters::Surroundings::Kind>(filter->Surroundings);
  rest.Follow.method = static_cast<morph::SurfaceMorphOptions::Method>(filter->SurfaceMethod);
  rest.Follow.unattached = static_cast<morph::UnattachedMotion>(filter->UnattachedMotion);
  rest.Sliding =
    filters::Patches::Surfaces(this->Model.Geometry(), this->SlidingPatches, "SlidingPatches");
  rest.Radius = filter->FalloffRadius * this->Model.Size();
  monitor.SetRange(target ? 0.7 : 0.5, 0.9);
  const filters::Surroundings::Result result =
    this->Spread.Spread(this->Model, this->Choice, targets, rest, monitor);
  const std::vector<morph::Index> collapsed =
    filters::Motion::Collapsed(this->Model, this->Choice, result.Moved);
  if (!collapsed.empty())
  {
    monitor.warn(
      "The motion leaves faces of the boundary without area, and no cell behind them can "
      "be valid: the output's cell ids " +
      morph::listIds(collapsed) + ". Is a scale zero?");
  }
  filters::DisplacedSurface::Write(
    this->Model, result, input, filter->OutputPointsPrecision, output);
  this->Fields.Write(
    this->Model, this->Choice, motion, rest, result, this->Spread, output, monitor);
  if (target)
  {
    this->WriteDistances(result, output);
  }
  const auto count = [&result](filters::Surroundings::Role role)
  { return std::count(result.Roles.begin(), result.Roles.end(), role); };
  filter->MovingPoints = count(filters::Surroundings::Moves);
  filter->HeldPoints = count(filters::Surroundings::IsHeld);
  filter->FollowingPoints = count(filters::Surroundings::Follows);
}

void vtkBoundaryDisplacement::ResetResults()
{
  this->MovingPoints = this->HeldPoints = this->FollowingPoints = 0;
}

void vtkBoundaryDisplacement::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto text = [](const char* name) { return name ? name : "(none)"; };
  const auto list = [&](const char* name, const std::set<std::string>& values)
  {
    os << indent << name << ": ";
    for (const std::string& value : values)
    {
      os << (value == *values.begin() ? "" : ", ") << value;
    }
    os << "\n";
  };
  os << indent << "Moving: " << this->Moving << "\n";
  os << indent << "MovingArray: " << text(this->MovingArray) << "\n";
  list("Patches", this->Internals->Patches);
  list("HeldPatches", this->Internals->HeldPatches);
  list("SlidingPatches", this->Internals->SlidingPatches);
  os << indent << "Region: " << this->Internals->Region.Get() << "\n";
  os << indent << "Motion: " << this->Motion << "\n";
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
  os << indent << "AlignTarget: " << this->AlignTarget << "\n";
  os << indent << "TargetReach: " << this->TargetReach << "\n";
  os << indent << "TargetAngle: " << this->TargetAngle << "\n";
  os << indent << "ScaleFactor: " << this->ScaleFactor << "\n";
  os << indent << "Surroundings: " << this->Surroundings << "\n";
  os << indent << "FalloffRadius: " << this->FalloffRadius << "\n";
  os << indent << "SurfaceMethod: " << this->SurfaceMethod << "\n";
  os << indent << "UnattachedMotion: " << this->UnattachedMotion << "\n";
  os << indent << "FeatureAngle: " << this->FeatureAngle << "\n";
  os << indent << "CornerAngle: " << this->CornerAngle << "\n";
  os << indent << "SurfaceIdArray: " << text(this->SurfaceIdArray) << "\n";
  os << indent << "UseGeometryArrays: " << this->UseGeometryArrays << "\n";
  os << indent << "OutputPointsPrecision: " << this->OutputPointsPrecision << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "MovingPoints: " << this->MovingPoints << "\n";
  os << indent << "HeldPoints: " << this->HeldPoints << "\n";
  os << indent << "FollowingPoints: " << this->FollowingPoints << "\n";
  os << indent << "ClassifyCount: " << this->GetClassifyCount() << "\n";
  os << indent << "ChooseCount: " << this->ChooseCount << "\n";
  os << indent << "PrepareCount: " << this->GetPrepareCount() << "\n";
}

morphSetNumberMacro(vtkBoundaryDisplacement, Distance)
  morphSetNumberMacro(vtkBoundaryDisplacement, ScaleFactor)
    morphSetNumberMacro(vtkBoundaryDisplacement, RadiusChange)
      morphSetNumberMacro(vtkBoundaryDisplacement, TargetReach, 0.0, 10.0)
        morphSetNumberMacro(vtkBoundaryDisplacement, TargetAngle, 0.0, 180.0)
          morphSetNumberMacro(vtkBoundaryDisplacement, FalloffRadius, 0.0, 10.0)
            morphSetNumberMacro(vtkBoundaryDisplacement, FeatureAngle, 0.0, 180.0)
              morphSetNumberMacro(vtkBoundaryDisplacement, CornerAngle, 0.0, 180.0)
                morphSetVectorMacro(vtkBoundaryDisplacement, Vector)
                  morphSetVectorMacro(vtkBoundaryDisplacement, Translation)
                    morphSetVectorMacro(vtkBoundaryDisplacement, Rotation)
                      morphSetVectorMacro(vtkBoundaryDisplacement, Scale)
                        morphSetVectorMacro(vtkBoundaryDisplacement, Center)
