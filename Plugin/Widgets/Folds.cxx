// SPDX-License-Identifier: BSD-3-Clause
#include "Folds.h"

#include "Ancestor.h"
#include "Fold.h"
#include "FoldTitle.h"

#include <pqPropertiesPanel.h>
#include <pqPropertyWidget.h>
#include <pqSearchBox.h>

#include <QComboBox>
#include <QEvent>
#include <QGridLayout>
#include <QStringList>
#include <QTimer>

#include <algorithm>

namespace
{
/// ParaView's title of a group, which it keeps above each row of it; null where there is none.
QWidget* headerAbove(QGridLayout* grid, QWidget* widget, int& row)
{
  int column = 0, rows = 0, columns = 0;
  const int index = grid->indexOf(widget);
  if (index < 0)
  {
    return nullptr;
  }
  grid->getItemPosition(index, &row, &column, &rows, &columns);
  QLayoutItem* const above = row > 0 ? grid->itemAtPosition(--row, 0) : nullptr;
  QWidget* const header = above ? above->widget() : nullptr;
  return qobject_cast<pqPropertyWidget*>(header) ? nullptr : header;
}
}

Folds* Folds::Of(QWidget* panel)
{
  auto* const known = panel->findChild<Folds*>(QString(), Qt::FindDirectChildrenOnly);
  return known ? known : new Folds(panel);
}

Folds::Folds(QWidget* panel)
  : Superclass(panel)
{
  panel->installEventFilter(this);
}

Folds::~Folds() = default;

void Folds::add(const QString& title, Fold* row)
{
  this->Groups[title].Rows.append(row);
}

bool Folds::isOpen(const QString& title) const
{
  const Group& group = *this->Groups.constFind(title);
  const auto isSet = [](const Fold* row) { return row && !row->isDefault(); };
  return this->isSearched() ||
         (group.Asked ? group.Open : std::any_of(group.Rows.begin(), group.Rows.end(), isSet));
}

bool Folds::isSearched() const
{
  return this->Search && !this->Search->text().isEmpty();
}

bool Folds::withAdvanced() const
{
  return this->Search && this->Search->isAdvancedSearchActive();
}

bool Folds::eventFilter(QObject* object, QEvent* event)
{
  if (event->type() == QEvent::LayoutRequest || event->type() == QEvent::Show)
  {
    this->refreshLater();
  }
  return this->Superclass::eventFilter(object, event);
}

void Folds::refreshLater()
{
  if (!this->Due)
  {
    this->Due = true;
    QTimer::singleShot(0, this, [this] { this->refresh(); });
  }
}

void Folds::place(const QString& title, Group& group)
{
  auto* const panel = static_cast<QWidget*>(this->parent());
  auto* const grid = qobject_cast<QGridLayout*>(panel->layout());
  for (int i = 0; grid && i < group.Rows.size(); ++i)
  {
    int row = 0;
    QWidget* const header =
      group.Rows[i] ? headerAbove(grid, group.Rows[i]->parentWidget(), row) : nullptr;
    if (header && !group.Title)
    {
      group.Title = new FoldTitle(title, panel);
      grid->addWidget(group.Title, row, 0, 1, -1);
      QObject::connect(group.Title, &QToolButton::clicked, this,
        [this, title](bool open)
        {
          Group& clicked = this->Groups[title];
          clicked.Asked = true;
          clicked.Open = open;
          Q_EMIT clicked.Rows.first()->visibilityChanged();
        });
    }
    if (header)
    {
      header->setMaximumHeight(this->isSearched() ? QWIDGETSIZE_MAX : 0);
    }
  }
}

/// By default a list of choices is as wide as its longest entry, and all of the panel then needs a
/// scroll bar. All of an entry is in the open list.
void Folds::narrow() const
{
  for (auto* const list : static_cast<QWidget*>(this->parent())->findChildren<QComboBox*>())
  {
    if (list->minimumWidth() == 0)
    {
      list->setMinimumWidth(12 * list->fontMetrics().averageCharWidth());
    }
  }
}

void Folds::refresh()
{
  this->Due = false;
  this->narrow();
  auto* const panel = static_cast<QWidget*>(this->parent());
  if (!this->Search)
  {
    const auto* const above = ancestorOf<pqPropertiesPanel>(panel);
    this->Search = above ? above->findChild<pqSearchBox*>() : nullptr;
    if (this->Search)
    {
      QObject::connect(this->Search, &pqSearchBox::textChanged, this, &Folds::refreshLater);
      QObject::connect(
        this->Search, &pqSearchBox::advancedSearchActivated, this, &Folds::refreshLater);
    }
  }
  for (auto it = this->Groups.begin(); it != this->Groups.end(); ++it)
  {
    Group& group = it.value();
    group.Rows.removeAll(nullptr);
    this->place(it.key(), group);
    if (!group.Title)
    {
      continue;
    }
    bool isOffered = false;
    QStringList held;
    for (const Fold* row : group.Rows)
    {
      isOffered = isOffered || row->isOffered(this->withAdvanced());
      const QString told = row->told();
      if (!told.isEmpty())
      {
        held << told;
      }
    }
    group.Title->setHeld(held.join(", "));
    group.Title->setVisible(isOffered && !this->isSearched());
    if (group.Title->isChecked() != this->isOpen(it.key()))
    {
      group.Title->setChecked(this->isOpen(it.key()));
      Q_EMIT group.Rows.first()->visibilityChanged();
    }
  }
}
