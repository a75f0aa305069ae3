// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Compare/BoundarySeries.h"

#include <vtkDataObject.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationDoubleVectorKey.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>

namespace morph::filters
{
using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(BoundarySeries);

BoundarySeries::BoundarySeries()
{
  this->SetNumberOfInputPorts(0);
  this->SetNumberOfOutputPorts(1);
}

BoundarySeries::~BoundarySeries() = default;

void BoundarySeries::SetBoundaries(
  std::vector<double> times, std::vector<vtkSmartPointer<vtkDataObject>> boundaries)
{
  this->Times = std::move(times);
  this->Boundaries = std::move(boundaries);
  this->Modified();
}

int BoundarySeries::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataObject");
  return 1;
}

vtkTypeBool BoundarySeries::ProcessRequest(
  vtkInformation* request, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkInformation* output = outputVector->GetInformationObject(0);
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT()))
  {
    vtkSmartPointer<vtkDataObject> data;
    data.TakeReference(this->Boundaries.front()->NewInstance());
    output->Set(vtkDataObject::DATA_OBJECT(), data);
  }
  else if (request->Has(vtkDemandDrivenPipeline::REQUEST_INFORMATION()))
  {
    this->WriteTimes(output);
  }
  else if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA()))
  {
    this->WriteBoundary(output);
  }
  return 1;
}

void BoundarySeries::WriteTimes(vtkInformation* output) const
{
  if (this->Times.size() > 1)
  {
    const double range[2] = { this->Times.front(), this->Times.back() };
    output->Set(Pipeline::TIME_STEPS(), this->Times.data(), static_cast<int>(this->Times.size()));
    output->Set(Pipeline::TIME_RANGE(), range, 2);
  }
}

void BoundarySeries::WriteBoundary(vtkInformation* output) const
{
  vtkDataObject* data = output->Get(vtkDataObject::DATA_OBJECT());
  std::size_t number = 0;
  if (output->Has(Pipeline::UPDATE_TIME_STEP()))
  {
    const auto after = std::upper_bound(
      this->Times.begin(), this->Times.end(), output->Get(Pipeline::UPDATE_TIME_STEP()));
    number = after == this->Times.begin() ? 0 : after - this->Times.begin() - 1;
  }
  number = std::min(number, this->Boundaries.size() - 1);
  data->ShallowCopy(this->Boundaries[number]);
  if (this->Times.size() > 1)
  {
    data->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), this->Times[number]);
  }
}
}
