// SPDX-License-Identifier: BSD-3-Clause
#include "PanelWords.h"

#include <QRegularExpression>
#include <QString>

QString inPanelWords(const QString& message)
{
  static const QRegularExpression quoted("`(\\w+)`"), inner("(?<=[a-z])(?=[A-Z])");
  QString words;
  int from = 0;
  for (auto found = quoted.globalMatch(message); found.hasNext();)
  {
    const QRegularExpressionMatch one = found.next();
    words += message.mid(from, one.capturedStart() - from) + one.captured(1).replace(inner, " ");
    from = one.capturedEnd();
  }
  return words + message.mid(from);
}
