// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDisplacementAlgorithm.h"

#include "Private/Displace/SharedProperties.h"
#include "Private/Options.h"
#include "Private/Pipeline/Property.h"

#include <vtkInformation.h>
#include <vtkSelection.h>

#include <algorithm>

namespace filters = morph::filters;

vtkDisplacementAlgorithm::vtkDisplacementAlgorithm()
  : Options(std::make_unique<morph::DisplacementOptions>())
{
  this->SetNumberOfInputPorts(5);
}

vtkDisplacementAlgorithm::~vtkDisplacementAlgorithm() = default;

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
  // An object that is not in use may change without an execution.
  const auto ofUsed = [](bool isUsed, vtkObject* object)
  { return isUsed && object ? object->GetMTime() : 0; };
  return std::max({ this->Superclass::GetMTime(),
    ofUsed(this->Options->ZoneRegionType != ZONE_NONE, this->Shared->ZoneRegion),
    ofUsed(this->Options->Displacement == DISPLACEMENT_TRANSFORM, this->Shared->Transform),
    ofUsed(this->Options->Moving == MOVING_REGION, this->Shared->Region),
    ofUsed(true, this->Shared->RigidTransform) });
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
  filters::Property::Set(this, this->Shared->Extractor, extractor);
}

#define morphObjectMacro(name, type)                          \
  void vtkDisplacementAlgorithm::Set##name(type* object)      \
  {                                                           \
    filters::Property::Set(this, this->Shared->name, object); \
  }                                                           \
  type* vtkDisplacementAlgorithm::Get##name()                 \
  {                                                           \
    return this->Shared->name;                                \
  }
morphObjectMacro(Region, vtkImplicitFunction);
morphObjectMacro(ZoneRegion, vtkImplicitFunction);
morphObjectMacro(Transform, vtkAbstractTransform);
morphObjectMacro(RigidTransform, vtkAbstractTransform);

const char* vtkDisplacementAlgorithm::GetSlideReport() const
{
  return this->Shared->SlideReport.c_str();
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
  filters::Property::Set(this, this->Shared->Handles, {});
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
  filters::Property::Set(this, this->Shared->LatticeDisplacements, {});
}

int vtkDisplacementAlgorithm::GetNumberOfLatticeDisplacements() const
{
  return static_cast<int>(this->Shared->LatticeDisplacements.size());
}

void vtkDisplacementAlgorithm::TakeDisplacement(
  const morph::DisplacementOptions& options, const vtkShared& objects)
{
  filters::Property::Set(this, *this->Options, options);
  this->SetSelectionExtractor(objects.Extractor);
  this->SetRegion(objects.Region);
  this->SetZoneRegion(objects.ZoneRegion);
  this->SetTransform(objects.Transform);
  this->SetRigidTransform(objects.RigidTransform);
  filters::Property::Set(this, this->Shared->Handles, objects.Handles);
  filters::Property::Set(this, this->Shared->LatticeDisplacements, objects.LatticeDisplacements);
}

void vtkDisplacementAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const vtkShared& own = *this->Shared;
  this->PrintOptions(os, indent);
  os << indent << "ZoneRegion: " << own.ZoneRegion.Get() << "\n";
  os << indent << "RigidTransform: " << own.RigidTransform.Get() << "\n";
  os << indent << "Region: " << own.Region.Get() << "\n";
  os << indent << "Transform: " << own.Transform.Get() << "\n";
  const auto lists = [&](const char* name, const auto& values)
  {
    os << indent << name << ": ";
    for (const auto& one : values)
    {
      for (const double number : one)
      {
        os << number << " ";
      }
    }
    os << "\n";
  };
  lists("Handles", own.Handles);
  lists("LatticeDisplacements", own.LatticeDisplacements);
}
