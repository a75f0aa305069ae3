// SPDX-License-Identifier: BSD-3-Clause
#ifndef Ancestor_h
#define Ancestor_h

#include <QWidget>

/// The nearest widget of a class that `widget` lies in, or null.
template <class Ancestor>
Ancestor* ancestorOf(const QWidget* widget)
{
  Ancestor* found = nullptr;
  for (; widget && !found; widget = widget->parentWidget())
  {
    found = qobject_cast<Ancestor*>(widget->parentWidget());
  }
  return found;
}

#endif
