// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMKeptArraySelectionDomain.h"

#include <vtkCommand.h>
#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkSMKeptArraySelectionDomain);

vtkSMKeptArraySelectionDomain::vtkSMKeptArraySelectionDomain()
{
  // The superclass of ParaView 6.1 observes itself, and sets its property to the defaults.
  this->RemoveObservers(vtkCommand::DomainModifiedEvent);
}
