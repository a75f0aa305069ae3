// SPDX-License-Identifier: BSD-3-Clause
// Where things are on the screen, for tests that press the real mouse: a part of the library that
// a script loads into the window's process.
#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAction>
#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QDockWidget>
#include <QFile>
#include <QJsonDocument>
#include <QJsonObject>
#include <QLabel>
#include <QLineEdit>
#include <QMainWindow>
#include <QMenu>
#include <QScrollArea>
#include <QScrollBar>
#include <QStyle>
#include <QStyleOptionButton>
#include <QTimer>
#include <QToolButton>
#include <QTreeWidget>

#include <functional>

namespace
{
/// The visible widget at the end of a path of names; other widgets may be between them.
QWidget* widgetAt(const QString& path)
{
  const QStringList names = path.split('/');
  std::function<QWidget*(QWidget*, int)> find = [&](QWidget* from, int i) -> QWidget*
  {
    if (i == names.size())
    {
      return from->isVisible() ? from : nullptr;
    }
    for (QWidget* const child : from->findChildren<QWidget*>(names[i]))
    {
      if (QWidget* const found = find(child, i + 1))
      {
        return found;
      }
    }
    return nullptr;
  };
  for (QWidget* const top : QApplication::topLevelWidgets())
  {
    if (top->isVisible() && top->objectName() == names[0])
    {
      if (QWidget* const found = find(top, 1))
      {
        return found;
      }
    }
    if (QWidget* const found = top->isVisible() ? find(top, 0) : nullptr)
    {
      return found;
    }
  }
  return nullptr;
}

QJsonObject placeOf(const QWidget* widget, const QRect& rectangle)
{
  const QPoint corner = widget->mapToGlobal(rectangle.topLeft());
  return { { "x", corner.x() }, { "y", corner.y() }, { "width", rectangle.width() },
    { "height", rectangle.height() }, { "enabled", widget->isEnabled() } };
}

/// As a user who turns the wheel until it is seen.
void scrollTo(QWidget* widget)
{
  for (QWidget* above = widget->parentWidget(); above; above = above->parentWidget())
  {
    if (auto* const area = qobject_cast<QScrollArea*>(above))
    {
      area->ensureWidgetVisible(widget);
      QApplication::processEvents();
    }
  }
}

QJsonObject rowOf(QAbstractItemView* view, const QString& text)
{
  std::function<QModelIndex(const QModelIndex&)> find = [&](const QModelIndex& parent)
  {
    for (int i = 0; i < view->model()->rowCount(parent); ++i)
    {
      const QModelIndex row = view->model()->index(i, 0, parent);
      if (row.data().toString() == text)
      {
        return row;
      }
      const QModelIndex below = find(row);
      if (below.isValid())
      {
        return below;
      }
    }
    return QModelIndex();
  };
  const QModelIndex row = find(QModelIndex());
  if (!row.isValid())
  {
    return {};
  }
  scrollTo(view);
  view->scrollTo(row);
  view->horizontalScrollBar()->setValue(0);
  return placeOf(view->viewport(), view->visualRect(row));
}

/// An entry of the menu or the list that is open.
QJsonObject entryOf(const QString& text)
{
  QWidget* const popup = QApplication::activePopupWidget();
  if (auto* const menu = qobject_cast<QMenu*>(popup))
  {
    for (QAction* const action : menu->actions())
    {
      if (action->text().remove('&') == text)
      {
        return placeOf(menu, menu->actionGeometry(action));
      }
    }
  }
  auto* const list = popup ? popup->findChild<QAbstractItemView*>() : nullptr;
  return list ? rowOf(list, text) : QJsonObject();
}

QString textOf(const QWidget* widget)
{
  const auto* const label = qobject_cast<const QLabel*>(widget);
  const auto* const field = qobject_cast<const QLineEdit*>(widget);
  const auto* const list = qobject_cast<const QComboBox*>(widget);
  return label   ? label->text()
         : field ? field->text()
         : list  ? list->currentText()
                 : widget->property("text").toString();
}

/// A button by its text, or by the name or the text of its action.
QJsonObject buttonOf(const QString& text)
{
  for (QWidget* const one : QApplication::allWidgets())
  {
    auto* const button = qobject_cast<QAbstractButton*>(one);
    auto* const tool = qobject_cast<QToolButton*>(one);
    const QAction* const action = tool ? tool->defaultAction() : nullptr;
    if (button && button->isVisible() &&
        (button->text().remove('&') == text ||
          (action && (action->objectName() == text || action->text().remove('&') == text))))
    {
      scrollTo(button);
      return placeOf(button, button->rect());
    }
  }
  return {};
}

/// `question`: what, and where, and what of that, apart by tabs.
QJsonObject answer(const QString& question)
{
  const QStringList parts = question.split('\t');
  if (parts[0] == "entry")
  {
    return entryOf(parts[1]);
  }
  if (parts[0] == "button")
  {
    return buttonOf(parts[1]);
  }
  QWidget* const widget = widgetAt(parts[1]);
  if (!widget)
  {
    return {};
  }
  if (parts[0] == "row")
  {
    auto* const view = qobject_cast<QAbstractItemView*>(widget);
    return view ? rowOf(view, parts[2]) : QJsonObject();
  }
  scrollTo(widget);
  QRect rectangle = widget->rect();
  if (auto* const tick = qobject_cast<QCheckBox*>(widget))
  {
    QStyleOptionButton option;
    option.initFrom(tick);
    rectangle = tick->style()->subElementRect(QStyle::SE_CheckBoxIndicator, &option, tick);
  }
  QJsonObject place = placeOf(widget, rectangle);
  place["text"] = textOf(widget);
  return place;
}
}

/// Answers questions in the file `path`, one at a time, from the event loop: the answer comes in a
/// file with ".answer" added, once the window is idle. The dock of the panel gets a width of `dock`
/// pixels: ParaView's own rows do not fit into its first one.
extern "C" Q_DECL_EXPORT void serve_places(const char* path, int dock)
{
  const QString asked = path;
  auto* const timer = new QTimer(qApp);
  QObject::connect(timer, &QTimer::timeout, timer,
    [asked, dock]
    {
      auto* const panel = qobject_cast<QDockWidget*>(widgetAt("propertiesDock"));
      auto* const window = panel ? qobject_cast<QMainWindow*>(panel->parentWidget()) : nullptr;
      if (window && panel->width() != dock)
      {
        window->resizeDocks({ panel }, { dock }, Qt::Horizontal);
      }
      QFile question(asked);
      if (!question.open(QIODevice::ReadOnly))
      {
        return;
      }
      const QString text = QString::fromUtf8(question.readAll());
      question.close();
      question.remove();
      QFile made(asked + ".made");
      if (made.open(QIODevice::WriteOnly))
      {
        made.write(QJsonDocument(answer(text)).toJson(QJsonDocument::Compact));
        made.close();
        made.rename(asked + ".answer");
      }
    });
  timer->start(20);
}
