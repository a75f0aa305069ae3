// SPDX-License-Identifier: BSD-3-Clause
// What the properties panel of ParaView's window shows, for tests: a library that a script loads
// into the window's process.
#include <QApplication>
#include <QDockWidget>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QLabel>
#include <QLineEdit>
#include <QMainWindow>
#include <QScrollArea>
#include <QTreeWidget>

#include <cstring>

namespace
{
template <typename Widget>
Widget* named(const char* name)
{
  for (QWidget* const top : QApplication::topLevelWidgets())
  {
    if (auto* const found = top->findChild<Widget*>(name))
    {
      return found;
    }
  }
  return nullptr;
}

QString textOf(const QWidget* widget)
{
  const auto* const label = qobject_cast<const QLabel*>(widget);
  const auto* const field = qobject_cast<const QLineEdit*>(widget);
  return label ? label->text() : field ? field->text() : QString();
}
}

/// A JSON text, to be freed, of the panel in a dock of this width in pixels, 0 as it is: "dock" and
/// "width", those of the dock and of what is seen of the panel; "height"; "rows", the names of its rows,
/// titles that fold included; "titles", with what each of them says; "texts", all that labels and
/// fields say; "styles", of labels with a style of their own, by their texts; "cut", what the edge
/// of the dock cuts off; "table", the rows of the table of surfaces that are not hidden, each with
/// its texts, whether it is ticked and whether it is selected; "columns", those that it shows;
/// "bars", the minimum that each bar of quality marks, by its name.
extern "C" Q_DECL_EXPORT char* panel_rows(int width)
{
  auto* const dock = named<QDockWidget>("propertiesDock");
  auto* const window = qobject_cast<QMainWindow*>(dock->parentWidget());
  if (width > 0)
  {
    window->resizeDocks({ dock }, { width }, Qt::Horizontal);
  }
  for (int i = 0; i < 5; ++i)
  {
    QApplication::processEvents();
  }
  auto* const panel = dock->findChild<QWidget*>("ProxyPanel");
  auto* const area = dock->findChild<QScrollArea*>("scrollArea");
  QJsonArray rows, texts, cut, table;
  auto* const surfaces = panel->findChild<QTreeWidget*>("Rows");
  for (int i = 0; surfaces && i < surfaces->topLevelItemCount(); ++i)
  {
    const QTreeWidgetItem* const row = surfaces->topLevelItem(i);
    if (!row->isHidden())
    {
      QJsonArray cells;
      for (int column = 0; column < surfaces->columnCount(); ++column)
      {
        cells.append(row->text(column));
      }
      cells.append(row->checkState(0) == Qt::Checked);
      cells.append(row->isSelected());
      table.append(cells);
    }
  }
  QJsonArray columns;
  for (int column = 0; surfaces && column < surfaces->columnCount(); ++column)
  {
    if (!surfaces->isColumnHidden(column))
    {
      columns.append(surfaces->headerItem()->text(column));
    }
  }
  QJsonObject titles, styles, bars;
  for (QWidget* const one : panel->findChildren<QWidget*>())
  {
    if (!one->isVisible())
    {
      continue;
    }
    const bool isTitle = one->inherits("FoldTitle");
    if (one->parentWidget() == panel && (isTitle || one->inherits("pqPropertyWidget")))
    {
      rows.append(one->objectName());
    }
    if (isTitle)
    {
      titles[one->objectName()] = one->property("held").toString();
    }
    if (one->inherits("QualityBar"))
    {
      bars[one->objectName()] = one->property("minimum").toDouble();
    }
    if (!textOf(one).isEmpty())
    {
      texts.append(textOf(one));
      styles[textOf(one)] = one->styleSheet();
    }
    const int right = one->mapTo(area->viewport(), QPoint(one->width(), 0)).x();
    if (right > area->viewport()->width())
    {
      cut.append(QString("%1 %2 (%3)")
                   .arg(one->metaObject()->className(), one->objectName())
                   .arg(one->minimumSizeHint().width()));
    }
  }
  const QJsonObject all{ { "width", area->viewport()->width() }, { "dock", dock->width() },
    { "height", panel->height() }, { "rows", rows }, { "table", table }, { "columns", columns },
    { "texts", texts }, { "styles", styles }, { "cut", cut }, { "titles", titles },
    { "bars", bars } };
  return strdup(QJsonDocument(all).toJson(QJsonDocument::Compact).data());
}
