// SPDX-License-Identifier: BSD-3-Clause
#include "vtkListedSurfaces.h"

#include "vtkDisplacementAlgorithm.h"

#include <vtkDataArraySelection.h>
#include <vtkDataObject.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>

#include <algorithm>

vtkStandardNewMacro(vtkListedSurfaces);

vtkListedSurfaces::vtkListedSurfaces()
{
  this->SetNumberOfInputPorts(0);
}

vtkListedSurfaces::~vtkListedSurfaces() = default;

void vtkListedSurfaces::SetFilter(vtkAlgorithm* filter)
{
  if (this->Filter != filter)
  {
    this->Filter = filter;
    this->Modified();
  }
}

void vtkListedSurfaces::SetMotion(vtkAlgorithm* motion)
{
  if (this->Motion != motion)
  {
    this->Motion = motion;
    this->Modified();
  }
}

void vtkListedSurfaces::SetSurfaceStatus(const char* name, int status)
{
  if (!name || (this->Names->ArrayExists(name) != 0) == (status != 0))
  {
    return;
  }
  if (status != 0)
  {
    this->Names->AddArray(name, true);
  }
  else
  {
    this->Names->RemoveArrayByName(name);
  }
  this->Modified();
}

void vtkListedSurfaces::RemoveAllSurfaces()
{
  if (this->Names->GetNumberOfArrays() > 0)
  {
    this->Names->RemoveAllArrays();
    this->Modified();
  }
}

const char* vtkListedSurfaces::GetDimension()
{
  auto* displacement = vtkDisplacementAlgorithm::SafeDownCast(this->Filter);
  this->Dimension = displacement ? displacement->DescribeDimension(this->Names) : "";
  return this->Dimension.c_str();
}

vtkMTimeType vtkListedSurfaces::GetMTime()
{
  vtkMTimeType time = this->Superclass::GetMTime();
  if (this->Filter)
  {
    vtkDataObject* output = this->Filter->GetOutputDataObject(0);
    time = std::max({ time, this->Filter->GetMTime(), output ? output->GetMTime() : 0 });
  }
  if (this->Motion)
  {
    time = std::max(time, this->Motion->GetMTime());
  }
  return time;
}

int vtkListedSurfaces::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  auto* displacement = vtkDisplacementAlgorithm::SafeDownCast(this->Filter);
  auto* motion = vtkDisplacementAlgorithm::SafeDownCast(this->Motion);
  if (displacement && motion)
  {
    displacement->CopyMovedSurfaces(this->Names, motion, output);
  }
  else if (displacement)
  {
    displacement->CopySurfaces(this->Names, output);
  }
  return 1;
}

void vtkListedSurfaces::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Filter: " << this->Filter.Get() << "\n";
  os << indent << "Motion: " << this->Motion.Get() << "\n";
  os << indent << "Surfaces: ";
  for (int i = 0; i < this->Names->GetNumberOfArrays(); ++i)
  {
    os << (i > 0 ? ", " : "") << this->Names->GetArrayName(i);
  }
  os << "\n";
}
