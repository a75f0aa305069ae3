// SPDX-License-Identifier: BSD-3-Clause
#include "PanelLabel.h"

#include <pqArraySelectionWidget.h>
#include <pqPropertyWidget.h>
#include <vtkPVXMLElement.h>

#include <QCheckBox>
#include <QEvent>
#include <QGridLayout>
#include <QLabel>

namespace
{
/// The label on the left of a widget of the panel; null where there is none.
QLabel* labelOf(QWidget* widget)
{
  QWidget* panel = widget->parentWidget();
  auto* grid = panel ? qobject_cast<QGridLayout*>(panel->layout()) : nullptr;
  const int index = grid ? grid->indexOf(widget) : -1;
  if (index < 0)
  {
    return nullptr;
  }
  int row = 0, column = 0, rows = 0, columns = 0;
  grid->getItemPosition(index, &row, &column, &rows, &columns);
  QLayoutItem* left = column > 0 ? grid->itemAtPosition(row, 0) : nullptr;
  return left ? qobject_cast<QLabel*>(left->widget()) : nullptr;
}

/// Puts a label above what a widget without one shows, a list of texts for instance.
void putAbove(QWidget* widget, const QString& text)
{
  auto* const label = new QLabel(text, widget);
  label->setObjectName("PanelLabel");
  label->adjustSize();
  label->show();
  QMargins margins = widget->contentsMargins();
  margins.setTop(margins.top() + label->height());
  widget->setContentsMargins(margins);
}
}

PanelLabel::PanelLabel(vtkPVXMLElement* hint, pqPropertyWidget* widget)
  : Superclass(hint, widget)
  , Text(hint->GetAttribute("text"))
{
  widget->installEventFilter(this);
}

PanelLabel::~PanelLabel() = default;

bool PanelLabel::eventFilter(QObject* object, QEvent* event)
{
  // The panel makes its labels after the widgets, and lays both out before it shows them.
  if (event->type() == QEvent::Show)
  {
    if (QLabel* label = labelOf(this->parentWidget()))
    {
      label->setText(this->Text);
    }
    else if (auto* title = this->parentWidget()->findChild<QLabel*>("PanelLabel"))
    {
      title->setText(this->Text); // that of an earlier time, or a widget's own
    }
    else if (auto* list = this->parentWidget()->findChild<pqArraySelectionWidget*>())
    {
      list->setHeaderLabel(this->Text);
    }
    else if (auto* box = this->parentWidget()->findChild<QCheckBox*>())
    {
      box->setText(this->Text);
    }
    else
    {
      putAbove(this->parentWidget(), this->Text);
    }
  }
  return this->Superclass::eventFilter(object, event);
}
