// SPDX-License-Identifier: BSD-3-Clause
#include "KnownResult.h"

#include <pqCoreUtilities.h>
#include <pqPropertyWidget.h>
#include <vtkCommand.h>
#include <vtkSMProperty.h>

KnownResult::KnownResult(vtkPVXMLElement* hint, pqPropertyWidget* widget)
  : Superclass(hint, widget)
{
  pqCoreUtilities::connect(
    widget->property(), vtkCommand::ModifiedEvent, this, SIGNAL(visibilityChanged()));
}

KnownResult::~KnownResult() = default;

bool KnownResult::canShowWidget(bool) const
{
  return !this->parentWidget()->property()->IsValueDefault();
}
