// SPDX-License-Identifier: BSD-3-Clause
#include "NarrowPanel.h"

#include <pqPropertyWidget.h>

#include <QComboBox>
#include <QEvent>
#include <QTimer>

NarrowPanel::NarrowPanel(vtkPVXMLElement* hint, pqPropertyWidget* widget)
  : Superclass(hint, widget)
{
  if (QWidget* const panel = widget->QWidget::parentWidget())
  {
    panel->installEventFilter(this);
  }
}

NarrowPanel::~NarrowPanel() = default;

bool NarrowPanel::eventFilter(QObject* object, QEvent* event)
{
  const QEvent::Type type = event->type();
  if (!this->Asked && (type == QEvent::LayoutRequest || type == QEvent::Show))
  {
    this->Asked = true;
    QTimer::singleShot(0, this, [this] { this->narrow(); });
  }
  return this->Superclass::eventFilter(object, event);
}

void NarrowPanel::narrow()
{
  this->Asked = false;
  const QWidget* const panel = this->parentWidget()->QWidget::parentWidget();
  for (auto* const list : panel->findChildren<QComboBox*>())
  {
    if (list->minimumWidth() == 0)
    {
      // All of an entry is in the open list.
      list->setMinimumWidth(12 * list->fontMetrics().averageCharWidth());
    }
  }
}
