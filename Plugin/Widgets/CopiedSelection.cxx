// SPDX-License-Identifier: BSD-3-Clause
#include "CopiedSelection.h"

#include <pqPropertyWidget.h>
#include <pqSelectionInputWidget.h>

#include <QLabel>
#include <QTextBrowser>

CopiedSelection::CopiedSelection(vtkPVXMLElement* hint, pqPropertyWidget* widget)
  : Superclass(hint, widget)
{
  auto* const copier = widget->findChild<pqSelectionInputWidget*>();
  auto* const text = copier ? copier->findChild<QTextBrowser*>() : nullptr;
  auto* const label = copier ? copier->findChild<QLabel*>("label") : nullptr;
  if (!text)
  {
    return;
  }
  const auto update = [text, label]
  {
    const bool isEmpty = text->toPlainText().isEmpty();
    text->setVisible(!isEmpty);
    if (label && isEmpty)
    {
      label->setText(tr("No selection is copied"));
    }
  };
  QObject::connect(text, &QTextBrowser::textChanged, this, update);
  update();
}

CopiedSelection::~CopiedSelection() = default;
