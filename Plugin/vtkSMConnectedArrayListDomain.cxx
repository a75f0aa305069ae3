// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMConnectedArrayListDomain.h"

#include <vtkClientServerInterpreter.h>
#include <vtkClientServerInterpreterInitializer.h>
#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkSMConnectedArrayListDomain);

int vtkSMConnectedArrayListDomain::ReadXMLAttributes(vtkSMProperty* prop, vtkPVXMLElement* element)
{
  const int done = this->Superclass::ReadXMLAttributes(prop, element);
  this->SetStrings({});
  return done;
}

void vtkSMConnectedArrayListDomain::Register()
{
  vtkClientServerInterpreterInitializer::GetInitializer()->RegisterCallback(
    [](vtkClientServerInterpreter* interpreter)
    {
      interpreter->AddNewInstanceFunction("vtkSMConnectedArrayListDomain",
        [](void*) -> vtkObjectBase* { return vtkSMConnectedArrayListDomain::New(); });
    });
}
