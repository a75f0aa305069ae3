// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMKnownBoundsDomain.h"

#include <vtkBoundingBox.h>
#include <vtkObjectFactory.h>
#include <vtkPVDataInformation.h>

vtkStandardNewMacro(vtkSMKnownBoundsDomain);

void vtkSMKnownBoundsDomain::Update(vtkSMProperty* requested)
{
  vtkPVDataInformation* const input = this->GetInputInformation();
  if (input && vtkBoundingBox(input->GetBounds()).IsValid())
  {
    this->Superclass::Update(requested);
  }
}
