// SPDX-License-Identifier: BSD-3-Clause
#include "FirstReader.h"

#include <QApplication>
#include <QDialog>
#include <QEvent>
#include <QListWidget>
#include <QTimer>

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
        readers->setCurrentItem(own[0]);
        QTimer::singleShot(0, watched, [watched] { static_cast<QDialog*>(watched)->accept(); });
      }
    }
  }
  return QObject::eventFilter(watched, event);
}
