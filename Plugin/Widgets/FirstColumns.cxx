// SPDX-License-Identifier: BSD-3-Clause
#include "FirstColumns.h"

#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqOutputPort.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>
#include <pqView.h>
#include <vtkPVXMLElement.h>
#include <vtkSMProxy.h>

#include <QAbstractItemModel>
#include <QHeaderView>
#include <QTableView>
#include <QTimer>

namespace
{
/// What the hint of the filter names; empty without.
QStringList namesFor(pqOutputPort* port)
{
  vtkPVXMLElement* const hints = port->getSource()->getProxy()->GetHints();
  vtkPVXMLElement* const hint = hints ? hints->FindNestedElementByName("FirstColumns") : nullptr;
  int wanted = -1;
  if (!hint || !hint->GetScalarAttribute("port", &wanted) || wanted != port->getPortNumber())
  {
    return {};
  }
  return QString(hint->GetAttribute("names")).split(' ');
}

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

void FirstColumns::startup()
{
  QObject::connect(pqApplicationCore::instance()->getServerManagerModel(),
    SIGNAL(representationAdded(pqRepresentation*)), this, SLOT(added(pqRepresentation*)));
}

void FirstColumns::added(pqRepresentation* representation)
{
  if (qobject_cast<pqDataRepresentation*>(representation))
  {
    QObject::connect(representation, SIGNAL(dataUpdated()), this, SLOT(dataUpdated()));
  }
}

void FirstColumns::dataUpdated()
{
  auto* const shown = qobject_cast<pqDataRepresentation*>(this->sender());
  pqOutputPort* const port = shown ? shown->getOutputPortFromInput() : nullptr;
  const QStringList names = port ? namesFor(port) : QStringList();
  pqView* const view = shown ? shown->getView() : nullptr;
  auto* const table = view && view->widget() ? view->widget()->findChild<QTableView*>() : nullptr;
  if (names.isEmpty() || !table || !table->model() || this->Known.contains(table))
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
