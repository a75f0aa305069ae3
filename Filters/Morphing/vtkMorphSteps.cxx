// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphSteps.h"

#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationDoubleVectorKey.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkMorphSteps::vtkMorphSteps(int number, vtkInformation* boundary)
{
  const int own = boundary ? boundary->Length(Pipeline::TIME_STEPS()) : 0;
  if (own > 1 || (own == 1 && number == 0))
  {
    const double* times = boundary->Get(Pipeline::TIME_STEPS());
    this->Times.assign(times, times + own);
    this->Varies = true;
    return;
  }
  const bool continuous =
    own == 0 && boundary && boundary->Length(Pipeline::TIME_RANGE()) == 2 &&
    boundary->Get(Pipeline::TIME_RANGE())[0] < boundary->Get(Pipeline::TIME_RANGE())[1];
  for (int step = 0; number > 0 && step <= number; ++step)
  {
    const double part = static_cast<double>(step) / number;
    const double* range = continuous ? boundary->Get(Pipeline::TIME_RANGE()) : nullptr;
    // The end exactly.
    this->Times.push_back(!range           ? step
                          : step == number ? range[1]
                                           : range[0] + part * (range[1] - range[0]));
  }
  this->Varies = continuous && number > 0;
}

double vtkMorphSteps::Fraction(int step) const
{
  return this->Varies ? 1 : step / static_cast<double>(this->Times.size() - 1);
}

int vtkMorphSteps::Asked(vtkInformation* output) const
{
  const int last = static_cast<int>(this->Times.size()) - 1;
  if (!output->Has(Pipeline::UPDATE_TIME_STEP()))
  {
    return this->Varies ? 0 : last;
  }
  const auto after = std::upper_bound(
    this->Times.begin(), this->Times.end(), output->Get(Pipeline::UPDATE_TIME_STEP()));
  return std::clamp(static_cast<int>(after - this->Times.begin()) - 1, std::min(0, last), last);
}

void vtkMorphSteps::Write(vtkInformation* output) const
{
  if (this->Any())
  {
    const double range[2] = { this->Times.front(), this->Times.back() };
    output->Set(Pipeline::TIME_STEPS(), this->Times.data(), static_cast<int>(this->Times.size()));
    output->Set(Pipeline::TIME_RANGE(), range, 2);
  }
}
