// SPDX-License-Identifier: BSD-3-Clause
#include "BelowField.h"

#include <QBoxLayout>
#include <QGridLayout>
#include <QList>
#include <QSizePolicy>
#include <QWidget>

void putBelow(QWidget* widget, QWidget* row)
{
  row->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  if (auto* const grid = qobject_cast<QGridLayout*>(widget->layout()))
  {
    grid->addWidget(row, grid->rowCount(), 0, 1, -1);
    return;
  }
  auto* const box = qobject_cast<QBoxLayout*>(widget->layout());
  if (box && box->direction() != QBoxLayout::TopToBottom)
  {
    // A widget keeps its layout: the items go into a new one.
    QList<QLayoutItem*> items;
    while (QLayoutItem* const item = box->takeAt(0))
    {
      items.append(item);
    }
    const QMargins margins = box->contentsMargins();
    const int spacing = box->spacing();
    delete box;
    auto* const column = new QVBoxLayout(widget);
    column->setContentsMargins(margins);
    column->setSpacing(spacing);
    auto* const line = new QHBoxLayout();
    column->addLayout(line);
    for (QLayoutItem* const item : items)
    {
      line->addItem(item);
    }
  }
  widget->layout()->addWidget(row);
}
