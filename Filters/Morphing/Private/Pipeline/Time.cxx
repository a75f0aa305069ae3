// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Pipeline/Time.h"

#include "Private/Blocks/Leaves.h"
#include "Private/Pipeline/Ranks.h"
#include "Support/Monitor.h"

#include <vtkDataObject.h>
#include <vtkDataObjectTree.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationDoubleVectorKey.h>
#include <vtkInformationIntegerKey.h>
#include <vtkInformationVector.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <sstream>

namespace morph::filters
{
using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace
{
std::optional<double> restStep(double restTime, vtkInformation* mesh)
{
  if (const int count = mesh->Length(Pipeline::TIME_STEPS()))
  {
    const double* steps = mesh->Get(Pipeline::TIME_STEPS());
    const double* after = std::upper_bound(steps, steps + count, restTime);
    return after == steps ? steps[0] : after[-1];
  }
  if (mesh->Length(Pipeline::TIME_RANGE()) == 2)
  {
    const double* range = mesh->Get(Pipeline::TIME_RANGE());
    return std::min(std::max(restTime, range[0]), range[1]);
  }
  return std::nullopt;
}
}

void Time::CopySteps(vtkInformation* boundary, vtkInformation* output)
{
  // The executive has copied port 0's; copying a key that is not there removes it.
  output->CopyEntry(boundary, Pipeline::TIME_STEPS());
  output->CopyEntry(boundary, Pipeline::TIME_RANGE());
}

void Time::CopyDataTime(vtkDataObject* boundary, vtkDataObject* output)
{
  output->GetInformation()->CopyEntry(boundary->GetInformation(), vtkDataObject::DATA_TIME_STEP());
}

std::optional<double> Time::AskRest(double restTime, vtkInformation* mesh)
{
  const std::optional<double> step = restStep(restTime, mesh);
  if (step)
  {
    Ask(mesh, step);
  }
  return step;
}

void Time::WarnOfSeries(vtkInformationVector** inputVector, vtkInformation* output,
  const std::vector<std::string>& names, morph::Monitor& monitor)
{
  if (output && output->Has(Pipeline::TIME_RANGE()))
  {
    return;
  }
  for (std::size_t port = 0; port < names.size(); ++port)
  {
    for (int i = 0; i < inputVector[port]->GetNumberOfInformationObjects(); ++i)
    {
      vtkInformation* info = inputVector[port]->GetInformationObject(i);
      vtkDataObject* data = vtkDataObject::GetData(info);
      if (!names[port].empty() && data && info->Length(Pipeline::TIME_STEPS()) > 1)
      {
        std::ostringstream text;
        text << names[port] << " has " << info->Length(Pipeline::TIME_STEPS())
             << " time steps, and is taken at one";
        if (data->GetInformation()->Has(vtkDataObject::DATA_TIME_STEP()))
        {
          text << ", " << data->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP());
        }
        monitor.warn(text.str() + ". The filter Force Time before this one chooses another.");
      }
    }
  }
}

void Time::Request(double restTime, std::optional<double> boundaryTime, vtkInformation* mesh,
  vtkInformation* boundary)
{
  this->RestStep = restStep(restTime, mesh);
  this->BoundaryTime = boundaryTime;
  this->OnePort = mesh == boundary;
  Ask(boundary, boundaryTime);
  if (!this->OnePort || this->RestStep)
  {
    Ask(mesh, this->RestStep);
  }
}

void Time::Ask(vtkInformation* input, std::optional<double> time)
{
  if (time)
  {
    input->Set(Pipeline::UPDATE_TIME_STEP(), *time);
  }
  else
  {
    input->Remove(Pipeline::UPDATE_TIME_STEP());
  }
}

vtkSmartPointer<vtkDataObject> Time::TakeRest(vtkDataObject* mesh, const Fetch& fetch) const
{
  const auto isAtRest = [this](vtkDataObject* data)
  {
    vtkInformation* info = data ? data->GetInformation() : nullptr;
    return !info || !info->Has(vtkDataObject::DATA_TIME_STEP()) ||
           info->Get(vtkDataObject::DATA_TIME_STEP()) == *this->RestStep;
  };
  const bool overwritten = Ranks::Count(this->RestStep && !isAtRest(mesh)) > 0;
  if (overwritten)
  {
    mesh = fetch(0, this->RestStep);
  }
  vtkSmartPointer<vtkDataObject> rest = mesh;
  if (this->RestStep && mesh)
  {
    rest.TakeReference(mesh->NewInstance());
    if (auto* blocks = Leaves::TreeOf(mesh))
    {
      Leaves::Copy(blocks, vtkDataObjectTree::SafeDownCast(rest));
    }
    else
    {
      rest->ShallowCopy(mesh);
    }
  }
  if (overwritten || (this->OnePort && this->RestStep))
  {
    fetch(1, this->BoundaryTime);
  }
  return rest;
}
}
