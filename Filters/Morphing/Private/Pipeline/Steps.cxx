// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Pipeline/Steps.h"

#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationDoubleVectorKey.h>
#include <vtkInformationVector.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>

namespace morph::filters
{
using Pipeline = vtkStreamingDemandDrivenPipeline;

Steps::Steps(int number, vtkInformation* boundary)
{
  const int own = boundary ? boundary->Length(Pipeline::TIME_STEPS()) : 0;
  if (own > 1 || (own == 1 && number == 0))
  {
    const double* times = boundary->Get(Pipeline::TIME_STEPS());
    this->Own.assign(times, times + own);
    this->Count = own;
    this->Varies = true;
    return;
  }
  if (number <= 0)
  {
    return;
  }
  this->Count = number + 1;
  if (own == 0 && boundary && boundary->Length(Pipeline::TIME_RANGE()) == 2)
  {
    const double* range = boundary->Get(Pipeline::TIME_RANGE());
    this->First = range[0];
    this->Last = range[1];
    this->Varies = range[0] < range[1];
  }
}

double Steps::Time(int step) const
{
  if (!this->Own.empty())
  {
    return this->Own[step];
  }
  if (!this->Varies)
  {
    return step;
  }
  const int last = this->Count - 1;
  // The end exactly.
  return step == last ? this->Last
                      : this->First + static_cast<double>(step) / last * (this->Last - this->First);
}

double Steps::Fraction(int step) const
{
  return this->Varies ? 1 : step / static_cast<double>(this->Count - 1);
}

int Steps::Asked(vtkInformation* output) const
{
  const int last = this->Count - 1;
  if (!output->Has(Pipeline::UPDATE_TIME_STEP()))
  {
    return this->Varies ? 0 : last;
  }
  const double time = output->Get(Pipeline::UPDATE_TIME_STEP());
  int after = 0;
  for (int end = this->Count; after < end;)
  {
    const int middle = after + (end - after) / 2;
    if (time < this->Time(middle))
    {
      end = middle;
    }
    else
    {
      after = middle + 1;
    }
  }
  return std::clamp(after - 1, std::min(0, last), last);
}

void Steps::Write(vtkInformation* output) const
{
  if (!this->Any())
  {
    return;
  }
  std::vector<double> times(this->Count);
  for (int step = 0; step < this->Count; ++step)
  {
    times[step] = this->Time(step);
  }
  const double range[2] = { times.front(), times.back() };
  output->Set(Pipeline::TIME_STEPS(), times.data(), this->Count);
  output->Set(Pipeline::TIME_RANGE(), range, 2);
}

void Steps::WriteTime(int step, vtkInformationVector* outputs) const
{
  for (int port = 0;
       this->Any() && !this->Varies && port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject* data = vtkDataObject::GetData(outputs, port);
    data->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), this->Time(step));
  }
}
}
