// SPDX-License-Identifier: BSD-3-Clause
#include "ServerManagerClasses.h"

#include "vtkSMConnectedArrayListDomain.h"
#include "vtkSMKeptArraySelectionDomain.h"
#include "vtkSMKnownBoundsDomain.h"
#include "vtkSMReportingSourceProxy.h"

#include <vtkClientServerInterpreter.h>
#include <vtkClientServerInterpreterInitializer.h>

namespace
{
template <typename Class>
vtkObjectBase* make(void*)
{
  return Class::New();
}
}

void MeshMorphingRegisterServerManagerClasses()
{
  vtkClientServerInterpreterInitializer::GetInitializer()->RegisterCallback(
    [](vtkClientServerInterpreter* interpreter)
    {
      interpreter->AddNewInstanceFunction(
        "vtkSMConnectedArrayListDomain", make<vtkSMConnectedArrayListDomain>);
      interpreter->AddNewInstanceFunction(
        "vtkSMKeptArraySelectionDomain", make<vtkSMKeptArraySelectionDomain>);
      interpreter->AddNewInstanceFunction("vtkSMKnownBoundsDomain", make<vtkSMKnownBoundsDomain>);
      interpreter->AddNewInstanceFunction(
        "vtkSMReportingSourceProxy", make<vtkSMReportingSourceProxy>);
    });
}
