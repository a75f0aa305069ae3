// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDisplacementAlgorithm.h"

#include "Private/Displace/SharedProperties.h"
#include "Private/Pipeline/NameSet.h"
#include "Private/Pipeline/Property.h"

#include <vtkInformation.h>
#include <vtkSelection.h>

#include <algorithm>

namespace filters = morph::filters;

namespace
{
/// Returns whether `kept` was another object.
template <typename Object>
bool replaced(vtkSmartPointer<Object>& kept, Object* given)
{
  if (kept == given)
  {
    return false;
  }
  kept = given;
  return true;
}

template <typename List>
bool replaced(List& kept, const List& given)
{
  if (kept == given)
  {
    return false;
  }
  kept = given;
  return true;
}

vtkMTimeType timeOf(vtkObject* object)
{
  return object ? object->GetMTime() : 0;
}
}

vtkDisplacementAlgorithm::vtkDisplacementAlgorithm()
{
  this->SetNumberOfInputPorts(5);
}

vtkDisplacementAlgorithm::~vtkDisplacementAlgorithm()
{
  this->SetMovingArray(nullptr);
  this->SetLayersArray(nullptr);
  this->SetDisplacementArray(nullptr);
  this->SetSurfaceIdArray(nullptr);
}

int vtkDisplacementAlgorithm::FillInputPortInformation(int port, vtkInformation* info)
{
  // Any other type would make the executive run the filter block by block; see filters::Input.h.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(),
    port == 1 || port == 3 ? "vtkSelection" : "vtkDataObject");
  if (port > 0)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

vtkMTimeType vtkDisplacementAlgorithm::GetMTime()
{
  vtkMTimeType time = this->Superclass::GetMTime();
  // An object that is not in use may change without an execution.
  if (this->ZoneRegionType != ZONE_NONE)
  {
    time = std::max(time, timeOf(this->Shared->ZoneRegion));
  }
  return std::max(time, timeOf(this->Shared->RigidTransform));
}

void vtkDisplacementAlgorithm::SetSelectionConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkDisplacementAlgorithm::SetSelectionData(vtkSelection* selection)
{
  this->SetInputDataObject(1, selection);
}

void vtkDisplacementAlgorithm::SetTargetConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(2, output);
}

void vtkDisplacementAlgorithm::SetTargetData(vtkDataObject* target)
{
  this->SetInputDataObject(2, target);
}

void vtkDisplacementAlgorithm::SetZoneSelectionConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(3, output);
}

void vtkDisplacementAlgorithm::SetZoneSelectionData(vtkSelection* selection)
{
  this->SetInputDataObject(3, selection);
}

void vtkDisplacementAlgorithm::SetControlPointsConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(4, output);
}

void vtkDisplacementAlgorithm::SetControlPointsData(vtkDataObject* points)
{
  this->SetInputDataObject(4, points);
}

void vtkDisplacementAlgorithm::SetSelectionExtractor(vtkExtractSelection* extractor)
{
  if (replaced(this->Shared->Extractor, extractor))
  {
    this->Modified();
  }
}

#define morphObjectMacro(name, type)                     \
  void vtkDisplacementAlgorithm::Set##name(type* object) \
  {                                                      \
    if (replaced(this->Shared->name, object))            \
    {                                                    \
      this->Modified();                                  \
    }                                                    \
  }                                                      \
  type* vtkDisplacementAlgorithm::Get##name()            \
  {                                                      \
    return this->Shared->name;                           \
  }
morphObjectMacro(Region, vtkImplicitFunction);
morphObjectMacro(ZoneRegion, vtkImplicitFunction);
morphObjectMacro(Transform, vtkAbstractTransform);
morphObjectMacro(RigidTransform, vtkAbstractTransform);

const char* vtkDisplacementAlgorithm::GetSlideReport() const
{
  return this->Shared->SlideReport.c_str();
}

void vtkDisplacementAlgorithm::SetZoneRegionType(int type)
{
  const int known = std::clamp(type, int(ZONE_NONE), this->LargestZoneType);
  if (this->ZoneRegionType != known)
  {
    this->ZoneRegionType = known;
    this->Modified();
  }
}

void vtkDisplacementAlgorithm::SetZoneSelectionType(int type)
{
  const int known = std::clamp(type, int(ZONE_NONE), this->LargestZoneType);
  if (this->ZoneSelectionType != known)
  {
    this->ZoneSelectionType = known;
    this->Modified();
  }
}

void vtkDisplacementAlgorithm::AddHandle(
  double x, double y, double z, double dx, double dy, double dz, double radius)
{
  // Values that are not finite are an error of the execution, which names the handle.
  this->Shared->Handles.push_back({ x, y, z, dx, dy, dz, radius });
  this->Modified();
}

void vtkDisplacementAlgorithm::AddHandle(const double v[7])
{
  this->AddHandle(v[0], v[1], v[2], v[3], v[4], v[5], v[6]);
}

void vtkDisplacementAlgorithm::RemoveAllHandles()
{
  if (replaced(this->Shared->Handles, {}))
  {
    this->Modified();
  }
}

int vtkDisplacementAlgorithm::GetNumberOfHandles() const
{
  return static_cast<int>(this->Shared->Handles.size());
}

void vtkDisplacementAlgorithm::AddLatticeDisplacement(
  double i, double j, double k, double dx, double dy, double dz)
{
  this->Shared->LatticeDisplacements.push_back({ i, j, k, dx, dy, dz });
  this->Modified();
}

void vtkDisplacementAlgorithm::AddLatticeDisplacement(const double v[6])
{
  this->AddLatticeDisplacement(v[0], v[1], v[2], v[3], v[4], v[5]);
}

void vtkDisplacementAlgorithm::RemoveAllLatticeDisplacements()
{
  if (replaced(this->Shared->LatticeDisplacements, {}))
  {
    this->Modified();
  }
}

int vtkDisplacementAlgorithm::GetNumberOfLatticeDisplacements() const
{
  return static_cast<int>(this->Shared->LatticeDisplacements.size());
}

void vtkDisplacementAlgorithm::SetLatticeSize(int l, int m, int n)
{
  const int size[3] = { std::clamp(l, 2, 30), std::clamp(m, 2, 30), std::clamp(n, 2, 30) };
  if (!std::equal(size, size + 3, this->LatticeSize))
  {
    std::copy(size, size + 3, this->LatticeSize);
    this->Modified();
  }
}

void vtkDisplacementAlgorithm::SetLatticeSize(const int size[3])
{
  this->SetLatticeSize(size[0], size[1], size[2]);
}

void vtkDisplacementAlgorithm::SetLatticeBounds(
  double xmin, double xmax, double ymin, double ymax, double zmin, double zmax)
{
  const double bounds[6] = { xmin, xmax, ymin, ymax, zmin, zmax };
  for (int i = 0; i < 6; ++i)
  {
    if (!filters::Property::Accepts(this, "LatticeBounds", bounds[i], this->LatticeBounds[i]))
    {
      return;
    }
  }
  if (!std::equal(bounds, bounds + 6, this->LatticeBounds))
  {
    std::copy(bounds, bounds + 6, this->LatticeBounds);
    this->Modified();
  }
}

void vtkDisplacementAlgorithm::SetLatticeBounds(const double b[6])
{
  this->SetLatticeBounds(b[0], b[1], b[2], b[3], b[4], b[5]);
}

void vtkDisplacementAlgorithm::CopyDisplacement(vtkDisplacementAlgorithm* from)
{
  vtkShared& own = *this->Shared;
  const vtkShared& theirs = *from->Shared;
  bool isNew = replaced(own.FrozenZones, theirs.FrozenZones);
  isNew = replaced(own.RigidZones, theirs.RigidZones) || isNew;
  isNew = replaced(own.Handles, theirs.Handles) || isNew;
  isNew = replaced(own.LatticeDisplacements, theirs.LatticeDisplacements) || isNew;
  if (isNew)
  {
    this->Modified();
  }
  this->SetSelectionExtractor(theirs.Extractor);
  this->SetRegion(theirs.Region);
  this->SetZoneRegion(theirs.ZoneRegion);
  this->SetTransform(theirs.Transform);
  this->SetRigidTransform(theirs.RigidTransform);
  // Soft zones prescribe nothing.
  const auto prescribed = [](int type) { return type == ZONE_SOFT ? int(ZONE_NONE) : type; };
  this->SetZoneRegionType(prescribed(from->ZoneRegionType));
  this->SetZoneSelectionType(prescribed(from->ZoneSelectionType));
  this->SetMovingArray(from->MovingArray);
  this->SetKeepLayers(from->KeepLayers);
  this->SetLayersArray(from->LayersArray);
  this->SetVector(from->Vector);
  this->SetDistance(from->Distance);
  this->SetDisplacementArray(from->DisplacementArray);
  this->SetTranslation(from->Translation);
  this->SetRotation(from->Rotation);
  this->SetScale(from->Scale);
  this->SetAutoCenter(from->AutoCenter);
  this->SetCenter(from->Center);
  this->SetTransformAboutCenter(from->TransformAboutCenter);
  this->SetRadiusChange(from->RadiusChange);
  this->SetAlignTarget(from->AlignTarget);
  this->SetTargetReach(from->TargetReach);
  this->SetTargetAngle(from->TargetAngle);
  this->SetProjectAlong(from->ProjectAlong);
  this->SetProjectVector(from->ProjectVector);
  this->SetSelectedHandles(from->SelectedHandles);
  this->SetHandleRadius(from->HandleRadius);
  this->SetLatticeBasis(from->LatticeBasis);
  this->SetLatticeSize(from->LatticeSize);
  this->SetAutoLattice(from->AutoLattice);
  this->SetLatticeBounds(from->LatticeBounds);
  this->SetScaleFactor(from->ScaleFactor);
  this->SetSurroundings(from->Surroundings);
  this->SetSurfaceMethod(from->SurfaceMethod);
  this->SetFalloffRadius(from->FalloffRadius);
  this->SetSlideRounds(from->SlideRounds);
  this->SetFeatureAngle(from->FeatureAngle);
  this->SetCornerAngle(from->CornerAngle);
  this->SetSurfaceIdArray(from->SurfaceIdArray);
  this->SetUseGeometryArrays(from->UseGeometryArrays);
  this->SetNumberOfThreads(from->NumberOfThreads);
  this->SetCoincidentPoints(from->CoincidentPoints);
}

void vtkDisplacementAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const vtkShared& own = *this->Shared;
  const auto text = [](const char* name) { return name ? name : "(none)"; };
  const auto numbers = [&](const char* name, const auto* v, int count)
  {
    os << indent << name << ": ";
    for (int i = 0; i < count; ++i)
    {
      os << (i > 0 ? " " : "") << v[i];
    }
    os << "\n";
  };
  filters::NameSet::Print(os, indent, "FrozenZones", own.FrozenZones);
  filters::NameSet::Print(os, indent, "RigidZones", own.RigidZones);
  os << indent << "ZoneRegion: " << own.ZoneRegion.Get() << "\n";
  os << indent << "ZoneRegionType: " << this->ZoneRegionType << "\n";
  os << indent << "ZoneSelectionType: " << this->ZoneSelectionType << "\n";
  os << indent << "RigidTransform: " << own.RigidTransform.Get() << "\n";
  os << indent << "KeepLayers: " << this->KeepLayers << "\n";
  os << indent << "LayersArray: " << text(this->LayersArray) << "\n";
  os << indent << "Region: " << own.Region.Get() << "\n";
  os << indent << "MovingArray: " << text(this->MovingArray) << "\n";
  os << indent << "Transform: " << own.Transform.Get() << "\n";
  numbers("Vector", this->Vector, 3);
  os << indent << "Distance: " << this->Distance << "\n";
  os << indent << "DisplacementArray: " << text(this->DisplacementArray) << "\n";
  numbers("Translation", this->Translation, 3);
  numbers("Rotation", this->Rotation, 3);
  numbers("Scale", this->Scale, 3);
  os << indent << "AutoCenter: " << this->AutoCenter << "\n";
  numbers("Center", this->Center, 3);
  os << indent << "TransformAboutCenter: " << this->TransformAboutCenter << "\n";
  os << indent << "RadiusChange: " << this->RadiusChange << "\n";
  os << indent << "AlignTarget: " << this->AlignTarget << "\n";
  os << indent << "TargetReach: " << this->TargetReach << "\n";
  os << indent << "TargetAngle: " << this->TargetAngle << "\n";
  os << indent << "ProjectAlong: " << this->ProjectAlong << "\n";
  numbers("ProjectVector", this->ProjectVector, 3);
  // A std::vector of arrays of numbers has them without gaps.
  numbers("Handles", own.Handles.empty() ? nullptr : own.Handles.front().data(),
    7 * this->GetNumberOfHandles());
  os << indent << "SelectedHandles: " << this->SelectedHandles << "\n";
  os << indent << "HandleRadius: " << this->HandleRadius << "\n";
  os << indent << "LatticeBasis: " << this->LatticeBasis << "\n";
  numbers("LatticeSize", this->LatticeSize, 3);
  os << indent << "AutoLattice: " << this->AutoLattice << "\n";
  numbers("LatticeBounds", this->LatticeBounds, 6);
  numbers("LatticeDisplacements",
    own.LatticeDisplacements.empty() ? nullptr : own.LatticeDisplacements.front().data(),
    6 * this->GetNumberOfLatticeDisplacements());
  os << indent << "ScaleFactor: " << this->ScaleFactor << "\n";
  os << indent << "Surroundings: " << this->Surroundings << "\n";
  os << indent << "SurfaceMethod: " << this->SurfaceMethod << "\n";
  os << indent << "FalloffRadius: " << this->FalloffRadius << "\n";
  os << indent << "SlideRounds: " << this->SlideRounds << "\n";
  os << indent << "FeatureAngle: " << this->FeatureAngle << "\n";
  os << indent << "CornerAngle: " << this->CornerAngle << "\n";
  os << indent << "SurfaceIdArray: " << text(this->SurfaceIdArray) << "\n";
  os << indent << "UseGeometryArrays: " << this->UseGeometryArrays << "\n";
  os << indent << "OutputPointsPrecision: " << this->OutputPointsPrecision << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "CoincidentPoints: " << this->CoincidentPoints << "\n";
}

morphNameSetOfMacro(vtkDisplacementAlgorithm, Shared, FrozenZone, FrozenZones);
morphNameSetOfMacro(vtkDisplacementAlgorithm, Shared, RigidZone, RigidZones);
morphSetNumberMacro(vtkDisplacementAlgorithm, Distance);
morphSetNumberMacro(vtkDisplacementAlgorithm, ScaleFactor);
morphSetNumberMacro(vtkDisplacementAlgorithm, RadiusChange);
morphSetNumberMacro(vtkDisplacementAlgorithm, HandleRadius, 0.0, 1e50);
morphSetNumberMacro(vtkDisplacementAlgorithm, TargetReach, 0.0, 10.0);
morphSetNumberMacro(vtkDisplacementAlgorithm, TargetAngle, 0.0, 180.0);
morphSetNumberMacro(vtkDisplacementAlgorithm, FalloffRadius, 0.0, 10.0);
morphSetNumberMacro(vtkDisplacementAlgorithm, FeatureAngle, 0.0, 180.0);
morphSetNumberMacro(vtkDisplacementAlgorithm, CornerAngle, 0.0, 180.0);
morphSetVectorMacro(vtkDisplacementAlgorithm, Vector);
morphSetVectorMacro(vtkDisplacementAlgorithm, ProjectVector);
morphSetVectorMacro(vtkDisplacementAlgorithm, Translation);
morphSetVectorMacro(vtkDisplacementAlgorithm, Rotation);
morphSetVectorMacro(vtkDisplacementAlgorithm, Scale);
morphSetVectorMacro(vtkDisplacementAlgorithm, Center);
