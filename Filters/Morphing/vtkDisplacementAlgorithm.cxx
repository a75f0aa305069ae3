// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDisplacementAlgorithm.h"

#include "Private/Displace/Internals.h"
#include "Private/Displace/Views.h"
#include "Private/Pipeline/Property.h"
#include "Private/Pipeline/Ranks.h"
#include "Support/Error.h"

#include <vtkInformation.h>
#include <vtkSelection.h>

#include <algorithm>

namespace filters = morph::filters;

vtkDisplacementAlgorithm::vtkDisplacementAlgorithm()
  : Options(std::make_unique<morph::DisplacementOptions>())
  , Internals(std::make_unique<vtkInternals>())
{
  this->SetNumberOfInputPorts(6);
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
    ofUsed(this->Options->ZoneRegionType != ZONE_NONE, this->Internals->ZoneRegion),
    ofUsed(this->Options->Displacement == DISPLACEMENT_TRANSFORM, this->Internals->Transform),
    ofUsed(this->Options->Moving == MOVING_REGION, this->Internals->Region),
    ofUsed(true, this->Internals->RigidTransform) });
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

void vtkDisplacementAlgorithm::SetFieldConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(5, output);
}

void vtkDisplacementAlgorithm::SetFieldData(vtkDataObject* field)
{
  this->SetInputDataObject(5, field);
}

void vtkDisplacementAlgorithm::SetSelectionExtractor(vtkExtractSelection* extractor)
{
  filters::Property::Set(this, this->Internals->Extractor, extractor);
}

#define morphObjectMacro(name, type)                             \
  void vtkDisplacementAlgorithm::Set##name(type* object)         \
  {                                                              \
    filters::Property::Set(this, this->Internals->name, object); \
  }                                                              \
  type* vtkDisplacementAlgorithm::Get##name()                    \
  {                                                              \
    return this->Internals->name;                                \
  }
morphObjectMacro(Region, vtkImplicitFunction);
morphObjectMacro(ZoneRegion, vtkImplicitFunction);
morphObjectMacro(Transform, vtkAbstractTransform);
morphObjectMacro(RigidTransform, vtkAbstractTransform);

vtkDataArraySelection* vtkDisplacementAlgorithm::GetSurfaceList()
{
  return this->Internals->SurfaceList;
}

void vtkDisplacementAlgorithm::FindSurfaces(
  vtkDataObject* shown, vtkSelection* selection, vtkDataArraySelection* names)
{
  const vtkInternals& own = *this->Internals;
  try
  {
    const bool isPicked = own.Whole && selection && selection->GetNumberOfNodes() > 0;
    filters::Pick::Find(
      shown, isPicked ? nullptr : selection, own.Extractor, own.Blocks, own.Model, names);
    if (isPicked)
    {
      throw morph::Error("The mesh is on several MPI ranks, each of which shows a part. Choose "
                         "surfaces by their names.");
    }
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro("Cannot find the surfaces of this selection: " << error.what());
  }
}

void vtkDisplacementAlgorithm::CopySurfaces(vtkDataArraySelection* names, vtkPolyData* output)
{
  const vtkInternals& own = *this->Internals;
  filters::Pick::Write(own.Model, names, own.Displaced, output);
  if (own.Whole && !filters::Ranks::IsFirst())
  {
    output->Initialize(); // the first rank has it all
  }
}

void vtkDisplacementAlgorithm::CopyMovedSurfaces(
  vtkDataArraySelection* names, vtkDisplacementAlgorithm* motion, vtkPolyData* output)
{
  output->Initialize();
  const vtkInternals& own = *this->Internals;
  const int how = motion->Options->Displacement;
  const bool isCheap = how <= DISPLACEMENT_ALONG_NORMALS ||
                       how == DISPLACEMENT_TRANSLATE_ROTATE_SCALE || how == DISPLACEMENT_RADIUS ||
                       how == DISPLACEMENT_DIMENSION;
  if (isCheap && own.Model.Surface() && (!own.Whole || filters::Ranks::IsFirst()))
  {
    filters::Views::Preview(
      own.Model, names, { *motion->Options, motion->Internals->Transform }, output);
  }
}

std::string vtkDisplacementAlgorithm::DescribeDimension(vtkDataArraySelection* names)
{
  const vtkInternals& own = *this->Internals;
  return own.Model.Surface() ? filters::Pick::DimensionOf(own.Model, names) : std::string();
}

double vtkDisplacementAlgorithm::GetPresentDimension() const
{
  return this->Internals->PresentDimension;
}

void vtkDisplacementAlgorithm::SetPick(vtkAlgorithm* selection)
{
  this->Internals->Picker.Selection = selection;
}

void vtkDisplacementAlgorithm::SetPickPort(int port)
{
  this->Internals->Picker.Port = std::max(port, -1);
}

int vtkDisplacementAlgorithm::GetPickPort() const
{
  return this->Internals->Picker.Port;
}

vtkDataArraySelection* vtkDisplacementAlgorithm::GetPickedSurfaces()
{
  filters::Picker& picker = this->Internals->Picker;
  this->FindSurfaces(picker.Shown(this), picker.Update(), picker.Names);
  return picker.Names;
}

vtkStringArray* vtkDisplacementAlgorithm::GetSurfaceSizes()
{
  return this->Internals->SurfaceSizes;
}

vtkStringArray* vtkDisplacementAlgorithm::GetSurfaceShapes()
{
  this->Internals->ListShapes();
  return this->Internals->SurfaceShapes;
}

vtkDoubleArray* vtkDisplacementAlgorithm::GetSurfaceBounds()
{
  return this->Internals->SurfaceBounds;
}

vtkDoubleArray* vtkDisplacementAlgorithm::GetLatticePoints()
{
  return this->Internals->LatticePoints;
}

vtkDataArraySelection* vtkDisplacementAlgorithm::GetZoneList()
{
  return this->Internals->ZoneList;
}

vtkStringArray* vtkDisplacementAlgorithm::GetZoneSizes()
{
  return this->Internals->ZoneSizes;
}

vtkIdType vtkDisplacementAlgorithm::GetZonePoints() const
{
  return this->Internals->Count[morph::Surroundings::IsZone];
}

vtkIdType vtkDisplacementAlgorithm::GetLayerPoints() const
{
  return this->Internals->Count[morph::Surroundings::IsLayer];
}

const char* vtkDisplacementAlgorithm::GetContactReport() const
{
  return this->Internals->ContactReport.c_str();
}

const char* vtkDisplacementAlgorithm::GetSlideReport() const
{
  return this->Internals->SlideReport.c_str();
}

void vtkDisplacementAlgorithm::AddHandle(
  double x, double y, double z, double dx, double dy, double dz, double radius)
{
  // Values that are not finite are an error of the execution, which names the handle.
  this->Internals->Handles.push_back({ x, y, z, dx, dy, dz, radius });
  this->Modified();
}

void vtkDisplacementAlgorithm::AddHandle(const double v[7])
{
  this->AddHandle(v[0], v[1], v[2], v[3], v[4], v[5], v[6]);
}

void vtkDisplacementAlgorithm::RemoveAllHandles()
{
  filters::Property::Set(this, this->Internals->Handles, {});
}

int vtkDisplacementAlgorithm::GetNumberOfHandles() const
{
  return static_cast<int>(this->Internals->Handles.size());
}

void vtkDisplacementAlgorithm::AddLatticeDisplacement(
  double i, double j, double k, double dx, double dy, double dz)
{
  this->Internals->LatticeDisplacements.push_back({ i, j, k, dx, dy, dz });
  this->Modified();
}

void vtkDisplacementAlgorithm::AddLatticeDisplacement(const double v[6])
{
  this->AddLatticeDisplacement(v[0], v[1], v[2], v[3], v[4], v[5]);
}

void vtkDisplacementAlgorithm::RemoveAllLatticeDisplacements()
{
  filters::Property::Set(this, this->Internals->LatticeDisplacements, {});
}

int vtkDisplacementAlgorithm::GetNumberOfLatticeDisplacements() const
{
  return static_cast<int>(this->Internals->LatticeDisplacements.size());
}

void vtkDisplacementAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const vtkInternals& own = *this->Internals;
  this->PrintOptions(os, indent);
  os << indent << "PickPort: " << this->GetPickPort() << "\n";
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
