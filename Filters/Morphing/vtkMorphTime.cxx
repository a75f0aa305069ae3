// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphTime.h"

#include "vtkMorphRanks.h"

#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationDoubleVectorKey.h>
#include <vtkInformationIntegerKey.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>

using Pipeline = vtkStreamingDemandDrivenPipeline;

void vtkMorphTime::CopySteps(vtkInformation* boundary, vtkInformation* output)
{
  // The executive has copied port 0's; copying a key that is not there removes it.
  output->CopyEntry(boundary, Pipeline::TIME_STEPS());
  output->CopyEntry(boundary, Pipeline::TIME_RANGE());
}

void vtkMorphTime::CopyDataTime(vtkDataObject* boundary, vtkDataObject* output)
{
  output->GetInformation()->CopyEntry(boundary->GetInformation(), vtkDataObject::DATA_TIME_STEP());
}

void vtkMorphTime::Request(double restTime, vtkMTimeType meshTime,
  std::optional<double> boundaryTime, vtkInformation* mesh, vtkInformation* boundary)
{
  const double lastStep = this->RestStep;
  this->HasRestStep = true;
  if (const int count = mesh->Length(Pipeline::TIME_STEPS()))
  {
    const double* steps = mesh->Get(Pipeline::TIME_STEPS());
    const double* after = std::upper_bound(steps, steps + count, restTime);
    this->RestStep = after == steps ? steps[0] : after[-1];
  }
  else if (mesh->Length(Pipeline::TIME_RANGE()) == 2)
  {
    const double* range = mesh->Get(Pipeline::TIME_RANGE());
    this->RestStep = std::min(std::max(restTime, range[0]), range[1]);
  }
  else
  {
    this->HasRestStep = false;
  }

  if (this->MeshTime != meshTime || this->RestStep != lastStep)
  {
    // Left over from an execution that failed upstream between its passes.
    this->Rest = nullptr;
  }
  this->MeshTime = meshTime;

  const bool onePort = mesh == boundary;
  if (onePort && this->HasRestStep && !this->Rest)
  {
    this->BothAtRest = true;
  }
  if (this->HasRestStep)
  {
    mesh->Set(Pipeline::UPDATE_TIME_STEP(), this->RestStep);
  }
  else if (!onePort)
  {
    mesh->Remove(Pipeline::UPDATE_TIME_STEP());
  }
  if (this->BothAtRest)
  {
    boundary->Set(Pipeline::UPDATE_TIME_STEP(), this->RestStep);
  }
  else if (boundaryTime)
  {
    boundary->Set(Pipeline::UPDATE_TIME_STEP(), *boundaryTime);
  }
  else
  {
    boundary->Remove(Pipeline::UPDATE_TIME_STEP());
  }
}

vtkSmartPointer<vtkDataObject> vtkMorphTime::TakeRest(vtkDataObject* mesh, vtkInformation* request)
{
  vtkInformation* info = mesh ? mesh->GetInformation() : nullptr;
  const bool overwritten = this->HasRestStep && info &&
                           info->Has(vtkDataObject::DATA_TIME_STEP()) &&
                           info->Get(vtkDataObject::DATA_TIME_STEP()) != this->RestStep;
  const bool repeat = this->BothAtRest || (vtkMorphRanks::Count(overwritten) > 0 && !this->Rest);
  if (repeat)
  {
    if (this->BothAtRest)
    {
      this->Rest.TakeReference(mesh->NewInstance());
      this->Rest->ShallowCopy(mesh);
    }
    this->BothAtRest = !this->BothAtRest;
    request->Set(Pipeline::CONTINUE_EXECUTING(), 1);
    return nullptr;
  }
  request->Remove(Pipeline::CONTINUE_EXECUTING());
  vtkSmartPointer<vtkDataObject> taken = mesh;
  if (this->Rest)
  {
    taken = this->Rest;
    this->Rest = nullptr;
  }
  return taken;
}
