// SPDX-License-Identifier: BSD-3-Clause
#include "TakeSelection.h"

#include <pqApplicationCore.h>
#include <pqPipelineFilter.h>
#include <pqPropertyWidget.h>
#include <pqSelectionInputWidget.h>
#include <pqServerManagerModel.h>
#include <vtkPVXMLElement.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMSourceProxy.h>

#include <QMetaObject>
#include <QTimer>

TakeSelection::TakeSelection(vtkPVXMLElement* hint, pqPropertyWidget* widget)
  : Superclass(hint, widget)
{
  // The panel is still being made, and its links would empty the widget again.
  QTimer::singleShot(0, this, [this] { this->take(); });
}

TakeSelection::~TakeSelection() = default;

void TakeSelection::take()
{
  pqPropertyWidget* const widget = this->parentWidget();
  vtkSMProxy* const proxy = widget->proxy();
  const auto* const filter =
    pqApplicationCore::instance()->getServerManagerModel()->findItem<pqPipelineFilter*>(proxy);
  if (!filter || filter->modifiedState() != pqProxy::UNINITIALIZED ||
      vtkSMPropertyHelper(widget->property()).GetNumberOfElements() > 0)
  {
    return;
  }
  const vtkSMPropertyHelper input(proxy, "Input");
  auto* const source =
    input.GetNumberOfElements() > 0 ? vtkSMSourceProxy::SafeDownCast(input.GetAsProxy()) : nullptr;
  auto* const copier = widget->findChild<pqSelectionInputWidget*>();
  if (copier && source && source->GetSelectionInput(input.GetOutputPort()))
  {
    QMetaObject::invokeMethod(copier, "copyActiveSelection"); // a protected slot
    const char* const moving = this->xml()->GetAttribute("moving");
    vtkSMProperty* const what = moving ? proxy->GetProperty("Moving") : nullptr;
    if (what)
    {
      vtkSMPropertyHelper(what).Set(moving);
    }
  }
}
