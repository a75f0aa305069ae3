// SPDX-License-Identifier: BSD-3-Clause
#include "FirstColumns.h"

#include <pqDataRepresentation.h>
#include <pqView.h>
#include <vtkPVXMLElement.h>

#include <QAbstractItemModel>
#include <QHeaderView>
#include <QTableView>
#include <QTimer>

namespace
{
int columnOf(const QAbstractItemModel* model, const QString& name)
{
  for (int column = 0; column < model->columnCount(); ++column)
  {
    if (model->headerData(column, Qt::Horizontal).toString() == name)
    {
      return column;
    }
  }
  return -1;
}
}

void FirstColumns::updated(pqDataRepresentation* shown, vtkPVXMLElement* hint)
{
  const QStringList names = QString(hint->GetAttribute("names")).split(' ');
  pqView* const view = shown->getView();
  auto* const table = view && view->widget() ? view->widget()->findChild<QTableView*>() : nullptr;
  if (!table || !table->model() || this->Known.contains(table))
  {
    return;
  }
  this->Known.insert(table);
  QObject::connect(
    table, &QObject::destroyed, this, [this](QObject* gone) { this->Known.remove(gone); });
  QHeaderView* const header = table->horizontalHeader();
  const auto again = [header, names]
  { QTimer::singleShot(0, header, [header, names] { FirstColumns::order(header, names); }); };
  QObject::connect(table->model(), &QAbstractItemModel::modelReset, header, again);
  QObject::connect(table->model(), &QAbstractItemModel::headerDataChanged, header, again);
  again();
}

void FirstColumns::order(QHeaderView* header, const QStringList& names)
{
  int place = 0;
  for (const QString& name : names)
  {
    const int column = header->model() ? columnOf(header->model(), name) : -1;
    if (column >= 0)
    {
      header->moveSection(header->visualIndex(column), place++);
    }
  }
}
