// SPDX-License-Identifier: BSD-3-Clause
#include "HintedResults.h"

#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqOutputPort.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>
#include <vtkPVXMLElement.h>
#include <vtkSMProxy.h>

HintedResults::HintedResults(const char* hint, OfStates ofStates)
  : Hint(hint)
  , States(ofStates)
{
}

void HintedResults::startup()
{
  QObject::connect(pqApplicationCore::instance()->getServerManagerModel(),
    SIGNAL(representationAdded(pqRepresentation*)), this, SLOT(added(pqRepresentation*)));
}

void HintedResults::added(pqRepresentation* representation)
{
  const bool isLeft =
    this->States == OfStates::Left && pqApplicationCore::instance()->isLoadingState();
  if (qobject_cast<pqDataRepresentation*>(representation) && !isLeft)
  {
    QObject::connect(representation, SIGNAL(dataUpdated()), this, SLOT(dataUpdated()));
  }
}

void HintedResults::dataUpdated()
{
  auto* const shown = qobject_cast<pqDataRepresentation*>(this->sender());
  pqOutputPort* const port = shown ? shown->getOutputPortFromInput() : nullptr;
  vtkPVXMLElement* const hints = port ? port->getSource()->getProxy()->GetHints() : nullptr;
  vtkPVXMLElement* const hint = hints ? hints->FindNestedElementByName(this->Hint) : nullptr;
  int wanted = -1;
  if (hint && (!hint->GetScalarAttribute("port", &wanted) || wanted == port->getPortNumber()))
  {
    this->updated(shown, hint);
  }
}
