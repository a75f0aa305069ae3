// SPDX-License-Identifier: BSD-3-Clause
#include "Beside.h"

#include <pqPropertyWidget.h>
#include <vtkPVXMLElement.h>

#include <QLayout>
#include <QTimer>

Beside::Beside(vtkPVXMLElement* hint, pqPropertyWidget* widget)
  : Superclass(hint, widget)
{
  const QString name = hint->GetAttribute("property");
  // The panel lays its rows out after they were made.
  QTimer::singleShot(0, this,
    [this, name]
    {
      QWidget* const row = this->parentWidget();
      const QWidget* const panel = row->parentWidget();
      auto* const other = panel ? panel->findChild<pqPropertyWidget*>(name) : nullptr;
      if (other && other->layout())
      {
        const bool isShown = row->isVisibleTo(panel);
        other->layout()->addWidget(row);
        row->setVisible(isShown);
      }
    });
}

Beside::~Beside() = default;
