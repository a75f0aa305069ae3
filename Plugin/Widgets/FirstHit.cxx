// SPDX-License-Identifier: BSD-3-Clause
#include "FirstHit.h"

#include <pqApplicationCore.h>

#include <QAbstractItemModel>
#include <QApplication>
#include <QEvent>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QListView>
#include <QListWidget>
#include <QTimer>

namespace
{
const QString First = QStringLiteral("Morph Mesh");
const QString Others = QStringLiteral("Morph ");

bool isMeant(const QString& typed)
{
  return !typed.isEmpty() && First.startsWith(typed, Qt::CaseInsensitive);
}

void moveUp(QListWidget* hits)
{
  int first = -1;
  for (int row = 0; row < hits->count(); ++row)
  {
    const QString text = hits->item(row)->text();
    if (first < 0 && text.startsWith(Others))
    {
      first = row;
    }
    if (text == First && row > first)
    {
      hits->insertItem(first, hits->takeItem(row));
      hits->setCurrentRow(0);
      return;
    }
  }
}
}

void FirstHit::startup()
{
  // The application that loads the plugin from PV_PLUGIN_PATH is still under construction, and has
  // this signal only when it is whole.
  QTimer::singleShot(0, this,
    [this]
    {
      QObject::connect(
        pqApplicationCore::instance(), SIGNAL(aboutToShowQuickLaunch()), this, SLOT(aboutToShow()));
    });
}

void FirstHit::aboutToShow()
{
  qApp->installEventFilter(this);
}

bool FirstHit::eventFilter(QObject* watched, QEvent* event)
{
  const QEvent::Type type = event->type();
  if (type == QEvent::Show && watched->inherits("pqQuickLaunchDialogExtended"))
  {
    FirstHit::selectIn(watched);
    qApp->removeEventFilter(this);
  }
  else if (type == QEvent::Show && watched->inherits("pqQuickLaunchDialog"))
  {
    this->Dialog = watched;
    for (QListWidget* const hits : watched->findChildren<QListWidget*>())
    {
      QObject::connect(hits->model(), &QAbstractItemModel::rowsInserted, watched,
        [watched] { QTimer::singleShot(0, watched, [watched] { FirstHit::order(watched); }); });
    }
  }
  else if (type == QEvent::Hide && watched == this->Dialog)
  {
    this->Dialog = nullptr;
    qApp->removeEventFilter(this);
  }
  else if (type == QEvent::KeyPress && this->Dialog)
  {
    // On a busy machine Enter may come before the timer.
    const int key = static_cast<QKeyEvent*>(event)->key();
    if (key == Qt::Key_Return || key == Qt::Key_Enter)
    {
      FirstHit::order(this->Dialog);
    }
  }
  return QObject::eventFilter(watched, event);
}

void FirstHit::order(QObject* dialog)
{
  // It reads "( morph )".
  const auto* const typed = dialog->findChild<QLabel*>("searchString");
  if (!typed || !isMeant(typed->text().mid(2).chopped(2)))
  {
    return;
  }
  for (QListWidget* const hits : dialog->findChildren<QListWidget*>())
  {
    moveUp(hits);
  }
}

void FirstHit::selectIn(QObject* dialog)
{
  auto* const request = dialog->findChild<QLineEdit*>("Request");
  auto* const hits = dialog->findChild<QListView*>("AvailableProxies");
  if (!request || !hits)
  {
    return;
  }
  // The dialog's own slot, which is connected before, has updated the list.
  QObject::connect(request, &QLineEdit::textChanged, hits,
    [hits](const QString& typed)
    {
      if (!isMeant(typed) || !hits->currentIndex().data().toString().startsWith(Others))
      {
        return;
      }
      for (int row = 0; row < hits->model()->rowCount(); ++row)
      {
        const QModelIndex index = hits->model()->index(row, 0);
        if (index.data().toString() == First)
        {
          hits->setCurrentIndex(index);
        }
      }
    });
}
