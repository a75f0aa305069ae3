// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMConnectedArrayListDomain.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkSMConnectedArrayListDomain);

int vtkSMConnectedArrayListDomain::ReadXMLAttributes(vtkSMProperty* prop, vtkPVXMLElement* element)
{
  const int done = this->Superclass::ReadXMLAttributes(prop, element);
  this->SetStrings({});
  return done;
}
