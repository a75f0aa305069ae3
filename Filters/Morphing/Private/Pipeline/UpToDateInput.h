// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkAlgorithm.h>
#include <vtkDataObject.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkTrivialProducer.h>

class vtkInformationVector;

namespace morph::filters
{
/// The data on port 0 if an update would not change them, else null.
inline vtkDataObject* upToDateInput(vtkAlgorithm* filter, vtkInformationVector** inputVector)
{
  vtkDataObject* data = vtkDataObject::GetData(inputVector[0]);
  if (vtkTrivialProducer::SafeDownCast(filter->GetInputAlgorithm(0, 0)))
  {
    return data;
  }
  auto* upstream = vtkDemandDrivenPipeline::SafeDownCast(filter->GetInputExecutive(0, 0));
  return data && upstream && data->GetUpdateTime() > upstream->GetPipelineMTime() ? data : nullptr;
}
}
