// SPDX-License-Identifier: BSD-3-Clause
#include "FirstReader.h"

#include <QApplication>
#include <QEvent>
#include <QListWidget>

void FirstReader::startup()
{
  qApp->installEventFilter(this); // each dialog is another object
}

bool FirstReader::eventFilter(QObject* watched, QEvent* event)
{
  if (event->type() == QEvent::Show && watched->inherits("pqSelectReaderDialog"))
  {
    for (QListWidget* const readers : watched->findChildren<QListWidget*>())
    {
      const QList<QListWidgetItem*> own =
        readers->findItems(QStringLiteral("Solver File Reader"), Qt::MatchExactly);
      if (!own.isEmpty())
      {
        readers->setSortingEnabled(false);
        readers->insertItem(0, readers->takeItem(readers->row(own[0])));
        readers->setCurrentRow(0);
      }
    }
  }
  return QObject::eventFilter(watched, event);
}
