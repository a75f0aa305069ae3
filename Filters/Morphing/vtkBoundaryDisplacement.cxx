// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBoundaryDisplacement.h"

#include "Private/Displace/Internals.h"
#include "Private/Pipeline/CrewMonitor.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Ranks.h"
#include "Private/Pipeline/UpToDateInput.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>

namespace filters = morph::filters;

vtkStandardNewMacro(vtkBoundaryDisplacement);

vtkBoundaryDisplacement::vtkBoundaryDisplacement()
{
  this->Options->Moving = morph::BoundaryDisplacementDefaults::Moving;
}

vtkBoundaryDisplacement::~vtkBoundaryDisplacement() = default;

vtkPolyData* vtkBoundaryDisplacement::GetOutput()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(0));
}

int vtkBoundaryDisplacement::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkPolyData");
  return 1;
}

vtkPolyData* vtkBoundaryDisplacement::GetFittedTarget()
{
  return this->Options->Displacement == DISPLACEMENT_TARGET ? this->Internals->Fit.Surface()
                                                            : nullptr;
}

#define morphCountMacro(name, role)                           \
  vtkIdType vtkBoundaryDisplacement::Get##name() const        \
  {                                                           \
    return this->Internals->Count[morph::Surroundings::role]; \
  }
morphCountMacro(MovingPoints, Moves);
morphCountMacro(FixedPoints, IsHeld);
morphCountMacro(FollowingPoints, Follows);
morphCountMacro(FreePoints, IsFree);

int vtkBoundaryDisplacement::GetClassifyCount() const
{
  return this->Internals->Model.ClassifyCount();
}

int vtkBoundaryDisplacement::GetChooseCount() const
{
  return this->Internals->ChooseCount;
}

int vtkBoundaryDisplacement::GetPrepareCount() const
{
  return this->Internals->Mover.surroundings().prepareCount();
}

int vtkBoundaryDisplacement::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  // A user who is about to choose patches wants to see their names before the first execution. On
  // several ranks they are known after it: a request for information need not come to all of them.
  if (filters::Ranks::Processes() > 1)
  {
    return 1;
  }
  this->Internals->List(*this->Options, filters::upToDateInput(this, inputVector));
  return 1;
}

int vtkBoundaryDisplacement::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInternals& own = *this->Internals;
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  own.ResetResults();
  filters::CrewMonitor monitor(this, this->Options->NumberOfThreads);
  const auto displace = [&]
  {
    vtkInternals::WarnOfSeries(inputVector, outputVector->GetInformationObject(0), monitor);
    const filters::Input::Mesh mesh = filters::Input::TakeMesh(
      vtkDataObject::GetData(inputVector[0]), own.Blocks, this->Options->CoincidentPoints,
      filters::Input::Use::ToMorph, this->GetClassName(), monitor);
    own.Displace(*this->Options, mesh, vtkInternals::InputsOf(inputVector), output, monitor);
  };
  const auto clear = [&]
  {
    output->Initialize();
    own.ResetResults();
  };
  filters::Execution::Run(this, "displace this mesh's boundary", displace, clear);
  if (own.IsTeller())
  {
    monitor.TellWarnings();
  }
  return 1;
}

void vtkBoundaryDisplacement::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MovingPoints: " << this->GetMovingPoints() << "\n";
  os << indent << "FixedPoints: " << this->GetFixedPoints() << "\n";
  os << indent << "FollowingPoints: " << this->GetFollowingPoints() << "\n";
  os << indent << "FreePoints: " << this->GetFreePoints() << "\n";
  os << indent << "ZonePoints: " << this->GetZonePoints() << "\n";
  os << indent << "LayerPoints: " << this->GetLayerPoints() << "\n";
  os << indent << "ClassifyCount: " << this->GetClassifyCount() << "\n";
  os << indent << "ChooseCount: " << this->GetChooseCount() << "\n";
  os << indent << "PrepareCount: " << this->GetPrepareCount() << "\n";
}
