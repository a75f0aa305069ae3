// SPDX-License-Identifier: BSD-3-Clause
#include "TakeBest.h"

#include "Ancestor.h"

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqPipelineSource.h>
#include <pqPropertiesPanel.h>
#include <pqPropertyWidget.h>
#include <pqServerManagerModel.h>
#include <vtkCommand.h>
#include <vtkSMEnumerationDomain.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>

#include <QEvent>
#include <QLayout>
#include <QLineEdit>
#include <QPointer>
#include <QPushButton>
#include <QTimer>

#include <string>

TakeBest::TakeBest(vtkPVXMLElement* hint, pqPropertyWidget* widget)
  : Superclass(hint, widget)
  , Button(new QPushButton(tr("Use it"), widget))
{
  this->Button->setObjectName("TakeBest");
  this->Button->setToolTip(tr("Gives this method to the filter that has moved the boundary"));
  widget->layout()->addWidget(this->Button);
  widget->installEventFilter(this);
  QObject::connect(this->Button, &QPushButton::clicked, this, &TakeBest::take);
  pqCoreUtilities::connect(widget->property(), vtkCommand::ModifiedEvent, this, SLOT(showButton()));
  this->showButton();
}

TakeBest::~TakeBest() = default;

bool TakeBest::eventFilter(QObject* object, QEvent* event)
{
  pqPropertyWidget* const widget = this->parentWidget();
  if (event->type() == QEvent::EnabledChange && !widget->isEnabled())
  {
    widget->setEnabled(true);
    for (auto* const field : widget->findChildren<QLineEdit*>())
    {
      field->setReadOnly(true);
    }
  }
  return this->Superclass::eventFilter(object, event);
}

pqPipelineSource* TakeBest::filter() const
{
  const vtkSMPropertyHelper boundary(this->parentWidget()->proxy(), "Boundary", true);
  vtkSMProxy* const from = boundary.GetNumberOfElements() > 0 ? boundary.GetAsProxy() : nullptr;
  return from && from->GetProperty("Method")
           ? pqApplicationCore::instance()->getServerManagerModel()->findItem<pqPipelineSource*>(
               from)
           : nullptr;
}

void TakeBest::showButton()
{
  const vtkSMPropertyHelper best(this->parentWidget()->property());
  const bool isKnown = best.GetNumberOfElements() > 0 && *best.GetAsString() != '\0' &&
                       best.GetAsString() != std::string("None");
  this->Button->setVisible(isKnown && this->filter());
}

void TakeBest::take()
{
  pqPipelineSource* const source = this->filter();
  auto* const panel = ancestorOf<pqPropertiesPanel>(this->parentWidget());
  if (!source || !panel)
  {
    return;
  }
  vtkSMProperty* const method = source->getProxy()->GetProperty("Method");
  auto* const names = method->FindDomain<vtkSMEnumerationDomain>();
  const std::string best = vtkSMPropertyHelper(this->parentWidget()->property()).GetAsString();
  if (!names || names->HasEntryText(best.c_str()) == 0)
  {
    return;
  }
  const int value = names->GetEntryValueForText(best.c_str());
  pqActiveObjects::instance().setActiveSource(source);
  // Its panel is made first.
  QTimer::singleShot(0, panel,
    [panel, method, value, source = QPointer<pqPipelineSource>(source)]
    {
      if (source)
      {
        vtkSMUncheckedPropertyHelper(method).Set(value);
        source->setModifiedState(pqProxy::MODIFIED);
        panel->apply();
      }
    });
}
