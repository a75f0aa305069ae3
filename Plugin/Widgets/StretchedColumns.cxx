// SPDX-License-Identifier: BSD-3-Clause
#include "StretchedColumns.h"

#include <pqPropertyWidget.h>

#include <QHeaderView>
#include <QHelpEvent>
#include <QTableView>
#include <QToolTip>

namespace
{
/// Gives access to what is protected.
struct LabelAccess : pqPropertyWidget
{
  using pqPropertyWidget::setShowLabel;
};
}

StretchedColumns::StretchedColumns(vtkPVXMLElement* hint, pqPropertyWidget* widget)
  : Superclass(hint, widget)
{
  // A label at the left would leave the table little room; PanelLabel puts one above.
  (widget->*&LabelAccess::setShowLabel)(false);
  for (auto* const table : widget->findChildren<QTableView*>())
  {
    table->verticalHeader()->hide();
    QHeaderView* const header = table->horizontalHeader();
    header->setMinimumSectionSize(3 * header->fontMetrics().averageCharWidth());
    header->setStretchLastSection(false);
    header->setSectionResizeMode(QHeaderView::Stretch);
    table->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    table->viewport()->installEventFilter(this);
    QObject::disconnect(table, SIGNAL(editPastLastRow()), nullptr, nullptr);
  }
}

StretchedColumns::~StretchedColumns() = default;

bool StretchedColumns::eventFilter(QObject* object, QEvent* event)
{
  auto* const table = event->type() == QEvent::ToolTip && object->parent()
                        ? qobject_cast<QTableView*>(object->parent())
                        : nullptr;
  const auto* const help = static_cast<QHelpEvent*>(event);
  const QModelIndex index = table ? table->indexAt(help->pos()) : QModelIndex();
  if (index.isValid())
  {
    QToolTip::showText(help->globalPos(), index.data().toString(), table->viewport());
    return true;
  }
  return this->Superclass::eventFilter(object, event);
}
