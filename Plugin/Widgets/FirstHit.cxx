// SPDX-License-Identifier: BSD-3-Clause
#include "FirstHit.h"

#include <pqApplicationCore.h>

#include <QAbstractItemModel>
#include <QApplication>
#include <QListWidget>
#include <QTimer>

void FirstHit::startup()
{
  QObject::connect(
    pqApplicationCore::instance(), SIGNAL(aboutToShowQuickLaunch()), this, SLOT(aboutToShow()));
}

void FirstHit::aboutToShow()
{
  // The dialog has the event loop then.
  QTimer::singleShot(0, this,
    []
    {
      QWidget* const dialog = QApplication::activeModalWidget();
      auto* const hits = dialog && dialog->inherits("pqQuickLaunchDialog")
                           ? dialog->findChild<QListWidget*>()
                           : nullptr;
      if (hits)
      {
        QObject::connect(hits->model(), &QAbstractItemModel::rowsInserted, hits,
          [hits] { QTimer::singleShot(0, hits, [hits] { FirstHit::order(hits); }); });
      }
    });
}

void FirstHit::order(QListWidget* hits)
{
  int first = -1;
  for (int row = 0; row < hits->count(); ++row)
  {
    const QString text = hits->item(row)->text();
    if (first < 0 && text.startsWith("Morph "))
    {
      first = row;
    }
    if (text == "Morph Mesh" && row > first)
    {
      hits->insertItem(first, hits->takeItem(row));
      hits->setCurrentRow(0);
      return;
    }
  }
}
