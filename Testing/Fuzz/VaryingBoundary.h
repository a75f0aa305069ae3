// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "RandomBoundary.h"

#include <vtkPointSetAlgorithm.h>

namespace fuzz
{
/// A boundary that varies in time: at time i of 0, 1, ..., `Steps` its points have made i / Steps
/// of the way from their undeformed positions to those of `data`.
class VaryingBoundary : public vtkPointSetAlgorithm
{
public:
  static VaryingBoundary* New();
  vtkTypeMacro(VaryingBoundary, vtkPointSetAlgorithm);

  vtkSmartPointer<vtkPointSet> Data;
  morph::Points Rest; ///< of each point
  int Steps = 2;

protected:
  VaryingBoundary();
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int ExecuteInformation(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
};
}
