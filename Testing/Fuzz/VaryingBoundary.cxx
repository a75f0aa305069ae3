// SPDX-License-Identifier: BSD-3-Clause
#include "VaryingBoundary.h"

#include <vtkDemandDrivenPipeline.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPoints.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <numeric>

namespace fuzz
{
using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(VaryingBoundary);

VaryingBoundary::VaryingBoundary()
{
  this->SetNumberOfInputPorts(0);
}

int VaryingBoundary::RequestDataObject(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  auto made = vtkSmartPointer<vtkDataObject>::Take(this->Data->NewInstance());
  info->Set(vtkDataObject::DATA_OBJECT(), made);
  return 1;
}

int VaryingBoundary::ExecuteInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  std::vector<double> times(this->Steps + 1);
  std::iota(times.begin(), times.end(), 0.0);
  const double range[] = { times.front(), times.back() };
  vtkInformation* info = outputs->GetInformationObject(0);
  info->Set(Pipeline::TIME_STEPS(), times.data(), static_cast<int>(times.size()));
  info->Set(Pipeline::TIME_RANGE(), range, 2);
  return 1;
}

int VaryingBoundary::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  const double time =
    info->Has(Pipeline::UPDATE_TIME_STEP()) ? info->Get(Pipeline::UPDATE_TIME_STEP()) : 0;
  auto* output = vtkPointSet::SafeDownCast(vtkDataObject::GetData(info));
  output->ShallowCopy(this->Data);
  const double part = time / this->Steps;
  vtkNew<vtkPoints> points;
  points->SetDataType(this->Data->GetPoints()->GetDataType());
  points->SetNumberOfPoints(this->Data->GetNumberOfPoints());
  for (vtkIdType p = 0; p < points->GetNumberOfPoints(); ++p)
  {
    Eigen::RowVector3d x;
    this->Data->GetPoint(p, x.data());
    // The last are those of the data, bit for bit.
    const Eigen::RowVector3d rest = this->Rest.row(p);
    points->SetPoint(p, (part == 1 ? x : (rest + part * (x - rest)).eval()).data());
  }
  output->SetPoints(points);
  info->Set(vtkDataObject::DATA_TIME_STEP(), time);
  output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
  return 1;
}
}
