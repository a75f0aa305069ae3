// SPDX-License-Identifier: BSD-3-Clause
#include "FirstHit.h"

#include <pqApplicationCore.h>

#include <QAbstractItemModel>
#include <QApplication>
#include <QEvent>
#include <QKeyEvent>
#include <QListWidget>
#include <QTimer>

void FirstHit::startup()
{
  QObject::connect(
    pqApplicationCore::instance(), SIGNAL(aboutToShowQuickLaunch()), this, SLOT(aboutToShow()));
}

void FirstHit::aboutToShow()
{
  qApp->installEventFilter(this);
}

bool FirstHit::eventFilter(QObject* watched, QEvent* event)
{
  const QEvent::Type type = event->type();
  if (type == QEvent::Show && watched->inherits("pqQuickLaunchDialog"))
  {
    // Filters that are available, and those that are not.
    this->Lists = watched->findChildren<QListWidget*>();
    for (QListWidget* const hits : this->Lists)
    {
      QObject::connect(hits->model(), &QAbstractItemModel::rowsInserted, hits,
        [hits] { QTimer::singleShot(0, hits, [hits] { FirstHit::order(hits); }); });
    }
  }
  else if (type == QEvent::Hide && watched->inherits("pqQuickLaunchDialog"))
  {
    this->Lists.clear();
    qApp->removeEventFilter(this);
  }
  else if (type == QEvent::KeyPress)
  {
    // On a busy machine Enter may come before the timer.
    const int key = static_cast<QKeyEvent*>(event)->key();
    if (key == Qt::Key_Return || key == Qt::Key_Enter)
    {
      for (QListWidget* const hits : this->Lists)
      {
        FirstHit::order(hits);
      }
    }
  }
  return QObject::eventFilter(watched, event);
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
