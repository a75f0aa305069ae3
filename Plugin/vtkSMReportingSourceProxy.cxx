// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMReportingSourceProxy.h"

#include <vtkObjectFactory.h>
#include <vtkSMDoubleVectorProperty.h>
#include <vtkSMPropertyIterator.h>
#include <vtkSmartPointer.h>

#include <cmath>

vtkStandardNewMacro(vtkSMReportingSourceProxy);

void vtkSMReportingSourceProxy::PostUpdateData(bool usingCache)
{
  const bool executed = this->NeedsUpdate && !usingCache;
  this->Superclass::PostUpdateData(usingCache);
  if (executed)
  {
    this->UpdatePropertyInformation();
  }
}

void vtkSMReportingSourceProxy::UpdatePropertyInformationInternal(vtkSMProperty* property)
{
  this->Superclass::UpdatePropertyInformationInternal(property);
  const auto properties = vtk::TakeSmartPointer(this->NewPropertyIterator());
  for (properties->Begin(); !properties->IsAtEnd(); properties->Next())
  {
    auto* number = vtkSMDoubleVectorProperty::SafeDownCast(properties->GetProperty());
    if (number && number->GetInformationOnly() && number->GetNumberOfElements() == 1 &&
        std::isnan(number->GetElement(0)))
    {
      number->ResetToXMLDefaults();
    }
  }
}
